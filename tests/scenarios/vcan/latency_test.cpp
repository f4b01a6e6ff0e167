// Promises: TIME-HOST.
// From the log that candump wrote of a whole run on vcan, with the kernel's times: how long a controller
// takes from a command to its answer, and how long pinjaw takes from a report that it waits for to the
// command that follows. Figures only: they are the machine's as much as ours. Asserted is that each thing
// that is measured took place.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <vector>

#include "protocol/bus/candump.hpp"
#include "protocol/wire/codec.hpp"
#include "tests/support/figures.hpp"

namespace pinjaw::wire {
namespace {

/// Sorted, in ms.
class Latencies {
 public:
  void add(std::int64_t us) { ms_.push_back(static_cast<double>(us) * 1e-3); }
  [[nodiscard]] std::size_t count() const { return ms_.size(); }
  void tell(const std::string& what) {
    std::sort(ms_.begin(), ms_.end());
    test::figure("TIME-HOST", what + ", median", ms_.at(ms_.size() / 2), "ms");
    test::figure("TIME-HOST", what + ", nine of ten within", ms_.at(ms_.size() * 9 / 10), "ms");
    test::figure("TIME-HOST", what + ", worst", ms_.back(), "ms");
  }

 private:
  std::vector<double> ms_;
};

/// Follows a log, line by line.
class Watch {
 public:
  Latencies answers;
  Latencies reactions;

  void take(const bus::LogLine& line) {
    if (const auto command = parse<Command>(line.frame))
      take(command->message, command->label.node, line.time_us);
    if (const auto answer = parse<Acknowledge>(line.frame))
      take(answer->message, answer->label.node, line.time_us);
    if (const auto report = parse<NodeState>(line.frame))
      take(report->message, report->label.node, line.time_us);
  }

 private:
  struct Node {
    std::map<std::uint8_t, std::int64_t> asked_us;  ///< by sequence: when it was first said
    State state = State::Boot;
    std::int64_t since_us = 0;  ///< of its first report of that state
  };

  void take(const Command& command, std::uint8_t node, std::int64_t time_us) {
    const bool first = nodes_[node].asked_us.try_emplace(command.sequence, time_us).second;
    if (!first) return;
    // ACCEPT follows the giver's report that it offers, SQUEEZE the receiver's that the part is seated.
    const std::uint8_t reporter = command.op == Op::Accept ? command.argument : node;
    const State awaited = command.op == Op::Accept ? State::Offered : State::Seated;
    const bool follows = command.op == Op::Accept || command.op == Op::Squeeze;
    if (follows && nodes_[reporter].state == awaited) reactions.add(time_us - nodes_[reporter].since_us);
  }
  void take(const Acknowledge& answer, std::uint8_t node, std::int64_t time_us) {
    const auto asked = nodes_[node].asked_us.extract(answer.sequence);
    if (!asked.empty()) answers.add(time_us - asked.mapped());
  }
  void take(const NodeState& report, std::uint8_t node, std::int64_t time_us) {
    if (report.state == nodes_[node].state) return;
    nodes_[node].state = report.state;
    nodes_[node].since_us = time_us;
  }

  std::array<Node, 16> nodes_;
};

TEST(HostLatency, of_a_run_on_vcan_is_measured) {
  std::ifstream lines(OUT_DIR "/candump.log");
  Watch watch;
  for (std::string text; std::getline(lines, text);) {
    const auto line = bus::parse_log_line(text);
    ASSERT_TRUE(line) << text;
    watch.take(*line);
  }
  ASSERT_GE(watch.answers.count(), 19U) << "of a run in which nothing is said twice";
  ASSERT_GE(watch.reactions.count(), 4U);
  watch.answers.tell("from a command to its answer");
  watch.reactions.tell("from a report to the command that follows");
}

}  // namespace
}  // namespace pinjaw::wire
