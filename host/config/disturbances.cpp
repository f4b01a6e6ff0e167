#include "host/config/disturbances.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "host/config/disturbance_kinds.hpp"
#include "host/config/fields.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

/// Gives out names: each stands for one disturbance.
class Names {
 public:
  std::string given(const YamlValue& value) {
    std::string name = value.text("a name").value_or("");
    const auto [first, is_new] = lines_.emplace(name, value.place().line);
    if (!is_new && !name.empty()) {
      value.mistake(fmt::format("\"{}\" names another disturbance, in line {}", name, first->second));
    }
    return name;
  }

  std::string made(const std::string& kind, int line) {
    std::string name = kind;
    for (int number = 2; !lines_.emplace(name, line).second; ++number)
      name = fmt::format("{}-{}", kind, number);
    return name;
  }

 private:
  std::map<std::string, int> lines_;
};

constexpr std::string_view kWhat = "a disturbance {KIND: {...}}";

struct Entry {
  YamlValue at;
  std::string kind;
  bool named = false;
  model::DisturbanceSource source;
};

model::DisturbanceSource widened(model::SingleSource source) {
  return std::visit([](auto& each) { return model::DisturbanceSource(std::move(each)); }, source);
}

bool is_spray(const model::SingleSource& source) {
  return std::holds_alternative<model::Spray>(source);
}

/// A source that is not `together`, with its name where it has one; nothing (reported) where it is none.
struct Single {
  model::SingleSource source;
  bool named = false;
};
std::optional<Single> read_single_entry(const Choice& choice, Names& names) {
  if (choice.word == "gravity" && choice.value.is_list()) {
    model::Gravity gravity;
    if (const auto down = unit_vector(choice.value)) gravity.poses = {*down};
    return Single{gravity, false};
  }
  YamlMap map = choice.value.map("settings {key: value}");
  if (!map.present()) return {};
  const auto name = map.find("name");
  Single single{read_single(choice.word, map), name.has_value()};
  map.finish();
  if (name) std::visit([&](auto& source) { source.name = names.given(*name); }, single.source);
  return single;
}

/// `{name: ..., of: [{KIND: {...}}, ...]}`.
Entry read_together(const YamlValue& value, Names& names) {
  Entry entry{value, "together", false, {}};
  model::Together together;
  YamlMap map = value.map("settings {name: ..., of: [...]}");
  if (const auto name = map.find("name")) {
    entry.named = true;
    together.name = names.given(*name);
  }
  const auto of = map.require("of");
  const auto items =
      of ? of->list("a list of 2 to 20 disturbances [{KIND: {...}}, ...]", {2, 20}) : std::nullopt;
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    const auto choice = only_choice(item, kWhat, single_kinds());
    auto single = choice ? read_single_entry(*choice, names) : std::nullopt;
    if (!single) continue;
    if (is_spray(single->source) && std::ranges::any_of(together.of, is_spray))
      item.mistake("expected one spray at most: of two jets at once, list each choice as a wrench");
    together.of.push_back(std::move(single->source));
  }
  map.finish();
  entry.source = std::move(together);
  return entry;
}

std::optional<Entry> read_entry(const YamlValue& item, Names& names) {
  static const std::vector<std::string> kKinds = [] {
    std::vector<std::string> kinds = single_kinds();
    kinds.emplace_back("together");
    return kinds;
  }();
  const auto choice = only_choice(item, kWhat, kKinds);
  if (!choice) return {};
  if (choice->word == "together") return read_together(choice->value, names);
  auto single = read_single_entry(*choice, names);
  if (!single) return {};
  return Entry{choice->value, choice->word, single->named, widened(std::move(single->source))};
}

std::vector<Entry> read_list(YamlMap& task, std::string_view key, Names& names) {
  std::vector<Entry> entries;
  const auto list = task.find(key);
  const auto items =
      list ? list->list("a list of disturbances [{KIND: {...}}, ...]", {0, 10000}) : std::nullopt;
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    if (auto entry = read_entry(item, names)) entries.push_back(std::move(*entry));
  }
  return entries;
}

/// A jet comes and goes: a thousand hits, each with each disturbance, is not what acts always.
void refuse_sprays(const Entry& entry) {
  const auto* together = std::get_if<model::Together>(&entry.source);
  const bool sprays = std::holds_alternative<model::Spray>(entry.source) ||
                      (together != nullptr && std::ranges::any_of(together->of, is_spray));
  if (sprays)
    entry.at.mistake("a spray is many loads, of which one acts at a time; list it under disturbances");
}

/// How many loads a source stands for.
std::int64_t loads_of(const model::DisturbanceSource& source) {
  if (const auto* spray = std::get_if<model::Spray>(&source)) return spray->count;
  const auto* acceleration = std::get_if<model::Acceleration>(&source);
  return acceleration == nullptr ? 1 : static_cast<std::int64_t>(acceleration->along.size());
}

/// Each design is held against every load; so many bound memory to some 100 MB.
void refuse_too_many(const std::vector<Entry>& entries) {
  constexpr std::int64_t kMost = 1'000'000;
  std::int64_t loads = 0;
  for (const Entry& entry : entries) {
    loads += loads_of(entry.source);
    if (loads <= kMost) continue;
    return entry.at.mistake(fmt::format("with this the task has {} loads; expected up to {}", loads, kMost));
  }
}

}  // namespace

DisturbanceLists read_disturbances(YamlMap& task) {
  Names names;
  std::vector<Entry> always = read_list(task, "always", names);
  std::vector<Entry> disturbances = read_list(task, "disturbances", names);
  if (!task.has("disturbances") && task.present()) {
    task.mistake("lacks disturbances (a list; [] where the part is only located)");
  }
  refuse_too_many(disturbances);
  DisturbanceLists lists;
  // Names made up come after all given ones, so that none of them takes a name from a later line.
  for (auto* entries : {&always, &disturbances}) {
    for (Entry& entry : *entries) {
      const std::string name = entry.named ? "" : names.made(entry.kind, entry.at.place().line);
      if (!entry.named) std::visit([&](auto& source) { source.name = name; }, entry.source);
      if (entries == &always) refuse_sprays(entry);
      (entries == &always ? lists.always : lists.disturbances).push_back(std::move(entry.source));
    }
  }
  return lists;
}

}  // namespace pinjaw::config
