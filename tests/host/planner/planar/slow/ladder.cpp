#include "tests/host/planner/planar/slow/ladder.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace pinjaw::planner::slow {
namespace {

/// How far beyond the ends of its feature a foot is followed; uneven, so that no corner of a part of round
/// measures lies on a grid line.
constexpr double kBeyond_mm = 0.0137;
constexpr double kPush = -0.05;  // chosen: turns less than this within a slide

/// How far apart neighbouring rungs are along a track, at most. Chords then stay within 0.05 mm for parts of
/// 50 mm; the second foot's are closer, so that a way along a diagonal does not run through the corners of
/// cells.
constexpr double kFirstFoot_mm = 0.6;
constexpr double kSecondFoot_mm = 0.53;

/// The places of one foot, cut into equal parts.
struct Axis {
  double from_mm = 0;
  double step_mm = 0;
  int count = 0;

  Axis(const Track& track, double longest_mm) {
    const double beyond_mm = track.closed() ? 0 : kBeyond_mm;
    const double length_mm = track.length_mm() + 2 * beyond_mm;
    from_mm = -beyond_mm;
    count = std::max(1, static_cast<int>(std::ceil(length_mm / longest_mm)));
    step_mm = length_mm / count;
  }
  [[nodiscard]] double line(int i) const { return from_mm + i * step_mm; }
  [[nodiscard]] int cell(double at_mm) const {
    return static_cast<int>(std::floor((at_mm - from_mm) / step_mm));
  }
};

struct Feet {
  double a_mm = 0;
  double b_mm = 0;
};

/// Where a ladder of one length fits between two tracks, cell by cell.
class Fits {
 public:
  Fits(const Track& a, const Track& b, double length_mm)
      : along_a_(a, kFirstFoot_mm), along_b_(b, kSecondFoot_mm) {
    for (int i = 0; i <= along_a_.count; ++i) {
      const double a_mm = along_a_.line(i);
      for (const auto& b_mm : b.places_away(a.centre(a_mm), length_mm)) {
        if (!b_mm) continue;
        for (const int left : {i - 1, i}) add(left, along_b_.cell(*b_mm), {a_mm, *b_mm});
      }
    }
    for (int k = 0; k <= along_b_.count; ++k) {
      const double b_mm = along_b_.line(k);
      for (const auto& a_mm : a.places_away(b.centre(b_mm), length_mm)) {
        if (!a_mm) continue;
        for (const int below : {k - 1, k}) add(along_a_.cell(*a_mm), below, {*a_mm, b_mm});
      }
    }
    std::ranges::sort(found_, {}, &Found::cell);
  }

  /// Calls with both ends of each way through a cell; a cell with several ways gives some too many.
  template <typename Take>
  void each(const Take& take) const {
    for (std::size_t i = 0; i < found_.size(); ++i) {
      for (std::size_t k = i + 1; k < found_.size() && found_[k].cell == found_[i].cell; ++k) {
        take(found_[i].feet, found_[k].feet);
      }
    }
  }

 private:
  struct Found {
    int cell;
    Feet feet;
  };
  void add(int i, int k, const Feet& feet) {
    if (i < 0 || i >= along_a_.count || k < 0 || k >= along_b_.count) return;
    found_.push_back({i * along_b_.count + k, feet});
  }

  Axis along_a_;
  Axis along_b_;
  std::vector<Found> found_;
};

class Slider {
 public:
  Slider(const Task& task, model::JawSide jaw) : task_(task), out_(jaw == model::JawSide::Left ? -1 : 1) {}

  void add(int a, int b, const std::vector<HolePair>& pairs, double length_mm) {
    const Track& on_a = track(a);
    const Track& on_b = track(b);
    Fits(on_a, on_b, length_mm).each([&](const Feet& one, const Feet& other) {
      for (const HolePair& holes : pairs) {
        if (!pushes(on_a, on_b, holes, one) && !pushes(on_a, on_b, holes, other)) continue;
        Slide slide{a, b, holes, rung(on_a, on_b, holes, one), rung(on_a, on_b, holes, other)};
        slide.to.theta_rad = slide.from.theta_rad +
                             std::remainder(slide.to.theta_rad - slide.from.theta_rad, 2 * std::numbers::pi);
        found_.push_back(slide);
      }
    });
  }
  [[nodiscard]] std::vector<Slide> take() { return std::move(found_); }

 private:
  [[nodiscard]] const Track& track(int feature) const {
    return task_.tracks[static_cast<std::size_t>(feature)];
  }
  /// Cosine and sine of theta, by the ladder's directions in the gripper and in the part.
  [[nodiscard]] Vector2d turn(const Track& a, const Track& b, const HolePair& holes, const Feet& feet) const {
    const Vector2d in_gripper = Vector2d(out_ * holes.columns, holes.rows).normalized();
    const Vector2d in_part = (b.centre(feet.b_mm) - a.centre(feet.a_mm)).normalized();
    return {in_gripper.dot(in_part), in_part.x() * in_gripper.y() - in_part.y() * in_gripper.x()};
  }
  [[nodiscard]] bool pushes(const Track& a, const Track& b, const HolePair& holes, const Feet& feet) const {
    const Vector2d cs = turn(a, b, holes, feet);
    const auto push = [&](const Track& track, double at_mm) {
      const Vector2d n = track.outward(track.centre(at_mm));
      return out_ * (cs.x() * n.x() - cs.y() * n.y());
    };
    return push(a, feet.a_mm) > kPush && push(b, feet.b_mm) > kPush;
  }
  [[nodiscard]] Rung rung(const Track& a, const Track& b, const HolePair& holes, const Feet& feet) const {
    const Vector2d cs = turn(a, b, holes, feet);
    const Vector2d q_mm = a.centre(feet.a_mm);
    return {std::atan2(cs.y(), cs.x()),
            Vector2d(cs.y() * q_mm.y() - cs.x() * q_mm.x(), -cs.y() * q_mm.x() - cs.x() * q_mm.y())};
  }

  const Task& task_;
  double out_;
  std::vector<Slide> found_;
};

}  // namespace

std::vector<Slide> slides(const Task& task, model::JawSide jaw) {
  const model::Grid& grid = task.kit.grid;
  std::map<int, std::vector<HolePair>> by_square;
  for (int rows = 0; rows < grid.rows; ++rows) {
    for (int columns = rows == 0 ? 1 : 1 - grid.columns; columns < grid.columns; ++columns) {
      by_square[columns * columns + rows * rows].push_back({columns, rows});
    }
  }
  Slider slider(task, jaw);
  const int count = static_cast<int>(task.tracks.size());
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const auto& tracks = task.tracks;
      if (!tracks[static_cast<std::size_t>(a)].exists() || !tracks[static_cast<std::size_t>(b)].exists())
        continue;
      for (const auto& [square, pairs] : by_square)
        slider.add(a, b, pairs, grid.spacing_mm * std::sqrt(square));
    }
  }
  return slider.take();
}

}  // namespace pinjaw::planner::slow
