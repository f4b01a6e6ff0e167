#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware_sim/node/node.hpp"
#include "firmware_sim/world/force_record.hpp"
#include "firmware_sim/world/part_truth.hpp"
#include "protocol/bench/bench.hpp"

/// The simulated truth of a cell: the part and every station. It knows no planning: a run tells it where each
/// station's pins meet the part and what squeeze holds it. Its facts go out through bench::Truth alone.
namespace pinjaw::world {

/// One station and the end of the bus its controller talks on, which must outlive the world.
struct Member {
  node::Figures figures;
  bus::Bus* bus = nullptr;
};

class World {
 public:
  /// Members have different node numbers. Each station's specimen errors and noise are drawn from `seed` and
  /// its number, so that they do not depend on who else is there.
  World(const std::vector<Member>& members, std::uint64_t seed);

  /// One millisecond of the whole cell, or more of one where nothing happens. The first failure of a bus is
  /// handed back; the others' time passed too.
  bus::Expected<void> step(unsigned elapsed_ms = 1);

  /// Carries out a request now.
  bench::Reply handle(const bench::Request& request);

  [[nodiscard]] bench::Truth truth() const;
  [[nodiscard]] double time_s() const { return static_cast<double>(elapsed_ms_) * 1e-3; }

  /// Called with a line for every request and every change of what is held, touched, seated or over its
  /// limit.
  void on_event(std::function<void(const std::string&)> log) { log_ = std::move(log); }

  /// For tests and the program that owns the cell; nothing where there is no such node.
  [[nodiscard]] node::Node* find(int number);

 private:
  struct Station {
    std::unique_ptr<node::Node> node;
    bool known_grasp = false;  ///< the run told where its pins meet the part
    double contact_mm = 0;
    double needed_n = 0;
    bool meets = false;  ///< its frame is at the part
    bool local_enable = false;
    bool over_limit = false;
    bool touched = false;
    ForceRecord forces;
  };

  bench::Reply carry_out(const bench::Place& request);
  bench::Reply carry_out(const bench::Remove& request);
  bench::Reply carry_out(const bench::Meet& request);
  bench::Reply carry_out(const bench::Enable& request);
  bench::Reply carry_out(const bench::Move& request);
  bench::Reply carry_out(const bench::Rotate& request);
  bench::Reply carry_out(const bench::Disturb& request);
  bench::Reply carry_out(const bench::Power& request);
  bench::Reply carry_out(const bench::Break& request);
  bench::Reply carry_out(const bench::AskTruth& request) const;

  [[nodiscard]] Station* station(int number);
  [[nodiscard]] const Station* gripping_beside(const Station& one) const;
  /// The first of `nodes` that is no station, or whose closed jaws have no room for the part.
  [[nodiscard]] std::string why_not_at_part(const std::vector<int>& nodes);
  bench::Reply travel(int number, const char* how);

  [[nodiscard]] bool has_contact(const Station& one) const;
  [[nodiscard]] bool seated(const Station& one) const;
  [[nodiscard]] bool touches_part(const Station& one) const;
  [[nodiscard]] Touch touch_of(const Station& one) const;
  [[nodiscard]] node::Surroundings surroundings_of(const Station& one) const;
  [[nodiscard]] bench::NodeTruth node_truth(const Station& one) const;

  void observe();
  void observe_station(Station& one);
  void let_hand_go(const std::vector<Touch>& touched);
  void log(const std::string& text) const;

  std::vector<Station> stations_;  ///< ascending by node
  PartTruth part_;
  std::string disturbance_;
  bool removing_ = false;  ///< the hand at the part will take it away
  std::int64_t elapsed_ms_ = 0;
  std::function<void(const std::string&)> log_;
};

}  // namespace pinjaw::world
