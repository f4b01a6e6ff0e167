#include "host/app/why_text.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "host/planner/plan/json_values.hpp"

namespace pinjaw::app {

namespace {

using nlohmann::ordered_json;
using planner::NearMiss;
using planner::Unit;

std::string amount(double value, Unit unit) {
  switch (unit) {
    case Unit::Millimetre:
      return fmt::format("{:.3f} mm", value);
    case Unit::Newton:
      return fmt::format("{:.2f} N", value);
    case Unit::Ratio:
      return fmt::format("{:.3f}", value);
  }
  return {};
}

const char* key_suffix(Unit unit) {
  switch (unit) {
    case Unit::Millimetre:
      return "_mm";
    case Unit::Newton:
      return "_n";
    case Unit::Ratio:
      return "";
  }
  return "";
}

std::string miss_text(const NearMiss& miss) {
  std::string text = fmt::format("  {:<9} {}", miss.phase, miss.reason);
  if (miss.count > 0) text += fmt::format(" ({})", miss.count);
  if (!miss.gap) return text + fmt::format(": no {} alone lets one through\n", miss.quantity);
  text += fmt::format(": {} {}, needs {} {}", miss.quantity, amount(miss.gap->has, miss.unit),
                      miss.gap->needs > miss.gap->has ? "at least" : "at most",
                      amount(miss.gap->needs, miss.unit));
  if (!miss.where.empty()) text += "; " + miss.where;
  return text + "\n";
}

ordered_json miss_json(const NearMiss& miss) {
  ordered_json json = {
      {"phase", miss.phase}, {"reason", miss.reason}, {"count", miss.count}, {"quantity", miss.quantity}};
  if (miss.gap) {
    json[std::string("has") + key_suffix(miss.unit)] = miss.gap->has;
    json[std::string("needs") + key_suffix(miss.unit)] = miss.gap->needs;
  }
  if (!miss.where.empty()) json["where"] = miss.where;
  return json;
}

ordered_json change_json(const planner::Change& change) {
  return {{"key", change.key}, {"from", change.from}, {"to", change.to}};
}

ordered_json suggestion_json(const planner::Suggestion& suggestion) {
  ordered_json changes = ordered_json::array();
  for (const planner::Change& change : suggestion.changes) changes.push_back(change_json(change));
  return {{"changes", changes},
          {"designs", suggestion.designs},
          {"best_n", suggestion.best_n},
          {"funnel", planner::funnel_json(suggestion.funnel)}};
}

}  // namespace

std::string misses_text(const std::vector<NearMiss>& misses) {
  if (misses.empty()) return {};
  std::string text = "nearest misses:\n";
  for (const NearMiss& miss : misses) text += miss_text(miss);
  return text;
}

std::string suggestion_text(const planner::Suggestion& suggestion) {
  std::string text = "  with ";
  for (const planner::Change& change : suggestion.changes) {
    if (&change != suggestion.changes.data()) text += " and ";
    text += fmt::format("{}: {} (now {})", change.key, change.to, change.from);
  }
  return text + fmt::format(": {} designs, best {:.1f} N", suggestion.designs, suggestion.best_n);
}

std::string rest_text(const Advice& advice) {
  std::string text;
  for (const planner::Change& change : advice.suggestions.in_vain) {
    text += fmt::format("  still none with {}: {} (now {})\n", change.key, change.to, change.from);
  }
  for (const std::string& left : advice.suggestions.not_tried) {
    text += fmt::format("  not tried for lack of time: {}\n", left);
  }
  return text;
}

std::string why_json(const planner::Plan& plan, const Advice& advice) {
  ordered_json document = {
      {"task", plan.task}, {"funnel", planner::funnel_json(plan.funnel)}, {"losses", plan.losses}};
  document["near_misses"] = ordered_json::array();
  for (const NearMiss& miss : advice.misses) document["near_misses"].push_back(miss_json(miss));
  document["suggestions"] = ordered_json::array();
  for (const auto& found : advice.suggestions.found)
    document["suggestions"].push_back(suggestion_json(found));
  document["in_vain"] = ordered_json::array();
  for (const auto& change : advice.suggestions.in_vain) document["in_vain"].push_back(change_json(change));
  document["not_tried"] = advice.suggestions.not_tried;
  document["plans_tried"] = advice.suggestions.plans;
  return document.dump(1);
}

}  // namespace pinjaw::app
