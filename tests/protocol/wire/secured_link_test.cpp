// Promises: AUTH-FD.
#include "protocol/wire/secured_link.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "protocol/wire/commands.hpp"
#include "tests/support/figures.hpp"

/// Frames of CAN FD: only who knows the key is heard, and only once.
namespace pinjaw::wire {
namespace {

using Link = SecuredLink<15>;

constexpr Key kLinkKey{3, 1, 4, 1, 5, 9, 2, 6, 5, 3, 5, 8, 9, 7, 9, 3};

Frame custody(std::uint8_t node, std::uint8_t counter) {
  return pack(Custody{.fact = Fact::Take, .peer = 1, .token = 7, .pair = 9},
              {.node = node, .counter = counter});
}

/// Links on one wire; what each opens is counted.
struct Wire {
  explicit Wire(std::vector<std::uint8_t> nodes) {
    for (const std::uint8_t node : nodes) links.emplace_back(node, FrameNumber{node} << 20);
  }
  /// One millisecond: everybody hears `frames`, and each other's questions and answers of the last.
  void step(const std::vector<Frame>& frames = {}) {
    std::vector<Frame> now = frames;
    now.insert(now.end(), said.begin(), said.end());
    said.clear();
    for (Link& link : links) {
      for (const Frame& frame : now) {
        if (link.open(kLinkKey, frame)) ++opened;
      }
      if (const auto frame = link.speak(kLinkKey, 1)) said.push_back(*frame);
    }
    all.insert(all.end(), now.begin(), now.end());
  }
  void run(int ms) {
    for (int i = 0; i < ms; ++i) step();
  }
  std::vector<Link> links;
  std::vector<Frame> said;
  std::vector<Frame> all;  ///< everything that was on the wire
  int opened = 0;
};

/// Nodes 1 and 2 that know each other.
Wire acquainted() {
  Wire wire({1, 2});
  wire.run(1000);
  EXPECT_TRUE(wire.links[0].knows(2));
  EXPECT_TRUE(wire.links[1].knows(1));
  return wire;
}

TEST(SecuredLink, gives_back_the_frame_that_was_sealed) {
  Wire wire = acquainted();
  for (int i = 0; i < 1000; ++i) {
    const Frame frame = custody(1, static_cast<std::uint8_t>(i % 15));
    const Frame sealed = wire.links[0].seal(kLinkKey, frame);
    EXPECT_EQ(sealed.length, 12);
    EXPECT_EQ(wire.links[1].open(kLinkKey, sealed), std::optional(frame));
  }
}

TEST(SecuredLink, nodes_that_start_at_once_get_to_know_each_other) {
  Wire wire({0, 1, 2, 3, 4, 5});
  for (int ms = 0; ms < 1500; ++ms) {
    std::vector<Frame> frames;
    if (ms % 20 == 0) {
      for (std::uint8_t node = 1; node <= 5; ++node)
        frames.push_back(wire.links[node].seal(kLinkKey, custody(node, 0)));
      frames.push_back(wire.links[0].seal(kLinkKey, pack(HostHeartbeat{}, {})));
    }
    wire.step(frames);
  }
  for (Link& link : wire.links) {
    int known = 0;
    for (std::uint8_t node = 0; node <= 5; ++node) known += link.knows(node) ? 1 : 0;
    EXPECT_EQ(known, 5);
  }
}

TEST(SecuredLink, no_flipped_bit_passes) {
  Wire wire = acquainted();
  const Frame sealed = wire.links[0].seal(kLinkKey, custody(1, 3));
  int flips = 0;
  for (unsigned bit = 0; bit < 96; ++bit) {
    Link listener = wire.links[1];
    Frame flipped = sealed;
    std::uint8_t& byte = bit < 64 ? flipped.data[bit / 8] : flipped.tail[bit / 8 - 8];
    byte ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(listener.open(kLinkKey, flipped)) << bit;
    ++flips;
  }
  for (unsigned bit = 0; bit < 11; ++bit) {
    Link listener = wire.links[1];
    Frame moved = sealed;
    moved.id ^= 1U << bit;
    EXPECT_FALSE(listener.open(kLinkKey, moved)) << "id bit " << bit;
    ++flips;
  }
  EXPECT_TRUE(wire.links[1].open(kLinkKey, sealed));
  test::figure("AUTH-FD", "flipped bits of a frame rejected", flips);
}

TEST(SecuredLink, a_plain_frame_is_not_heard_unless_it_asks_to_hold) {
  Wire wire = acquainted();
  EXPECT_FALSE(wire.links[1].open(kLinkKey, custody(1, 3)));
  const Frame hold_everyone = pack(GlobalHold{}, {.node = 9});
  const Frame hold = pack(hold_command(), {.node = 2});
  EXPECT_EQ(wire.links[1].open(kLinkKey, hold_everyone), std::optional(hold_everyone));
  EXPECT_EQ(wire.links[1].open(kLinkKey, hold), std::optional(hold));
}

TEST(SecuredLink, an_urgent_frame_may_overtake_others_of_its_sender) {
  Wire wire = acquainted();
  std::vector<Frame> frames;
  for (int i = 0; i < 30; ++i)
    frames.push_back(wire.links[0].seal(kLinkKey, custody(1, static_cast<std::uint8_t>(i % 15))));
  std::mt19937 random(5);
  std::shuffle(frames.begin(), frames.end(), random);
  for (const Frame& frame : frames) EXPECT_TRUE(wire.links[1].open(kLinkKey, frame));
  for (const Frame& frame : frames) EXPECT_FALSE(wire.links[1].open(kLinkKey, frame)) << "once only";
  EXPECT_TRUE(wire.links[1].knows(1)) << "a repeat is no wrong MAC";
}

TEST(SecuredLink, up_to_223_frames_may_be_lost_in_a_row_and_after_more_the_sender_is_asked) {
  Wire wire = acquainted();
  for (int lost = 0; lost < 223; ++lost) (void)wire.links[0].seal(kLinkKey, custody(1, 0));
  EXPECT_TRUE(wire.links[1].open(kLinkKey, wire.links[0].seal(kLinkKey, custody(1, 0))));
  for (int lost = 0; lost < 1000; ++lost) (void)wire.links[0].seal(kLinkKey, custody(1, 0));
  int ms = 0;
  for (int opened = wire.opened; wire.opened == opened && ms < 2000; ms += 20) {
    wire.step({wire.links[0].seal(kLinkKey, custody(1, 0))});
    wire.run(19);
  }
  EXPECT_LT(ms, 400);
  test::figure("AUTH-FD", "from a long silence to being heard again", ms, "ms");
}

/// Everything that was ever said, over and over, to a listener: what of it is heard.
int heard_of(Link listener, const std::vector<Frame>& recorded) {
  int heard = 0;
  for (int round = 0; round < 3; ++round) {
    for (const Frame& frame : recorded) {
      if (listener.open(kLinkKey, frame)) ++heard;
      (void)listener.speak(kLinkKey, 1);
    }
    for (int ms = 0; ms < 200; ++ms) (void)listener.speak(kLinkKey, 1);
  }
  return heard;
}

TEST(SecuredLink, what_was_recorded_is_never_heard_again_resets_of_either_side_included) {
  Wire wire({1, 2});
  for (int ms = 0; ms < 1000; ++ms) {
    std::vector<Frame> frames;
    if (ms % 20 == 0)
      frames = {wire.links[0].seal(kLinkKey, custody(1, 0)), wire.links[1].seal(kLinkKey, custody(2, 0))};
    wire.step(frames);
  }
  ASSERT_GT(wire.opened, 50);
  EXPECT_EQ(heard_of(wire.links[1], wire.all), 0) << "in the same life";
  EXPECT_EQ(heard_of(Link(2, FrameNumber{1} << 40), wire.all), 0) << "after its reset";

  // the sender starts again with numbers below those of before, as a host without a memory may
  wire.links[0] = Link(1, 1000);
  const std::vector<Frame> before = wire.all;
  const int opened = wire.opened;
  for (int ms = 0; ms < 1000; ++ms) {
    wire.step(ms % 20 == 0 ? std::vector<Frame>{wire.links[0].seal(kLinkKey, custody(1, 0))}
                           : std::vector<Frame>{});
  }
  EXPECT_GT(wire.opened, opened + 20) << "it is heard again";
  EXPECT_EQ(heard_of(wire.links[1], before), 0) << "and what it said before is not";
  test::figure("AUTH-FD", "recorded frames said again, none heard",
               3 * (wire.all.size() + 2 * before.size()));
}

TEST(SecuredLink, whoever_has_another_key_is_not_heard_and_hears_nobody) {
  Wire wire = acquainted();
  Key other = kLinkKey;
  other[15] ^= 1U;
  Link stranger(3, 77);
  for (int ms = 0; ms < 1000; ++ms) {
    std::vector<Frame> said{wire.links[0].seal(kLinkKey, custody(1, 0))};
    said.insert(said.end(), wire.said.begin(), wire.said.end());
    for (const Frame& frame : said) EXPECT_FALSE(stranger.open(other, frame));
    std::vector<Frame> strange{stranger.seal(other, custody(3, 0))};
    if (const auto frame = stranger.speak(other, 1)) strange.push_back(*frame);
    const int opened = wire.opened;
    wire.step(strange);
    EXPECT_EQ(wire.opened, opened);
  }
  EXPECT_FALSE(wire.links[0].knows(3));
  EXPECT_FALSE(stranger.knows(1));
}

TEST(SecuredLink, hears_only_whom_it_follows_and_others_take_their_places) {
  Wire wire({1, 2, 3, 4});
  SecuredLink<2> small(5, 1);
  const auto run = [&](std::uint16_t sources) {
    small.follow(sources);
    std::array<int, 5> heard{};
    for (int ms = 0; ms < 1500; ++ms) {
      std::vector<Frame> now;
      for (std::uint8_t node = 1; node <= 4 && ms % 20 == 0; ++node)
        now.push_back(wire.links[node - 1U].seal(kLinkKey, custody(node, 0)));
      for (const Frame& frame : wire.said) (void)small.open(kLinkKey, frame);
      for (const Frame& frame : now) {
        if (small.open(kLinkKey, frame)) ++heard.at(frame.id & 0xFU);
      }
      if (const auto frame = small.speak(kLinkKey, 1)) now.push_back(*frame);
      wire.step(now);
    }
    return heard;
  };
  std::array<int, 5> heard = run(1U << 1 | 1U << 2);
  EXPECT_GT(heard[1], 30);
  EXPECT_GT(heard[2], 30);
  EXPECT_EQ(heard[3] + heard[4], 0);
  heard = run(1U << 2 | 1U << 4);
  EXPECT_GT(heard[2], 70) << "who stays is heard all the time";
  EXPECT_GT(heard[4], 30);
  EXPECT_EQ(heard[1] + heard[3], 0);
}

TEST(SecuredLink, three_guesses_are_looked_at_before_the_sender_must_prove_itself_anew) {
  Wire wire = acquainted();
  const Frame right = wire.links[0].seal(kLinkKey, custody(1, 3));
  for (unsigned i = 1; i <= 3; ++i) {
    Frame guess = right;
    guess.tail[3] ^= static_cast<std::uint8_t>(i);
    EXPECT_FALSE(wire.links[1].open(kLinkKey, guess));
  }
  EXPECT_FALSE(wire.links[1].knows(1));
}

}  // namespace
}  // namespace pinjaw::wire
