#include "tests/host/cell/synthetic.hpp"

#include <algorithm>
#include <numbers>

#include "host/planner/interference/interference.hpp"
#include "tests/host/planner/interference/test_designs.hpp"

namespace pinjaw::cell::testing {
namespace {

using geometry::Pose2;
using model::JawSide;
using model::Side;
using planner::Adjustment;

constexpr double kPi = std::numbers::pi;
constexpr double kPartHeight_mm = 40;

int column(const model::Design& design, JawSide jaw, bool least) {
  std::vector<int> columns;
  for (const model::PinDesign& pin : design.pins) {
    if (pin.hole.jaw == jaw) columns.push_back(pin.hole.column);
  }
  if (columns.empty()) return 0;
  return least ? std::ranges::min(columns) : std::ranges::max(columns);
}

/// One column further out on the left, where there is room.
void add_alternative(model::Design& design, const model::Kit& kit) {
  const double s_mm = design.jaw_separation_mm - kit.grid.spacing_mm;
  if (s_mm < kit.jaws.separation_mm.lo || column(design, JawSide::Left, false) + 1 >= kit.grid.columns)
    return;
  design.alternatives.push_back(
      {column(design, JawSide::Left, true) + 1, column(design, JawSide::Right, true), s_mm});
}

struct Stood {
  planner::Hold hold;
  planner::FingerSet fingers;
};

/// A design in each stance that its station may choose.
std::vector<Stood> stances(const TestStation& station, std::size_t index, bool own_only) {
  const model::Task& task = station.station.task;
  const model::Design& design = station.designs[index];
  std::vector<Stood> all;
  for (const planner::Stance& stance : planner::stances_of(design, task.kit)) {
    const model::Design there = planner::moved(design, task.kit, stance);
    all.push_back(
        {{task.side, there.part_pose},
         planner::fingers_of(there, {&task.kit, task.side, station.station.grips}, station.part_low_mm)});
    if (own_only) break;
  }
  return all;
}

std::size_t handoffs_at(const TestCell& cell, std::size_t station) {
  return static_cast<std::size_t>(std::ranges::count_if(cell.handoffs, [&](const StationPair& pair) {
    return pair.giver == station || pair.receiver == station;
  }));
}

class Trial {
 public:
  Trial(const TestCell& cell, const References& references) : cell_(cell), references_(references) {
    for (std::size_t i = 0; i < cell.stations.size(); ++i) {
      const bool own_only = handoffs_at(cell, i) > 1 || i == references.offset;
      all_.emplace_back();
      for (std::size_t k = 0; k < cell.stations[i].designs.size(); ++k) {
        all_.back().push_back(stances(cell.stations[i], k, own_only));
      }
    }
  }

  Tried run() {
    designs_.assign(cell_.stations.size(), 0);
    next(0);
    std::ranges::sort(tried_.combinations);
    return std::move(tried_);
  }

 private:
  void next(std::size_t station) {
    if (station == cell_.stations.size()) {
      stood_.assign(cell_.stations.size(), nullptr);
      if (stands(0)) tried_.combinations.push_back({score_n(), designs_});
      return;
    }
    for (designs_[station] = 0; designs_[station] < all_[station].size(); ++designs_[station]) {
      next(station + 1);
    }
    designs_[station] = 0;
  }

  bool stands(std::size_t station) {
    if (station == stood_.size()) return possible();
    return std::ranges::any_of(all_[station][designs_[station]], [&](const Stood& stood) {
      stood_[station] = &stood;
      return stands(station + 1);
    });
  }

  /// The reference stations stand at 0; all others are adjusted to them.
  [[nodiscard]] bool possible() const {
    const Stood& offset = *stood_[references_.offset];
    const Adjustment turn = planner::required_adjustment(stood_[references_.theta]->hold, {}, offset.hold);
    const Adjustment known{turn.theta_rad, {0, 0}};
    for (std::size_t i = 0; i < stood_.size(); ++i) {
      const Adjustment adjustment = planner::required_adjustment(offset.hold, known, stood_[i]->hold);
      if (!planner::within(adjustment, cell_.stations[i].station.adjust)) return false;
    }
    return std::ranges::all_of(cell_.handoffs, [&](const StationPair& pair) {
      return planner::check_handoff(stood_[pair.giver]->fingers, stood_[pair.receiver]->fingers).compatible();
    });
  }

  [[nodiscard]] double score_n() const {
    double score_n = 0;
    for (std::size_t i = 0; i < designs_.size(); ++i) {
      const TestStation& station = cell_.stations[i];
      if (station.station.grips) score_n = std::max(score_n, station.designs[designs_[i]].squeeze.required_n);
    }
    return score_n;
  }

  const TestCell& cell_;
  References references_;
  std::vector<std::vector<std::vector<Stood>>> all_;  ///< station, design, stance
  std::vector<std::uint32_t> designs_;
  std::vector<const Stood*> stood_;
  Tried tried_;
};

}  // namespace

StationKind arm() {
  return {"arm", Side::Above, true, {{0, 0}, {0, 0}, {-kPi, kPi}}};
}
StationKind pedestal() {
  return {"pedestal", Side::Below, true, {{-9, 9}, {-9, 9}, {0, 0}}};
}
StationKind pallet() {
  return {"pallet", Side::Below, false, {{-7, 7}, {-7, 7}, {-kPi, kPi}}};
}

TestStation random_station(base::Random& random, const StationKind& kind, std::size_t designs) {
  TestStation result;
  result.station.name = kind.name;
  result.station.grips = kind.grips;
  result.station.adjust = kind.adjust;
  result.station.task.side = kind.side;
  result.station.task.kit = planner::testing::kit();
  result.part_low_mm = kind.side == Side::Above ? -kPartHeight_mm : 0;
  for (std::size_t i = 0; i < designs; ++i) {
    model::Design design = planner::testing::random_design(random, result.part_low_mm, kPartHeight_mm);
    for (model::PinDesign& pin : design.pins) {
      const double contact_mm =
          model::p_GHole_mm(result.station.task.kit.grid, pin.hole, design.jaw_separation_mm).x();
      pin.contact_mm.x() = contact_mm + 2.5 * pin.normal.x();
    }
    if (!kind.grips) {
      design.pins.resize(2);
      design.jaw_open_mm = design.jaw_separation_mm;
    }
    design.id = kind.name + std::to_string(i);
    design.squeeze.required_n = kind.grips ? std::floor(random.uniform(10, 20)) : 0;
    add_alternative(design, result.station.task.kit);
    result.designs.push_back(design);
  }
  std::ranges::stable_sort(result.designs, {}, [](const model::Design& d) { return d.squeeze.required_n; });
  return result;
}

void move_part_frame(TestStation& station, const Pose2& motion) {
  Pose2 seen = motion;
  if (station.station.task.side == Side::Above) {
    seen = {-motion.theta_rad, {-motion.t_mm.x(), motion.t_mm.y()}};
  }
  for (model::Design& design : station.designs) design.part_pose = design.part_pose * seen.inverse();
}

Joined joined(const TestCell& cell, std::size_t top) {
  std::vector<PlanBounds> bounds;
  for (const TestStation& one : cell.stations) {
    bounds.emplace_back(one.station.task.side, one.station.adjust);
  }
  Joined answer;
  answer.references = references_of(bounds);
  const TreeOutcome tree =
      handoff_tree(cell.stations.size(), cell.handoffs, {answer.references.theta, answer.references.offset});
  std::vector<StationSetups> setups;
  for (std::size_t i = 0; i < cell.stations.size(); ++i) {
    const bool chooses = handoffs_at(cell, i) == 1 && i != answer.references.offset;
    const TestStation& one = cell.stations[i];
    setups.push_back(
        setups_of(one.station, one.designs, one.part_low_mm, chooses ? Stances::All : Stances::OwnOnly));
  }
  std::vector<Partners> partners;
  answer.pairs.resize(cell.handoffs.size());
  for (const HandoffTree::Link& link : tree.tree.links) {
    partners.push_back(partners_of(setups[link.near], setups[link.far]));
    answer.pairs[link.handoff] = count(partners.back());
  }
  answer.result = join({&setups, &tree.tree, &partners, answer.references}, top);
  return answer;
}

Tried tried(const TestCell& cell, const References& references) {
  return Trial(cell, references).run();
}

}  // namespace pinjaw::cell::testing
