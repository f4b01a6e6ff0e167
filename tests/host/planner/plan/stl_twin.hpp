#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/model/design.hpp"
#include "host/model/task.hpp"
#include "host/part/brep.hpp"
#include "host/planner/plan/candidates.hpp"

/// A part and the same part as a mesh, planned and held against each other.
namespace pinjaw::planner {

/// The shape's binary STL as OpenCASCADE writes it at this deflection, turning by half a radian a chord at
/// most.
std::string stl_of(const part::Shape& shape, double deflection_mm);

/// The only solid of a STEP file.
part::Shape shape_in(const std::string& file);

/// What phases 1 to 4 make of one part file with a kit, from below.
struct Sound {
  model::Task task;
  Scene scene;
  CandidateCounts counts;
  std::vector<model::Design> designs;
};
Sound sound_designs(const std::string& file, const model::Kit& kit);

/// How far two poses of one design may differ. Chosen: each of four feet may be off by a corner's rounding
/// and by how far a fit of a short arc carries it, and pins close together lever that up.
struct PoseTolerance {
  double turn_rad = 1e-3;
  double shift_mm = 0.02;
};

/// For each design of `a` the place of the one in `b` that has the same pins up to shifts of columns and
/// rows, in the same pose; -1 where there is none.
std::vector<int> matches(const std::vector<model::Design>& a, const std::vector<model::Design>& b,
                         const PoseTolerance& tolerance = {});

/// How many of `in`'s designs `other` has, and why it lacks the rest.
struct Share {
  std::size_t designs = 0;
  std::size_t matched = 0;
  std::map<std::string, int> lacking;
};
Share share_of(const Sound& in, const Sound& other);

}  // namespace pinjaw::planner
