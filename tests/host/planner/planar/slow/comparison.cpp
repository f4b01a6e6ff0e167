#include "tests/host/planner/planar/slow/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace pinjaw::planner::slow {
namespace {

using Holes = std::vector<model::Hole>;

Holes holes_of(const Stand& stand) {
  Holes holes;
  for (const Pin& pin : stand.pins) holes.push_back(pin.hole);
  return holes;
}

std::vector<int> labels_of(const Stand& stand) {
  std::vector<int> labels;
  for (const Pin& pin : stand.pins) labels.push_back(pin.feature);
  return labels;
}

bool same_pose(const Stand& p, const Stand& q) {
  return std::abs(std::remainder(p.theta_rad - q.theta_rad, 2 * std::numbers::pi)) < 1e-7 &&
         std::abs(p.y_mm - q.y_mm) < 1e-6 && std::abs(p.x_mm[0] - q.x_mm[0]) < 1e-6 &&
         std::abs(p.x_mm[1] - q.x_mm[1]) < 1e-6;
}

std::string told(const Stand& stand, double margin) {
  std::string text = fmt::format("theta {:.9f} span {:.9f} y {:.6f} margin {:.3g}:", stand.theta_rad,
                                 span_mm(stand), stand.y_mm, margin);
  for (const Pin& pin : stand.pins) {
    text += fmt::format(" {}{},{} on {}", pin.hole.jaw == model::JawSide::Left ? 'L' : 'R', pin.hole.column,
                        pin.hole.row, pin.feature);
  }
  return text;
}

/// A pose of one list with all its labels in the other.
struct Pose {
  Stand stand;
  bool ours = false;
  bool certain = false;  ///< the slow search has it beyond doubt under some label
  double margin = 0;
  std::vector<int> label;              ///< ours
  std::vector<std::vector<int>> sure;  ///< labels that are beyond doubt
};

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
  parts += other.parts;
  fixtures += other.fixtures;
  borderlines += other.borderlines;
  overlooked += other.overlooked;
  disagreements.insert(disagreements.end(), other.disagreements.begin(), other.disagreements.end());
  return *this;
}

Tally compare(const Task& task, const std::vector<PlanarFixture>& ours, const std::string& name) {
  Tally tally;
  tally.parts = 1;
  const auto complain = [&](const std::string& what, const Stand& stand, double margin) {
    tally.disagreements.push_back(fmt::format("{}: {}: {}", name, what, told(stand, margin)));
  };
  std::map<Holes, std::vector<Pose>> poses;
  for (const PlanarFixture& fixture : ours) {
    const Stand stand = stand_of(fixture);
    const Verdict verdict = slow::verdict(task, stand);
    ++tally.fixtures;
    if (!verdict.fixture && !verdict.borderline) complain("is no fixture", stand, verdict.closure_margin);
    if (std::abs(verdict.closure_margin - fixture.closure_margin) > 1e-7)
      complain(fmt::format("margin is told as {}", fixture.closure_margin), stand, verdict.closure_margin);
    if (canonical(task, stand).pins != stand.pins)
      complain("is not canonical", stand, verdict.closure_margin);
    auto& group = poses[holes_of(stand)];
    if (std::ranges::any_of(group, [&](const Pose& other) { return same_pose(other.stand, stand); }))
      complain("is there twice", stand, verdict.closure_margin);
    group.push_back(
        {stand, true, verdict.fixture && !verdict.borderline, verdict.closure_margin, labels_of(stand), {}});
  }
  for (const Found& found : search(task)) {
    auto& group = poses[holes_of(found.stand)];
    auto it =
        std::ranges::find_if(group, [&](const Pose& pose) { return same_pose(pose.stand, found.stand); });
    if (it == group.end()) {
      group.push_back({found.stand, false, false, found.verdict.closure_margin, {}, {}});
      it = std::prev(group.end());
    }
    if (!found.verdict.borderline) it->sure.push_back(labels_of(found.stand));
  }
  for (const auto& [holes, group] : poses) {
    for (const Pose& pose : group) {
      if (!pose.ours && !pose.sure.empty()) complain("the slow search alone has", pose.stand, pose.margin);
      if (!pose.ours && pose.sure.empty()) ++tally.borderlines;
      if (pose.ours && !pose.certain) ++tally.borderlines;
      if (pose.ours && pose.certain && pose.sure.empty()) ++tally.overlooked;
      if (pose.ours && !pose.sure.empty() && *std::ranges::min_element(pose.sure) < pose.label)
        complain("has a smaller label", pose.stand, pose.margin);
    }
  }
  return tally;
}

}  // namespace pinjaw::planner::slow
