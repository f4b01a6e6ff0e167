#include "host/planner/plan/scene.hpp"

#include "host/config/read.hpp"

namespace pinjaw::planner {

namespace {

/// The source with its profile, where its file holds one.
base::Expected<model::PartSource> with_profile(model::PartSource source) {
  const std::string ending = source.file.extension().string();
  if (!source.profile && (ending == ".yaml" || ending == ".yml")) {
    auto profile = config::read_profile(source.file);
    if (!profile) return base::failure(base::render(profile.error(), "no part"));
    source.profile = std::move(*profile);
  }
  return source;
}

/// Reads a body, and remembers among `bodies` what it is made of.
base::Expected<part::Part> read(std::vector<part::ExactBody>& bodies, part::ExactBody body) {
  auto source = with_profile(std::move(body.source));
  if (!source) return tl::unexpected(source.error());
  body.source = std::move(*source);
  auto part = part::read_part(body.source, body.selection);
  bodies.push_back(std::move(body));
  return part;
}

/// The part with its surface at `pose` and `z_mm` in the part frame.
geometry::Surface placed(const part::Part& part, const model::Obstacle& at) {
  geometry::TriangleMesh mesh = part.surface.mesh();
  mesh.silhouettes.clear();  // nothing grips an obstacle
  for (geometry::Vector3d& p_mm : mesh.vertices_mm) {
    const geometry::Vector2d plan = at.pose * geometry::Vector2d(p_mm.head<2>());
    p_mm = {plan.x(), plan.y(), p_mm.z() + at.z_mm};
  }
  for (geometry::Vector3d& normal : mesh.normals)
    normal.head<2>() = at.pose.turned(geometry::Vector2d(normal.head<2>()));
  return geometry::Surface(std::move(mesh));
}

/// Pose of a body that stands at `at` in the part frame, in the frame turned by the side.
Eigen::Isometry3d pose_of(const model::Obstacle& at, model::Side side) {
  Eigen::Isometry3d X_PB = Eigen::Isometry3d::Identity();
  X_PB.translate(geometry::Vector3d(at.pose.t_mm.x(), at.pose.t_mm.y(), at.z_mm));
  X_PB.rotate(Eigen::AngleAxisd(at.pose.theta_rad, geometry::Vector3d::UnitZ()));
  return Eigen::Isometry3d(part::rotation_to(side)) * X_PB;
}

geometry::Surface turned_surface(part::Part part, geometry::Surface surface, model::Side side) {
  part.surface = std::move(surface);
  return part::turned(part, side).surface;
}

}  // namespace

std::vector<geometry::Surface> others_of(const Scene& scene) {
  std::vector<geometry::Surface> others = scene.attached;
  others.insert(others.end(), scene.obstacles.begin(), scene.obstacles.end());
  return others;
}

base::Expected<Scene> read_scene(const model::Task& task) {
  std::vector<part::ExactBody> bodies;
  auto part = read(bodies, {task.part, {}, pose_of({}, task.side)});
  if (!part) return tl::unexpected(part.error());
  part::Part turned = part::turned(*part, task.side);
  Scene scene{std::move(*part), std::move(turned), {}, {}};

  if (task.attached) {
    model::PartSource source = task.part;
    source.file = task.attached->file;
    source.density_g_cm3.reset();  // only its shape is asked for, and an open mesh has no mass
    const part::Selection selection{.base = task.attached->base, .rest = true};
    const auto rest = read(bodies, {std::move(source), selection, pose_of({}, task.side)});
    if (!rest) return tl::unexpected(rest.error());
    scene.attached.push_back(turned_surface(*rest, rest->surface, task.side));
  }
  for (const model::Obstacle& obstacle : task.obstacles) {
    model::PartSource source;
    source.file = obstacle.file;
    const auto body = read(bodies, {std::move(source), {}, pose_of(obstacle, task.side)});
    if (!body) return tl::unexpected(body.error());
    scene.obstacles.push_back(turned_surface(*body, placed(*body, obstacle), task.side));
  }
  scene.bodies = std::move(bodies);
  return scene;
}

}  // namespace pinjaw::planner
