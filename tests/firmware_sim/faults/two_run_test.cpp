// Promises: I4.
//
// The two-run property over every state and every kind of bad frame, seeded. tests/fuzz has the same oracle
// for libFuzzer.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/faults/bad_frames.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/nightly.hpp"

namespace pinjaw::core::test {
namespace {

std::string told(const BadFrame& bad) {
  std::string text = "frame " + std::to_string(bad.frame.id) + " of";
  for (const std::uint8_t byte : bad.frame.data) text += ' ' + std::to_string(byte);
  return text + " at " + std::to_string(bad.ms) + " ms";
}

TEST(Scenes, are_one_for_each_state) {
  ASSERT_EQ(scenes().size(), kStates);
  for (std::size_t s = 0; s < kStates; ++s) EXPECT_EQ(scenes()[s].state, static_cast<StateId>(s));
}

TEST(Scenes, have_every_message_of_the_table_in_their_past) {
  for (const Scene& scene : scenes()) {
    std::set<wire::MessageType> types;
    for (const wire::Frame& frame : scene.history) types.insert(wire::identify(frame)->type);
    EXPECT_EQ(types.size(), wire::kMessages.size()) << wire::to_string(scene.state);
  }
}

TEST(TwoRuns, do_not_differ_by_a_bad_frame) {
  constexpr std::uint64_t kSeed = 4;
  std::mt19937_64 engine(kSeed);
  const Choose choose = [&engine](std::uint32_t limit) {
    return static_cast<std::uint32_t>(engine() % limit);
  };
  const int rounds = pinjaw::test::by_night(4000, 60);
  std::map<Badness, std::int64_t> tried;
  int shown = 0;
  for (const Scene& scene : scenes()) {
    for (int kind = 0; kind < kBadnesses; ++kind) {
      for (int round = 0; round < rounds; ++round) {
        const auto bad = bad_frame(scene, static_cast<Badness>(kind), choose);
        if (!bad) continue;
        ++tried[static_cast<Badness>(kind)];
        const auto differs = two_runs_differ(scene, *bad);
        if (differs && ++shown <= 20)
          ADD_FAILURE() << "kind " << kind << ": " << told(*bad) << ": " << *differs;
      }
    }
  }
  std::int64_t all = 0;
  for (int kind = 0; kind < kBadnesses; ++kind) {
    EXPECT_GT(tried[static_cast<Badness>(kind)], rounds) << "kind " << kind;
    all += tried[static_cast<Badness>(kind)];
  }
  pinjaw::test::figure("I4", "pairs of runs in all 16 states that a bad frame did not change", all, "pairs");
}

TEST(TwoRuns, differ_by_a_good_frame_that_means_something) {
  const Scene& ready = scenes()[static_cast<std::size_t>(StateId::Ready)];
  const wire::Frame hold = wire::pack(wire::Command{.op = wire::Op::Hold}, {.node = ready.node});
  EXPECT_TRUE(two_runs_differ(ready, {hold, 0}));
  const Scene& relax = scenes()[static_cast<std::size_t>(StateId::Relax)];
  const auto last = last_counter(relax, 0, {.id = 0x040U + relax.peer});
  ASSERT_TRUE(last);
  const wire::Frame doubt = wire::pack(wire::Custody{.fact = wire::Fact::Empty},
                                       {.node = relax.peer, .counter = wire::next_counter(*last)});
  EXPECT_TRUE(two_runs_differ(relax, {doubt, 0}));
}

}  // namespace
}  // namespace pinjaw::core::test
