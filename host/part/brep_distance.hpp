#pragma once

#include <memory>

#include "host/part/brep.hpp"
#include "host/part/exact.hpp"

/// Distances to exact faces. Private to host/part; OpenCASCADE's exceptions come out.
namespace pinjaw::part {

/// A shape's faces at a pose, and how far columns are from them.
class ExactFaces {
 public:
  ExactFaces(const Shape& shape, const Eigen::Isometry3d& pose);
  ~ExactFaces();

  /// As ExactDistance and ExactHeight define it.
  [[nodiscard]] double distance_mm(const Column& column) const;
  [[nodiscard]] double height_mm(const Column& column, End end, double guess_mm) const;
  [[nodiscard]] double tolerance_mm() const;

 private:
  struct Held;
  std::unique_ptr<const Held> held_;
};

}  // namespace pinjaw::part
