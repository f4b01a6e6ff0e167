// A port to QEMU's Arm board `virt` (highmem=off, Cortex-A15) with a Kvaser PCI CAN card, whose jaws are
// simulated elsewhere and reached over the board's serial port (sensor_link.hpp). Polled; interrupts only end
// a WFI.
#include "firmware_sim/target/board.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware_sim/target/sensor_link.hpp"
#include "firmware_sim/target/virt/sja1000.hpp"

#ifndef PINJAW_BOARD_NODE
#error "the build says which node the board is and which kit it works with"
#endif

namespace pinjaw::board {
namespace {

// Addresses and interrupts: QEMU, hw/arm/virt.c, base_memmap and a15irqmap. Those count from the GIC's first
// shared interrupt, 32; the virtual timer is the processor's private interrupt 27 (Cortex-A15 TRM).
constexpr std::uintptr_t kGicDistributor = 0x08000000;
constexpr std::uintptr_t kGicProcessor = 0x08010000;
constexpr std::uintptr_t kUart = 0x09000000;
constexpr std::uintptr_t kPciPorts = 0x3EFF0000;
constexpr std::uintptr_t kPciConfiguration = 0x3F000000;
constexpr std::uint32_t kKvaserPciCan = 0x840610E8;  // device and vendor: QEMU, hw/net/can/can_kvaser_pci.c
constexpr std::uint32_t kTick_ms = 1;
constexpr std::uint32_t kTimerInterrupt = 27;  // virtual timer
constexpr std::uint32_t kUartInterrupt = 33;
constexpr std::uint32_t kFirstPciInterrupt = 35;  // INTA to INTD

volatile std::uint32_t& word(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
volatile std::uint16_t& half(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint16_t*>(address);
}

std::uint64_t now_ticks() {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  asm volatile("mrrc p15, 1, %0, %1, c14" : "=r"(low), "=r"(high));
  return std::uint64_t{high} << 32 | low;
}
std::uint32_t ticks_per_second() {
  std::uint32_t ticks = 0;
  asm volatile("mrc p15, 0, %0, c14, c0, 0" : "=r"(ticks));
  return ticks;
}
void wake_at(std::uint64_t ticks) {
  asm volatile("mcrr p15, 3, %0, %1, c14"
               :
               : "r"(static_cast<std::uint32_t>(ticks)), "r"(static_cast<std::uint32_t>(ticks >> 32)));
  asm volatile("mcr p15, 0, %0, c14, c3, 1" : : "r"(1));
}

/// Of a device, to this processor: GICD_ISENABLER and GICD_ITARGETSR (GICv2, Arm IHI 0048B, table 4-1).
void enable(std::uint32_t interrupt) {
  word(kGicDistributor + 0x100 + interrupt / 32 * 4) = 1U << interrupt % 32;
  *reinterpret_cast<volatile std::uint8_t*>(kGicDistributor + 0x800 + interrupt) = 1;
}

void start_interrupts() {
  word(kGicDistributor) = 1;  // GICD_CTLR
  enable(kTimerInterrupt);
  enable(kUartInterrupt);
  for (std::uint32_t i = 0; i < 4; ++i) enable(kFirstPciInterrupt + i);
  word(kGicProcessor + 4) = 0xFF;  // GICC_PMR (table 4-2): any priority
  word(kGicProcessor) = 1;         // GICC_CTLR
}

template <class T, std::size_t kSize>
class Ring {
 public:
  bool push(const T& item) {
    if (count_ == kSize) return false;
    items_[(first_ + count_++) % kSize] = item;
    return true;
  }
  bool pop(T& item) {
    if (count_ == 0) return false;
    item = items_[first_];
    first_ = (first_ + 1) % kSize;
    --count_;
    return true;
  }

 private:
  std::array<T, kSize> items_{};
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

constexpr virt::Sja1000 kCan(kPciPorts + 0x1100);

/// Finds the card, gives it addresses and lets its interrupt through. Its three address ranges and the
/// bridge's register INTCSR (0x38, bit 13) are those of QEMU's can_kvaser_pci.c; the addresses given are
/// chosen.
bool start_card() {
  for (std::uintptr_t device = 0; device < 32; ++device) {
    const std::uintptr_t registers = kPciConfiguration + (device << 15);
    if (word(registers) != kKvaserPciCan) continue;
    word(registers + 0x10) = 0x1000;           // the bridge
    word(registers + 0x14) = 0x1100;           // the CAN controllers
    word(registers + 0x18) = 0x1200;           // the rest
    half(registers + 4) = 0x0001;              // answers to ports
    word(kPciPorts + 0x1000 + 0x38) = 0x2000;  // the bridge passes interrupts on
    return true;
  }
  return false;
}

struct Board {
  core::Config config;
  Ring<wire::Frame, 64> received;
  Ring<wire::Frame, 64> to_send;
  core::Sensors sensors;
  core::NvmStatus memory;
  std::uint32_t overruns = 0;
  std::uint32_t not_sent = 0;    ///< frames without room in `to_send`, for a debugger
  std::uint64_t tick = 0;        ///< when the last one was due
  std::uint64_t tick_ticks = 1;  ///< of kTick_ms
  link::PacketReader<link::kSensorsBytes> packets{link::kSensorsMark};
  std::uint8_t reading = 0;  ///< number of these sensors'
  bool sensed = false;       ///< a packet has come
  bool answered = false;     ///< the last one
  core::Valves told;         ///< to the valves, last
};

constinit Board the_board;

void serve_can() {
  while (kCan.has_frame()) {
    if (!the_board.received.push(kCan.take())) ++the_board.overruns;
  }
  if (kCan.overrun()) {
    kCan.clear_overrun();
    ++the_board.overruns;
  }
  wire::Frame frame;
  while (kCan.can_send() && the_board.to_send.pop(frame)) kCan.send(frame);
}

void serve_link() {
  while ((word(kUart + 0x18) & 0x10U) == 0) {  // UARTFR without RXFE: the receiver holds something
    const auto packet = the_board.packets.take(static_cast<std::uint8_t>(word(kUart)));
    if (!packet) continue;
    the_board.sensors = link::sensors_of(*packet);
    the_board.reading = link::number_of(*packet);
    the_board.sensed = true;
    the_board.answered = false;
  }
}

/// Until `ticks`, serving what comes.
void wait_until(std::uint64_t ticks) {
  wake_at(ticks);
  for (;;) {
    serve_can();
    serve_link();
    if (now_ticks() >= ticks) return;
    asm volatile("wfi");
  }
}

}  // namespace

void start() {
  the_board.config.node = PINJAW_BOARD_NODE;
  the_board.config.kit_id = PINJAW_BOARD_KIT;
  the_board.tick_ticks = std::uint64_t{ticks_per_second()} * kTick_ms / 1000;
  start_interrupts();
  // PL011 (Arm DDI 0183, table 3-1)
  word(kUart + 0x2C) = 0x70;   // UARTLCR_H: eight bits, FIFO
  word(kUart + 0x30) = 0x301;  // UARTCR: on
  word(kUart + 0x38) = 0x10;   // UARTIMSC: an interrupt for what comes: its FIFO holds half a packet
  while (!start_card()) {      // without its card a board has nothing to say
  }
  kCan.start();
  do {  // no decision before the first readings
    the_board.tick = now_ticks() + the_board.tick_ticks;
    wait_until(the_board.tick);
  } while (!the_board.sensed);
}

const core::Config& config() {
  return the_board.config;
}

/// This board's memory is as long-lived as its power: it begins with none stored.
void read_memory(core::NvmImage& image) {
  image = {};
}

std::uint32_t wait_for_tick() {
  std::uint32_t elapsed_ms = 0;
  do {
    the_board.tick += the_board.tick_ticks;
    elapsed_ms += kTick_ms;
  } while (now_ticks() >= the_board.tick + the_board.tick_ticks);
  wait_until(the_board.tick);
  return elapsed_ms;
}

core::Sensors sensors() {
  return the_board.sensors;
}

bool receive(wire::Frame& frame) {
  return the_board.received.pop(frame);
}

core::BusHealth bus_health() {
  return {.off = kCan.bus_off(), .passive = kCan.passive(), .overruns = the_board.overruns};
}

/// News, or an answer to readings.
void set_valves(const core::Valves& valves) {
  if (the_board.answered && valves == the_board.told) return;
  the_board.answered = true;
  the_board.told = valves;
  for (const std::uint8_t byte : link::pack(valves, the_board.reading)) {
    while ((word(kUart + 0x18) & 0x20U) != 0) {  // UARTFR with TXFF: the sender is full
    }
    word(kUart) = byte;
  }
}

void store(const core::NvmWrite& write) {
  the_board.memory.done = write.sequence;
}
core::NvmStatus memory_status() {
  return the_board.memory;
}

void send(const wire::Frame& frame) {
  if (!the_board.to_send.push(frame)) ++the_board.not_sent;
  serve_can();
}

void restart_bus() {
  kCan.restart();
}

void stepped(const core::State& /*state*/) {}

}  // namespace pinjaw::board
