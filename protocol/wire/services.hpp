#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "protocol/wire/spec.hpp"

/// What travels in ISO-TP: a request {service, transaction, ...}, a response {service | 0x40, transaction,
/// status, ...}.
namespace pinjaw::wire {

enum class Service : std::uint8_t {
  Write = 0x21,
  Commit = 0x22,
  Readback = 0x23,
  Identify = 0x24,
  Log = 0x25
};

inline constexpr std::uint8_t kResponseBit = 0x40;
inline constexpr std::size_t kRequestHeader = 2;
inline constexpr std::size_t kResponseHeader = 3;

/// How a request ended.
enum class TransferStatus : std::uint8_t {
  Ok,
  UnknownService,
  Length,      ///< the record is shorter or longer than it says
  WrongState,  ///< COMMIT outside UNCONF and LOADED, or WRITE while a part is held
  Magic,
  Schema,
  NodeClass,
  Kit,  ///< made for another kit
  PinCount,
  Pin,  ///< a pin's jaw, kind, hole or length means nothing
  DuplicateHole,
  JawWithoutPins,
  Separation,         ///< open <= contact + tolerance, or over 204 mm
  LightForce,         ///< F_light >= F_req
  ForceWindow,        ///< F_req + 2u > F_limit: no force is surely enough and surely within the limit
  ForceOverHardware,  ///< F_limit over the hardware's
  Timing,             ///< t_stable or slip tolerance 0
  PassiveFields,      ///< a passive station with two jaws or with forces
  LayoutChecksum,
  Peers,  ///< a peer's node means nothing or comes twice, or names this node
  PeersChecksum,
  PairChecksum,
  NothingStaged,  ///< COMMIT or READBACK without a layout
  CommitDiffers,  ///< COMMIT of another checksum than the staged one's
  Memory,         ///< the layout could not be stored
};
inline constexpr std::size_t kTransferStatusCount = 25;

inline constexpr ValueName kTransferStatusNames[] = {{0, "OK"},
                                                     {1, "UNKNOWN_SERVICE"},
                                                     {2, "LENGTH"},
                                                     {3, "WRONG_STATE"},
                                                     {4, "MAGIC"},
                                                     {5, "SCHEMA"},
                                                     {6, "NODE_CLASS"},
                                                     {7, "KIT"},
                                                     {8, "PIN_COUNT"},
                                                     {9, "PIN"},
                                                     {10, "DUPLICATE_HOLE"},
                                                     {11, "JAW_WITHOUT_PINS"},
                                                     {12, "SEPARATION"},
                                                     {13, "LIGHT_FORCE"},
                                                     {14, "FORCE_WINDOW"},
                                                     {15, "FORCE_OVER_HARDWARE"},
                                                     {16, "TIMING"},
                                                     {17, "PASSIVE_FIELDS"},
                                                     {18, "LAYOUT_CHECKSUM"},
                                                     {19, "PEERS"},
                                                     {20, "PEERS_CHECKSUM"},
                                                     {21, "PAIR_CHECKSUM"},
                                                     {22, "NOTHING_STAGED"},
                                                     {23, "COMMIT_DIFFERS"},
                                                     {24, "MEMORY"}};

constexpr const char* to_string(TransferStatus status) {
  for (const ValueName& entry : kTransferStatusNames) {
    if (entry.value == static_cast<std::uint32_t>(status)) return entry.name;
  }
  return "?";
}

/// Refused because a force would exceed a limit, which a caller tells apart from other refusals.
constexpr bool is_force_refusal(TransferStatus status) {
  return status == TransferStatus::ForceWindow || status == TransferStatus::ForceOverHardware ||
         status == TransferStatus::LightForce;
}

}  // namespace pinjaw::wire
