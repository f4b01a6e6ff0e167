#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

/// What reads files that may come from anywhere, and what hears a bus. A target takes any bytes and must come
/// to an answer: a value, or mistakes that a person can act on. Where it has neither, or a value that does
/// not hold what its reader promises, it aborts with a sentence on stderr.
namespace pinjaw::fuzz {

struct Target {
  std::string name;
  std::function<void(std::string_view bytes)> answer;
  std::vector<std::string> seeds;  ///< folders and files of the checkout with inputs to begin with
  std::string dictionary;          ///< of the words that mean something to it, in tests/fuzz/
};

/// Every target of this program, by name: those that read files, or those of protocol and firmware.
const std::vector<Target>& targets();

/// Files people write: kit, profile, task, materials, cell, sequence, controller.
std::vector<Target> yaml_targets();
/// Files programs write: plan, cell-plan.
std::vector<Target> json_targets();
/// Files of CAD systems.
std::vector<Target> part_targets();
/// Bytes of a bus or of a controller's memory.
std::vector<Target> bus_targets();
/// What a controller does about frames; bus_targets() has them, too.
std::vector<Target> controller_targets();
/// What it does about frames on CAN FD under a key; bus_targets() has them, too.
std::vector<Target> link_targets();

/// A folder of this process, like the checkout's configs/ but with room for one more file in it, which
/// relative names of the shipped files find their way from. Gone at the end of the process.
std::filesystem::path written(std::string_view bytes, const std::string& ending);

/// Aborts with `sentence` where `holds` is false.
void must(bool holds, const std::string& sentence);

}  // namespace pinjaw::fuzz
