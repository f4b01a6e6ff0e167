#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/cell/cell_plan.hpp"
#include "host/model/sequence.hpp"
#include "host/planner/force/force.hpp"
#include "host/planner/plan/scene.hpp"
#include "protocol/wire/commands.hpp"
#include "protocol/wire/layout.hpp"

namespace pinjaw::sequence {

/// One station of a run: its design, the layout its controller is sent, and what squeeze its grip needs.
class Member {
 public:
  /// `squeeze`: F_set and F_permit that SQUEEZE commands; unused by a station that does not grip.
  Member(const model::Station& station, const model::Design& design, const wire::Layout& layout);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint8_t node() const { return node_; }
  [[nodiscard]] bool grips() const { return grips_; }
  [[nodiscard]] const model::Design& design() const { return design_; }
  [[nodiscard]] const wire::Layout& layout() const { return layout_; }
  [[nodiscard]] wire::Layout& layout() { return layout_; }
  [[nodiscard]] wire::SqueezeForces squeeze() const { return squeeze_; }

  /// Squeeze with which this station alone balances `wrench` (part frame); infinite where none does; 0 for
  /// one that does not grip.
  [[nodiscard]] double needed_n(const model::Wrench& wrench);

  /// A direction of the station's own frame, in the part frame while it holds the part.
  [[nodiscard]] model::Vector3d in_part_frame(const model::Vector3d& v_G) const;

 private:
  std::string name_;
  std::uint8_t node_;
  bool grips_;
  model::Side side_;
  model::Design design_;
  wire::Layout layout_;
  wire::SqueezeForces squeeze_;
  std::optional<planner::SqueezeSolver> solver_;
};

/// The stations of a run, each knowing its peers: every handoff of the cell is named in both layouts.
class Crew {
 public:
  static base::Expected<Crew> of(const model::Cell& cell, const cell::CellDesign& design,
                                 const planner::Scene& scene);

  [[nodiscard]] std::vector<Member>& members() { return members_; }
  [[nodiscard]] const std::vector<Member>& members() const { return members_; }
  /// Precondition: there is such a station (the sequence reader checked it).
  [[nodiscard]] Member& at(const std::string& station);

 private:
  std::vector<Member> members_;
};

}  // namespace pinjaw::sequence
