#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "protocol/wire/dispatch.hpp"

/// What our codec reads in a frame, signal by signal, to be compared with what another reader of the DBC
/// does.
namespace pinjaw::wire::testing {

/// A decoded frame: raw numbers and physical values by signal.
struct Decoded {
  std::string message;
  std::map<std::string, std::uint64_t> raw{};
  std::map<std::string, double> physical{};

  void put(const FieldSpec& field, std::uint64_t number) {
    raw[field.name] = number;
    physical[field.name] = static_cast<double>(number) * field.factor.numerator / field.factor.denominator;
  }
};

/// A visitor of dispatch(): what our codec reads, by way of the typed message.
struct Collect {
  const Frame& frame;
  Decoded decoded{};

  template <class T>
  void operator()(const FieldSpec& field, const T& member) {
    decoded.put(field, detail::to_raw(field, member));
  }
  template <class Message>
  void operator()(const Received<Message>& received) {
    begin(Message::kType, received.label.node);
    decoded.put(kCrcField, frame.data[0]);
    if (spec_of(Message::kType).protection == Protection::Counter) {
      decoded.put(kCounterField, received.label.counter);
      decoded.put(kVersionField, kProtocolVersion);
    }
    Message::fields(received.message, *this);
  }
  void operator()(const Segment& segment) {
    begin(segment.identifier.type, segment.identifier.node);
    decoded.put(kTransferFields[0], segment.data[0] & 0xFU);
    decoded.put(kTransferFields[1], segment.data[0] >> 4);
    for (std::size_t i = 1; i < 8; ++i) decoded.put(kTransferFields[i + 1], segment.data.at(i));
  }
  void begin(MessageType type, std::uint8_t node) {
    decoded.message = spec_of(type).name;
    if (spec_of(type).per_node) decoded.message += '_' + std::to_string(node);
  }
};

}  // namespace pinjaw::wire::testing
