#include "tests/firmware_sim/model_check/local.hpp"

namespace pinjaw::core::model {
namespace {

struct Packer {
  static constexpr bool kUnpacks = false;
  Packed bytes;
  template <class T>
  void operator()(const T& member) {
    static_assert(std::is_integral_v<T> || std::is_enum_v<T>);
    char raw[sizeof(T)];
    std::memcpy(raw, &member, sizeof(T));
    bytes.append(raw, sizeof(T));
  }
};

struct Unpacker {
  static constexpr bool kUnpacks = true;
  const Packed& bytes;
  std::size_t at = 0;
  template <class T>
  void operator()(T& member) {
    std::memcpy(&member, bytes.data() + at, sizeof(T));
    at += sizeof(T);
  }
};

}  // namespace

std::uint32_t held_faults(const Faults& faults) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < wire::kFaultCodes.size(); ++i) {
    const wire::FaultCode code = wire::kFaultCodes[i];
    if (faults.active(code) && severity_of(code) >= wire::Severity::Hold) bits |= std::uint32_t{1} << i;
  }
  return bits;
}

Faults with_held_faults(std::uint32_t bits) {
  Faults faults;
  for (std::size_t i = 0; i < wire::kFaultCodes.size(); ++i) {
    if (((bits >> i) & 1U) != 0) faults.raise(wire::kFaultCodes[i]);
  }
  return faults;
}

Packed pack(Local& local) {
  Packer packer;
  packer.bytes.reserve(256);
  visit_local(local, packer);
  return packer.bytes;
}

Local unpack(const Packed& packed, const Local& base) {
  Local local = base;
  Unpacker unpacker{packed};
  visit_local(local, unpacker);
  return local;
}

}  // namespace pinjaw::core::model
