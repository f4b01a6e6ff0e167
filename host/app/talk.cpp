#include "host/app/talk.hpp"

#include <fmt/format.h>

namespace pinjaw::app {

std::unique_ptr<Talk> Talk::open(Context& context) {
  const auto interface = can_interface(context.bus);
  if (!interface) {
    context.fail(
        ExitCode::Usage,
        fmt::format(
            "{} is no bus that other programs can reach: use --bus can:IFACE (sim: lives inside pinjaw run)",
            context.bus));
    return nullptr;
  }
  const auto host = context.host_settings();
  if (!host) return nullptr;
  auto venue = open_can_venue(*interface, "");
  if (!venue) {
    context.fail(ExitCode::Unavailable, venue.error().message);
    return nullptr;
  }
  return std::unique_ptr<Talk>(new Talk(context, std::move(*venue), *host));
}

Talk::Talk(Context& context, std::unique_ptr<Venue> venue, jaw_client::Client::Settings host)
    : context_(context), venue_(std::move(venue)), client_(venue_->bus(), host) {}

void Talk::tick() {
  now_us_ = venue_->tick_us();
  client_.step(now_us_);
}

bool Talk::carry_out(std::uint8_t node, const std::function<void(jaw_client::Client&)>& begin) {
  begin(client_);
  do {
    tick();
  } while (client_.outcome(node).pending());
  const jaw_client::Outcome& outcome = client_.outcome(node);
  if (outcome.done()) return true;
  context_.fail(code_of(outcome), fmt::format("node {}: {}", node, outcome.sentence));
  return false;
}

bool Talk::wait_for(double seconds, const std::string& otherwise, const std::function<bool()>& condition) {
  const std::int64_t until_us = now_us_ + static_cast<std::int64_t>(seconds * 1e6);
  while (!condition()) {
    if (now_us_ >= until_us || client_.bus_failure()) {
      context_.fail(ExitCode::Unavailable,
                    client_.bus_failure() ? client_.bus_failure()->message : otherwise);
      return false;
    }
    tick();
  }
  return true;
}

ExitCode code_of(const jaw_client::Outcome& outcome) {
  using jaw_client::OutcomeKind;
  switch (outcome.kind) {
    case OutcomeKind::Done:
      return ExitCode::Done;
    case OutcomeKind::ForceRefused:
      return ExitCode::ForceLimit;
    case OutcomeKind::Silent:
    case OutcomeKind::BusFailed:
      return ExitCode::Unavailable;
    case OutcomeKind::Pending:
    case OutcomeKind::Refused:
    case OutcomeKind::Fault:
      break;
  }
  return ExitCode::Refused;
}

}  // namespace pinjaw::app
