#include "host/app/commands/commands.hpp"

namespace pinjaw::app {

void add_commands(CLI::App& app, Context& context) {
  add_plan(app, context);
  add_planar(app, context);
  add_features(app, context);
  add_why(app, context);
  add_check(app, context);
  add_cell(app, context);
  add_sheet(app, context);
  add_kit(app, context);
  add_send(app, context);
  add_jaw(app, context);
  add_run(app, context);
  add_dbc(app, context);
  add_explain(app, context);
  add_examples(app);
}

}  // namespace pinjaw::app
