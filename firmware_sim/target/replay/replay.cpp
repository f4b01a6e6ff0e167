// A port whose hardware is a trace: sensors, frames and memory come from a file on the computer that runs the
// emulator, what the firmware does goes to another (Arm's semihosting). Power-on in the trace restarts the
// image.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "firmware_sim/target/board.hpp"
#include "firmware_sim/target/trace.hpp"

extern "C" {
[[noreturn]] void reset_handler();
extern std::uint32_t image_stack_top;
}

namespace pinjaw::board {
namespace {

namespace semihosting {
enum : std::uint32_t { Open = 1, Write0 = 4, Write = 5, Read = 6, Exit = 0x18 };
constexpr std::uint32_t kReadBinary = 1;
constexpr std::uint32_t kWriteBinary = 5;
constexpr std::uint32_t kApplicationExit = 0x20026;
constexpr std::uint32_t kInternalError = 0x20024;

std::uint32_t call(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

template <std::size_t kSize>
std::uint32_t open(const char (&name)[kSize], std::uint32_t mode) {
  const std::uintptr_t block[] = {reinterpret_cast<std::uintptr_t>(name), mode, kSize - 1};
  return call(Open, block);
}

/// Both give the number of bytes that were not transferred.
std::uint32_t transfer(std::uint32_t operation, std::uint32_t file, std::span<std::uint8_t> bytes) {
  const std::uintptr_t block[] = {file, reinterpret_cast<std::uintptr_t>(bytes.data()), bytes.size()};
  return call(operation, block);
}

[[noreturn]] void exit(std::uint32_t reason) {
  for (;;) call(Exit, reinterpret_cast<const void*>(static_cast<std::uintptr_t>(reason)));
}
}  // namespace semihosting

/// The processor's own clock, for the count of instructions.
struct SysTick {
  std::uint32_t control;
  std::uint32_t reload;
  std::uint32_t value;
};
volatile SysTick& systick() {
  return *reinterpret_cast<volatile SysTick*>(0xE000E010);
}
constexpr std::uint32_t kMost = 0xFFFFFF;

constexpr std::uint32_t kStarted = 0x50A11ED;
constexpr std::size_t kBuffer = 2048;

/// All that outlives a restart of the image; zero when the emulator starts.
struct Player {
  std::uint32_t started;
  std::uint32_t file_in;
  std::uint32_t file_out;
  std::array<std::uint8_t, kBuffer> in;
  std::size_t in_next;
  std::size_t in_end;
  std::array<std::uint8_t, kBuffer> out;
  std::size_t out_end;
  std::uint32_t steps;
  std::uint32_t most_ticks;
  std::uint64_t ticks;
  core::Config config;
  core::Inputs inputs;
  std::size_t frames_left;
  trace::StateMask mask;
  std::uint32_t step_began;
};

[[gnu::section(".harness")]] Player player;

[[noreturn]] void give_up(const char* why) {
  semihosting::call(semihosting::Write0, why);
  semihosting::exit(semihosting::kInternalError);
}

std::uint8_t take_byte() {
  if (player.in_next == player.in_end) {
    player.in_end = kBuffer - semihosting::transfer(semihosting::Read, player.file_in, player.in);
    player.in_next = 0;
    if (player.in_end == 0) give_up("the trace ends in the middle\n");
  }
  return player.in[player.in_next++];
}

void take(std::span<std::uint8_t> bytes) {
  for (std::uint8_t& byte : bytes) byte = take_byte();
}

void flush() {
  const std::span<std::uint8_t> filled = std::span(player.out).first(player.out_end);
  if (semihosting::transfer(semihosting::Write, player.file_out, filled) != 0) give_up("cannot write\n");
  player.out_end = 0;
}

/// The end of the file of outputs.
struct Out {
  void put(std::span<const std::uint8_t> bytes) const {
    for (const std::uint8_t byte : bytes) {
      if (player.out_end == kBuffer) flush();
      player.out[player.out_end++] = byte;
    }
  }
};

/// "name number\n"
void tell(const char* name, std::uint64_t number) {
  std::array<char, 24> digits{};
  std::size_t at = digits.size() - 1;
  digits[--at] = '\n';
  do {
    digits[--at] = static_cast<char>('0' + number % 10);
    number /= 10;
  } while (number != 0);
  semihosting::call(semihosting::Write0, name);
  semihosting::call(semihosting::Write0, &digits[at]);
}

[[noreturn]] void finish() {
  flush();
  tell("steps ", player.steps);
  tell("ticks ", player.ticks);
  tell("most_ticks ", player.most_ticks);
  semihosting::exit(semihosting::kApplicationExit);
}

/// Where the image begins again, as after a power cut: all memory but the player's is made anew.
[[noreturn]] void restart() {
  asm volatile("msr msp, %0\n bx %1" : : "r"(&image_stack_top), "r"(&reset_handler));
  __builtin_unreachable();
}

}  // namespace

void start() {
  if (player.started == kStarted) return;

  player.started = kStarted;
  player.file_in = semihosting::open("trace.in", semihosting::kReadBinary);
  player.file_out = semihosting::open("trace.out", semihosting::kWriteBinary);
  systick().reload = kMost;
  systick().value = 0;
  systick().control = 5;  // processor's clock, no interrupt
  std::uint16_t size = 0;
  take(trace::bytes_of(size));
  if (size != player.mask.size()) give_up("the trace is of another state\n");
  take(player.mask);
  if (take_byte() != trace::kPowerOn) give_up("the trace does not begin with power\n");
}

const core::Config& config() {
  return player.config;
}

void read_memory(core::NvmImage& image) {
  player.config = {};
  take(trace::bytes_of(player.config).first(trace::kConfigBytes));
  image = {};
  if (take_byte() != 0) take(trace::bytes_of(image.record.emplace()));
  image.readable = take_byte() != 0;
  image.reset = static_cast<wire::ResetCause>(take_byte());
  take(trace::bytes_of(image.layout.size));
  take(std::span(image.layout.bytes).first(image.layout.size));
}

std::uint32_t wait_for_tick() {
  const std::uint8_t kind = take_byte();
  if (kind == trace::kEnd) finish();
  if (kind == trace::kPowerOn) restart();
  if (kind != trace::kStep) give_up("the trace has an unknown record\n");
  take(trace::bytes_of(player.inputs.elapsed_ms));
  take(trace::tail_of(player.inputs));
  player.frames_left = take_byte();
  return player.inputs.elapsed_ms;
}

core::Sensors sensors() {
  return player.inputs.sensors;
}
core::NvmStatus memory_status() {
  return player.inputs.nvm;
}
core::BusHealth bus_health() {
  player.step_began = systick().value;  // the last that is asked for before the step
  return player.inputs.bus;
}

bool receive(wire::Frame& frame) {
  if (player.frames_left == 0) return false;
  --player.frames_left;
  take(trace::bytes_of(frame.id));
  frame.kind = static_cast<wire::FrameKind>(take_byte());
  frame.extended = take_byte() != 0;
  frame.length = take_byte();
  take(frame.data);
  return true;
}

void set_valves(const core::Valves& valves) {
  const std::uint32_t ticks = (player.step_began - systick().value) & kMost;
  player.ticks += ticks;
  player.most_ticks = std::max(player.most_ticks, ticks);
  ++player.steps;
  if (player.frames_left != 0) give_up("more frames in a step than the firmware takes\n");
  Out out;
  trace::Writer<Out>{out}.valves(valves);
}

void store(const core::NvmWrite& write) {
  Out out;
  trace::Writer<Out>{out}.byte('N');
  trace::Writer<Out>{out}.write(write);
}

void send(const wire::Frame& frame) {
  Out out;
  trace::Writer<Out>{out}.byte('F');
  trace::Writer<Out>{out}.frame(frame);
}

void restart_bus() {
  Out out;
  trace::Writer<Out>{out}.byte('B');
}

void stepped(const core::State& state) {
  Out out;
  trace::Writer<Out>{out}.byte('.');
  trace::Writer<Out>{out}.raw(trace::digest_of(state, player.mask));
}

}  // namespace pinjaw::board
