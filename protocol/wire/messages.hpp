#pragma once

#include <cstdint>
#include <optional>

#include "protocol/wire/codes.hpp"
#include "protocol/wire/table.hpp"

/// The messages as values. `fields` names each member's row of the table; the codec walks it both ways.
/// An empty optional is a quantity that the sender does not know. Forces are sums of both jaws.
namespace pinjaw::wire {

namespace detail {
void the_table_has_no_such_field();  // not constexpr, so that naming it stops the compiler

constexpr bool same_text(const char* a, const char* b) {
  while (*a != '\0' && *a == *b) ++a, ++b;
  return *a == *b;
}

/// The row called `name`, found by the compiler.
consteval const FieldSpec& row(MessageType type, const char* name) {
  for (const FieldSpec& field : spec_of(type).fields) {
    if (same_text(field.name, name)) return field;
  }
  the_table_has_no_such_field();
  return kCrcField;
}
}  // namespace detail

struct GlobalHold {
  static constexpr auto kType = MessageType::GlobalHold;
  Reason reason = Reason::None;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "REASON"), self.reason);
  }
  friend constexpr bool operator==(const GlobalHold&, const GlobalHold&) = default;
};

struct FaultReport {
  static constexpr auto kType = MessageType::Fault;
  FaultCode code = FaultCode::None;
  Severity severity = Severity::Info;
  bool active = false;
  State state = State::Boot;
  std::uint16_t argument = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "CODE"), self.code);
    visit(detail::row(kType, "SEV"), self.severity);
    visit(detail::row(kType, "ACTIVE"), self.active);
    visit(detail::row(kType, "STATE"), self.state);
    visit(detail::row(kType, "ARG"), self.argument);
  }
  friend constexpr bool operator==(const FaultReport&, const FaultReport&) = default;
};

struct Custody {
  static constexpr auto kType = MessageType::Custody;
  Fact fact = Fact::Unknown;
  std::uint8_t peer = 0;
  std::uint16_t token = 0;
  std::uint16_t pair = 0;
  std::optional<std::uint8_t> f_low_n{};

  /// How a handoff ended that is over; says nothing of now.
  [[nodiscard]] constexpr bool past() const {
    return !f_low_n && (fact == Fact::Released || fact == Fact::Retain);
  }
  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "FACT"), self.fact);
    visit(detail::row(kType, "PEER"), self.peer);
    visit(detail::row(kType, "TOKEN"), self.token);
    visit(detail::row(kType, "PAIR"), self.pair);
    visit(detail::row(kType, "F_LOW"), self.f_low_n);
  }
  friend constexpr bool operator==(const Custody&, const Custody&) = default;
};

struct NodeState {
  static constexpr auto kType = MessageType::State;
  State state = State::Boot;
  bool armed = false;
  bool layout_ok = false;
  bool host_alive = false;
  bool part = false;
  bool hold_stable = false;
  bool at_limit = false;
  bool manual_enable = false;
  bool degraded = false;
  Fact custody = Fact::Unknown;
  std::optional<std::uint16_t> f_low_dn{};         ///< 0.1 N
  std::optional<std::uint16_t> separation_50um{};  ///< 0.05 mm
  FaultCode fault = FaultCode::None;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "STATE"), self.state);
    visit(detail::row(kType, "ARMED"), self.armed);
    visit(detail::row(kType, "LAYOUT_OK"), self.layout_ok);
    visit(detail::row(kType, "HOST_ALIVE"), self.host_alive);
    visit(detail::row(kType, "PART"), self.part);
    visit(detail::row(kType, "HOLD_STABLE"), self.hold_stable);
    visit(detail::row(kType, "AT_LIMIT"), self.at_limit);
    visit(detail::row(kType, "MAN_ENABLE"), self.manual_enable);
    visit(detail::row(kType, "DEGRADED"), self.degraded);
    visit(detail::row(kType, "CUST"), self.custody);
    visit(detail::row(kType, "F_LOW"), self.f_low_dn);
    visit(detail::row(kType, "SEP"), self.separation_50um);
    visit(detail::row(kType, "FAULT"), self.fault);
  }
  friend constexpr bool operator==(const NodeState&, const NodeState&) = default;
};

struct Force {
  static constexpr auto kType = MessageType::Force;
  std::optional<std::uint16_t> f_high_dn{};
  std::optional<std::uint16_t> f_set_dn{};
  std::optional<std::uint16_t> f_limit_effective_dn{};
  std::optional<std::uint16_t> f_measured_dn{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "F_HIGH"), self.f_high_dn);
    visit(detail::row(kType, "F_SET"), self.f_set_dn);
    visit(detail::row(kType, "F_LIM_EFF"), self.f_limit_effective_dn);
    visit(detail::row(kType, "F_MEAS"), self.f_measured_dn);
  }
  friend constexpr bool operator==(const Force&, const Force&) = default;
};

struct HostHeartbeat {
  static constexpr auto kType = MessageType::HostHeartbeat;
  HostState state = HostState::Idle;
  std::uint16_t permit = 0;  ///< bit n-1: node n may move
  std::uint16_t epoch = 0;

  [[nodiscard]] constexpr bool permits(std::uint8_t node) const {
    return node >= kFirstNode && node <= kLastNode && ((permit >> (node - 1)) & 1U) != 0;
  }
  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "HSTATE"), self.state);
    visit(detail::row(kType, "PERMIT"), self.permit);
    visit(detail::row(kType, "EPOCH"), self.epoch);
  }
  friend constexpr bool operator==(const HostHeartbeat&, const HostHeartbeat&) = default;
};

struct HostTime {
  static constexpr auto kType = MessageType::Time;
  std::uint64_t time_us = 0;  ///< 48 bits

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "TIME"), self.time_us);
  }
  friend constexpr bool operator==(const HostTime&, const HostTime&) = default;
};

/// The functions of commands.hpp make them.
struct Command {
  static constexpr auto kType = MessageType::Command;
  std::uint8_t sequence = 0;
  Op op = Op::Hold;
  std::uint8_t argument = 0;  ///< 4 bits
  std::uint16_t session = 0;
  std::uint16_t a = 0;  ///< 12 bits
  std::uint16_t b = 0;  ///< 12 bits

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "SEQ"), self.sequence);
    visit(detail::row(kType, "OP"), self.op);
    visit(detail::row(kType, "ARG"), self.argument);
    visit(detail::row(kType, "SESSION"), self.session);
    visit(detail::row(kType, "A"), self.a);
    visit(detail::row(kType, "B"), self.b);
  }
  friend constexpr bool operator==(const Command&, const Command&) = default;
};

struct Acknowledge {
  static constexpr auto kType = MessageType::Acknowledge;
  std::uint8_t sequence = 0;
  Op op = Op::Hold;
  CommandResult result = CommandResult::Ok;
  std::uint16_t session = 0;
  Reason reason = Reason::None;
  State state = State::Boot;
  std::uint8_t next_sequence = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "SEQ_ECHO"), self.sequence);
    visit(detail::row(kType, "OP"), self.op);
    visit(detail::row(kType, "RESULT"), self.result);
    visit(detail::row(kType, "SESSION"), self.session);
    visit(detail::row(kType, "REASON"), self.reason);
    visit(detail::row(kType, "STATE"), self.state);
    visit(detail::row(kType, "NEXT_SEQ"), self.next_sequence);
  }
  friend constexpr bool operator==(const Acknowledge&, const Acknowledge&) = default;
};

struct Pneumatics {
  static constexpr auto kType = MessageType::Pneumatics;
  std::optional<std::uint16_t> close_2500ubar{};  ///< 2.5 mbar
  std::optional<std::uint16_t> open_2500ubar{};
  std::optional<std::uint16_t> supply_2500ubar{};
  std::uint8_t valves = 0;
  std::optional<std::uint8_t> temperature_degc{};

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "P_CLOSE"), self.close_2500ubar);
    visit(detail::row(kType, "P_OPEN"), self.open_2500ubar);
    visit(detail::row(kType, "P_SUPPLY"), self.supply_2500ubar);
    visit(detail::row(kType, "VALVES"), self.valves);
    visit(detail::row(kType, "TEMP"), self.temperature_degc);
  }
  friend constexpr bool operator==(const Pneumatics&, const Pneumatics&) = default;
};

struct LayoutStatus {
  static constexpr auto kType = MessageType::LayoutStatus;
  std::uint32_t layout_crc = 0;
  std::uint16_t kit_id = 0;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "LAYOUT_CRC"), self.layout_crc);
    visit(detail::row(kType, "KIT"), self.kit_id);
  }
  friend constexpr bool operator==(const LayoutStatus&, const LayoutStatus&) = default;
};

enum class IdentityPage : std::uint8_t { Product, Firmware, Image, Serial, Boot };

/// One page at a time; members of other pages stay as they are.
struct Identity {
  static constexpr auto kType = MessageType::Identity;
  IdentityPage page = IdentityPage::Product;
  std::uint16_t product = 0;
  std::uint8_t hardware = 0;
  std::uint8_t major = 0;
  std::uint8_t minor = 0;
  std::uint8_t patch = 0;
  bool dirty = false;
  std::uint32_t image_crc = 0;
  std::uint32_t serial = 0;
  std::uint16_t boots = 0;
  ResetCause reset = ResetCause::PowerOn;
  MemoryStatus memory = MemoryStatus::Good;

  template <class Self, class Visitor>
  static constexpr void fields(Self& self, Visitor& visit) {
    visit(detail::row(kType, "PAGE"), self.page);
    switch (self.page) {
      case IdentityPage::Product:
        visit(detail::row(kType, "PRODUCT"), self.product);
        visit(detail::row(kType, "HARDWARE"), self.hardware);
        break;
      case IdentityPage::Firmware:
        visit(detail::row(kType, "MAJOR"), self.major);
        visit(detail::row(kType, "MINOR"), self.minor);
        visit(detail::row(kType, "PATCH"), self.patch);
        visit(detail::row(kType, "DIRTY"), self.dirty);
        break;
      case IdentityPage::Image:
        visit(detail::row(kType, "IMAGE_CRC"), self.image_crc);
        break;
      case IdentityPage::Serial:
        visit(detail::row(kType, "SERIAL"), self.serial);
        break;
      case IdentityPage::Boot:
        visit(detail::row(kType, "BOOTS"), self.boots);
        visit(detail::row(kType, "RESET"), self.reset);
        visit(detail::row(kType, "MEMORY"), self.memory);
        break;
    }
  }
  friend constexpr bool operator==(const Identity&, const Identity&) = default;
};

}  // namespace pinjaw::wire
