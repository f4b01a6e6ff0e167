#include "tests/firmware_sim/model_check/words.hpp"

#include <span>

#include "protocol/wire/names.hpp"
#include "tests/firmware_sim/model_check/layouts.hpp"

namespace pinjaw::core::model {
namespace {

std::string name_in(std::span<const wire::ValueName> names, std::uint32_t value) {
  for (const wire::ValueName& name : names) {
    if (name.value == value) return name.name;
  }
  return "?";
}

}  // namespace

std::string station(std::uint8_t node) {
  switch (node) {
    case kArm:
      return "arm";
    case kPedestal:
      return "pedestal";
    case kPallet:
      return "pallet";
    case wire::kOperatorPeer:
      return "operator";
    default:
      return "node " + std::to_string(node);
  }
}

std::string fact_name(wire::Fact fact) {
  return name_in(wire::kFactNames, static_cast<std::uint32_t>(fact));
}
std::string state_name(wire::State state) {
  return name_in(wire::kStateNames, static_cast<std::uint32_t>(state));
}
std::string op_name(wire::Op op) {
  return name_in(wire::kOpNames, static_cast<std::uint32_t>(op));
}

std::string custody_name(Custody custody) {
  switch (custody) {
    case Custody::Empty:
      return "empty";
    case Custody::Sole:
      return "sole";
    case Custody::Offered:
      return "offered";
    case Custody::Latched:
      return "latched";
    case Custody::Decided:
      return "decided";
    case Custody::Released:
      return "released";
    case Custody::Retained:
      return "retained";
  }
  return "?";
}

std::string grip_name(Grip grip) {
  switch (grip) {
    case Grip::Open:
      return "open";
    case Grip::Light:
      return "light";
    case Grip::Full:
      return "full";
  }
  return "?";
}

}  // namespace pinjaw::core::model
