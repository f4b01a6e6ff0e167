#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>

#include "protocol/describe/describe.hpp"
#include "protocol/describe/physical.hpp"
#include "protocol/wire/codes.hpp"
#include "protocol/wire/table.hpp"

namespace pinjaw::describe {

namespace {

using wire::Direction;
using wire::FieldSpec;
using wire::MessageSpec;
using wire::Presence;

constexpr std::uint8_t kService = wire::kOperatorPeer;

/// One message of one sender, as a DBC lists them.
struct Entry {
  const MessageSpec* spec = nullptr;
  std::uint32_t id = 0;
  std::string name;
  std::string sender{};
  std::vector<std::string> receivers{};
};

std::string node_name(std::uint8_t node) {
  if (node == wire::kHostNode) return "HOST";
  return node == kService ? "SERVICE" : "NODE" + std::to_string(node);
}

std::string joined(const std::vector<std::string>& words, const char* between) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : between) + word;
  return text;
}

std::vector<std::string> everyone(const std::vector<std::uint8_t>& nodes) {
  std::vector<std::string> names{node_name(wire::kHostNode)};
  for (const std::uint8_t node : nodes) names.push_back(node_name(node));
  names.push_back(node_name(kService));
  return names;
}

Entry entry_of(const MessageSpec& spec, std::uint8_t node, const std::vector<std::uint8_t>& nodes) {
  Entry entry{.spec = &spec, .id = std::uint32_t{spec.base_id} + node, .name = spec.name};
  if (spec.per_node) entry.name += '_' + (node == wire::kHostNode ? "HOST" : std::to_string(node));
  const bool from_host = spec.direction == Direction::HostToAll || spec.direction == Direction::HostToNode;
  entry.sender = from_host ? node_name(wire::kHostNode) : node_name(node);
  switch (spec.direction) {
    case Direction::HostToNode:
      entry.receivers = {node_name(node)};
      break;
    case Direction::NodeToHost:
      entry.receivers = {node_name(wire::kHostNode)};
      break;
    default:
      entry.receivers = everyone(nodes);
      std::erase(entry.receivers, entry.sender);
  }
  return entry;
}

std::vector<Entry> entries_for(const std::vector<std::uint8_t>& nodes) {
  std::vector<Entry> entries;
  for (const MessageSpec& spec : wire::kMessages) {
    if (!spec.per_node) {
      entries.push_back(entry_of(spec, 0, nodes));
      continue;
    }
    const bool any = spec.direction == Direction::AnyToAll;
    if (any) entries.push_back(entry_of(spec, wire::kHostNode, nodes));
    for (const std::uint8_t node : nodes) entries.push_back(entry_of(spec, node, nodes));
    if (any) entries.push_back(entry_of(spec, kService, nodes));
  }
  return entries;
}

std::string multiplexing(const FieldSpec& field) {
  if (field.presence == Presence::Selector) return " M";
  return field.presence == Presence::Selected ? " m" + std::to_string(field.selector) : "";
}

std::string signal(const FieldSpec& field, const Entry& entry) {
  const std::uint64_t largest =
      field.values.empty() ? field.largest()
                           : std::accumulate(field.values.begin(), field.values.end(), std::uint64_t{0},
                                             [](std::uint64_t most, const wire::ValueName& value) {
                                               return std::max<std::uint64_t>(most, value.value);
                                             });
  return std::string(" SG_ ") + field.name + multiplexing(field) + " : " + std::to_string(field.start) + '|' +
         std::to_string(field.length) + "@1+ (" + physical(1, field.factor) + ",0) [0|" +
         physical(largest, field.factor) + "] \"" + field.unit + "\" " + joined(entry.receivers, ",") + '\n';
}

std::string comments(const Entry& entry) {
  const std::string id = std::to_string(entry.id);
  std::string text = "CM_ BO_ " + id + " \"" + entry.spec->comment + "\";\n";
  for (const FieldSpec& field : entry.spec->fields) {
    if (*field.comment != '\0') text += "CM_ SG_ " + id + ' ' + field.name + " \"" + field.comment + "\";\n";
  }
  return text;
}

std::string value_names(const Entry& entry) {
  std::string text;
  for (const FieldSpec& field : entry.spec->fields) {
    if (field.values.empty() && !field.all_ones_is_unknown) continue;
    text += "VAL_ " + std::to_string(entry.id) + ' ' + field.name;
    for (const wire::ValueName& value : field.values)
      text += ' ' + std::to_string(value.value) + " \"" + value.name + '"';
    if (field.all_ones_is_unknown) text += ' ' + std::to_string(wire::ones(field.length)) + " \"UNKNOWN\"";
    text += " ;\n";
  }
  return text;
}

std::string attributes(const std::vector<Entry>& entries) {
  std::string text =
      "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
      "BA_DEF_ BO_ \"GenMsgSendType\" ENUM \"Event\",\"Cyclic\";\n"
      "BA_DEF_ \"BusType\" STRING ;\n"
      "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
      "BA_DEF_DEF_ \"GenMsgSendType\" \"Event\";\n"
      "BA_DEF_DEF_ \"BusType\" \"CAN\";\n"
      "BA_ \"BusType\" \"CAN\";\n";
  for (const Entry& entry : entries) {
    const std::string id = std::to_string(entry.id);
    text += "BA_ \"GenMsgCycleTime\" BO_ " + id + ' ' + std::to_string(entry.spec->period_ms) + ";\n";
    text += "BA_ \"GenMsgSendType\" BO_ " + id + (entry.spec->period_ms > 0 ? " 1;\n" : " 0;\n");
  }
  return text;
}

constexpr const char* kNewSymbols =
    "NS_ :\n\tCM_\n\tBA_DEF_\n\tBA_\n\tVAL_\n\tBA_DEF_DEF_\n\tSIG_VALTYPE_\n\tBO_TX_BU_\n";

}  // namespace

std::vector<std::uint8_t> all_nodes() {
  std::vector<std::uint8_t> nodes(wire::kLastNode);
  std::iota(nodes.begin(), nodes.end(), wire::kFirstNode);
  return nodes;
}

std::string to_dbc(const std::vector<std::uint8_t>& nodes) {
  const std::vector<Entry> entries = entries_for(nodes);
  std::string text = "VERSION \"pinjaw bus " + std::to_string(wire::kProtocolVersion) + "\"\n\n" +
                     kNewSymbols + "\nBS_:\n\nBU_: " + joined(everyone(nodes), " ") + "\n\n";
  for (const Entry& entry : entries) {
    text += "BO_ " + std::to_string(entry.id) + ' ' + entry.name + ": 8 " + entry.sender + '\n';
    for (const FieldSpec& field : entry.spec->fields) text += signal(field, entry);
    text += '\n';
  }
  for (const Entry& entry : entries) text += comments(entry);
  text += '\n' + attributes(entries) + '\n';
  for (const Entry& entry : entries) text += value_names(entry);
  return text;
}

}  // namespace pinjaw::describe
