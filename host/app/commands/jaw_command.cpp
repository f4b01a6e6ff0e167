#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/talk.hpp"
#include "protocol/wire/names.hpp"

namespace pinjaw::app {

namespace {

struct JawOptions {
  int node = 0;
  int peer = 0;
  double force_n = 0;
  double permit_n = 0;
};

using Operation = std::function<void(jaw_client::Client&, std::uint8_t, const JawOptions&)>;

bool hear(Talk& talk, std::uint8_t node) {
  const jaw_client::NodeView& view = talk.client().node(node);
  return talk.wait_for(kAnswerS, fmt::format("node {} does not answer", node),
                       [&] { return view.state && view.force && view.layout; });
}

std::string tenths(const std::optional<std::uint16_t>& value) {
  return value ? fmt::format("{:.1f}", *value / 10.0) : std::string("?");
}

nlohmann::ordered_json newtons(const std::optional<std::uint16_t>& value_dn) {
  return value_dn ? nlohmann::ordered_json(*value_dn / 10.0) : nlohmann::ordered_json();
}

nlohmann::ordered_json status_json(const jaw_client::NodeView& view, int node) {
  const wire::NodeState& state = *view.state;
  nlohmann::ordered_json faults = nlohmann::ordered_json::array();
  for (const wire::FaultReport& fault : view.faults) faults.push_back(wire::to_string(fault.code));
  nlohmann::ordered_json separation_mm;
  if (state.separation_50um) separation_mm = *state.separation_50um * 0.05;
  return {{"node", node},
          {"state", wire::to_string(state.state)},
          {"armed", state.armed},
          {"custody", wire::to_string(state.custody)},
          {"force_low_n", newtons(state.f_low_dn)},
          {"force_high_n", newtons(view.force->f_high_dn)},
          {"force_set_n", newtons(view.force->f_set_dn)},
          {"limit_n", newtons(view.force->f_limit_effective_dn)},
          {"jaw_separation_mm", separation_mm},
          {"layout", fmt::format("{:08x}", view.layout->layout_crc)},
          {"kit", fmt::format("{:04x}", view.layout->kit_id)},
          {"faults", faults}};
}

void print_status(const Context& context, const jaw_client::NodeView& view, int node) {
  if (context.json) return context.print(status_json(view, node).dump(1));
  const wire::NodeState& state = *view.state;
  context.print(fmt::format("node {}: {}{}, custody {}", node, wire::to_string(state.state),
                            state.armed ? ", armed" : "", wire::to_string(state.custody)));
  context.print(fmt::format("  force between {} and {} N, set {} N, limit {} N", tenths(state.f_low_dn),
                            tenths(view.force->f_high_dn), tenths(view.force->f_set_dn),
                            tenths(view.force->f_limit_effective_dn)));
  if (state.separation_50um)
    context.print(fmt::format("  jaws {:.2f} mm apart", *state.separation_50um * 0.05));
  context.print(fmt::format("  layout {:08x}, kit {:04x}", view.layout->layout_crc, view.layout->kit_id));
  for (const wire::FaultReport& fault : view.faults) {
    const char* name = wire::to_string(fault.code);
    context.print(fmt::format("  fault {}; see pinjaw explain {}", name, name));
  }
}

void run_status(Context& context, const JawOptions& options) {
  const std::unique_ptr<Talk> talk = Talk::open(context);
  const auto node = static_cast<std::uint8_t>(options.node);
  if (talk && hear(*talk, node)) print_status(context, talk->client().node(node), options.node);
}

/// One action as a host of its own: heartbeat, permission, ARM where the action needs a session, the action,
/// its end.
void run_operation(Context& context, const JawOptions& options, bool needs_session,
                   const Operation& operation) {
  const std::unique_ptr<Talk> talk = Talk::open(context);
  const auto node = static_cast<std::uint8_t>(options.node);
  if (!talk || !hear(*talk, node)) return;
  talk->client().permit(node, true);
  if (needs_session) {
    const std::uint32_t crc = talk->client().node(node).layout->layout_crc;
    if (!talk->carry_out(node, [&](auto& client) { client.arm(node, crc); })) return;
  }
  if (!talk->carry_out(node, [&](auto& client) { operation(client, node, options); })) return;
  print_status(context, talk->client().node(node), options.node);
}

wire::SqueezeForces forces_of(const JawOptions& options) {
  const auto tenths_of = [](double force_n) { return static_cast<std::uint16_t>(std::lround(force_n * 10)); };
  return {tenths_of(options.force_n), tenths_of(options.permit_n)};
}

struct Verb {
  const char* name;
  const char* help;
  bool needs_session;
  Operation operation;
};

std::vector<Verb> verbs() {
  const auto peer = [](const JawOptions& o) { return static_cast<std::uint8_t>(o.peer); };
  return {
      {"hold", "keep holding, whatever is going on", false, [](auto& c, auto n, auto&) { c.hold(n); }},
      {"close", "close lightly on a part (needs the local enable)", true,
       [](auto& c, auto n, auto&) { c.close_light(n); }},
      {"squeeze", "squeeze with --force-n, never over --permit-n", true,
       [](auto& c, auto n, auto& o) { c.squeeze(n, forces_of(o)); }},
      {"offer", "offer the part to --to", true, [peer](auto& c, auto n, auto& o) { c.offer(n, peer(o)); }},
      {"accept", "take the part that --from offers", true,
       [peer](auto& c, auto n, auto& o) { c.accept(n, peer(o)); }},
      {"abort", "call off what is going on; whoever holds the part goes on holding", true,
       [](auto& c, auto n, auto&) { c.abort(n); }},
      {"release", "release by hand (needs the local enable)", true,
       [](auto& c, auto n, auto&) { c.release(n); }},
      {"clear", "clear a fault whose cause is gone", true, [](auto& c, auto n, auto&) { c.clear_fault(n); }}};
}

}  // namespace

void add_jaw(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("jaw", "one controller, by hand");
  command->require_subcommand(1);
  command->fallthrough();
  auto options = std::make_shared<JawOptions>();
  for (const Verb& verb : verbs()) {
    CLI::App* sub = command->add_subcommand(verb.name, verb.help);
    sub->add_option("--node", options->node, "the controller, 1 to 14")
        ->type_name("N")
        ->required()
        ->check(whole_in({1, 14}));
    const std::string name = verb.name;
    if (name == "offer")
      sub->add_option("--to", options->peer, "the receiver")
          ->type_name("N")
          ->required()
          ->check(whole_in({1, 14}));
    if (name == "accept")
      sub->add_option("--from", options->peer, "the giver")
          ->type_name("N")
          ->required()
          ->check(whole_in({1, 14}));
    if (name == "squeeze") {
      constexpr double kMostN = 250;
      sub->add_option("--force-n", options->force_n, "squeeze, sum of both jaws")
          ->type_name("NEWTON")
          ->required()
          ->check(force_up_to(kMostN));
      sub->add_option("--permit-n", options->permit_n, "never to be exceeded")
          ->type_name("NEWTON")
          ->required()
          ->check(force_up_to(kMostN));
    }
    sub->callback(
        [&context, options, verb] { run_operation(context, *options, verb.needs_session, verb.operation); });
  }
  CLI::App* status = command->add_subcommand("status", "what the controller says of itself");
  status->add_option("--node", options->node, "the controller, 1 to 14")
      ->type_name("N")
      ->required()
      ->check(whole_in({1, 14}));
  status->callback([&context, options] { run_status(context, *options); });
}

}  // namespace pinjaw::app
