#include "firmware_sim/target/firmware.hpp"

#include <cstddef>
#include <span>

#include "firmware_sim/target/board.hpp"

namespace pinjaw::firmware {

void boot(core::State& fresh, core::NvmImage& memory) {
  board::start();
  board::read_memory(memory);
  core::power_on(board::config(), memory, fresh);
}

void turn(core::State& state, Work& work) {
  const std::uint32_t elapsed_ms = board::wait_for_tick();
  core::Outputs& outputs = work.outputs;
  std::size_t count = 0;
  while (count < work.received.size() && board::receive(work.received[count])) ++count;
  core::Inputs& inputs = work.inputs;
  inputs.elapsed_ms = elapsed_ms;
  inputs.received = std::span<const wire::Frame>(work.received).first(count);
  inputs.sensors = board::sensors();
  inputs.nvm = board::memory_status();
  inputs.bus = board::bus_health();
  core::step(state, inputs, outputs);
  board::set_valves(outputs.valves);
  if (outputs.nvm) board::store(*outputs.nvm);
  for (const wire::Frame& frame : outputs.send.view()) board::send(frame);
  if (outputs.restart_bus) board::restart_bus();
  board::stepped(state);
}

}  // namespace pinjaw::firmware
