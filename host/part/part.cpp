#include "host/part/part.hpp"

#include <cmath>

#include "host/base/files.hpp"
#include "host/base/sha256.hpp"
#include "host/part/brep.hpp"
#include "host/part/brep_packing.hpp"
#include "host/part/cad_process.hpp"
#include "host/part/placing.hpp"
#include "host/part/selected.hpp"
#include "host/part/stl_part.hpp"

namespace pinjaw::part {
namespace {

constexpr double kKgPerMm3AtOneGPerCm3 = 1e-6;

/// CAD systems fill in product names of their own, so only a name that the caller asked for counts.
std::string name_of(const model::PartSource& source, const Selection& selection) {
  if (source.profile) return source.profile->name;
  return selection.base.empty() || selection.rest ? source.file.stem().string() : selection.base;
}

double mass_kg(const model::PartSource& source, double volume_mm3) {
  if (source.mass_kg) return *source.mass_kg;
  return source.density_g_cm3.value_or(0) * volume_mm3 * kKgPerMm3AtOneGPerCm3;
}

/// The profile as it lies in plan under `rotation`; nothing where it no longer does.
std::optional<model::Profile> profile_in_plan(const std::optional<model::Profile>& profile,
                                              const Eigen::Matrix3d& rotation) {
  if (!profile || rotation.isIdentity(0)) return profile;
  if (rotation == upright_rotation(-Vector3d::UnitZ())) return mirrored(*profile, 1);
  return std::nullopt;
}

/// Everything of `source` that OpenCASCADE has to be asked.
base::Expected<BrepValues> brep_values(const model::PartSource& source, const std::string& bytes,
                                       const Selection& selection, const base::IsolatedStage& stage) {
  const std::string file = source.file.string();
  stage("reading its solids");
  const auto solids = chosen_solids(source, bytes, selection);
  if (!solids) return tl::unexpected(solids.error());
  auto values = values_of(solids->all, solids->chosen, source.up, stage);
  if (!values) return base::failure(file + ": " + values.error().message);
  return values;
}

/// The same, asked where OpenCASCADE can do no harm.
base::Expected<BrepValues> values_in_cad_process(const model::PartSource& source, const std::string& bytes,
                                                 const Selection& selection) {
  const std::string file = source.file.string();
  const auto answer = in_cad_process(file, [&](const base::IsolatedStage& stage) {
    return brep_values(source, bytes, selection, stage).map([](const BrepValues& values) {
      return packed(values);
    });
  });
  if (!answer) return tl::unexpected(answer.error());
  auto values = unpacked(*answer);
  if (!values) return base::failure(file + ": " + values.error().message);
  return values;
}

base::Expected<Part> read_brep(const model::PartSource& source, const std::string& bytes,
                               const Selection& selection) {
  auto values = values_in_cad_process(source, bytes, selection);
  if (!values) return tl::unexpected(values.error());
  const Eigen::Matrix3d rotation = upright_rotation(source.up);
  Part part = placed(std::move(*values), rotation);
  part.profile = profile_in_plan(source.profile, rotation);
  return part;
}

base::Expected<Part> read_mesh(const model::PartSource& source, const std::string& bytes,
                               const Selection& selection) {
  const std::string file = source.file.string();
  const auto solids = read_stl(bytes, file, kMostTriangles);
  if (!solids) return tl::unexpected(solids.error());
  const auto chosen = selected(*solids, selection, file);
  if (!chosen) return tl::unexpected(chosen.error());
  auto part = stl_part(*solids, *chosen, upright_rotation(source.up));
  if (!part) return base::failure(file + ": " + part.error().message);
  if (part->volume_mm3 <= 0 && source.density_g_cm3 && !source.mass_kg) {
    const std::string why = part->mesh_counts->closed()
                                ? "encloses no volume"
                                : "has " + std::to_string(part->mesh_counts->open_edges) + " open edges";
    return base::failure(file + ": its mesh " + why +
                         ", so no material can tell its mass; state mass_kg instead");
  }
  return part;
}

}  // namespace

base::Expected<Part> read_part(const model::PartSource& source, const Selection& selection) {
  const std::string file = source.file.string();
  if (!(source.up.norm() > 0) || !source.up.allFinite()) return base::failure(file + ": up has no direction");
  const auto bytes = base::read_file(source.file, kMostFileBytes);
  if (!bytes) return base::failure(file + ": " + bytes.error().message);
  auto part = has_brep(source) ? read_brep(source, *bytes, selection) : read_mesh(source, *bytes, selection);
  if (!part) return part;
  part->file = source.file;
  part->mass_kg = mass_kg(source, part->volume_mm3);
  part->name = name_of(source, selection);
  part->sha256 = base::sha256(*bytes);
  return part;
}

Eigen::Matrix3d rotation_to(model::Side side) {
  if (side == model::Side::Below) return Eigen::Matrix3d::Identity();
  return Vector3d(-1, 1, -1).asDiagonal();
}

Part turned(const Part& part, model::Side side) {
  if (side == model::Side::Below) return part;
  const Eigen::Matrix3d rotation = rotation_to(side);
  Part result = part;
  result.surface = geometry::Surface(rotated(part.surface.mesh(), rotation));
  for (EdgeCurve& edge : result.edges) edge.curve = rotated(edge.curve, rotation);
  for (Wall& wall : result.walls) {
    wall.curve = mirrored(wall.curve, 0);
    wall.z_mm = {-wall.z_mm.hi, -wall.z_mm.lo};
  }
  for (Contour& contour : result.contours) {
    contour.curve = mirrored(contour.curve, 0);
    for (Vector3d& p : contour.trace_mm) p = rotation * p;
  }
  if (result.profile) result.profile = mirrored(*result.profile, 0);
  result.centroid_mm = rotation * part.centroid_mm;
  return result;
}

Eigen::Matrix3d upright_rotation(const Vector3d& up) {
  const Vector3d u = up.normalized();
  constexpr double kOpposite = 1e-12;  // 1 + cos of the turn below which the shortest turn is not unique
  if (1 + u.z() < kOpposite) return Vector3d(1, -1, -1).asDiagonal();
  Eigen::Matrix3d cross;  // of u x z
  cross << 0, 0, -u.x(), 0, 0, -u.y(), u.x(), u.y(), 0;
  return Eigen::Matrix3d::Identity() + cross + cross * cross / (1 + u.z());
}

}  // namespace pinjaw::part
