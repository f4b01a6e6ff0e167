#include "firmware_sim/target/firmware.hpp"

#include <cstddef>
#include <span>

#include "firmware_sim/target/board.hpp"

namespace pinjaw::firmware {

void boot(Firmware& fresh) {
  board::start();
  board::read_memory(fresh.memory);
  core::power_on(board::config(), fresh.memory, fresh.state);
}

void turn(Firmware& firmware) {
  const std::uint32_t elapsed_ms = board::wait_for_tick();
  std::size_t count = 0;
  while (count < firmware.received.size() && board::receive(firmware.received[count])) ++count;
  const core::Inputs inputs{.elapsed_ms = elapsed_ms,
                            .received = std::span<const wire::Frame>(firmware.received).first(count),
                            .sensors = board::sensors(),
                            .nvm = board::memory_status(),
                            .bus = board::bus_health()};
  core::step(firmware.state, inputs, firmware.outputs);
  board::set_valves(firmware.outputs.valves);
  if (firmware.outputs.nvm) board::store(*firmware.outputs.nvm);
  for (const wire::Frame& frame : firmware.outputs.send.view()) board::send(frame);
  if (firmware.outputs.restart_bus) board::restart_bus();
  board::stepped(firmware.state);
}

}  // namespace pinjaw::firmware
