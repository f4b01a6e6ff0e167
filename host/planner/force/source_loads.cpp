#include "host/planner/force/source_loads.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "host/planner/force/covers.hpp"

namespace pinjaw::planner {
namespace {

using geometry::Vector3d;
using model::Wrench;
using SourceLoads = base::Expected<std::vector<SourceLoad>>;

constexpr double kStandardGravity = 9.80665;  // m/s2, by definition, CGPM 1901

Wrench torque_about(const Vector3d& direction, double torque_nmm) {
  Wrench wrench = Wrench::Zero();
  wrench.tail<3>() = torque_nmm * direction;
  return wrench;
}

/// The heading's name; else `+z` along an axis, else the direction's unit components.
std::string label_of(const model::Heading& heading) {
  if (!heading.name.empty()) return heading.name;
  const Vector3d unit = heading.direction.normalized();
  constexpr double kOnAxis = 1e-9;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(unit[k]) > 1 - kOnAxis) return fmt::format("{}{}", unit[k] > 0 ? '+' : '-', "xyz"[k]);
  }
  const auto rounded = [&](int k) { return std::round(unit[k] * 1e3) / 1e3 + 0.0; };  // never "-0"
  return fmt::format("{:g},{:g},{:g}", rounded(0), rounded(1), rounded(2));
}

/// A value and its word in a label; an empty word says nothing.
struct Worded {
  double value = 0;
  std::string word;
};

/// 0 alone, or a value either way.
std::vector<Worded> either_way(double value, const char* one, const char* other) {
  if (value == 0) return {{0, ""}};
  return {{value, one}, {-value, other}};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!word.empty()) text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}

/// The torques a drill may have: none, and its own in each sense it turns.
std::vector<Worded> torques_of(const model::Drilling& drilling) {
  std::vector<Worded> torques = {{0, ""}};
  if (drilling.torque_nmm == 0) return torques;
  const bool both = drilling.turns == model::Drilling::Turns::Both;
  if (drilling.turns != model::Drilling::Turns::Left) {
    torques.push_back({drilling.torque_nmm, both ? "right torque" : "torque"});
  }
  if (drilling.turns != model::Drilling::Turns::Right) {
    torques.push_back({-drilling.torque_nmm, both ? "left torque" : "torque"});
  }
  return torques;
}

struct LoadsOf {
  const Body& body;

  SourceLoads operator()(const model::Gravity& gravity) const {
    if (body.mass_kg <= 0) return base::failure("gravity needs the part's mass: give a material or mass_kg");
    std::vector<SourceLoad> loads;
    for (const model::Heading& pose : gravity.poses) {
      const Vector3d weight_n = body.mass_kg * kStandardGravity * pose.direction.normalized();
      const bool one = gravity.poses.size() == 1 && pose.name.empty();
      loads.push_back({one ? "" : label_of(pose), force_at(body.centroid_mm, weight_n)});
    }
    return loads;
  }

  SourceLoads operator()(const model::Acceleration& acceleration) const {
    if (body.mass_kg <= 0) {
      return base::failure("an acceleration needs the part's mass: give a material or mass_kg");
    }
    std::vector<SourceLoad> loads;
    const double force_n = body.mass_kg * acceleration.peak_g * kStandardGravity;
    for (const model::Heading& along : acceleration.along) {
      loads.push_back({label_of(along), force_at(body.centroid_mm, force_n * along.direction.normalized())});
    }
    if (acceleration.every_direction) {
      for (const Vector3d& corner : corners_around_ball())
        loads.push_back({label_of(corner), force_at(body.centroid_mm, force_n * corner)});
    }
    return loads;
  }

  SourceLoads operator()(const model::Spray& spray) const {
    if (body.surface == nullptr) return base::failure("a spray needs the part's surface");
    const auto hits = spray_hits(spray, *body.surface);
    if (!hits) return tl::unexpected(hits.error());
    std::vector<SourceLoad> loads;
    for (const SprayHit& hit : *hits)
      loads.push_back({std::to_string(loads.size()), force_at(hit.p_mm, hit.force_n)});
    return loads;
  }

  SourceLoads operator()(const model::PointForce& force) const {
    return std::vector<SourceLoad>{{"", force_at(force.at_mm, force.force_n)}};
  }

  SourceLoads operator()(const model::PlainWrench& plain) const {
    Wrench wrench;
    wrench << plain.force_n, plain.torque_nmm;
    return std::vector<SourceLoad>{{"", wrench}};
  }

  /// Corners of (thrust to pull) x (torques); the one without a load is left out.
  SourceLoads operator()(const model::Drilling& drilling) const {
    std::vector<SourceLoad> loads;
    const std::array<Worded, 2> feeds = {Worded{drilling.thrust_n, "thrust"},
                                         Worded{-drilling.pull_n, drilling.pull_n > 0 ? "pull" : ""}};
    for (const Worded& feed : feeds) {
      for (const Worded& torque : torques_of(drilling)) {
        if (feed.value == 0 && torque.value == 0) continue;
        loads.push_back({joined({feed.word, torque.word}),
                         force_at(drilling.at_mm, feed.value * drilling.axis.normalized()) +
                             torque_about(drilling.axis.normalized(), torque.value)});
      }
    }
    return loads;
  }

  SourceLoads operator()(const model::Insertion& insertion) const {
    const Vector3d along = insertion.along.normalized();
    const Vector3d push_n = insertion.force_n * along;
    if (insertion.side_n == 0) {
      return std::vector<SourceLoad>{{"", force_at(insertion.at_mm, push_n)}};
    }
    std::vector<SourceLoad> loads;
    for (const Vector3d& corner : corners_around_circle(along)) {
      loads.push_back(
          {"side " + label_of(corner), force_at(insertion.at_mm, push_n + insertion.side_n * corner)});
    }
    return loads;
  }

  /// At both ends of each run, since between them the wrench is a mean of theirs.
  SourceLoads operator()(const model::Path& path) const {
    std::vector<SourceLoad> loads;
    if (path.drag_n == 0) {
      for (const Vector3d& p_mm : path.points_mm)
        loads.push_back({std::to_string(loads.size()), force_at(p_mm, path.force_n)});
      return loads;
    }
    for (std::size_t i = 0; i + 1 < path.points_mm.size(); ++i) {
      const Vector3d travel = (path.points_mm[i + 1] - path.points_mm[i]).normalized();
      for (const double way : path.back_and_forth ? std::vector<double>{1, -1} : std::vector<double>{1}) {
        for (const std::size_t at : {i, i + 1}) {
          const std::string label = way > 0 ? fmt::format("{} to {}, at {}", i, i + 1, at)
                                            : fmt::format("{} to {}, at {}", i + 1, i, at);
          loads.push_back({label, force_at(path.points_mm[at], path.force_n + way * path.drag_n * travel)});
        }
      }
    }
    return loads;
  }

  SourceLoads operator()(const model::Milling& milling) const {
    std::vector<SourceLoad> loads;
    const Vector3d axis = milling.axis.normalized();
    for (std::size_t i = 0; i < milling.points_mm.size(); ++i) {
      const std::string point = milling.points_mm.size() > 1 ? fmt::format("at {}", i) : "";
      for (const Vector3d& corner : corners_around_circle(axis)) {
        for (const Worded& axial : either_way(milling.axial_n, "down", "up")) {
          for (const Worded& torque : either_way(milling.torque_nmm, "right torque", "left torque")) {
            loads.push_back({joined({point, label_of(corner), axial.word, torque.word}),
                             force_at(milling.points_mm[i], milling.side_n * corner + axial.value * axis) +
                                 torque_about(axis, torque.value)});
          }
        }
      }
    }
    return loads;
  }
};

struct CountOf {
  std::size_t operator()(const model::Gravity& gravity) const { return gravity.poses.size(); }
  std::size_t operator()(const model::Acceleration& acceleration) const {
    return acceleration.along.size() + (acceleration.every_direction ? corners_around_ball().size() : 0);
  }
  std::size_t operator()(const model::Spray& spray) const {
    return static_cast<std::size_t>(std::max(0, spray.count));
  }
  template <class Mechanical>
  std::size_t operator()(const Mechanical& source) const {
    return LoadsOf{{}}(source)->size();  // needs no body, and is cheap
  }
};

struct KindOf {
  const char* operator()(const model::Gravity&) const { return "gravity"; }
  const char* operator()(const model::Acceleration&) const { return "acceleration"; }
  const char* operator()(const model::Spray&) const { return "spray"; }
  const char* operator()(const model::PointForce&) const { return "force"; }
  const char* operator()(const model::PlainWrench&) const { return "wrench"; }
  const char* operator()(const model::Drilling&) const { return "drilling"; }
  const char* operator()(const model::Insertion&) const { return "insertion"; }
  const char* operator()(const model::Path&) const { return "path"; }
  const char* operator()(const model::Milling&) const { return "milling"; }
};

}  // namespace

std::string name_of(const model::SingleSource& source) {
  const std::string given = std::visit([](const auto& each) { return each.name; }, source);
  return given.empty() ? std::visit(KindOf{}, source) : given;
}

std::string full_name(const std::string& name, const std::string& label) {
  return label.empty() ? name : fmt::format("{}[{}]", name, label);
}

Wrench force_at(const Vector3d& p_mm, const Vector3d& force_n) {
  Wrench wrench;
  wrench << force_n, p_mm.cross(force_n);
  return wrench;
}

base::Expected<std::vector<SourceLoad>> loads_of(const model::SingleSource& source, const Body& body) {
  return std::visit(LoadsOf{body}, source);
}

std::size_t count_of(const model::SingleSource& source) {
  return std::visit(CountOf{}, source);
}

}  // namespace pinjaw::planner
