#include "firmware_sim/app/program.hpp"

#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "firmware_sim/app/pace.hpp"
#include "protocol/bus/statistics.hpp"
#include "protocol/wire/codec.hpp"
#include "protocol/wire/secured_link.hpp"

namespace pinjaw::jaw_app {
namespace {

constexpr std::int64_t kNs_per_s = 1'000'000'000;
constexpr std::int64_t kTellEvery_ns = kNs_per_s;
// chosen: a program that runs after its clock still answers its world
constexpr int kStepsBetweenServing = 20;

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * kNs_per_s + now.tv_nsec;
}

/// Sleeps so long, or until a signal.
void sleep_for(std::int64_t time_ns) {
  const timespec time{.tv_sec = time_ns / kNs_per_s, .tv_nsec = time_ns % kNs_per_s};
  nanosleep(&time, nullptr);
}

void tell(const std::string& text) {
  fmt::print(stderr, "pinjaw-jaw: {}\n", text);
}

std::vector<world::Member> join(const std::vector<node::Figures>& members,
                                const std::vector<std::unique_ptr<bus::Bus>>& buses) {
  std::vector<world::Member> joined;
  for (std::size_t i = 0; i < members.size(); ++i) joined.push_back({members[i], buses[i].get()});
  return joined;
}

}  // namespace

std::vector<bus::Filter> filters_of(int node, bool can_fd) {
  using wire::MessageType;
  constexpr std::uint32_t kOne = 0x7FF;
  constexpr std::uint32_t kAllNodes = 0x7F0;
  std::vector<bus::Filter> filters;
  for (const MessageType type :
       {MessageType::GlobalHold, MessageType::Fault, MessageType::Custody, MessageType::State}) {
    filters.push_back({wire::id_of({type, 0}), kAllNodes});
  }
  if (can_fd) filters.push_back({wire::kSynchronisationId, kAllNodes});
  filters.push_back({wire::id_of({MessageType::HostHeartbeat, 0}), kOne});
  const auto own = static_cast<std::uint8_t>(node);
  for (const MessageType type : {MessageType::Command, MessageType::TransferRequest}) {
    filters.push_back({wire::id_of({type, own}), kOne});
  }
  // what only this node may say: whoever else does is found out
  for (const MessageType type : {MessageType::Force, MessageType::Acknowledge, MessageType::Pneumatics,
                                 MessageType::LayoutStatus, MessageType::Identity}) {
    filters.push_back({wire::id_of({type, own}), kOne});
  }
  return filters;
}

Program::Program(const std::vector<node::Figures>& members, std::vector<std::unique_ptr<bus::Bus>> buses,
                 std::unique_ptr<bench::SocketServer> server, const Options& options)
    : buses_(std::move(buses)),
      server_(std::move(server)),
      world_(join(members, buses_), options.seed),
      faults_(options.faults),
      troubles_(buses_.size()) {
  for (const node::Figures& member : members) nodes_.push_back(member.node);
  if (options.events) {
    world_.on_event([](const std::string& line) { fmt::print(stderr, "{}\n", line); });
  }
}

void Program::run(const std::atomic<bool>& stop) {
  Pace pace(now_ns());
  std::int64_t tell_ns = pace.next_ns() + kTellEvery_ns;
  while (!stop) {
    // The clock is read once: what the steps take makes the next ones start so much later, but adds up to
    // nothing.
    const std::int64_t now = now_ns();
    int due = pace.due(now);
    while (due > kStepsBetweenServing && !stop) {
      for (int i = 0; i < kStepsBetweenServing; ++i, --due) step();
      serve(0);
    }
    for (; due > 0 && !stop; --due) step();
    if (pace.next_ns() >= tell_ns) {
      tell_troubles();
      tell_ns = pace.next_ns() + kTellEvery_ns;
    }
    serve(pace.next_ns() - now);
  }
  tell_troubles();
  if (pace.given_up_ms() > 0)
    tell(fmt::format("{} ms were never simulated: too far behind", pace.given_up_ms()));
}

void Program::serve(std::int64_t patience_ns) {
  if (!server_) return sleep_for(patience_ns);
  server_->serve([this](const bench::Request& request) { return world_.handle(request); }, patience_ns);
}

void Program::step() {
  start_faults();
  const auto stepped = world_.step();
  const bool failed = !stepped;
  if (failed && !bus_failed_) tell(stepped.error().message);
  if (!failed && bus_failed_) tell("the bus is back");
  bus_failed_ = failed;
}

void Program::tell_troubles() {
  for (std::size_t i = 0; i < buses_.size(); ++i) {
    std::string troubles = bus::to_text(buses_[i]->statistics());
    if (troubles == troubles_[i]) continue;
    tell(fmt::format("bus of node {}: {}", nodes_[i], troubles));
    troubles_[i] = std::move(troubles);
  }
}

void Program::start_faults() {
  std::erase_if(faults_, [this](const TimedFault& fault) {
    if (world_.time_s() < fault.at_s) return false;
    world_.handle(bench::Break{fault.node, fault.text});
    return true;
  });
}

}  // namespace pinjaw::jaw_app
