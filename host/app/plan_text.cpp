#include "host/app/plan_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace pinjaw::app {

namespace {

struct Phase {
  const char* name;
  const char* what;
  std::int64_t count;
};

std::array<Phase, 7> phases(const planner::Funnel& funnel) {
  return {{{"features", "edges with a free side", funnel.features},
           {"planar", "planar fixtures in form closure", funnel.planar},
           {"heights", "with a height for every pin", funnel.heights},
           {"loadable", "that load by closing the jaws", funnel.loadable},
           {"not wedging", "that neither wedge nor jam", funnel.not_wedging},
           {"resistable", "that some squeeze can hold", funnel.resistable},
           {"strong", "that the usable force can hold", funnel.strong}}};
}

std::string reasons_text(const planner::Losses& losses, const std::string& phase) {
  const auto found = losses.find(phase);
  if (found == losses.end()) return {};
  std::vector<std::pair<std::int64_t, std::string>> reasons;
  for (const auto& [reason, count] : found->second) {
    if (count > 0) reasons.emplace_back(-count, reason);
  }
  std::ranges::sort(reasons);
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMost, reasons.size()); ++i) {
    text += fmt::format("            {:>9}  left out: {}\n", -reasons[i].first, reasons[i].second);
  }
  if (reasons.size() > kMost) {
    std::int64_t rest = 0;
    for (std::size_t i = kMost; i < reasons.size(); ++i) rest -= reasons[i].first;
    text += fmt::format("            {:>9}  left out for {} more reasons\n", rest, reasons.size() - kMost);
  }
  return text;
}

std::string pins_text(const model::Design& design) {
  std::string text;
  for (const model::PinDesign& pin : design.pins) {
    text += fmt::format(" {}-C{}-R{}", pin.hole.jaw == model::JawSide::Left ? 'L' : 'R', pin.hole.column,
                        pin.hole.row);
  }
  return text;
}

}  // namespace

std::string funnel_text(const planner::Funnel& funnel) {
  std::string text;
  for (const Phase& phase : phases(funnel)) {
    text += fmt::format("{:<12}{:>9}  {}\n", phase.name, phase.count, phase.what);
  }
  return text;
}

std::string losses_text(const planner::Plan& plan) {
  // a phase's losses stand before the count of what it leaves; the force phase's after the last line
  const auto lines = phases(plan.funnel);
  std::string text;
  for (const Phase& phase : lines) {
    if (phase.name == std::string_view("heights")) text += reasons_text(plan.losses, "heights");
    if (phase.name == std::string_view("loadable")) text += reasons_text(plan.losses, "loading");
    text += fmt::format("{:<12}{:>9}  {}\n", phase.name, phase.count, phase.what);
    if (phase.name == std::string_view("features")) text += reasons_text(plan.losses, "features");
  }
  text += reasons_text(plan.losses, "force");
  return text;
}

std::string designs_text(const planner::Plan& plan, std::size_t at_most) {
  if (plan.designs.empty()) return "no design holds the part\n";
  const std::size_t shown = std::min(at_most, plan.designs.size());
  std::size_t width = 12;
  for (std::size_t i = 0; i < shown; ++i) width = std::max(width, plan.designs[i].squeeze.critical.size());
  std::string text = fmt::format("{:<10} {:>5} {:>9} {:>9}  {:<{}} pins\n", "design", "split", "squeeze N",
                                 "margin N", "critical", width);
  for (std::size_t i = 0; i < shown; ++i) {
    const model::Design& design = plan.designs[i];
    text += fmt::format("{:<10} {:>5} {:>9.1f} {:>9.1f}  {:<{}}{}\n", design.id,
                        model::to_string(design.split), design.squeeze.required_n, design.squeeze.margin_n,
                        design.squeeze.critical, width, pins_text(design));
  }
  if (plan.designs.size() > at_most) text += fmt::format("… and {} more\n", plan.designs.size() - at_most);
  return text;
}

std::string certified_text(const planner::Plan& plan) {
  std::string text;
  for (const model::Design& design : plan.designs) {
    if (!design.certified) continue;
    const model::Certified& worst = *design.certified;
    const std::string where =
        fmt::format("{} on a {} face at ({:.1f}, {:.1f}, {:.1f})", worst.spray,
                    worst.curved ? "curved" : "flat", worst.at_mm.x(), worst.at_mm.y(), worst.at_mm.z());
    if (std::isinf(worst.low_n)) {
      text += fmt::format("{:<10} warning: no squeeze resists {}\n", design.id, where);
      continue;
    }
    text += fmt::format("{:<10} {:>9.1f} {:>9.1f} {:>9.1f}  {}\n", design.id, worst.sampled_n, worst.low_n,
                        worst.high_n, where);
    if (!worst.closed)
      text += fmt::format("{:<10} bracket not closed: the search ended by its limit of splits\n", "");
    const double usable_n = design.squeeze.usable_n;
    if (worst.low_n > usable_n) {
      text += fmt::format("{:<10} warning: that is more than the usable {:.1f} N\n", "", usable_n);
    } else if (worst.high_n > usable_n) {
      text += fmt::format("{:<10} warning: that may be more than the usable {:.1f} N\n", "", usable_n);
    }
  }
  if (text.empty()) return text;
  return fmt::format(
             "\nThe worst spray anywhere a jet reaches: what the samples need, what one spray does need, "
             "what none "
             "exceeds.\n{:<10} {:>9} {:>9} {:>9}  worst spray\n",
             "design", "sampled N", "at least", "at most") +
         text;
}

std::string robust_text(const planner::Plan& plan) {
  if (!plan.ranges) return {};
  const model::Ranges& ranges = *plan.ranges;
  const geometry::Interval friction = ranges.friction_about(plan.friction);
  std::string text = fmt::format(
      "\nover friction {:.3g} to {:.3g}, pins {:.3g} mm off, {:.3g} mm thicker or thinner, part {:.3g} mm "
      "off, air "
      "{:.3g} to {:.3g}:\n",
      friction.lo, friction.hi, ranges.pin_position_mm, ranges.pin_radius_mm, ranges.part_size_mm,
      ranges.air_pressure.lo, ranges.air_pressure.hi);
  text += fmt::format("{:<10} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "design", "worst N", "margin N", "moves mm",
                      "at most", "turns deg");
  for (const model::Design& design : plan.designs) {
    if (!design.robust) continue;
    const model::Robust& robust = *design.robust;
    const std::string squeeze =
        robust.worst_required_n ? fmt::format("{:>9.1f} {:>9.1f}", *robust.worst_required_n, robust.margin_n)
                                : fmt::format("{:>19}", "fails: " + robust.failure);
    const std::string bound =
        robust.location_bound_mm ? fmt::format("{:.3f}", *robust.location_bound_mm) : "not proven";
    text += fmt::format("{:<10} {} {:>9.3f} {:>9} {:>9.3f}\n", design.id, squeeze, robust.location_error_mm,
                        bound, robust.location_error_deg);
  }
  return text;
}

std::string exact_text(const planner::Plan& plan) {
  std::string text;
  for (const model::Design& design : plan.designs) {
    if (!design.exact) continue;
    text +=
        fmt::format("{:<10} {:>10.4f} {:>10.4f} {:>9.3f}\n", design.id, design.exact->largest_difference_mm,
                    design.exact->contact_gap_mm, design.exact->least_clearance_mm);
  }
  if (text.empty()) return text;
  return fmt::format("\non the exact faces of the part, in mm:\n{:<10} {:>10} {:>10} {:>9}\n", "design",
                     "difference", "gap", "clearance") +
         text;
}

std::string exact_text(const planner::ExactReport& report, std::size_t asked) {
  std::string text;
  for (const std::string& file : report.without_faces) {
    text += fmt::format("not re-checked on exact faces: {} is a mesh and has none\n", file);
  }
  if (report.designs.size() < asked) return text;
  model::Exact most{.least_clearance_mm = std::numeric_limits<double>::infinity()};
  std::size_t differ = 0;
  for (const planner::ExactDesign& design : report.designs) {
    const model::Exact& one = design.summary;
    most.largest_difference_mm = std::max(most.largest_difference_mm, one.largest_difference_mm);
    most.contact_gap_mm = std::max(most.contact_gap_mm, one.contact_gap_mm);
    most.least_clearance_mm = std::min(most.least_clearance_mm, one.least_clearance_mm);
    for (const planner::ExactFigure& figure : design.figures) {
      if (figure.difference_mm() < kToldDifference_mm) continue;
      ++differ;
      text += fmt::format("{}: {}: mesh {:.4f}, exact {:.4f}: {:.4f} mm apart\n", figure.subject, figure.what,
                          figure.mesh_mm, figure.brep_mm, figure.difference_mm());
    }
  }
  return text + fmt::format(
                    "{} {} re-checked on the exact B-rep: largest difference {:.4f} mm, {} {} of {} mm or "
                    "more; contacts within {:.4f} mm, least clearance {:.3f} mm\n",
                    asked, asked == 1 ? "design" : "designs", most.largest_difference_mm, differ,
                    differ == 1 ? "difference" : "differences", kToldDifference_mm, most.contact_gap_mm,
                    most.least_clearance_mm);
}

}  // namespace pinjaw::app
