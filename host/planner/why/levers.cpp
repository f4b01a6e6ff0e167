#include "host/planner/why/levers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace pinjaw::planner {
namespace {

/// Usual grids and pins, metric and inch.
constexpr std::array kSpacings_mm{5.0,  6.0,  6.35,   8.0,  9.525, 10.0, 11.1125, 12.0,
                                  12.7, 15.0, 15.875, 16.0, 19.05, 20.0, 25.0,    25.4};
constexpr std::array kRadii_mm{0.5,     0.75, 0.79375, 1.0,   1.190625, 1.25,   1.5, 1.5875, 2.0,
                               2.38125, 2.5,  3.0,     3.175, 4.0,      4.7625, 5.0, 6.0,    6.35};
constexpr int kMostHoles = 64;               // what a kit file may say
constexpr double kMostTriedFriction = 1;     // chosen: more is no dry pin
constexpr double kTriedFrictionStep = 0.05;  // chosen: as tables give it
constexpr double kMostGap_mm = 20;           // chosen: pins bend
constexpr double kWholeForce_n = 5;          // chosen: what a cylinder is bought by

/// The phases of the funnel, in order; None: some design is left.
enum class Phase { Features, Planar, Heights, Loading, Force, None };

Phase dead_phase(const Plan& plan) {
  const Funnel& funnel = plan.funnel;
  if (funnel.features == 0) return Phase::Features;
  if (funnel.planar == 0) return Phase::Planar;
  if (funnel.heights == 0) return Phase::Heights;
  if (funnel.loadable == 0) return Phase::Loading;
  return funnel.strong == 0 ? Phase::Force : Phase::None;
}

std::string number(double value) {
  return fmt::format("{:.7g}", value);
}

/// The multiples of `step` between `from` and `to`, nearest to `from` first, and `to`; not `from` itself.
std::vector<double> steps(double from, double to, double step) {
  constexpr double kSame = 1e-9;
  constexpr double kDigits = 1e6;  // what the text of a change shows
  std::vector<double> values;
  const double sign = to > from ? 1 : -1;
  for (double k = sign > 0 ? std::floor(from / step + kSame) + 1 : std::ceil(from / step - kSame) - 1;;
       k += sign) {
    const double value = std::round(k * step * kDigits) / kDigits;
    if (sign * (to - value) < kSame) break;
    values.push_back(value);
  }
  if (sign * (to - from) > kSame) values.push_back(to);
  return values;
}

/// Those of a catalogue beyond `from`, nearest first.
template <std::size_t N>
std::vector<double> larger(const std::array<double, N>& catalogue, double from) {
  std::vector<double> values;
  std::ranges::copy_if(catalogue, std::back_inserter(values), [&](double v) { return v > from + 1e-9; });
  return values;
}
template <std::size_t N>
std::vector<double> smaller(const std::array<double, N>& catalogue, double from) {
  std::vector<double> values;
  std::ranges::copy_if(catalogue, std::back_inserter(values), [&](double v) { return v < from - 1e-9; });
  std::ranges::reverse(values);
  return values;
}

/// Builds ladders and sorts them by whether they act on the phase that lost the last fixtures.
class Workshop {
 public:
  Workshop(const Variant& variant, Phase dead) : variant_(variant), dead_(dead) {}

  /// A ladder of changes, kept where it has a step that a kit may have.
  void add(std::initializer_list<Phase> acts_on, Ladder ladder) {
    std::erase_if(ladder, [&](const Change& change) {
      Variant changed = variant_;
      change.apply(changed);
      return !model::conflicts_of(changed.task.kit).empty();
    });
    if (ladder.empty()) return;
    auto& list = std::ranges::find(acts_on, dead_) != acts_on.end() ? likely_ : others_;
    list.push_back(std::move(ladder));
  }

  /// The same for a number of the kit.
  template <class Set>
  void add_numbers(std::initializer_list<Phase> acts_on, const std::string& key, const std::string& from,
                   const std::vector<double>& values, const Set& set) {
    Ladder ladder;
    for (const double value : values) {
      ladder.push_back({key, from, number(value), [set, value](Variant& v) { set(v.task.kit, value); }});
    }
    add(acts_on, std::move(ladder));
  }

  std::vector<Ladder> take() {
    std::ranges::move(others_, std::back_inserter(likely_));
    return std::move(likely_);
  }

 private:
  const Variant& variant_;
  Phase dead_;
  std::vector<Ladder> likely_;
  std::vector<Ladder> others_;
};

std::string range_text(const geometry::Interval& range) {
  return fmt::format("[{}, {}]", number(range.lo), number(range.hi));
}

void add_separations(Workshop& shop, const model::Kit& kit, double widest_mm) {
  const geometry::Interval range = kit.jaws.separation_mm;
  const auto ladder_of = [&](const std::vector<double>& ends_mm, bool upper) {
    Ladder ladder;
    for (const double end_mm : ends_mm) {
      const geometry::Interval wider =
          upper ? geometry::Interval{range.lo, end_mm} : geometry::Interval{end_mm, range.hi};
      ladder.push_back({"kit.jaws.separation_mm", range_text(range), range_text(wider),
                        [wider](Variant& v) { v.task.kit.jaws.separation_mm = wider; }});
    }
    return ladder;
  };
  const double most_mm = std::ceil(widest_mm + 2);  // and a least opening of 1 mm a jaw
  if (most_mm > range.hi)
    shop.add({Phase::Planar, Phase::Loading}, ladder_of(steps(range.hi, most_mm, 1), true));
  if (range.lo > 0) shop.add({Phase::Planar}, ladder_of(steps(range.lo, 0, 1), false));
}

void add_grid(Workshop& shop, const model::Kit& kit, double widest_mm, bool plates_meet) {
  const model::Grid& grid = kit.grid;
  const auto set_spacing = [](model::Kit& k, double value) { k.grid.spacing_mm = value; };
  const auto set_rows = [](model::Kit& k, double value) { k.grid.rows = static_cast<int>(value); };
  const auto set_columns = [](model::Kit& k, double value) { k.grid.columns = static_cast<int>(value); };
  const double most = std::min<double>(kMostHoles, std::ceil(widest_mm / grid.spacing_mm) + 1);
  const auto more = {Phase::Planar, Phase::Heights, Phase::Loading, Phase::Force};
  if (grid.rows < most)
    shop.add_numbers(more, "kit.grid.rows", number(grid.rows), steps(grid.rows, most, 1), set_rows);
  if (grid.columns < most) {
    shop.add_numbers(more, "kit.grid.columns", number(grid.columns), steps(grid.columns, most, 1),
                     set_columns);
  }
  shop.add_numbers(more, "kit.grid.spacing_mm", number(grid.spacing_mm),
                   smaller(kSpacings_mm, grid.spacing_mm), set_spacing);
  shop.add_numbers(more, "kit.grid.spacing_mm", number(grid.spacing_mm),
                   larger(kSpacings_mm, grid.spacing_mm), set_spacing);
  if (!plates_meet) return;
  if (grid.rows > 2)
    shop.add_numbers({Phase::Loading}, "kit.grid.rows", number(grid.rows), steps(grid.rows, 2, 1), set_rows);
  if (grid.columns > 1) {
    shop.add_numbers({Phase::Loading}, "kit.grid.columns", number(grid.columns), steps(grid.columns, 1, 1),
                     set_columns);
  }
}

/// Stock lengths with one more, where a near miss tells which is missing; then any length at all.
void add_lengths(Workshop& shop, const model::Kit& kit, const std::vector<NearMiss>& misses) {
  if (kit.pins.lengths_mm.empty()) return;
  const auto text_of = [](const std::vector<double>& lengths_mm) {
    std::string text;
    for (const double length : lengths_mm) text += (text.empty() ? "[" : ", ") + number(length);
    return text + "]";
  };
  const std::string from = text_of(kit.pins.lengths_mm);
  const auto change_to = [&](std::vector<double> lengths_mm) {
    const std::string to = lengths_mm.empty() ? "any" : text_of(lengths_mm);
    return Change{"kit.pins.lengths_mm", from, to,
                  [lengths_mm](Variant& v) { v.task.kit.pins.lengths_mm = lengths_mm; }};
  };
  constexpr double kHalf_mm = 0.5;
  for (const NearMiss& miss : misses) {
    if (!miss.gap || miss.phase != "heights") continue;
    const bool longer = miss.reason == "stock_too_short";
    if (!longer && miss.reason != "no_stock_length") continue;
    const double halves = miss.gap->needs / kHalf_mm;
    std::vector<double> lengths_mm = kit.pins.lengths_mm;
    lengths_mm.push_back(kHalf_mm * (longer ? std::ceil(halves) : std::floor(halves)));
    std::ranges::sort(lengths_mm);
    if (lengths_mm.front() > 0) shop.add({Phase::Heights}, {change_to(lengths_mm)});
  }
  shop.add({Phase::Heights, Phase::Loading}, {change_to({})});
}

void add_pins(Workshop& shop, const model::Kit& kit) {
  const model::PinStock& pins = kit.pins;
  const auto set_radius = [](model::Kit& k, double value) { k.pins.radius_mm = value; };
  shop.add_numbers({Phase::Features, Phase::Planar, Phase::Heights, Phase::Loading}, "kit.pins.radius_mm",
                   number(pins.radius_mm), smaller(kRadii_mm, pins.radius_mm), set_radius);
  shop.add_numbers({Phase::Planar}, "kit.pins.radius_mm", number(pins.radius_mm),
                   larger(kRadii_mm, pins.radius_mm), set_radius);
  constexpr double kTenth_mm = 0.1;
  shop.add_numbers({Phase::Features, Phase::Planar, Phase::Heights}, "kit.pins.min_engagement_mm",
                   number(pins.min_engagement_mm), steps(pins.min_engagement_mm, kTenth_mm, kTenth_mm),
                   [](model::Kit& k, double value) { k.pins.min_engagement_mm = value; });
  shop.add_numbers({Phase::Loading}, "kit.pins.protrusion_mm", number(pins.protrusion_mm),
                   steps(pins.protrusion_mm, 0, kTenth_mm),
                   [](model::Kit& k, double value) { k.pins.protrusion_mm = value; });
  shop.add_numbers({Phase::Heights, Phase::Loading}, "kit.pins.clearance_mm", number(pins.clearance_mm),
                   steps(pins.clearance_mm, 0, kTenth_mm / 2),
                   [](model::Kit& k, double value) { k.pins.clearance_mm = value; });
  shop.add_numbers({Phase::Planar}, "kit.pins.min_foot_margin_mm", number(pins.min_foot_margin_mm),
                   steps(pins.min_foot_margin_mm, 0, kTenth_mm),
                   [](model::Kit& k, double value) { k.pins.min_foot_margin_mm = value; });
}

void add_jaws(Workshop& shop, const model::Kit& kit) {
  const double travel_mm = kit.jaws.separation_mm.length() / 2;
  const double opening_mm = std::min(kit.jaws.opening_mm.value_or(travel_mm), travel_mm);
  if (opening_mm > 1) {
    shop.add_numbers({Phase::Loading}, "kit.jaws.opening_mm",
                     kit.jaws.opening_mm ? number(*kit.jaws.opening_mm) : "full travel",
                     steps(opening_mm, 1, 1), [](model::Kit& k, double value) { k.jaws.opening_mm = value; });
  }
  const double gap_mm = kit.jaws.plate_gap_mm;
  constexpr double kHalf_mm = 0.5;
  const auto set_gap = [](model::Kit& k, double value) { k.jaws.plate_gap_mm = value; };
  const std::string key = "kit.jaws.plate_gap_mm";
  if (gap_mm < kMostGap_mm) {
    shop.add_numbers({Phase::Heights, Phase::Loading}, key, number(gap_mm),
                     steps(gap_mm, kMostGap_mm, kHalf_mm), set_gap);
  }
  if (gap_mm > kHalf_mm && !kit.pins.lengths_mm.empty())
    shop.add_numbers({Phase::Heights}, key, number(gap_mm), steps(gap_mm, kHalf_mm, kHalf_mm), set_gap);
}

void add_friction(Workshop& shop, const model::Task& task) {
  const auto change_to = [&](double mu, const std::string& to) {
    return Change{"task.friction", number(task.friction), to, [mu](Variant& v) { v.task.friction = mu; }};
  };
  Ladder more;
  Ladder less;
  std::vector<model::PinMaterial> pins = task.pin_materials;
  std::ranges::sort(pins, {},
                    [&](const model::PinMaterial& pin) { return std::abs(pin.friction - task.friction); });
  for (const model::PinMaterial& pin : pins) {
    if (pin.friction == task.friction) continue;
    const std::string to = fmt::format("{} (pins of {})", number(pin.friction), pin.name);
    (pin.friction > task.friction ? more : less).push_back(change_to(pin.friction, to));
  }
  if (pins.empty()) {
    if (task.friction < kMostTriedFriction) {
      for (const double mu : steps(task.friction, kMostTriedFriction, kTriedFrictionStep))
        more.push_back(change_to(mu, number(mu)));
    }
    if (task.friction > kTriedFrictionStep) {
      for (const double mu : steps(task.friction, kTriedFrictionStep, kTriedFrictionStep))
        less.push_back(change_to(mu, number(mu)));
    }
  }
  shop.add({Phase::Force}, std::move(more));
  shop.add({Phase::Force}, std::move(less));
}

/// An actuator that holds the design that needs least.
void add_force(Workshop& shop, const model::Kit& kit, const std::vector<NearMiss>& misses) {
  for (const NearMiss& miss : misses) {
    if (!miss.gap || miss.phase != "force" || miss.unit != Unit::Newton) continue;
    const double least_n = miss.gap->needs + 2 * kit.actuator.force_uncertainty_n;
    shop.add_numbers({Phase::Force}, "kit.actuator.max_squeeze_n", number(kit.actuator.max_squeeze_n),
                     {kWholeForce_n * std::ceil(least_n / kWholeForce_n)},
                     [](model::Kit& k, double value) { k.actuator.max_squeeze_n = value; });
  }
}

}  // namespace

double widest_grip_mm(const geometry::Surface& part, const model::Kit& kit) {
  return std::hypot(part.x_range_mm().length(), part.y_range_mm().length()) + 2 * kit.pins.radius_mm;
}

std::vector<Ladder> ladders(const Variant& variant, const Scene& scene, const Plan& plan,
                            const std::vector<NearMiss>& misses) {
  const model::Task& task = variant.task;
  const model::Kit& kit = task.kit;
  const double widest_mm = widest_grip_mm(scene.turned.surface, kit);
  const bool plates_meet =
      std::ranges::any_of(misses, [](const NearMiss& miss) { return miss.reason == "plate_meets_obstacle"; });
  Workshop shop(variant, dead_phase(plan));
  add_force(shop, kit, misses);
  add_lengths(shop, kit, misses);
  add_separations(shop, kit, widest_mm);
  add_jaws(shop, kit);
  add_pins(shop, kit);
  add_friction(shop, task);
  const bool below = task.side == model::Side::Below;
  shop.add({Phase::Features, Phase::Planar, Phase::Heights, Phase::Loading},
           {{"task.side", below ? "below" : "above", below ? "above" : "below",
             [below](Variant& v) { v.task.side = below ? model::Side::Above : model::Side::Below; }}});
  if (variant.options.friction == model::FrictionModel::Pyramid) {
    shop.add({Phase::Force}, {{"--friction", "pyramid", "cone",
                               [](Variant& v) { v.options.friction = model::FrictionModel::Cone; }}});
  }
  add_grid(shop, kit, widest_mm, plates_meet);
  return shop.take();
}

}  // namespace pinjaw::planner
