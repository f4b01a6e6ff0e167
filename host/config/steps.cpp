#include <fmt/format.h>

#include <algorithm>

#include "host/config/fields.hpp"
#include "host/config/script.hpp"

namespace pinjaw::config {
namespace {

using base::YamlMap;
using base::YamlValue;

/// Reads steps in order and follows the part through them.
class StepReader {
 public:
  explicit StepReader(const model::Cell& cell) : cell_(cell) {
    for (const model::Station& station : cell.stations) stations_.push_back(station.name);
  }

  std::optional<model::Step> read(const YamlValue& item) {
    const auto choice = only_choice(item, "a step {ACTION: {...}}",
                                    {"place", "handoff", "move", "rotate", "spray", "wait", "remove"});
    if (!choice) return {};
    YamlMap map = choice->value.map("settings {key: value}");
    if (!map.present()) return {};
    model::Step step = read_action(choice->word, map);
    map.finish();
    return step;
  }

 private:
  model::Step read_action(const std::string& action, YamlMap& map) {
    if (action == "place") return place(map);
    if (action == "handoff") return handoff(map);
    if (action == "move") return move(map);
    if (action == "rotate") return rotate(map);
    if (action == "spray") return spray(map);
    if (action == "wait") return model::WaitStep{map.number("seconds", seconds_above_0())};
    return remove(map);
  }

  model::PlaceStep place(YamlMap& map) {
    model::PlaceStep step{station(map, "on")};
    if (!holder_.empty()) map.mistake_at("on", fmt::format("the part is already at {}", holder_));
    holder_ = step.on;
    return step;
  }

  model::RemoveStep remove(YamlMap& map) {
    model::RemoveStep step{station(map, "from")};
    needs_part(map, "from", step.from);
    holder_.clear();
    return step;
  }

  model::HandoffStep handoff(YamlMap& map) {
    model::HandoffStep step;
    step.from = station(map, "from");
    step.to = station(map, "to");
    step.within_s = map.number_or("within_s", seconds_above_0(), step.within_s);
    needs_part(map, "from", step.from);
    const auto joins = [&](const model::Handoff& pair) {
      return (pair.giver == step.from && pair.receiver == step.to) ||
             (pair.giver == step.to && pair.receiver == step.from);
    };
    const bool both = !step.from.empty() && !step.to.empty() && !stations_.empty();
    if (both && std::none_of(cell_.handoffs.begin(), cell_.handoffs.end(), joins)) {
      map.mistake_at("to",
                     fmt::format("cell {} has no handoff between {} and {}", cell_.name, step.from, step.to));
    }
    holder_ = step.to;
    return step;
  }

  model::MoveStep move(YamlMap& map) {
    model::MoveStep step;
    step.station = station(map, "station");
    step.seconds = map.number("seconds", seconds_above_0());
    step.peak_g = map.number_or("peak_g", acceleration_g(), 0);
    if (const auto along = map.find("along")) step.along = unit_vector(*along).value_or(step.along);
    return step;
  }

  model::RotateStep rotate(YamlMap& map) {
    model::RotateStep step;
    step.station = station(map, "station");
    step.angle_rad = map.number("deg", angle_deg()) * kRadPerDeg;
    step.seconds = map.number("seconds", seconds_above_0());
    step.peak_g = map.number_or("peak_g", acceleration_g(), 0);
    return step;
  }

  model::SprayStep spray(YamlMap& map) {
    model::SprayStep step;
    step.on = station(map, "on");
    needs_part(map, "on", step.on);
    step.seconds = map.number("seconds", seconds_above_0());
    step.force_n = map.number("force_n", force_above_0());
    if (const auto seed = map.find("seed")) {
      const auto number = seed->whole(whole_between("a seed", 0, std::numeric_limits<std::int64_t>::max()));
      step.seed = static_cast<std::uint64_t>(number.value_or(1));
    }
    return step;
  }

  /// A station of the cell; empty (reported) where there is none of that name.
  std::string station(YamlMap& map, std::string_view key) {
    const auto value = map.require(key);
    const auto name = value ? value->text("the name of a station") : std::nullopt;
    if (!name) return {};
    // Without stations the cell could not be read, which is told there.
    if (stations_.empty() || std::find(stations_.begin(), stations_.end(), *name) != stations_.end())
      return *name;
    value->mistake(fmt::format("cell {} has no station \"{}\"{}", cell_.name, *name,
                               base::did_you_mean(*name, stations_)));
    return {};
  }

  void needs_part(const YamlMap& map, std::string_view key, const std::string& name) {
    if (name.empty() || name == holder_) return;
    const std::string where = holder_.empty() ? "placed nowhere" : fmt::format("at {}", holder_);
    map.mistake_at(key, fmt::format("{} does not have the part, which is {}", name, where));
  }

  const model::Cell& cell_;
  std::vector<std::string> stations_;
  std::string holder_;  ///< empty where nobody has the part
};

}  // namespace

std::vector<model::Step> read_steps(const YamlValue& list, const model::Cell& cell) {
  std::vector<model::Step> steps;
  StepReader reader(cell);
  const auto items = list.list("a list of steps [{ACTION: {...}}, ...]", {1, 10000});
  for (const YamlValue& item : items.value_or(std::vector<YamlValue>{})) {
    if (auto step = reader.read(item)) steps.push_back(std::move(*step));
  }
  return steps;
}

}  // namespace pinjaw::config
