#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// The message table in the formats that other tools and people read. Everything here is written from the
/// table.
namespace pinjaw::describe {

/// Every node that the protocol knows: 1 to 14.
std::vector<std::uint8_t> all_nodes();

/// A DBC file for a bus with a host and these nodes: names, senders, receivers, units, ranges, value names,
/// comments and cycle times. Precondition: nodes 1..14, ascending.
std::string to_dbc(const std::vector<std::uint8_t>& nodes);

/// The catalogue as markdown tables: the generated part of docs/bus.md.
std::string to_markdown();

/// The catalogue as JSON (format pinjaw-bus/1).
std::string to_json();

}  // namespace pinjaw::describe
