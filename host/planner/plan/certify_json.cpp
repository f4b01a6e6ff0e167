#include "host/planner/plan/certify_json.hpp"

#include <cmath>
#include <limits>

#include "host/planner/plan/json_values.hpp"

namespace pinjaw::planner {
namespace {

using base::JsonField;
using nlohmann::ordered_json;

constexpr std::int64_t kMostRays = 100000;  // as a task may name
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double number_or_infinity(const JsonField& field, std::string_view key) {
  return field.has(key) ? field.number(key) : kInfinity;
}

}  // namespace

ordered_json certified_json(const model::Certified& certified) {
  ordered_json json = {{"sampled_n", certified.sampled_n}};
  if (std::isfinite(certified.low_n)) json["low_n"] = certified.low_n;
  if (std::isfinite(certified.high_n)) json["high_n"] = certified.high_n;
  json["spray"] = certified.spray;
  json["at_mm"] = vector_json(certified.at_mm);
  json["normal"] = vector_json(certified.normal);
  json["from"] = vector_json(certified.from);
  json["face"] = certified.curved ? "curved" : "flat";
  json["closed"] = certified.closed;
  return json;
}

model::Certified read_certified(const JsonField& field) {
  model::Certified certified;
  certified.sampled_n = field.number("sampled_n");
  certified.low_n = number_or_infinity(field, "low_n");
  certified.high_n = number_or_infinity(field, "high_n");
  certified.spray = field.text("spray");
  certified.at_mm = read_vector3(field.at("at_mm"));
  certified.normal = read_vector3(field.at("normal"));
  certified.from = read_vector3(field.at("from"));
  certified.curved = field.at("face").one_of({"flat", "curved"}) == 1;
  certified.closed = field.at("closed").truth();
  return certified;
}

ordered_json disturbances_json(const std::vector<model::Disturbance>& disturbances) {
  ordered_json list = ordered_json::array();
  for (const model::Disturbance& disturbance : disturbances) {
    ordered_json wrench = ordered_json::array();
    for (int i = 0; i < 6; ++i) wrench.push_back(disturbance.wrench[i]);
    list.push_back({{"name", disturbance.name}, {"wrench", wrench}});
  }
  return list;
}

std::vector<model::Disturbance> read_disturbances(const JsonField& field) {
  std::vector<model::Disturbance> disturbances;
  for (const JsonField& entry : field.list()) {
    model::Disturbance disturbance;
    disturbance.name = entry.text("name");
    const std::vector<double> wrench =
        entry.at("wrench").numbers(6, {"a number from -1e12 to 1e12", -1e12, 1e12});
    for (int i = 0; i < 6; ++i) disturbance.wrench[i] = wrench[static_cast<std::size_t>(i)];
    disturbances.push_back(std::move(disturbance));
  }
  return disturbances;
}

ordered_json jets_json(const std::vector<Jet>& jets) {
  ordered_json list = ordered_json::array();
  for (const Jet& jet : jets) {
    ordered_json entry = {{"name", jet.name},
                          {"force_n", jet.spray.force_n},
                          {"count", jet.spray.count},
                          {"seed", jet.spray.seed}};
    if (jet.spray.from) {
      entry["from"] = vector_json(*jet.spray.from);
      entry["within_deg"] = jet.spray.within_rad.value_or(0) / kDegree;
    }
    entry["with"] = disturbances_json(jet.with);
    list.push_back(std::move(entry));
  }
  return list;
}

std::vector<Jet> read_jets(const JsonField& field) {
  std::vector<Jet> jets;
  for (const JsonField& entry : field.list()) {
    Jet jet;
    jet.name = entry.text("name");
    jet.spray.name = jet.name;
    jet.spray.force_n = entry.number("force_n");
    jet.spray.count = static_cast<int>(
        entry.at("count").whole(base::WholeRule{"a count of rays from 1 to 100000", 1, kMostRays}));
    jet.spray.seed =
        static_cast<std::uint64_t>(entry.at("seed").whole(base::WholeRule{"a seed of 0 or more", 0}));
    if (entry.has("from")) {
      jet.spray.from = read_vector3(entry.at("from"));
      jet.spray.within_rad = entry.number("within_deg") * kDegree;
      if (!(jet.spray.from->norm() > 0))
        entry.at("from").mistake("expected a direction, found a vector of length 0");
    }
    jet.with = read_disturbances(entry.at("with"));
    if (jet.with.empty()) entry.at("with").mistake("expected one state or more");
    jets.push_back(std::move(jet));
  }
  return jets;
}

}  // namespace pinjaw::planner
