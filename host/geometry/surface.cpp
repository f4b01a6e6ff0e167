#include "host/geometry/surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/geometry/ray.hpp"
#include "host/geometry/surface_index.hpp"

namespace pinjaw::geometry {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d unit_or_zero(const Vector3d& v) {
  const double length = v.norm();
  return length > 0 ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

}  // namespace

Surface::Index::Index(TriangleMesh source) : mesh(std::move(source)) {
  std::vector<Facet> given;
  std::vector<Box> given_boxes;
  given.reserve(mesh.triangles.size());
  given_boxes.reserve(mesh.triangles.size());
  for (const auto& corners : mesh.triangles) {
    Facet facet;
    for (std::size_t i = 0; i < 3; ++i)
      facet.p_mm[i] = mesh.vertices_mm[static_cast<std::size_t>(corners[i])];
    facet.normal = unit_or_zero((facet.p_mm[1] - facet.p_mm[0]).cross(facet.p_mm[2] - facet.p_mm[0]));
    facet.triangle = static_cast<int>(given.size());
    given_boxes.push_back(facet.box());
    box.include(given_boxes.back());
    given.push_back(facet);
  }
  tree = Bvh(given_boxes);
  facets.reserve(given.size());
  boxes.reserve(given.size());
  spans.reserve(given.size());
  for (const int i : tree.order()) {
    facets.push_back(given[static_cast<std::size_t>(i)]);
    boxes.push_back(given_boxes[static_cast<std::size_t>(i)]);
    spans.emplace_back(facets.back());
  }
  index_silhouettes();
}

void Surface::Index::index_silhouettes() {
  std::vector<Link> given;
  std::vector<Box> link_boxes;
  for (const Silhouette& line : mesh.silhouettes) {
    for (std::size_t i = 1; i < line.points_mm.size(); ++i) {
      given.push_back(
          {line.points_mm[i - 1], line.points_mm[i], std::max(line.radius_mm[i - 1], line.radius_mm[i])});
      link_boxes.emplace_back();
      link_boxes.back().include(line.points_mm[i - 1]);
      link_boxes.back().include(line.points_mm[i]);
    }
  }
  links_tree = Bvh(link_boxes);
  for (const int i : links_tree.order()) links.push_back(given[static_cast<std::size_t>(i)]);
}

Hit Surface::Index::hit_of(const Facet& facet, double distance_mm, const Vector3d& p_mm) const {
  const auto at = static_cast<std::size_t>(facet.triangle);
  return {distance_mm, p_mm, facet.normal, facet.triangle, at < mesh.face_of.size() ? mesh.face_of[at] : 0};
}

std::optional<Hit> Surface::Index::lowest_hit(const std::pair<double, const Facet*>& found,
                                              const Vector2d& p_mm) const {
  const auto& [z_mm, facet] = found;
  if (facet == nullptr) return std::nullopt;
  return hit_of(*facet, z_mm - box.lo.z(), {p_mm.x(), p_mm.y(), z_mm});
}

Surface::Surface(TriangleMesh mesh) : index_(std::make_shared<const Index>(std::move(mesh))) {}

double Surface::lowest_z_mm(const Sweep& region, const Slab& slab) const {
  return lowest(*index_, Stadium(region), slab);
}

double Surface::highest_z_mm(const Sweep& region, const Slab& slab) const {
  return highest(*index_, Stadium(region), slab);
}

bool Surface::meets(const Sweep& region, const Slab& slab) const {
  return geometry::meets(*index_, Stadium(region), slab);
}

bool Surface::meets(const Rectangle& region, const Slab& slab) const {
  return geometry::meets(*index_, Oblong(region), slab);
}

std::optional<Hit> Surface::lowest_above(const Vector2d& p_mm) const {
  return index_->lowest_hit(lowest_facet(*index_, Stadium({p_mm, p_mm, 0})), p_mm);
}

std::optional<Hit> Surface::first_hit(const Ray& ray) const {
  const RayTest test(ray);
  double nearest_mm = kInfinity;
  const Facet* hit = nullptr;
  index_->tree.walk(
      [&](const Bvh::Node& node) {
        const double entry_mm = test.entry_mm(node.box);
        return entry_mm > nearest_mm || !std::isfinite(entry_mm);
      },
      [&](const Bvh::Node& a, const Bvh::Node& b) { return test.entry_mm(a.box) < test.entry_mm(b.box); },
      [&](const Bvh::Node& node) {
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
          const Facet& facet = index_->facets[static_cast<std::size_t>(i)];
          const auto distance_mm = test.distance_mm(facet);
          if (!distance_mm || *distance_mm > nearest_mm) continue;
          if (*distance_mm == nearest_mm && hit != nullptr && facet.triangle > hit->triangle) continue;
          nearest_mm = *distance_mm;
          hit = &facet;
        }
        return false;
      });
  if (hit == nullptr) return std::nullopt;
  return index_->hit_of(*hit, nearest_mm, ray.origin_mm + nearest_mm * ray.direction);
}

std::optional<double> Surface::silhouette_z_mm(const Vector2d& p_mm, double z_mm, double depth_mm) const {
  constexpr double kMargin = 1.5;
  const Stadium near({p_mm, p_mm, depth_mm});
  std::optional<double> nearest_mm;
  index_->links_tree.walk(
      [&](const Bvh::Node& node) { return !near.may_meet(node.box); },
      [](const Bvh::Node&, const Bvh::Node&) { return true; },
      [&](const Bvh::Node& node) {
        for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
          const Index::Link& link = index_->links[static_cast<std::size_t>(i)];
          const Vector2d along_mm = (link.b_mm - link.a_mm).head<2>();
          const double squared = along_mm.squaredNorm();
          const double t =
              squared > 0 ? std::clamp(along_mm.dot(p_mm - link.a_mm.head<2>()) / squared, 0.0, 1.0) : 0.0;
          const Vector3d foot_mm = link.a_mm + t * (link.b_mm - link.a_mm);
          if ((foot_mm.head<2>() - p_mm).norm() > depth_mm) continue;
          const double away_mm = std::abs(foot_mm.z() - z_mm);
          if (away_mm > kMargin * std::sqrt(2 * link.radius_mm * depth_mm)) continue;
          if (!nearest_mm || away_mm < std::abs(*nearest_mm - z_mm)) nearest_mm = foot_mm.z();
        }
        return false;
      });
  return nearest_mm;
}

const TriangleMesh& Surface::mesh() const {
  return index_->mesh;
}
Interval Surface::x_range_mm() const {
  return {index_->box.lo.x(), index_->box.hi.x()};
}
Interval Surface::y_range_mm() const {
  return {index_->box.lo.y(), index_->box.hi.y()};
}
Interval Surface::z_range_mm() const {
  return {index_->box.lo.z(), index_->box.hi.z()};
}

}  // namespace pinjaw::geometry
