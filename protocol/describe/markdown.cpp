#include <array>
#include <cstdio>

#include "protocol/describe/describe.hpp"
#include "protocol/describe/fault_help.hpp"
#include "protocol/describe/physical.hpp"
#include "protocol/wire/names.hpp"
#include "protocol/wire/services.hpp"
#include "protocol/wire/table.hpp"

namespace pinjaw::describe {

namespace {

using wire::FieldSpec;
using wire::MessageSpec;

std::string hex(std::uint32_t value, int digits) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%0*X", digits, value);
  return text.data();
}

std::string id_text(const MessageSpec& spec) {
  if (!spec.per_node) return hex(spec.base_id, 3);
  return hex(spec.base_id, 3) + (spec.direction == wire::Direction::AnyToAll ? " + source" : " + node");
}

std::string unit_text(const FieldSpec& field) {
  if (*field.unit == '\0') return "";
  const std::string step = physical(1, field.factor);
  return step == "1" ? field.unit : step + ' ' + field.unit;
}

std::string meaning(const FieldSpec& field) {
  std::string text = field.comment;
  if (field.presence == wire::Presence::Selected) text += " (page " + std::to_string(field.selector) + ")";
  if (field.all_ones_is_unknown) text += "; all ones: not known";
  return text;
}

std::string message(const MessageSpec& spec) {
  std::string text =
      std::string("### ") + spec.name + "\n\n" + spec.comment + "\n\n`" + id_text(spec) + "`, " +
      direction_text(spec.direction) +
      (spec.period_ms > 0 ? ", every " + std::to_string(spec.period_ms) + " ms" : ", on events") +
      ".\n\n| field | bits | unit | meaning |\n| --- | --- | --- | --- |\n";
  for (const FieldSpec& field : spec.fields) {
    text += std::string("| ") + field.name + " | " + std::to_string(field.start) + "\\|" +
            std::to_string(field.length) + " | " + unit_text(field) + " | " + meaning(field) + " |\n";
  }
  return text + '\n';
}

std::string values(const char* title, std::span<const wire::ValueName> names, int hex_digits) {
  std::string text = std::string("### ") + title + "\n\n| number | name |\n| --- | --- |\n";
  for (const wire::ValueName& value : names) {
    text += "| " + (hex_digits > 0 ? hex(value.value, hex_digits) : std::to_string(value.value)) + " | " +
            value.name + " |\n";
  }
  return text + '\n';
}

/// A sentence on the faults that the simulated controller does not report.
std::string not_simulated() {
  std::string names;
  for (const FaultHelp& help : fault_helps()) {
    if (!help.simulated) names += (names.empty() ? "" : ", ") + std::string(wire::to_string(help.code));
  }
  return "For other controllers, not reported by the simulated one: " + names + ".\n\n";
}

}  // namespace

std::string to_markdown() {
  std::string text = "## Messages\n\n";
  for (const MessageSpec& spec : wire::kMessages) text += message(spec);
  text += "## Numbers with names\n\n";
  text += values("States", wire::kStateNames, 0);
  text += values("Custody facts", wire::kFactNames, 0);
  text += values("Operations", wire::kOpNames, 0);
  text += values("Results", wire::kResultNames, 0);
  text += values("Reasons", wire::kReasonNames, 0);
  text += values("Fault codes", wire::kFaultNames, 4) + not_simulated();
  text += values("Severities", wire::kSeverityNames, 0);
  text += values("Transfer statuses", wire::kTransferStatusNames, 0);
  text.pop_back();
  return text;
}

}  // namespace pinjaw::describe
