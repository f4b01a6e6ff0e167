#include "host/planner/plan/exact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/model/tolerance.hpp"
#include "host/part/exact.hpp"
#include "host/planner/features/projection.hpp"
#include "host/planner/heights/heights.hpp"
#include "host/planner/loading/covered.hpp"
#include "host/planner/plan/pin_places.hpp"

namespace pinjaw::planner {

namespace {

using geometry::Slab;
using geometry::Sweep;
using geometry::Vector2d;
using model::kEps_mm;

constexpr double kStatedTol_mm = 2 * part::kHeightStep_mm;  // chosen: the same search from another guess
constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr const char* kClosing = "while it closes (exact faces)";
constexpr const char* kComing = "while it comes along z, open (exact faces)";
constexpr std::size_t kPartBody = 0;  ///< place of the part among the scene's bodies

Sweep disc(const Vector2d& center_mm, double radius_mm) {
  return {center_mm, center_mm, radius_mm};
}

/// Questions as they come up; each is known by its place.
class Questions {
 public:
  std::size_t distance(std::size_t body, part::Column column) {
    all_.emplace_back(part::ExactDistance{body, std::move(column)});
    return all_.size() - 1;
  }
  std::size_t height(part::Column column, part::End end, double guess_mm) {
    all_.emplace_back(part::ExactHeight{kPartBody, std::move(column), end, guess_mm});
    return all_.size() - 1;
  }
  [[nodiscard]] const std::vector<part::ExactQuestion>& all() const { return all_; }

 private:
  std::vector<part::ExactQuestion> all_;
};

/// A column that something of the gripper covers: how near it comes to a body, and whether it keeps away.
struct Way {
  std::string what;
  std::size_t distance;  ///< of what it covers
  std::size_t grown;     ///< of the same grown by the clearance that it keeps
};

/// What is asked about one pin, and what the triangles say.
struct PinAsked {
  std::string name;
  std::size_t side;       ///< distance of the pin, thinner by eps
  std::size_t way;        ///< of the same on its way from open to closed
  std::size_t contact;    ///< of the stated contact
  std::size_t topped;     ///< of the thin pin with its clearance above
  std::size_t engaged;    ///< of the line eps inside the foot up to where the pin must engage
  std::size_t protruded;  ///< of the pin, thicker by eps, over the length that may protrude
  std::size_t ceiling;    ///< lowest z over the thin pin
  std::size_t reach;      ///< highest z over the thick pin under the ceiling
  std::size_t edge;       ///< lowest z eps inside the foot
  double mesh_ceiling_mm;
  double mesh_reach_mm;
  double mesh_edge_mm;
};

struct DesignAsked {
  std::vector<PinAsked> pins;
  std::vector<Way> ways;
};

/// Words the questions of a plan's designs.
class Interviewer {
 public:
  Interviewer(const Plan& plan, const Scene& scene)
      : plan_(plan),
        scene_(scene),
        pins_(plan.kit.pins),
        plate_top_mm_(plate_top_mm(plan.kit, scene.turned.surface, scene.attached)) {}

  /// `bodies` are asked beside the part.
  DesignAsked ask(const model::Design& design, std::span<const std::size_t> bodies,
                  Questions& questions) const {
    DesignAsked asked;
    for (const model::PinDesign& pin : design.pins) {
      asked.pins.push_back(about_pin(design, pin, questions));
      for (const std::size_t body : bodies) about_way(design, pin, body, asked.ways, questions);
    }
    about_jaws(design, kPartBody, asked.ways, questions);
    for (const std::size_t body : bodies) about_jaws(design, body, asked.ways, questions);
    return asked;
  }

 private:
  static double opening_mm(const model::Design& design) {
    return (design.jaw_open_mm - design.jaw_separation_mm) / 2;
  }
  static Vector2d open_mm(const model::Design& design, const model::PinDesign& pin, const Vector2d& axis_mm) {
    return axis_mm + sign_of_outwards(pin.hole.jaw) * opening_mm(design) *
                         design.part_pose.inverse().turned(Vector2d::UnitX());
  }

  PinAsked about_pin(const model::Design& design, const model::PinDesign& pin, Questions& questions) const {
    const geometry::Surface& mesh = scene_.turned.surface;
    const Vector2d axis_mm = axis_in_part_mm(design, pin, plan_.kit.grid);
    const Vector2d foot_mm = foot_in_part_mm(design, pin);
    const Sweep thin = disc(axis_mm, pins_.radius_mm - kEps_mm);
    const Sweep thick = disc(axis_mm, pins_.radius_mm + kEps_mm);
    const Sweep inside = disc(foot_mm + kEps_mm * normal_in_part(design, pin), 0);
    const double top_mm = pin.top_z_mm;
    // a ceiling that a pin may all but touch must not be taken for the wall beside it
    const double side_top_mm = top_mm - std::max(0.0, 2 * kEps_mm - pins_.clearance_mm);
    const Sweep way{axis_mm, open_mm(design, pin, axis_mm), pins_.radius_mm - kEps_mm};

    PinAsked asked{};
    asked.name = "pin " + name_of(pin.hole);
    asked.mesh_ceiling_mm = mesh.lowest_z_mm(thin);
    const Slab under{.hi_mm = asked.mesh_ceiling_mm - kEps_mm};
    asked.mesh_reach_mm = mesh.highest_z_mm(thick, under);
    const auto edge = mesh.lowest_above(inside.from_mm);
    asked.mesh_edge_mm = edge ? edge->point_mm.z() : kEndless;

    asked.side = questions.distance(kPartBody, {thin, {.hi_mm = side_top_mm}});
    asked.way = questions.distance(kPartBody, {way, {.hi_mm = plan_.loading_2d ? kEndless : side_top_mm}});
    asked.contact =
        questions.distance(kPartBody, {disc(foot_mm, 0), {pin.contact_z_mm.lo, pin.contact_z_mm.hi}});
    asked.topped = questions.distance(kPartBody, {thin, {.hi_mm = top_mm + pins_.clearance_mm}});
    asked.engaged = questions.distance(kPartBody, {inside, {.hi_mm = top_mm - pins_.min_engagement_mm}});
    const double protruding_mm = std::min(top_mm - pins_.protrusion_mm, under.hi_mm);
    asked.protruded = questions.distance(kPartBody, {thick, {protruding_mm, under.hi_mm}});
    asked.ceiling = questions.height({thin, {}}, part::End::Lowest, asked.mesh_ceiling_mm);
    asked.reach = questions.height({thick, under}, part::End::Highest, asked.mesh_reach_mm);
    asked.edge = questions.height({inside, {}}, part::End::Lowest, asked.mesh_edge_mm);
    return asked;
  }

  /// A pin's way past another body, closing and, open, along z.
  void about_way(const model::Design& design, const model::PinDesign& pin, std::size_t body,
                 std::vector<Way>& ways, Questions& questions) const {
    const double clearance_mm = pins_.clearance_mm;
    const Vector2d closed_mm = axis_in_part_mm(design, pin, plan_.kit.grid);
    const Vector2d open = open_mm(design, pin, closed_mm);
    const auto add = [&](const Vector2d& from_mm, double lo_mm, const char* when) {
      const auto covers = [&](double grown_mm) {
        return questions.distance(
            body, {Sweep{from_mm, open, pins_.radius_mm + grown_mm}, {lo_mm, pin.top_z_mm + grown_mm}});
      };
      ways.push_back({fmt::format("pin {} keeps clear of {} {}", name_of(pin.hole), name_of_body(body), when),
                      covers(0), covers(clearance_mm)});
    };
    add(closed_mm, plate_top_mm_, kClosing);
    add(open, -kEndless, kComing);
  }

  void about_jaws(const model::Design& design, std::size_t body, std::vector<Way>& ways,
                  Questions& questions) const {
    const double opens_mm = opening_mm(design);
    for (const model::JawSide side : {model::JawSide::Left, model::JawSide::Right}) {
      const ClosedJaw jaw{side, design.jaw_separation_mm, design.part_pose};
      for (const model::JawBody& solid : model::jaw_solids(plan_.kit)) {
        const Slab standing = heights_of(solid, plate_top_mm_);
        const auto add = [&](const geometry::Interval& opening_mm, const Slab& slab, const char* when) {
          const auto covers = [&](double grown_mm) {
            return questions.distance(body, {covered(solid, jaw, opening_mm, grown_mm), slab});
          };
          ways.push_back(
              {fmt::format("the {} jaw keeps clear of {} {}", side == model::JawSide::Left ? "left" : "right",
                           name_of_body(body), when),
               covers(0), covers(pins_.clearance_mm)});
        };
        add({0, opens_mm}, standing, kClosing);
        add({opens_mm, opens_mm}, {.hi_mm = standing.hi_mm}, kComing);
      }
    }
  }

  [[nodiscard]] std::string name_of_body(std::size_t body) const {
    return body == kPartBody ? "the part" : scene_.bodies[body].source.file.filename().string();
  }

  const Plan& plan_;
  const Scene& scene_;
  const model::PinStock& pins_;
  double plate_top_mm_;
};

/// How far from what it should be a promise may be before it is broken.
struct Slack {
  double mesh_mm = 0;  ///< of what the triangles were asked
  double foot_mm = 0;  ///< of where a foot is: its feature may be fitted
};

/// Holds the answers against the questions of one design.
class Reader {
 public:
  Reader(const model::Design& design, const model::PinStock& pins, const std::vector<double>& mm,
         const Slack& slack)
      : design_(design), pins_(pins), mm_(mm), slack_(slack) {}

  ExactDesign read(const DesignAsked& asked) {
    result_.summary.least_clearance_mm = kEndless;
    for (std::size_t i = 0; i < asked.pins.size(); ++i) read_pin(design_.pins[i], asked.pins[i]);
    for (const Way& way : asked.ways) read_way(way);
    for (const ExactFigure& figure : result_.figures)
      result_.summary.largest_difference_mm =
          std::max(result_.summary.largest_difference_mm, figure.difference_mm());
    return std::move(result_);
  }

 private:
  void claim(std::string what, bool holds, std::string found) {
    result_.claims.push_back({design_.id, std::move(what), holds, holds ? std::string() : std::move(found)});
  }
  void figure(std::string what, double mesh_mm, double brep_mm) {
    result_.figures.push_back({design_.id, std::move(what), mesh_mm, brep_mm});
  }

  void read_pin(const model::PinDesign& pin, const PinAsked& asked) {
    const auto& [name, side, way, contact, topped, engaged, protruded, ceiling, reach, edge, mesh_ceiling_mm,
                 mesh_reach_mm, mesh_edge_mm] = asked;
    const auto top_mm = [&](double reach_mm, double ceiling_mm) {
      return std::min(reach_mm + pins_.protrusion_mm, ceiling_mm - pins_.clearance_mm);
    };
    const double gap_mm = mm_[side] - kEps_mm;
    figure(name + " gap to the part", 0, gap_mm);
    figure(name + " highest usable top", top_mm(mesh_reach_mm, mesh_ceiling_mm),
           top_mm(mm_[reach], mm_[ceiling]));
    figure(name + " edge it engages", mesh_edge_mm, mm_[edge]);
    result_.summary.contact_gap_mm = std::max(result_.summary.contact_gap_mm, std::abs(gap_mm));

    const auto promise = [&, &pin_name = name](const char* what, bool holds, std::string found) {
      claim(pin_name + what + " (exact faces)", holds, std::move(found));
    };
    promise(" does not cut the part", gap_mm >= -slack_.foot_mm,
            fmt::format("it does by {:.4f} mm", -gap_mm));
    promise(" touches the part", gap_mm <= slack_.foot_mm, fmt::format("{:.4f} mm are between", gap_mm));
    promise(" touches at its stated contact", std::abs(mm_[contact]) <= slack_.foot_mm,
            fmt::format("the part is {:.4f} mm away", std::abs(mm_[contact])));
    promise(" closes without cutting the part", mm_[way] - kEps_mm >= -slack_.foot_mm,
            fmt::format("it does by {:.4f} mm", kEps_mm - mm_[way]));
    claim(
        name + " has its clearance above", mm_[topped] >= -slack_.mesh_mm,
        fmt::format("the part is up to {:.4f} mm inside it; under the part the top could be at {:.4f}, it is "
                    "at {:.4f} mm",
                    -mm_[topped], mm_[ceiling] - pins_.clearance_mm, pin.top_z_mm));
    promise(" engages", mm_[engaged] <= slack_.mesh_mm,
            fmt::format("by {:.4f} mm, and {:.4f} mm are needed", pin.top_z_mm - mm_[edge],
                        pins_.min_engagement_mm));
    promise(" protrudes no further than allowed", mm_[protruded] <= slack_.mesh_mm,
            fmt::format("by {:.4f} mm, and {:.4f} mm are allowed", pin.top_z_mm - mm_[reach],
                        pins_.protrusion_mm));
  }

  void read_way(const Way& way) {
    result_.summary.least_clearance_mm = std::min(result_.summary.least_clearance_mm, mm_[way.distance]);
    claim(way.what, mm_[way.grown] >= -slack_.mesh_mm,
          fmt::format("{:.4f} mm apart, the clearance is short of it by {:.4f} mm", mm_[way.distance],
                      -mm_[way.grown]));
  }

  const model::Design& design_;
  const model::PinStock& pins_;
  const std::vector<double>& mm_;
  Slack slack_;
  ExactDesign result_;
};

}  // namespace

double ExactFigure::difference_mm() const {
  return mesh_mm == brep_mm ? 0 : std::abs(mesh_mm - brep_mm);
}

base::Expected<ExactReport> recheck_exactly(const Plan& plan, const Scene& scene,
                                            std::span<const model::Design* const> designs) {
  ExactReport report;
  std::vector<part::ExactBody> bodies = scene.bodies;
  std::vector<std::size_t> others;
  for (std::size_t body = 0; body < bodies.size(); ++body) {
    if (!part::has_brep(bodies[body].source)) {
      report.without_faces.push_back(bodies[body].source.file.string());
    } else if (body != kPartBody) {
      others.push_back(body);
    }
  }
  if (bodies.empty() || !part::has_brep(bodies[kPartBody].source)) return report;

  Questions questions;
  std::vector<DesignAsked> asked;
  const Interviewer interviewer(plan, scene);
  for (const model::Design* design : designs) asked.push_back(interviewer.ask(*design, others, questions));
  const auto answers = part::ask_exactly(bodies, questions.all());
  if (!answers) return tl::unexpected(answers.error());

  const double mesh_mm = scene.part.mesh_deflection_mm + std::ranges::max(answers->tolerance_mm);
  const Slack slack{mesh_mm, mesh_mm + kFitMm};
  report.tolerance_mm = slack.foot_mm;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    report.designs.push_back(Reader(*designs[i], plan.kit.pins, answers->mm, slack).read(asked[i]));
    const auto& stated = designs[i]->exact;
    if (!stated) continue;
    ExactDesign& found = report.designs.back();
    const auto equal = [&](const char* what, double stated_mm, double found_mm) {
      const bool holds = stated_mm == found_mm || std::abs(stated_mm - found_mm) <= kStatedTol_mm;
      found.claims.push_back(
          {designs[i]->id, what, holds,
           holds ? "" : fmt::format("stated {:.9g}, recomputed {:.9g}", stated_mm, found_mm)});
    };
    equal("largest difference from the exact faces", stated->largest_difference_mm,
          found.summary.largest_difference_mm);
    equal("gap of a contact on the exact faces", stated->contact_gap_mm, found.summary.contact_gap_mm);
    equal("least clearance on the exact faces", stated->least_clearance_mm, found.summary.least_clearance_mm);
  }
  return report;
}

base::Expected<void> tell_exactly(Plan& plan, const Scene& scene, std::size_t count) {
  std::vector<const model::Design*> best;
  for (std::size_t i = 0; i < std::min(count, plan.designs.size()); ++i) best.push_back(&plan.designs[i]);
  const auto report = recheck_exactly(plan, scene, best);
  if (!report) return tl::unexpected(report.error());
  if (report->designs.size() < best.size()) {
    return base::failure("--exact asks the part's exact faces, and " + scene.part.file.string() +
                         " is a mesh without any");
  }
  for (std::size_t i = 0; i < best.size(); ++i) plan.designs[i].exact = report->designs[i].summary;
  return {};
}

}  // namespace pinjaw::planner
