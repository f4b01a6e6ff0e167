#include "host/planner/plan/scene.hpp"

#include "host/config/read.hpp"

namespace pinjaw::planner {

namespace {

/// The part of a source, a profile read from its file where the source does not carry it.
base::Expected<part::Part> read(model::PartSource source, const part::Selection& selection = {}) {
  const std::string ending = source.file.extension().string();
  if (!source.profile && (ending == ".yaml" || ending == ".yml")) {
    auto profile = config::read_profile(source.file);
    if (!profile) return base::failure(base::render(profile.error(), "no part"));
    source.profile = std::move(*profile);
  }
  return part::read_part(source, selection);
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

geometry::Surface turned_surface(part::Part part, geometry::Surface surface, model::Side side) {
  part.surface = std::move(surface);
  return part::turned(part, side).surface;
}

}  // namespace

base::Expected<Scene> read_scene(const model::Task& task) {
  auto part = read(task.part);
  if (!part) return tl::unexpected(part.error());
  part::Part turned = part::turned(*part, task.side);
  Scene scene{std::move(*part), std::move(turned), {}, {}};

  if (task.attached) {
    model::PartSource source = task.part;
    source.file = task.attached->file;
    source.density_g_cm3.reset();  // only its shape is asked for, and an open mesh has no mass
    const auto rest = read(source, {.base = task.attached->base, .rest = true});
    if (!rest) return tl::unexpected(rest.error());
    scene.attached.push_back(turned_surface(*rest, rest->surface, task.side));
  }
  for (const model::Obstacle& obstacle : task.obstacles) {
    model::PartSource source;
    source.file = obstacle.file;
    const auto body = read(source);
    if (!body) return tl::unexpected(body.error());
    scene.obstacles.push_back(turned_surface(*body, placed(*body, obstacle), task.side));
  }
  return scene;
}

}  // namespace pinjaw::planner
