#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "host/planner/planar/crossing.hpp"
#include "host/planner/planar/piece.hpp"

namespace pinjaw::planner::planar {

/// Pieces by the slices of theta they reach into, so that slices can be swept apart: two pieces that overlap
/// (or meet within kThetaGap_rad) are together in the slice where the later one starts, and only there is one
/// of them starting.
class ThetaBins {
 public:
  struct Bin {
    std::vector<const Piece*> starting;
    std::vector<const Piece*> going;
  };

  ThetaBins(double turn_rad, std::size_t count)
      : width_rad_(turn_rad / static_cast<double>(count)), bins_(count) {}

  void add(const Piece& piece) {
    const std::size_t first = index(piece.theta_rad.lo - kThetaGap_rad);
    const std::size_t last = index(piece.theta_rad.hi + kThetaGap_rad);
    bins_[first].starting.push_back(&piece);
    for (std::size_t i = first + 1; i <= last; ++i) bins_[i].going.push_back(&piece);
  }

  [[nodiscard]] const Bin& operator[](std::size_t i) const { return bins_[i]; }
  [[nodiscard]] std::size_t size() const { return bins_.size(); }

 private:
  [[nodiscard]] std::size_t index(double theta_rad) const {
    const double at = std::max(0.0, theta_rad / width_rad_);
    return std::min(bins_.size() - 1, static_cast<std::size_t>(at));
  }

  double width_rad_;
  std::vector<Bin> bins_;
};

}  // namespace pinjaw::planner::planar
