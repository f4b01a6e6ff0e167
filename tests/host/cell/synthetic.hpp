#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/base/random.hpp"
#include "host/cell/join.hpp"

/// Small cells of designs that hold nothing but stand in every relation to each other, and a join of them
/// that tries everything.
namespace pinjaw::cell::testing {

/// A station with its designs, least squeeze first.
struct TestStation {
  model::Station station;
  std::vector<model::Design> designs;
  double part_low_mm = 0;  ///< of the part as the station sees it
};

struct StationKind {
  std::string name;
  model::Side side = model::Side::Below;
  bool grips = true;
  model::Adjust adjust;
};

TestStation random_station(base::Random& random, const StationKind& kind, std::size_t designs);

/// The cell of the paper (BB 4.1): an arm that turns, a pedestal that slides, a pallet that does both.
StationKind arm();
StationKind pedestal();
StationKind pallet();

/// The part, and all designs with it, told in a frame that is moved by `motion`.
void move_part_frame(TestStation& station, const geometry::Pose2& motion);

struct TestCell {
  std::vector<TestStation> stations;
  std::vector<StationPair> handoffs;
};

/// What the join says.
struct Joined {
  std::vector<std::int64_t> pairs;  ///< in the order of the handoffs
  JoinResult result;
  References references;
};
Joined joined(const TestCell& cell, std::size_t top);

/// What trying every design and every stance says. `combinations`: designs and score, in the join's order.
struct Tried {
  struct Combination {
    double score_n = 0;
    std::vector<std::uint32_t> designs;
    friend auto operator<=>(const Combination&, const Combination&) = default;
  };
  std::vector<Combination> combinations;
};
Tried tried(const TestCell& cell, const References& references);

}  // namespace pinjaw::cell::testing
