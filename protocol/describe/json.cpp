#include <nlohmann/json.hpp>

#include "protocol/describe/describe.hpp"
#include "protocol/describe/physical.hpp"
#include "protocol/wire/services.hpp"
#include "protocol/wire/table.hpp"

namespace pinjaw::describe {

namespace {

using Json = nlohmann::ordered_json;

Json values_of(std::span<const wire::ValueName> names) {
  Json values = Json::object();
  for (const wire::ValueName& value : names) values[std::to_string(value.value)] = value.name;
  return values;
}

Json field_of(const wire::FieldSpec& field) {
  Json json = {{"name", field.name},
               {"start_bit", field.start},
               {"length_bits", field.length},
               {"factor", {{"numerator", field.factor.numerator}, {"denominator", field.factor.denominator}}},
               {"unit", field.unit},
               {"largest_raw", field.largest()},
               {"all_ones_is_unknown", field.all_ones_is_unknown},
               {"comment", field.comment}};
  if (field.presence == wire::Presence::Selected) json["page"] = field.selector;
  if (!field.values.empty()) json["values"] = values_of(field.values);
  return json;
}

Json message_of(const wire::MessageSpec& spec) {
  Json json = {{"name", spec.name},
               {"base_id", spec.base_id},
               {"per_node", spec.per_node},
               {"data_id_type", static_cast<unsigned>(spec.type)},
               {"direction", direction_text(spec.direction)},
               {"period_ms", spec.period_ms},
               {"comment", spec.comment},
               {"fields", Json::array()}};
  for (const wire::FieldSpec& field : spec.fields) json["fields"].push_back(field_of(field));
  return json;
}

}  // namespace

std::string to_json() {
  Json json = {{"format", "pinjaw-bus/1"}, {"version", wire::kProtocolVersion}, {"messages", Json::array()}};
  for (const wire::MessageSpec& spec : wire::kMessages) json["messages"].push_back(message_of(spec));
  json["transfer_statuses"] = values_of(wire::kTransferStatusNames);
  return json.dump(2) + '\n';
}

}  // namespace pinjaw::describe
