#include <fmt/format.h>

#include <charconv>

#include "host/config/fields.hpp"
#include "host/config/read.hpp"
#include "host/config/script.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

/// The number in `20 %`, as a share from 0 to 1.
std::optional<double> read_share(const YamlValue& value) {
  const std::string text = value.raw();
  double percent = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), percent);
  std::string_view rest(end, static_cast<std::size_t>(text.data() + text.size() - end));
  while (rest.starts_with(' ')) rest.remove_prefix(1);
  if (error == std::errc() && rest == "%" && percent >= 0 && percent <= 100) return percent / 100;
  value.mistake("expected a share such as 20 %, from 0 to 100 %");
  return {};
}

/// The number in `step 4`.
std::optional<int> read_step_number(const YamlValue& value, std::size_t step_count) {
  constexpr std::string_view kWord = "step ";
  const std::string text = value.raw();
  int number = 0;
  const bool worded = text.starts_with(kWord);
  const char* begin = text.data() + (worded ? kWord.size() : 0);
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), number);
  const bool written = worded && error == std::errc() && end == text.data() + text.size();
  if (written && number >= 1 && static_cast<std::size_t>(number) <= step_count) return number;
  value.mistake(fmt::format("expected \"step N\" with N from 1 to {}", step_count));
  return {};
}

model::ScriptedFault read_fault(const YamlValue& item, std::size_t step_count) {
  YamlMap map = item.map("a fault {at: step N | at_s: ..., kill: host | drop: ... %}");
  model::ScriptedFault fault;
  if (!map.present()) return fault;
  if (const auto at = map.find("at")) fault.at_step = read_step_number(*at, step_count);
  if (const auto at_s = map.find("at_s")) {
    base::NumberRule rule{"seconds from 0 to 86400"};
    rule.at_least = 0;
    rule.at_most = 86400;
    fault.at_s = at_s->number(rule);
  }
  if (map.has("at") == map.has("at_s")) map.mistake("expected one of at and at_s");
  if (const auto kill = map.find("kill")) fault.kill_host = kill->one_of({"host"}).has_value();
  if (const auto drop = map.find("drop")) {
    fault.drop_share = read_share(*drop).value_or(0);
    fault.seconds = map.number("seconds", seconds_above_0());
  }
  if (map.has("kill") == map.has("drop")) map.mistake("expected one of kill and drop");
  map.finish();
  return fault;
}

}  // namespace

std::vector<model::ScriptedFault> read_faults(const YamlValue& list, std::size_t step_count) {
  std::vector<model::ScriptedFault> faults;
  const auto items = list.list("a list of faults [{...}, ...]", {0, 1000});
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    faults.push_back(read_fault(item, step_count));
  }
  return faults;
}

Read<model::Sequence> read_sequence(const std::filesystem::path& path) {
  base::YamlFile file(path);
  YamlMap top = top_of(file, "sequence");
  base::Diagnostics nested;
  model::Sequence sequence;
  sequence.name = top.text("sequence", "a name");
  if (const auto cell = top.require("cell")) {
    const auto cell_file = named_file(*cell);
    if (cell_file) sequence.cell = take(read_cell(*cell_file), nested).value_or(model::Cell{});
  }
  if (const auto design = top.find("design")) {
    sequence.design = design->text("best, or the id of a design").value_or("best");
  }
  if (const auto steps = top.require("steps")) {
    // Where the cell has mistakes, whether steps suit it cannot be told; their own form still can.
    sequence.steps = read_steps(*steps, sequence.cell);
    const auto count = steps->list("a list of steps").value_or(std::vector<YamlValue>{}).size();
    if (const auto faults = top.find("faults")) sequence.faults = read_faults(*faults, count);
  }
  top.finish();
  return checked(file, nested, std::move(sequence));
}

}  // namespace pinjaw::config
