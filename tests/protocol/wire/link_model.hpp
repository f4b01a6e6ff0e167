#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "protocol/wire/codec.hpp"
#include "tests/protocol/wire/reference_mac.hpp"

/// CAN FD with a key as docs/authentication.md tells it, in another way than SecuredLink: numbers that were
/// taken are kept one by one, MACs are OpenSSL's, and whose frame it is stands in the message table.
namespace pinjaw::wire::testing {

using Tail = std::array<std::uint8_t, 4>;

inline Tail tail_of(const Key& key, const Bytes& message, std::uint64_t number) {
  const AesBlock mac = openssl_cmac(key, message);
  return {static_cast<std::uint8_t>(number % 256), mac[0], mac[1], mac[2]};
}

/// `classic` as the frame `number` of its sender.
inline Frame fd_frame(const Key& key, const Frame& classic, std::uint64_t number) {
  Bytes message{static_cast<std::uint8_t>(0x10 + classic.id / 256),
                static_cast<std::uint8_t>(classic.id % 256)};
  message.insert(message.end(), classic.data.begin(), classic.data.end());
  return {.id = classic.id,
          .kind = FrameKind::Fd,
          .length = 12,
          .data = classic.data,
          .tail = tail_of(key, with_number(message, number, 6), number)};
}

struct Said {
  std::uint8_t source = 0;
  std::uint8_t receiver = 15;  ///< 15: a question
  std::uint64_t number = 0;
  std::uint64_t asked = 0;  ///< the number of the question that is answered
};

inline Frame said_frame(const Key& key, const Said& said) {
  const Bytes data = with_number({said.receiver, 0}, said.number, 6);
  const Bytes message =
      with_number(with_number({0x18, said.source, said.receiver}, said.number, 6), said.asked, 6);
  Frame frame{.id = 0x0E0U + said.source, .kind = FrameKind::Fd, .length = 12};
  std::copy(data.begin(), data.end(), frame.data.begin());
  frame.tail = tail_of(key, message, said.number);
  return frame;
}

/// Precondition: numbers stay within 1000 .. 2^47.
class LinkModel {
 public:
  struct Sender {
    int source = -1;  ///< -1: a free place
    bool known = false;
    std::uint64_t newest = 0;
    std::set<std::uint64_t> taken;
    int wrong = 0;    ///< MACs since it was learnt
    int answers = 0;  ///< looked at since the last question
  };

  LinkModel(Key key, std::size_t places, std::uint8_t self, std::uint64_t next)
      : key_(key), self_(self), next_(next), senders_(places) {}

  void follow(std::uint16_t sources) { sources_ = sources; }
  [[nodiscard]] std::uint64_t next_number() const { return next_; }
  [[nodiscard]] std::uint64_t asked() const { return asked_; }
  [[nodiscard]] std::uint32_t refused() const { return refused_; }
  bool take_alarm() { return std::exchange(alarm_, false); }
  [[nodiscard]] const Sender* sender(int source) const {
    const auto at =
        std::find_if(senders_.begin(), senders_.end(), [&](const Sender& s) { return s.source == source; });
    return at == senders_.end() ? nullptr : &*at;
  }

  Frame seal(const Frame& classic) { return fd_frame(key_, classic, next_++); }

  std::optional<Frame> open(const Frame& frame) {
    const bool is_fd = frame.kind == FrameKind::Fd && frame.length == 12;
    Frame classic{.id = frame.id, .extended = frame.extended, .data = frame.data};
    classic.kind = frame.kind == FrameKind::Fd ? FrameKind::Data : frame.kind;
    classic.length = is_fd ? std::uint8_t{8} : frame.length;
    const auto command = parse<Command>(classic);
    if (parse<GlobalHold>(classic).has_value() || (command.has_value() && command->message.op == Op::Hold)) {
      return classic;
    }
    if (is_fd && !frame.extended && frame.id >= 0x0E0 && frame.id <= 0x0EE) {
      hear(frame);
      return std::nullopt;
    }
    const auto identifier = identify(frame.id);
    if (!is_fd || frame.extended || !identifier) return refuse();
    const Direction direction = spec_of(identifier->type).direction;
    const bool is_hosts = direction == Direction::HostToAll || direction == Direction::HostToNode;
    const int source = is_hosts ? 0 : identifier->node;
    if (!follows(source)) return std::nullopt;
    if (!is_new(place_of(source), frame)) return refuse();
    return classic;
  }

  std::optional<Frame> speak(int elapsed_ms) {
    pause_ms_ = std::max(0, pause_ms_ - elapsed_ms);
    if (question_) {
      const Said answer{self_, question_->source, next_ - 1, question_->number};
      question_.reset();
      return said_frame(key_, answer);
    }
    if (!strangers_ || pause_ms_ > 0) return std::nullopt;
    strangers_ = false;
    pause_ms_ = 100 + self_;
    asked_ = next_++;
    for (Sender& sender : senders_) sender.answers = 0;
    return said_frame(key_, {.source = self_, .number = asked_});
  }

 private:
  std::nullopt_t refuse() {
    ++refused_;
    return std::nullopt;
  }

  [[nodiscard]] bool follows(int source) const {
    return source >= 0 && source <= 14 && source != self_ && sources_ / (1 << source) % 2 == 1;
  }

  Sender& place_of(int source) {
    Sender* place = &senders_.front();
    for (Sender& sender : senders_) {
      if (sender.source == source) return sender;
      if (!follows(sender.source)) place = &sender;
    }
    *place = {};
    place->source = source;
    return *place;
  }

  bool is_new(Sender& sender, const Frame& frame) {
    strangers_ = strangers_ || !sender.known;
    if (!sender.known) return false;
    std::uint64_t number = sender.newest - 31;  // to 224 above the newest: 256 numbers, each with another end
    while (number % 256 != frame.tail[0]) ++number;
    if (frame.tail == fd_frame(key_, frame, number).tail) {
      sender.newest = std::max(sender.newest, number);
      return sender.taken.insert(number).second;
    }
    if (++sender.wrong == 3) {
      sender.known = false;
      strangers_ = alarm_ = true;
    }
    return false;
  }

  void hear(const Frame& frame) {
    Said said{.source = static_cast<std::uint8_t>(frame.id - 0x0E0), .receiver = frame.data[0]};
    for (std::size_t i = 8; i-- > 2;) said.number = said.number * 256 + frame.data[i];
    if (said.source == self_) return;
    if (said.receiver == 15) {
      if (frame.tail != said_frame(key_, said).tail) {
        ++refused_;
      } else if (!question_) {
        question_ = said;
      }
      return;
    }
    if (said.receiver != self_ || !follows(said.source)) return;
    Sender& sender = place_of(said.source);
    if (sender.known || asked_ == 0 || sender.answers == 3) return;
    ++sender.answers;
    said.asked = asked_;
    if (frame.tail != said_frame(key_, said).tail) {
      ++refused_;
      return;
    }
    sender = {.source = said.source, .known = true, .newest = said.number, .taken = {}};
    for (std::uint64_t below = 0; below < 32; ++below) sender.taken.insert(said.number - below);
  }

  Key key_;
  std::uint8_t self_;
  std::uint64_t next_;
  std::vector<Sender> senders_;
  std::uint16_t sources_ = 0xFFFF;
  std::uint32_t refused_ = 0;
  std::uint64_t asked_ = 0;  ///< 0: nothing yet
  std::optional<Said> question_;
  int pause_ms_ = 0;
  bool strangers_ = true;
  bool alarm_ = false;
};

}  // namespace pinjaw::wire::testing
