#include "protocol/describe/fault_help.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <string>

#include "protocol/wire/names.hpp"

namespace pinjaw::describe {

namespace {

using wire::FaultCode;

constexpr std::array kHelps = {
    FaultHelp{FaultCode::SupplyVoltage, "the controller's supply voltage is out of range",
              "a weak or overloaded power supply, a loose connector",
              "measure the voltage at the controller; then pinjaw jaw clear", false},
    FaultHelp{FaultCode::PressureRange, "a pressure sensor reads what no chamber can have",
              "a broken sensor or its cable",
              "replace the sensor; support the part by hand before power is cut"},
    FaultHelp{FaultCode::SensorsDisagree,
              "the two pressure sensors of a chamber differ by more than their errors",
              "a drifting sensor, or a blocked line to one of them",
              "compare both with a gauge and replace the wrong one"},
    FaultHelp{FaultCode::ValveStuck, "the jaws did not open in the time their travel takes",
              "a stuck valve, a kinked hose, or pins that bind on the part",
              "free the jaws, try the valve by hand, then pinjaw jaw clear and arm again"},
    FaultHelp{FaultCode::Position, "the jaw separation reads what the jaws cannot have",
              "a broken position sensor or its cable",
              "check the sensor; the controller holds by force meanwhile"},
    FaultHelp{
        FaultCode::Watchdog, "the controller's program stopped and was started again",
        "a defect of hardware or firmware",
        "note what was going on; the custody record was restored: pinjaw jaw status, then pinjaw jaw clear"},
    FaultHelp{FaultCode::MemorySelfTest,
              "the controller's memory failed its test, or its two channels differ on whether to let go",
              "a defective controller; it holds", "support the part, replace the controller"},
    FaultHelp{
        FaultCode::CustodyMemory, "the record of who holds the part could not be stored or read",
        "worn or defective non-volatile memory",
        "support the part; pinjaw jaw clear tries the store again, and with the local enable on takes a part "
        "without a record as this node's own; pinjaw jaw abort opens where the giver still has it; replace "
        "the "
        "controller if neither helps"},
    FaultHelp{FaultCode::LayoutRefused, "a layout that was sent does not fit this controller",
              "its force is over the limit, its kit is another, or its numbers disagree",
              "plan again with this controller's kit file; pinjaw send tells which number it was"},
    FaultHelp{FaultCode::SupplyAirLow, "the supply air is too weak to build up force",
              "the compressor is off, a filter is clogged, or neighbours draw too much",
              "restore the supply; a held part stays held by the check valve and the spring"},
    FaultHelp{FaultCode::Leak, "a closed chamber loses pressure too fast", "a worn seal, a cracked hose",
              "find the leak before the next part; the controller refills within its limit"},
    FaultHelp{FaultCode::OverForce, "the squeeze rose above the limit in force",
              "a stuck pressure regulator, or a part thicker than planned",
              "the controller fell back to the light squeeze; look for the cause, then pinjaw jaw clear"},
    FaultHelp{FaultCode::HoldLost, "the squeeze fell below what the part needs",
              "a leak, too little supply air, or the part moved in the pins",
              "support the part; restore the air; the controller raises the force up to its limit meanwhile"},
    FaultHelp{FaultCode::Slip, "the jaws moved while they held the part",
              "the part slips: loads above the plan's, oil on the pins, or a wrong part",
              "support the part; compare the loads with the task's disturbances, plan with a lower friction"},
    FaultHelp{FaultCode::NoPart, "the jaws closed further than the part allows",
              "no part was there, or it is the wrong one",
              "place the part; pinjaw jaw clear, then try again"},
    FaultHelp{FaultCode::MisSeated, "the jaws stopped before they reached the part's planned separation",
              "the part does not seat: a chip, a burr, a pin in a wrong hole",
              "take the part out, clean it, compare the pins with pinjaw sheet, then pinjaw jaw clear"},
    FaultHelp{FaultCode::ReceiveOverrun, "frames came faster than the controller could take them",
              "a node floods the bus",
              "look at the load: candump and canbusload; take the talker off the bus"},
    FaultHelp{FaultCode::BusPassive, "the CAN controller is error passive: many frames fail",
              "a missing terminator, a wrong bit rate, a bad cable",
              "measure 60 ohm between CAN_H and CAN_L; check 500 kbit/s"},
    FaultHelp{FaultCode::HostLost, "the host's heartbeat stopped", "the host ended, or the bus is cut",
              "start the host again; whatever is held stays held"},
    FaultHelp{FaultCode::PeerLost, "the other side of a handoff fell silent",
              "its controller has no power, or the bus is cut",
              "restore it; both go on holding, then call the handoff off or let it finish"},
    FaultHelp{FaultCode::BusOffRecovered, "the controller was off the bus and came back",
              "errors as for BUS_PASSIVE", "check the cabling; nothing else is to be done"},
    FaultHelp{FaultCode::BusOff, "the controller is off the bus and stays off",
              "too many bus errors in too short a time",
              "repair the bus, then switch the controller off and on; a held part stays held"},
    FaultHelp{FaultCode::OwnIdSeen, "another node sends with this controller's number",
              "two controllers have the same node number", "give one of them another number"},
    FaultHelp{FaultCode::BadChecksum, "frames came with a wrong checksum",
              "a node that speaks another protocol, or a defect",
              "record the bus and look for the sender; such frames are never acted on", false},
    FaultHelp{FaultCode::BadSequence, "frames came repeated or out of order",
              "a replayed log, or a gateway that reorders",
              "take the replay or the gateway off; such frames are never acted on", false},
    FaultHelp{FaultCode::BadSession, "commands came for a session that is over",
              "the host kept on after a reset or another host's ARM", "arm again", false},
    FaultHelp{
        FaultCode::Authentication,
        "commands came with a wrong MAC; after three of them only HOLD is obeyed for a minute",
        "a host with another key or none, a replayed log, or somebody who tries to command the node",
        "give the host the cell's key (--key-file); if no host of yours did it, look who is on the bus"},
    FaultHelp{FaultCode::InDoubt, "the giver did not answer whether it let go, so both go on holding",
              "the giver's controller or its bus fell silent at that moment",
              "restore the giver; the handoff then settles by itself; never open by hand before it has"},
    FaultHelp{FaultCode::HandoffAborted, "a handoff was called off; the giver holds the part",
              "an abort, a lost host, a receiver that did not squeeze well", "try the handoff again"},
    FaultHelp{FaultCode::ManualRelease, "the part was released by hand",
              "somebody used the local enable and the release", "nothing, where that was meant"}};

static_assert(kHelps.size() + 1 == wire::kFaultCodes.size());
static_assert([] {
  for (std::size_t i = 0; i < kHelps.size(); ++i) {
    if (kHelps[i].code != wire::kFaultCodes[i + 1]) return false;
  }
  return true;
}());

std::optional<std::uint16_t> hexadecimal(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) text.remove_prefix(2);
  std::uint16_t value = 0;
  constexpr int kBase = 16;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, kBase);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::span<const FaultHelp> fault_helps() {
  return kHelps;
}

std::optional<FaultHelp> find_fault(std::string_view name_or_number) {
  std::string name(name_or_number);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return c == '-' ? '_' : std::toupper(c); });
  const auto number = hexadecimal(name_or_number);
  for (const FaultHelp& help : kHelps) {
    if (name == wire::to_string(help.code) || number == static_cast<std::uint16_t>(help.code)) return help;
  }
  return std::nullopt;
}

}  // namespace pinjaw::describe
