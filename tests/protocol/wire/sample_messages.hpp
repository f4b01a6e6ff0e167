#pragma once

#include <cstdint>
#include <random>

#include "protocol/wire/codec.hpp"

/// Every message of the catalogue with random legal content, for tests.
namespace pinjaw::wire::testing {

using Engine = std::mt19937_64;

inline std::uint64_t below(Engine& engine, std::uint64_t limit) {
  return limit == 0 ? engine() : engine() % limit;
}

/// Fills each member with a legal random value of its row.
struct Randomize {
  Engine& engine;

  template <class T>
  void operator()(const FieldSpec& field, T& member) {
    if (field.presence == Presence::Selector) return;
    std::uint64_t raw = below(engine, field.largest() + 1);
    if (!field.values.empty()) raw = field.values[below(engine, field.values.size())].value;
    if (field.all_ones_is_unknown && below(engine, 4) == 0) raw = ones(field.length);
    member = detail::from_raw<T>(field, raw);
  }
};

template <class Message>
Message random_message(Engine& engine) {
  Message message;
  if constexpr (Message::kType == MessageType::Identity) {
    message.page = static_cast<IdentityPage>(below(engine, 5));
  }
  Randomize randomize{engine};
  Message::fields(message, randomize);
  return message;
}

template <class Message>
Label random_label(Engine& engine) {
  constexpr const MessageSpec& kSpec = spec_of(Message::kType);
  Label label;
  if (kSpec.per_node) label.node = static_cast<std::uint8_t>(1 + below(engine, 14));
  if (kSpec.protection == Protection::Counter) label.counter = static_cast<std::uint8_t>(below(engine, 15));
  return label;
}

}  // namespace pinjaw::wire::testing
