// Promises: T-GUARD, R4, R6, MANUAL.
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

#include "protocol/wire/codec.hpp"
#include "tests/firmware_sim/core/bench.hpp"

/// The release guard against what docs/reliability.md says of it, written once more: payloads are read as
/// whole numbers, and instead of timers there are points of time.
namespace pinjaw::core::test {
namespace {

constexpr std::uint8_t kOwn = 1;
constexpr std::uint64_t kMask = ~std::uint64_t{0};

/// A frame's payload, little-endian, with its fields at the bits of section 2.3.
class Bits {
 public:
  explicit Bits(std::uint64_t value = 0) : value_(value) {}
  explicit Bits(const wire::Frame& frame) {
    for (std::size_t i = 8; i-- > 0;) value_ = value_ << 8 | frame.data[i];
  }
  [[nodiscard]] unsigned get(unsigned start, unsigned length) const {
    return static_cast<unsigned>(value_ >> start & ~(kMask << length));
  }
  Bits& set(unsigned start, unsigned length, std::uint64_t field) {
    value_ = (value_ & ~(~(kMask << length) << start)) | (field & ~(kMask << length)) << start;
    return *this;
  }
  [[nodiscard]] wire::Frame frame(std::uint32_t id, wire::Identifier label) const {
    wire::Frame made{.id = id};
    for (std::size_t i = 0; i < 8; ++i) made.data[i] = static_cast<std::uint8_t>(value_ >> 8 * i);
    made.data[0] = wire::detail::checksum(label, made.data);
    return made;
  }

 private:
  std::uint64_t value_ = 0;
};

/// What the guard should know and permit.
class Specified {
 public:
  void step(const Release& release, const std::vector<wire::Frame>& frames, bool enable, int elapsed_ms) {
    if (release.peer != peer_) custody_ = state_ = {}, faulty_until_ms_ = 0;
    if (release.peer != peer_ || release.token != token_) custody_.good = permits_ = false, good_ms_ = 0;
    peer_ = release.peer;
    token_ = release.token;
    now_ms_ += elapsed_ms;
    for (const wire::Frame& frame : frames) hear(release, frame, enable);
    const bool good = custody_.good && state_.good && now_ms_ < custody_.fresh_until_ms &&
                      now_ms_ < state_.fresh_until_ms && now_ms_ >= faulty_until_ms_;
    good_ms_ = good ? std::min(good_ms_ + elapsed_ms, 60'000) : 0;
    permits_ = permits_ || good_ms_ >= 200;
    if (!release.decided && now_ms_ >= asked_until_ms_) hand_ = false;
    if (!release.decided) decided_before_ = false;
  }
  void find_decided() { decided_before_ = true; }
  [[nodiscard]] int good_ms() const { return good_ms_; }
  [[nodiscard]] bool release(const NvmRecord& record) const {
    return permits_ && record.peer == peer_ && record.token == token_;
  }
  [[nodiscard]] bool decision(const NvmRecord& record) const {
    return record.custody != Custody::Decided || decided_before_ ||
           (record.peer == 15 ? hand_ : release(record));
  }
  [[nodiscard]] bool opening(const NvmRecord& record, bool stored) const {
    const bool empty = record.custody == Custody::Empty || record.custody == Custody::Released;
    return empty || (record.custody == Custody::Decided && stored && decision(record));
  }

 private:
  struct Message {
    std::optional<unsigned> counter;
    int in_order = 0;
    bool good = false;
    long fresh_until_ms = 0;
  };

  static bool whole(const wire::Frame& frame, std::uint32_t id, wire::Identifier label) {
    return frame.kind == wire::FrameKind::Data && !frame.extended && frame.length == 8 && frame.id == id &&
           frame.data[0] == wire::detail::checksum(label, frame.data);
  }
  /// After three of them in order, two lost at most in between.
  static bool qualified(Message& message, unsigned counter) {
    bool follows = !message.counter;
    for (unsigned more = 1; more <= 3; ++more) follows = follows || (*message.counter + more) % 15 == counter;
    message.counter = counter;
    message.in_order = follows ? message.in_order + 1 : 0;
    return message.in_order >= 3;
  }
  void hear(const Release& release, const wire::Frame& frame, bool enable) {
    const Bits bits(frame);
    if (whole(frame, 0x100 + kOwn, {wire::MessageType::Command, kOwn})) {
      if (!enable || bits.get(16, 4) != 10) return;
      if (bits.get(20, 4) == 1) asked_until_ms_ = now_ms_ + 3000;
      const bool answered = release.challenge != 0 && bits.get(52, 12) == release.challenge;
      if (bits.get(20, 4) == 2 && answered) hand_ = hand_ || now_ms_ < asked_until_ms_;
      return;
    }
    if (peer_ == 0 || peer_ == 15 || bits.get(12, 4) != 1 || bits.get(8, 4) == 15) return;
    if (whole(frame, 0x040U + peer_, {wire::MessageType::Custody, peer_})) {
      const unsigned fact = bits.get(16, 4);
      if (!qualified(custody_, bits.get(8, 4))) return;
      if (bits.get(56, 8) == 255 && (fact == 4 || fact == 5)) return;  // an outcome of the past (R10)
      custody_.good = fact == 3 && bits.get(20, 4) == kOwn && bits.get(24, 16) == release.token &&
                      bits.get(40, 16) == release.pair;
      custody_.fresh_until_ms = now_ms_ + 70;
    }
    if (whole(frame, 0x060U + peer_, {wire::MessageType::State, peer_}) &&
        qualified(state_, bits.get(8, 4))) {
      const unsigned force_dn = bits.get(32, 12);
      state_.good = bits.get(16, 5) == 8 && bits.get(25, 1) == 1 && force_dn != 0xFFF &&
                    force_dn >= release.peer_required_dn;
      state_.fresh_until_ms = now_ms_ + 70;
    }
    const bool active = bits.get(32, 2) >= 2 && bits.get(34, 1) == 1;
    if (whole(frame, 0x020U + peer_, {wire::MessageType::Fault, peer_}) && active)
      faulty_until_ms_ = now_ms_ + 320;
  }

  std::uint8_t peer_ = 0;
  std::uint16_t token_ = 0;
  long now_ms_ = 0;
  Message custody_;
  Message state_;
  long faulty_until_ms_ = 0;
  long asked_until_ms_ = 0;
  int good_ms_ = 0;
  bool permits_ = false;
  bool hand_ = false;
  bool decided_before_ = false;
};

/// A handoff's frames as they come: mostly those of a peer that holds, in order, and now and then what is
/// not.
class Stream {
 public:
  explicit Stream(unsigned seed) : random_(seed) {
    pace_ = pick<int>({0, 0, 1, 2});
    odd_percent_ = pick<int>({0, 2, 10, 40});
    to_ = {.peer = pick<std::uint8_t>({2, 2, 2, 9, 14, 15, 0}),
           .token = 0x1234,
           .pair = 0xBEEF,
           .peer_required_dn = pick<std::uint16_t>({0, 400, 0xFFE}),
           .decided = chance(30),
           .challenge = 99};
  }

  void next() {
    if (chance(odd_percent_) && chance(10)) change_handoff();
    elapsed_ms = pace_ == 0   ? 1
                 : pace_ == 1 ? pick<int>({0, 1, 5, 20, 20, 20, 35, 69, 70})
                              : pick<int>({20, 20, 69, 70, 199, 200, 319, 320, 2999, 3000, 60'000});
    enable = chance(70);
    frames.clear();
    const int percent = pace_ == 0 ? 5 : 80;
    for (const unsigned kind : {3U, 4U}) {
      if (chance(percent)) add(kind, kind == 3 ? custody_counter_ : state_counter_);
    }
    if (chance(odd_percent_ / 4)) add(2, fault_counter_);
    if (chance(pace_ == 2 ? 40 : 2)) add(8, sequence_);
  }

  [[nodiscard]] const Release& handoff() const { return to_; }
  [[nodiscard]] bool chance(int percent) { return static_cast<int>(random_() % 100U) < percent; }
  template <class Value>
  Value pick(std::initializer_list<Value> values) {
    return values.begin()[random_() % values.size()];
  }

  std::vector<wire::Frame> frames;
  bool enable = false;
  int elapsed_ms = 0;

 private:
  void change_handoff() {
    if (chance(30)) to_.peer = pick<std::uint8_t>({2, 3, 15, 0});
    if (chance(30)) to_.token ^= static_cast<std::uint16_t>(1U << random_() % 16);
    if (chance(30)) to_.pair ^= static_cast<std::uint16_t>(1U << random_() % 16);
    if (chance(10)) to_.challenge = pick<std::uint16_t>({0, 1, 99, 0xFFF});
    to_.decided = chance(30);
  }

  Bits good_payload(unsigned kind) {
    Bits bits;
    if (kind == 3)
      bits.set(16, 4, 3).set(20, 4, kOwn).set(24, 16, to_.token).set(40, 16, to_.pair).set(56, 8, 52);
    if (kind == 4)
      bits.set(16, 5, 8).set(25, 1, 1).set(32, 12, std::min<unsigned>(to_.peer_required_dn, 0xFFE));
    if (kind == 2) bits.set(16, 16, 0x7030).set(32, 2, random_()).set(34, 2, random_());
    if (kind == 8)
      bits.set(16, 4, 10)
          .set(20, 4, pick({1U, 2U, 2U, 3U, 0U, 9U, 10U}))
          .set(52, 12, chance(80) ? to_.challenge : pick({0U, 98U, 0xFFEU}));
    return bits;
  }

  /// One field of one of the four messages gets a value at or beside an edge of its meaning.
  void make_odd(unsigned kind, Bits& bits) {
    const auto flip = [&](unsigned start, unsigned length) {
      const unsigned at = start + static_cast<unsigned>(random_() % length);
      bits.set(at, 1, bits.get(at, 1) ^ 1U);
    };
    if (kind == 8) return bits.set(16, 4, pick({9U, 11U, 2U, 8U})), void();
    if (kind == 2) return flip(8, 56);
    if (kind == 3) {
      switch (random_() % 4) {
        case 0:
          bits.set(16, 4, chance(70) ? pick({4U, 5U}) : random_()).set(56, 8, pick({255U, 254U, 0U}));
          break;
        case 1:
          bits.set(20, 4, random_());
          break;
        case 2:
          flip(24, 32);
          break;
        default:
          flip(8, 56);
      }
      return;
    }
    switch (random_() % 3) {
      case 0:
        bits.set(32, 12, pick({0xFFFU, 0xFFEU, to_.peer_required_dn - 1U, to_.peer_required_dn + 1U}));
        break;
      case 1:
        flip(16, 10);
        break;
      default:
        flip(8, 56);
    }
  }

  void add(unsigned kind, unsigned& counter) {
    constexpr unsigned kBases[] = {0, 0, 0x020, 0x040, 0x060, 0, 0, 0, 0x100};
    const bool odd = chance(odd_percent_);
    const unsigned step = odd ? pick({0U, 1U, 2U, 3U, 4U, 14U}) : pick({1U, 1U, 1U, 1U, 2U, 3U});
    counter = (counter + step) % 15;
    Bits bits = good_payload(kind).set(8, 4, counter);
    if (kind != 8) bits.set(12, 4, 1);
    if (odd && chance(50)) make_odd(kind, bits);
    if (odd && chance(10)) bits.set(8, 4, 15);
    if (odd && chance(10)) bits.set(12, 4, pick({0U, 2U, 3U, 9U}));
    const std::uint8_t node = kind == 8 ? kOwn : to_.peer;
    wire::Frame frame = bits.frame(kBases[kind] + node, {static_cast<wire::MessageType>(kind), node});
    if (odd && chance(20)) damage(frame);
    frames.push_back(frame);
  }

  void damage(wire::Frame& frame) {
    switch (random_() % 6) {
      case 0:
        frame.data[random_() % 8] ^= static_cast<std::uint8_t>(1U << random_() % 8);
        break;
      case 1:
        frame.id ^= 1U << random_() % 11;
        break;
      case 2:
        frame.id += 0x800;
        break;
      case 3:
        frame.extended = true;
        break;
      case 4:
        frame.kind = pick({wire::FrameKind::Remote, wire::FrameKind::Error, wire::FrameKind::Fd});
        break;
      default:
        frame.length = pick<std::uint8_t>({0, 7, 9, 12});
    }
  }

  std::mt19937 random_;
  int pace_ = 0;
  int odd_percent_ = 0;
  Release to_;
  unsigned custody_counter_ = 0;
  unsigned state_counter_ = 0;
  unsigned fault_counter_ = 0;
  unsigned sequence_ = 0;
};

/// Whether the guard permits what it should by `record`, and all where it is turned off.
bool permits_alike(const ReleaseGuard& guard, const Specified& specified, const NvmRecord& record) {
  const Config config{.node = kOwn};
  Config off = config;
  off.release_guard_enabled = false;
  bool alike = sees_peer_hold(guard, off) &&
               permits_release(guard, config, record) == specified.release(record) &&
               permits_decision(guard, config, record) == specified.decision(record) &&
               permits_release(guard, off, record) && permits_decision(guard, off, record);
  for (const bool stored : {false, true}) {
    alike = alike && permits_opening(guard, config, record, stored) == specified.opening(record, stored) &&
            permits_opening(guard, off, record, stored) == (stored || record.custody != Custody::Decided);
  }
  return alike;
}

/// By records that the handoff is about and that it is not.
bool permits_alike(const ReleaseGuard& guard, const Specified& specified, const Release& handoff) {
  for (const std::uint8_t peer : {handoff.peer, std::uint8_t{15}, std::uint8_t{4}}) {
    for (const unsigned token : {handoff.token + 0U, handoff.token + 1U}) {
      for (const Custody custody : {Custody::Empty, Custody::Sole, Custody::Offered, Custody::Latched,
                                    Custody::Decided, Custody::Released, Custody::Retained}) {
        NvmRecord record{.custody = custody, .peer = peer};
        record.token = static_cast<std::uint16_t>(token);
        if (!permits_alike(guard, specified, record)) return false;
      }
    }
  }
  return true;
}

TEST(ReleaseGuardStream, permits_what_the_specification_says_and_nothing_else) {
  int by_peer = 0, by_hand = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    Stream stream(seed);
    NvmRecord found{.custody = stream.chance(20) ? Custody::Decided : Custody::Offered};
    ReleaseGuard guard = guard_after_reset(found);
    Specified specified;
    if (found.custody == Custody::Decided) specified.find_decided();
    for (int step = 0; step < 300; ++step) {
      stream.next();
      const Release& handoff = stream.handoff();
      watch(guard, Config{.node = kOwn}, handoff, stream.frames, stream.enable,
            static_cast<std::uint16_t>(stream.elapsed_ms));
      specified.step(handoff, stream.frames, stream.enable, stream.elapsed_ms);
      ASSERT_EQ(guard.good_ms, specified.good_ms()) << "seed " << seed << ", step " << step;
      ASSERT_EQ(sees_peer_hold(guard, Config{.node = kOwn}), specified.good_ms() > 0);
      const NvmRecord its{.custody = Custody::Decided, .peer = handoff.peer, .token = handoff.token};
      ASSERT_TRUE(permits_alike(guard, specified, its)) << "seed " << seed << ", step " << step;
      if (step % 16 != 0) continue;
      ASSERT_TRUE(permits_alike(guard, specified, handoff)) << "seed " << seed << ", step " << step;
      found = {.custody = Custody::Decided, .peer = 15};
      by_hand += !guard.decided_before && permits_decision(guard, Config{.node = kOwn}, found) ? 1 : 0;
      by_peer += guard.peer_permits ? 1 : 0;
    }
  }
  EXPECT_GT(by_peer, 1'000);
  EXPECT_GT(by_hand, 300);
}

}  // namespace
}  // namespace pinjaw::core::test
