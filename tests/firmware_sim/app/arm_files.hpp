#pragma once

#include <string>

#include "tests/support/folder.hpp"

namespace pinjaw::jaw_app {

/// A kit and files of controllers that work with it, in a folder of their own; "arm" is node 1.
class ArmFiles {
 public:
  ArmFiles() {
    write("kit.yaml",
          "kit: test\n"
          "grid: {spacing_mm: 11.1125, columns: 2, rows: 9, edge_offset_mm: 5.55625}\n"
          "pins: {radius_mm: 2.38125, lengths_mm: any, min_engagement_mm: 1.0, protrusion_mm: 1.0}\n"
          "jaws: {separation_mm: [5, 60], plate_gap_mm: 2.0}\n"
          "actuator: {max_squeeze_n: 140, force_uncertainty_n: 12}\n");
  }

  /// Writes a controller's file; gives its path. `more`: settings of its own.
  [[nodiscard]] std::string controller(const std::string& name = "arm", int node = 1,
                                       const std::string& more = {}) const {
    return write(name + ".yaml", "controller: " + name + "\nnode: " + std::to_string(node) +
                                     "\nkit: kit.yaml\npassive: false\n"
                                     "hardware: {max_squeeze_n: 140, force_uncertainty_n: 12}\nplant: {}\n" +
                                     more);
  }
  std::string write(const std::string& name, const std::string& text) const {
    return folder_.write(name, text);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path(name); }

 private:
  test::Folder folder_;
};

}  // namespace pinjaw::jaw_app
