#pragma once

#include <cstdint>

#include "firmware_sim/core/core.hpp"
#include "protocol/wire/frame.hpp"

/// The hardware as the firmware sees it. A port defines these functions for its board; nothing here is a
/// class, for there is one board. All are called from the main loop, never from an interrupt.
namespace pinjaw::board {

/// Clocks, pins, the CAN controller at 500 kbit/s, a tick each millisecond. The valves stay de-energised.
void start();

/// What this controller's hardware is: constants, or DIP switches read by start().
const core::Config& config();

/// What non-volatile memory holds, read once after start(); every member of `image` is set.
void read_memory(core::NvmImage& image);

/// Sleeps until the next tick; gives the milliseconds since the last call, at least 1.
std::uint32_t wait_for_tick();

core::Sensors sensors();

/// The next frame that was received, in order of arrival; false where there is none.
bool receive(wire::Frame& frame);
core::BusHealth bus_health();

/// Carries the valves out at once.
void set_valves(const core::Valves& valves);

/// Begins to store; a request that comes while one is under way waits for it. `write` is gone after the call.
void store(const core::NvmWrite& write);
core::NvmStatus memory_status();

/// Queues a frame; frames of one id keep their order. What has no room is dropped and is the port's to count.
void send(const wire::Frame& frame);
/// Lets the CAN controller recover from bus-off.
void restart_bus();

/// The step is done: feeds the watchdog.
void stepped(const core::State& state);

}  // namespace pinjaw::board
