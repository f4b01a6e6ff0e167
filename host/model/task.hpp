#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/model/disturbance.hpp"
#include "host/model/kit.hpp"
#include "host/model/profile.hpp"
#include "host/model/robust.hpp"

namespace pinjaw::model {

enum class Side { Below, Above };
enum class FrictionModel { Pyramid, Cone };

/// Where a part comes from and how it stands.
struct PartSource {
  std::filesystem::path file;  ///< absolute, or relative to the working folder: already resolved
  Vector3d up = Vector3d::UnitZ();
  std::optional<double> mass_kg;        ///< exactly one of these two
  std::optional<double> density_g_cm3;  ///< from the material
  std::string material;
  std::optional<Profile> profile;  ///< of a `profile` file, read by config; nothing for STEP
};

struct Obstacle {
  std::filesystem::path file;
  geometry::Pose2 pose;  ///< in the part frame
  double z_mm = 0;
};

struct Attached {
  std::filesystem::path file;
  std::string base;  ///< product name of the base part's solid in that file
};

/// What pins may be made of, and their static friction on a task's part.
struct PinMaterial {
  std::string name;
  double friction = 0;
};

/// One planning job: a part, a kit, the side it is reached from, and what the grip must resist.
struct Task {
  std::string name;
  PartSource part;
  Kit kit;
  Side side = Side::Below;
  double friction = 0;                     ///< static coefficient
  std::vector<PinMaterial> pin_materials;  ///< of the friction table that the task names; else none
  std::vector<DisturbanceSource> always;
  std::vector<DisturbanceSource> disturbances;
  std::vector<Obstacle> obstacles;
  std::optional<Attached> attached;
  Ranges ranges;
};

}  // namespace pinjaw::model
