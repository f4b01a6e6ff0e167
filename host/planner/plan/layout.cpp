#include "host/planner/plan/layout.hpp"

#include <fmt/format.h>

#include <cmath>

namespace pinjaw::planner {

namespace {

std::int64_t micro(double value) {
  return std::llround(value * 1e6);
}

template <class Whole>
Whole scaled(double value, double unit) {
  return static_cast<Whole>(std::llround(value / unit));
}

base::Expected<wire::LayoutPin> pin_of(const model::PinDesign& pin) {
  constexpr double kMostLengthMm = 655.35;
  if (pin.hole.column > 127 || pin.hole.row > 127)
    return base::failure("a layout holds holes up to 127, 127");
  if (pin.length_mm > kMostLengthMm) return base::failure("a layout holds pins up to 655 mm");
  return wire::LayoutPin{pin.hole.jaw == model::JawSide::Left ? wire::Jaw::Left : wire::Jaw::Right,
                         static_cast<std::int8_t>(pin.hole.column), static_cast<std::int8_t>(pin.hole.row),
                         scaled<std::uint16_t>(pin.length_mm, 0.01)};
}

base::Expected<void> sendable(const model::Kit& kit, const model::Design& design) {
  const double most_n = wire::kMaxForce_dn / 10.0;
  const double most_mm = wire::kMaxSeparation_10um / 100.0;
  if (kit.actuator.max_squeeze_n > most_n) {
    return base::failure(fmt::format("kit {} squeezes with {} N; the bus carries up to {} N", kit.name,
                                     kit.actuator.max_squeeze_n, most_n));
  }
  if (design.jaw_open_mm > most_mm) {
    return base::failure(
        fmt::format("the jaws open to {} mm; the bus carries up to {} mm", design.jaw_open_mm, most_mm));
  }
  if (design.pins.size() > wire::kMaxPins) return base::failure("a layout holds up to 16 pins");
  return {};
}

void set_forces(const LayoutSource& source, wire::Layout& layout) {
  layout.f_limit_dn = wire::limit_dn(micro(source.kit.actuator.max_squeeze_n));
  if (source.passive) return;
  layout.f_light_dn = wire::requirement_dn(micro(source.kit.grip.light_n));
  layout.f_required_dn = wire::layout_requirement_dn(
      wire::requirement_dn(micro(source.design.squeeze.required_n)), layout.f_light_dn);
}

}  // namespace

base::Expected<wire::Layout> layout_of(const LayoutSource& source) {
  const model::Kit& kit = source.kit;
  const model::Design& design = source.design;
  if (const auto ok = sendable(kit, design); !ok) return tl::unexpected(ok.error());

  wire::Layout layout;
  layout.node_class = source.passive ? wire::NodeClass::Passive : wire::NodeClass::Gripper;
  layout.passive = source.passive;
  layout.kit_id = wire::kit_id_of(std::span(kit.sha256));
  layout.part_id = wire::part_id_of(std::span(source.part_sha256));
  layout.grid_pitch_nm = scaled<std::uint32_t>(kit.grid.spacing_mm, 1e-6);
  layout.pin_diameter_nm = scaled<std::uint32_t>(2 * kit.pins.radius_mm, 1e-6);
  for (const model::PinDesign& pin : design.pins) {
    const auto encoded = pin_of(pin);
    if (!encoded) return tl::unexpected(encoded.error());
    layout.pins[layout.pin_count++] = *encoded;
  }
  layout.separation_open_10um = scaled<std::uint16_t>(design.jaw_open_mm, 0.01);
  layout.separation_contact_10um = scaled<std::uint16_t>(design.jaw_separation_mm, 0.01);
  layout.separation_tolerance_10um = scaled<std::uint16_t>(kit.grip.separation_tol_mm, 0.01);
  layout.slip_tolerance_um = scaled<std::uint16_t>(kit.grip.slip_tol_mm, 0.001);
  layout.stable_ms = scaled<std::uint16_t>(kit.grip.stable_ms, 1.0);
  set_forces(source, layout);
  return layout;
}

}  // namespace pinjaw::planner
