#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Pnt.hxx>
#include <memory>

#include "host/part/brep.hpp"

/// Our values as OpenCASCADE's, and back.
namespace pinjaw::planner {

inline gp_Pnt point(const geometry::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

inline part::Shape held(const TopoDS_Shape& shape) {
  return std::make_shared<const TopoDS_Shape>(shape);
}

}  // namespace pinjaw::planner
