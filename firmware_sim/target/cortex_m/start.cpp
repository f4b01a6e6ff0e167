// Reset and vector table of any Cortex-M. Symbols of memory come from image.ld.
#include <cstddef>
#include <cstdint>

extern "C" {
[[noreturn]] void firmware_main();

extern std::uint32_t image_stack_top;
extern std::uint32_t image_data_begin;
extern std::uint32_t image_data_end;
extern const std::uint32_t image_data_load;
extern std::uint32_t image_bss_begin;
extern std::uint32_t image_bss_end;

/// Static objects become what they are by default; none has a constructor to run (image.ld asserts it).
[[noreturn]] void reset_handler() {
  const std::uint32_t* from = &image_data_load;
  for (std::uint32_t* to = &image_data_begin; to < &image_data_end;) *to++ = *from++;
  for (std::uint32_t* to = &image_bss_begin; to < &image_bss_end;) *to++ = 0;
  firmware_main();
}

/// Nothing here may interrupt, so whatever comes is a fault: stand still with the valves as they are, and the
/// watchdog's reset de-energises them.
[[noreturn]] void fault_handler() {
  for (;;) {
  }
}

[[gnu::section(".vectors"), gnu::used]] extern const std::uintptr_t vectors[16] = {
    reinterpret_cast<std::uintptr_t>(&image_stack_top), reinterpret_cast<std::uintptr_t>(&reset_handler),
    reinterpret_cast<std::uintptr_t>(&fault_handler),  // NMI
    reinterpret_cast<std::uintptr_t>(&fault_handler),  // hard fault
    reinterpret_cast<std::uintptr_t>(&fault_handler),   reinterpret_cast<std::uintptr_t>(&fault_handler),
    reinterpret_cast<std::uintptr_t>(&fault_handler),
};
}

// What the compiler calls by itself, small instead of fast: the C library's take 700 B.
extern "C" {
void* memset(void* to, int value, std::size_t size) {
  auto* bytes = static_cast<unsigned char*>(to);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(value);
  return to;
}

void* memmove(void* to, const void* from, std::size_t size) {
  auto* out = static_cast<unsigned char*>(to);
  const auto* in = static_cast<const unsigned char*>(from);
  if (out <= in) {
    for (std::size_t i = 0; i < size; ++i) out[i] = in[i];
  } else {
    while (size-- > 0) out[size] = in[size];
  }
  return to;
}

void* memcpy(void* to, const void* from, std::size_t size) {
  return memmove(to, from, size);
}
}
