#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/app/choices.hpp"
#include "host/app/commands/commands.hpp"
#include "host/app/commands/planning.hpp"
#include "host/app/talk.hpp"
#include "host/planner/plan/layout.hpp"
#include "host/planner/plan/plan_json.hpp"

namespace pinjaw::app {

namespace {

struct SendOptions {
  std::string plan;
  std::string design = "best";
  int node = 0;
};

/// The controller's kit and limit fit the plan's; they are compared before anything is written to it.
bool fits(Context& context, Talk& talk, std::uint8_t node, const wire::Layout& layout) {
  const jaw_client::NodeView& view = talk.client().node(node);
  const bool heard = talk.wait_for(kAnswerS, fmt::format("node {} does not answer", node),
                                   [&] { return view.state && view.force && view.layout; });
  if (!heard) return false;
  if (view.layout->kit_id != layout.kit_id) {
    context.fail(ExitCode::Refused, fmt::format("node {} has kit {:04x}, the plan is for kit {:04x}", node,
                                                view.layout->kit_id, layout.kit_id));
    return false;
  }
  return true;
}

void run_send(Context& context, const SendOptions& options) {
  const auto plan = planner::read_plan(options.plan);
  if (!plan) return context.fail(plan.error(), "nothing was sent");
  const model::Design* design = find_design(plan->designs, options.design);
  if (design == nullptr)
    return fail_without_design(context, options.design, options.plan, plan->designs.size());
  const auto layout = planner::layout_of({plan->kit, *design, plan->part.sha256, false});
  if (!layout) return context.fail(ExitCode::Refused, layout.error().message);

  const std::unique_ptr<Talk> talk = Talk::open(context);
  if (!talk) return;
  const auto node = static_cast<std::uint8_t>(options.node);
  if (!fits(context, *talk, node, *layout)) return;
  const std::uint32_t crc = wire::layout_crc_of(*layout);
  const bool sent = talk->carry_out(node, [&](auto& client) { client.send_layout(node, *layout); }) &&
                    talk->carry_out(node, [&](auto& client) { client.arm(node, crc); }) &&
                    talk->carry_out(node, [&](auto& client) { client.disarm(node); });
  if (!sent) return;
  if (context.json) {
    const nlohmann::ordered_json document = {
        {"node", options.node}, {"design", design->id}, {"layout", fmt::format("{:08x}", crc)}};
    return context.print(document.dump(1));
  }
  context.print(fmt::format("node {} has design {} (layout {:08x}), armed once to prove it, and is LOADED",
                            node, design->id, crc));
}

}  // namespace

void add_send(CLI::App& app, Context& context) {
  auto options = std::make_shared<SendOptions>();
  CLI::App* command = app.add_subcommand("send", "send a design's layout to a controller and commit it");
  command->add_option("PLAN", options->plan, "plan JSON")->type_name("")->check(file_name())->required();
  command->add_option("--design", options->design, "id of a design, or best")
      ->type_name("ID")
      ->capture_default_str();
  command->add_option("--node", options->node, "the controller, 1 to 14")
      ->type_name("N")
      ->required()
      ->check(whole_in({1, 14}));
  command->callback([&context, options] { run_send(context, *options); });
}

}  // namespace pinjaw::app
