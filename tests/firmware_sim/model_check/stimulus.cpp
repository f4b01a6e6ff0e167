#include "tests/firmware_sim/model_check/stimulus.hpp"

#include "tests/firmware_sim/model_check/words.hpp"

namespace pinjaw::core::model {

std::vector<Stimulus> demands(bool, const std::vector<std::uint8_t>& others) {
  std::vector<Stimulus> all;
  const auto command = [&](wire::Op op, std::uint8_t argument) {
    all.push_back({.demand = Demand::Command, .op = op, .argument = argument});
  };
  using enum wire::Op;
  for (const wire::Op op : {Hold, Arm, Disarm, CloseLight, Squeeze, Abort, OpenEmpty, ClearFault})
    command(op, 0);
  for (const std::uint8_t other : others) {
    command(Offer, other);
    command(Accept, other);
  }
  for (const std::uint8_t step : {std::uint8_t{1}, std::uint8_t{2}}) command(ManualRelease, step);
  all.push_back({.demand = Demand::GlobalHold});
  all.push_back({.demand = Demand::Write});
  return all;
}

namespace {

std::string describe_demand(const Stimulus& stimulus) {
  switch (stimulus.demand) {
    case Demand::None:
      return "";
    case Demand::GlobalHold:
      return ", GLOBAL_HOLD";
    case Demand::Write:
      return ", WRITE";
    case Demand::Command:
      break;
  }
  std::string text = ", " + op_name(stimulus.op);
  if (stimulus.op == wire::Op::Offer) text += " to " + station(stimulus.argument);
  if (stimulus.op == wire::Op::Accept) text += " from " + station(stimulus.argument);
  return text;
}

std::string describe_step(const Stimulus& stimulus, const Network& network) {
  std::string text = "steps";
  if (stimulus.demand == Demand::None && stimulus.argument > 0) text += ", repeats an outcome";
  if (!stimulus.host_alive) text += ", host lost";
  if (stimulus.message >= 0) text += ", hears " + network.name(stimulus.message);
  if (stimulus.peer_holds) text += " and that it holds well";
  text += describe_demand(stimulus);
  if ((stimulus.fired & kStateTime) != 0) text += ", time of state over";
  if ((stimulus.fired & kStable) != 0) text += ", hold stable for long enough";
  if ((stimulus.fired & kPeerGood) != 0) text += ", peer good for long enough";
  if ((stimulus.fired & kBadHold) != 0) text += ", hold bad for long enough";
  return text;
}

}  // namespace

std::string describe(const Stimulus& stimulus, const Network& network) {
  switch (stimulus.what) {
    case Happening::Step:
      return describe_step(stimulus, network);
    case Happening::Stored:
      return "has stored its record";
    case Happening::Crash:
      return "restarts, having stored " + std::to_string(stimulus.argument) + " of the records on their way";
    case Happening::Jaws:
      return "moves its jaws";
  }
  return "?";
}

}  // namespace pinjaw::core::model
