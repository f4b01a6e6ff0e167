#include "host/app/commands/commands.hpp"

namespace pinjaw::app {

void add_commands(CLI::App& app, Context& context) {
  add_plan(app, context);
  add_planar(app, context);
  add_features(app, context);
  add_why(app, context);
  add_check(app, context);
}

}  // namespace pinjaw::app
