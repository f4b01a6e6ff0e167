// Promises: AUTH-FD.
#include "tests/protocol/wire/link_model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "protocol/wire/commands.hpp"
#include "protocol/wire/secured_link.hpp"
#include "tests/support/figures.hpp"

/// SecuredLink beside a model of docs/authentication.md: whatever is on the bus, both do the same.
namespace pinjaw::wire {
namespace {

using testing::fd_frame;
using testing::LinkModel;
using testing::Said;
using testing::said_frame;

constexpr Key kModelKey{0x2b, 0x7e, 0x15, 0x16, 0x28, 0xae, 0xd2, 0xa6,
                        0xab, 0xf7, 0x15, 0x88, 0x09, 0xcf, 0x4f, 0x3c};

/// Distances to a sender's newest number where something changes, and some between.
constexpr int kDistances[] = {-33, -32, -31, -30, -17, -1,  0,   1,   2,  5,
                              30,  31,  32,  33,  63,  223, 224, 225, 256};

/// What somebody who knows the key, or does not, may put on the bus. Numbers are near those that `model`
/// holds for newest.
class Bus {
 public:
  explicit Bus(std::uint64_t seed) : random_(seed) {}

  std::uint64_t below(std::uint64_t limit) { return random_() % limit; }
  bool one_in(std::uint64_t n) { return below(n) == 0; }
  std::uint64_t any_number() { return 1000 + below(std::uint64_t{1} << (16 + below(31))); }

  /// A frame of `source`: a node's, or one of those that a host says.
  Frame classic(std::uint8_t source) {
    Frame frame = pack(Custody{.fact = Fact::Take, .peer = 3, .token = 7}, {.node = source});
    if (source == 0) frame = hosts();
    if (one_in(20)) frame = pack_segment({{MessageType::TransferResponse, source}, {1, 2, 3}});
    for (std::size_t i = 1; i < 8 && one_in(2); ++i) frame.data[i] = static_cast<std::uint8_t>(below(256));
    return frame;
  }

  Frame of_sender(const LinkModel& model) {
    const auto source = static_cast<std::uint8_t>(below(16));
    const LinkModel::Sender* sender = model.sender(source);
    std::uint64_t number = any_number();
    if (sender != nullptr && sender->known) number = sender->newest + distance();
    return spoilt(fd_frame(kModelKey, classic(source), number));
  }

  Frame question() {
    const auto source = static_cast<std::uint8_t>(below(15));
    return spoilt(said_frame(kModelKey, {.source = source, .number = any_number()}));
  }

  Frame answer(const LinkModel& model, std::uint8_t self) {
    Said said{.source = static_cast<std::uint8_t>(below(15)), .receiver = self, .number = any_number()};
    said.asked = one_in(8) ? 0 : model.asked();
    if (one_in(16)) said.asked ^= std::uint64_t{1} << below(48);
    if (one_in(8)) said.receiver = static_cast<std::uint8_t>(below(16));
    return spoilt(said_frame(kModelKey, said));
  }

  /// What is no FD frame of 12 bytes, or of no sender: some of it asks to hold.
  Frame odd(std::uint8_t self) {
    Frame frame = classic(static_cast<std::uint8_t>(below(15)));
    if (one_in(3)) frame = pack(GlobalHold{}, {.node = static_cast<std::uint8_t>(below(16))});
    if (one_in(4)) frame = pack(hold_command(), {.node = self == 0 ? std::uint8_t{1} : self});
    if (one_in(2)) frame = fd_frame(kModelKey, frame, any_number());
    if (one_in(6)) frame.data[0] ^= 1U;  // its checksum
    if (one_in(3)) frame.kind = static_cast<FrameKind>(below(4));
    if (one_in(4)) frame.length = static_cast<std::uint8_t>(below(2) == 0 ? 8 + below(8) : 12);
    if (one_in(4)) frame.extended = true;
    if (one_in(4)) frame.id = static_cast<std::uint32_t>(0x0DE + below(20));
    return frame;
  }

 private:
  std::uint64_t distance() {
    const auto next = static_cast<std::int64_t>(below(4));
    const int edge = kDistances[below(std::size(kDistances))];
    return static_cast<std::uint64_t>(one_in(2) ? edge : next);
  }

  Frame hosts() {
    const Label to{.node = static_cast<std::uint8_t>(1 + below(14))};
    switch (below(4)) {
      case 0:
        return pack(HostHeartbeat{}, {});
      case 1:
        return pack(HostTime{}, {});
      case 2:
        return pack(arm_command(5, 6), to);
      default:
        return pack_segment({{MessageType::TransferRequest, to.node}, {1, 2, 3}});
    }
  }

  Frame spoilt(Frame frame) {
    if (!one_in(12)) return frame;
    const std::size_t bit = below(100);
    if (bit < 64) frame.data[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    if (bit >= 64 && bit < 96) frame.tail[bit / 8 - 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    if (bit >= 96) frame.extended = true;
    return frame;
  }

  std::mt19937_64 random_;
};

/// A link and its model, that hear and say the same.
template <std::size_t kPlaces>
struct Both {
  Both(std::uint8_t self, std::uint64_t first) : link(self, first), model(kModelKey, kPlaces, self, first) {}

  void open(const Frame& frame) {
    const std::optional<Frame> wanted = model.open(frame);
    ASSERT_EQ(link.open(kModelKey, frame), wanted) << std::hex << "id " << frame.id;
    opened += wanted ? 1 : 0;
    same();
  }
  void speak(std::uint16_t elapsed_ms) {
    ASSERT_EQ(link.speak(kModelKey, elapsed_ms), model.speak(elapsed_ms));
    same();
  }
  void seal(const Frame& frame) {
    ASSERT_EQ(link.seal(kModelKey, frame), model.seal(frame));
    same();
  }
  void follow(std::uint16_t sources) {
    link.follow(sources);
    model.follow(sources);
  }
  void same() {
    ASSERT_EQ(link.refused(), model.refused());
    ASSERT_EQ(link.next_number(), model.next_number());
    for (std::uint8_t source = 0; source < 16; ++source) {
      const LinkModel::Sender* sender = model.sender(source);
      ASSERT_EQ(link.knows(source), sender != nullptr && sender->known) << "source " << int{source};
    }
  }

  SecuredLink<kPlaces> link;
  LinkModel model;
  int opened = 0;
};

template <std::size_t kPlaces>
int opened_in_a_life(Bus& bus, std::uint8_t self) {
  Both<kPlaces> both(self, bus.any_number());
  for (int i = 0; i < 1500 && !::testing::Test::HasFatalFailure(); ++i) {
    switch (bus.below(16)) {
      case 0:
        both.speak(static_cast<std::uint16_t>(bus.below(60)));
        break;
      case 1:
        both.open(bus.question());
        break;
      case 2:
      case 3:
      case 4:
        both.open(bus.answer(both.model, self));
        break;
      case 5:
        both.open(bus.odd(self));
        break;
      case 6:
        both.seal(bus.classic(self == 0 ? std::uint8_t{0} : self));
        break;
      case 7:
        EXPECT_EQ(both.link.take_alarm(), both.model.take_alarm());
        if (bus.one_in(10)) both.follow(static_cast<std::uint16_t>(bus.below(0x10000)));
        break;
      default:
        both.open(bus.of_sender(both.model));
    }
  }
  return both.opened;
}

TEST(LinkModel, does_what_the_link_does_whatever_is_on_the_bus) {
  Bus bus(2026);
  int opened = 0;
  for (std::uint8_t self = 0; self < 15 && !HasFatalFailure(); ++self) {
    opened +=
        opened_in_a_life<15>(bus, self) + opened_in_a_life<5>(bus, self) + opened_in_a_life<2>(bus, self);
  }
  EXPECT_GT(opened, 4000);
  test::figure("AUTH-FD", "frames on a random bus opened as a model of the document does", opened);
}

/// A link that has just learnt that source 3's newest number is `newest`.
Both<5> acquainted_with_3(std::uint64_t newest) {
  Both<5> both(7, 5000);
  both.speak(1);
  both.open(said_frame(kModelKey, {.source = 3, .receiver = 7, .number = newest, .asked = 5000}));
  EXPECT_TRUE(both.link.knows(3));
  return both;
}

TEST(LinkModel, takes_each_number_of_the_window_once_after_every_step_to_a_newer_one) {
  for (const std::uint64_t newest :
       {std::uint64_t{0x12345678FF80}, std::uint64_t{0x10000}, std::uint64_t{0xFFFF}}) {
    for (std::uint64_t step = 1; step <= 225 && !HasFatalFailure(); ++step) {
      Both<5> both = acquainted_with_3(newest);
      const Frame classic = pack(Custody{}, {.node = 3});
      // a gap before the step, that it must not fill
      both.open(fd_frame(kModelKey, classic, newest + 2));
      both.open(fd_frame(kModelKey, classic, newest + 2 + step));
      for (std::uint64_t below = 0; below < 32; ++below) {
        const Frame frame = fd_frame(kModelKey, classic, newest + 2 + step - below);
        both.open(frame);
        const int opened = both.opened;
        both.open(frame);
        EXPECT_EQ(both.opened, opened) << "a second time";
      }
    }
  }
}

TEST(LinkModel, looks_at_three_answers_to_a_question_and_at_three_to_the_next) {
  Both<5> both(7, 5000);
  both.speak(1);
  const Said right{.source = 3, .receiver = 7, .number = 9000, .asked = 5000};
  Frame guess = said_frame(kModelKey, right);
  guess.tail[3] ^= 1U;
  for (int i = 0; i < 3; ++i) both.open(guess);
  EXPECT_EQ(both.link.refused(), 3U);
  both.open(guess);
  both.open(said_frame(kModelKey, right));
  EXPECT_EQ(both.link.refused(), 3U) << "not looked at";
  EXPECT_FALSE(both.link.knows(3));
  both.open(fd_frame(kModelKey, pack(Custody{}, {.node = 3}), 9001));  // so that it asks again
  both.speak(200);
  both.open(guess);
  both.open(guess);
  both.open(said_frame(kModelKey, {.source = 3, .receiver = 7, .number = 9001, .asked = 5001}));
  EXPECT_TRUE(both.link.knows(3));
}

TEST(LinkModel, hears_more_senders_than_it_has_places_for_by_forgetting_one) {
  Both<2> both(7, 5000);
  both.speak(1);
  for (std::uint8_t source = 1; source <= 4; ++source) {
    both.open(said_frame(kModelKey, {.source = source, .receiver = 7, .number = 9000, .asked = 5000}));
    EXPECT_TRUE(both.link.knows(source));
  }
  EXPECT_TRUE(both.link.knows(1)) << "the others stay known";
}

TEST(LinkModel, begins_as_a_host_that_has_said_nothing) {
  SecuredLink<2> link;
  LinkModel model(kModelKey, 2, 0, 1);
  EXPECT_EQ(link.next_number(), 1U);
  EXPECT_EQ(link.refused(), 0U);
  EXPECT_FALSE(link.take_alarm());
  EXPECT_EQ(link.speak(kModelKey, 0), model.speak(0));
}

}  // namespace
}  // namespace pinjaw::wire
