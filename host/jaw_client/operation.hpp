#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "host/jaw_client/command_channel.hpp"
#include "host/jaw_client/layout_transfer.hpp"
#include "host/jaw_client/node_view.hpp"
#include "host/jaw_client/outcome.hpp"

namespace pinjaw::jaw_client {

/// States of a controller as a set.
class StateSet {
 public:
  constexpr StateSet(std::initializer_list<wire::State> states) {
    for (const wire::State state : states) bits_ |= 1U << static_cast<unsigned>(state);
  }
  [[nodiscard]] constexpr bool has(wire::State state) const {
    return (bits_ >> static_cast<unsigned>(state) & 1U) != 0;
  }
  [[nodiscard]] constexpr bool empty() const { return bits_ == 0; }

 private:
  std::uint32_t bits_ = 0;
};

/// One thing that a host wants of a controller: a command, what must be so before it, and where it should
/// lead.
struct Order {
  wire::Command command;
  StateSet goals{};                    ///< reached: done; none: done with the answer
  StateSet failures{};                 ///< fallen into, after the answer: a fault
  std::int64_t reach_us = 10'000'000;  ///< longest from the answer to a goal
  bool needs_host_heard = false;       ///< wait until the node hears this host
  std::uint8_t offering_giver = 0;     ///< wait until this node offers to us
  bool leaves_loaded = false;          ///< in LOADED the node has not heard the permission: say it again
  bool asks_challenge = false;         ///< then answer the challenge, and only that leads to the goals
};

/// Carries out one order. It sees the node by its view and speaks by the channel; time is an argument.
class Operation {
 public:
  static constexpr std::int64_t kPrepare_us = 2'000'000;  ///< longest wait for what must be so before
  static constexpr std::int64_t kFallback_us = 200'000;   ///< a failure state counts at once if newly entered
  static constexpr std::int64_t kBusyRetry_us = 50'000;

  void begin(std::uint8_t node, const Order& order);
  void begin(std::uint8_t node, const wire::Layout& layout);

  struct Surroundings {
    NodeView& view;
    const NodeView* giver = nullptr;  ///< the order's giver
    CommandChannel& channel;
    std::int64_t now_us = 0;
  };
  void advance(const Surroundings& around);
  void fail(OutcomeKind kind, std::string sentence);

  [[nodiscard]] const Outcome& outcome() const { return outcome_; }
  [[nodiscard]] std::uint8_t giver() const { return order_.offering_giver; }
  /// The layout's way there, while one is being sent.
  [[nodiscard]] LayoutTransfer* transfer() { return phase_ == Phase::Transfer ? &transfer_ : nullptr; }

 private:
  enum class Phase : std::uint8_t { Over, Start, Prepare, Command, Pause, Challenge, Reach, Transfer };

  void enter(Phase phase, std::int64_t now_us);
  void prepare(const Surroundings& around);
  void await_answer(const Surroundings& around);
  void answered(const Surroundings& around);
  void refused(const wire::Acknowledge& answer);
  void await_challenge(const Surroundings& around);
  void reach(const Surroundings& around);
  [[nodiscard]] bool worth_another_try(const wire::Acknowledge& answer, std::int64_t now_us);

  std::uint8_t node_ = 0;
  Order order_;
  LayoutTransfer transfer_;
  Phase phase_ = Phase::Over;
  std::int64_t entered_us_ = 0;
  std::int64_t begun_us_ = 0;
  std::uint64_t states_before_ = 0;
  wire::State state_before_ = wire::State::Boot;
  bool left_ = false;  ///< the state from before the answer has been left
  bool challenged_ = false;
  bool knows_key_ = false;    ///< we share one with the controllers
  bool asked_again_ = false;  ///< for the number of a session, after a wrong MAC
  Outcome outcome_{.kind = OutcomeKind::Done, .sentence = {}};
};

}  // namespace pinjaw::jaw_client
