#include "host/geometry/surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/geometry/bvh.hpp"
#include "host/geometry/facet.hpp"
#include "host/geometry/ray.hpp"

namespace pinjaw::geometry {

struct Surface::Index {
  TriangleMesh mesh;
  Box box;
  std::vector<Facet> facets;       ///< in the order of the tree's leaves
  std::vector<Box> boxes;          ///< theirs
  std::vector<ShadowSpans> spans;  ///< theirs
  Bvh tree{{}};
  /// Two neighbouring points of a silhouette, in the order of the leaves of their tree.
  struct Link {
    Vector3d a_mm, b_mm;
    double radius_mm;
  };
  std::vector<Link> links;
  Bvh links_tree{{}};

  explicit Index(TriangleMesh source);
  void index_silhouettes();

  /// Calls leaf(facet) for facets that may meet the region and the slab [slab.lo, slab.hi]; `slab` may shrink
  /// while the walk goes on. Stops where leaf returns true.
  template <class Region, class First, class Leaf>
  void visit(const Region& region, const Slab& slab, First&& first, Leaf&& leaf) const;
  [[nodiscard]] Hit hit_of(const Facet& facet, double distance_mm, const Vector3d& p_mm) const;
  template <class Region>
  [[nodiscard]] double lowest(const Region& region, Slab slab) const;
  /// The lowest z and its facet; of facets as low the first of the mesh.
  template <class Region>
  [[nodiscard]] std::pair<double, const Facet*> lowest_facet(const Region& region) const;
  template <class Region>
  [[nodiscard]] double highest(const Region& region, Slab slab) const;
  template <class Region>
  [[nodiscard]] bool meets(const Region& region, const Slab& slab) const;
};

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3d unit_or_zero(const Vector3d& v) {
  const double length = v.norm();
  return length > 0 ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

/// `z` cut to the slab; empty where nothing is left.
Interval within(const Interval& z, const Slab& slab) {
  return {std::max(z.lo, slab.lo_mm), std::min(z.hi, slab.hi_mm)};
}

constexpr auto kLowerFirst = [](const Bvh::Node& a, const Bvh::Node& b) {
  return a.box.lo.z() < b.box.lo.z();
};
constexpr auto kHigherFirst = [](const Bvh::Node& a, const Bvh::Node& b) {
  return a.box.hi.z() > b.box.hi.z();
};

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

template <class Region, class First, class Leaf>
void Surface::Index::visit(const Region& region, const Slab& slab, First&& first, Leaf&& leaf) const {
  const auto outside = [&](const Box& candidate) {
    return candidate.lo.z() > slab.hi_mm || candidate.hi.z() < slab.lo_mm || !region.may_meet(candidate);
  };
  tree.walk([&](const Bvh::Node& node) { return outside(node.box); }, first,
            [&](const Bvh::Node& node) {
              const auto end = static_cast<std::size_t>(node.first + node.count);
              for (auto i = static_cast<std::size_t>(node.first); i < end; ++i) {
                if (outside(boxes[i]) || !region.may_meet(facets[i]) || spans[i].apart_from(region)) continue;
                if (leaf(facets[i])) return true;
              }
              return false;
            });
}

Hit Surface::Index::hit_of(const Facet& facet, double distance_mm, const Vector3d& p_mm) const {
  const auto at = static_cast<std::size_t>(facet.triangle);
  return {distance_mm, p_mm, facet.normal, facet.triangle, at < mesh.face_of.size() ? mesh.face_of[at] : 0};
}

template <class Region>
double Surface::Index::lowest(const Region& region, Slab slab) const {
  double best = kInfinity;
  visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi) return false;
    best = z.lo;
    slab.hi_mm = std::nextafter(z.lo, -kInfinity);  // what is as low need not be looked at
    return best <= slab.lo_mm;
  });
  return best;
}

template <class Region>
std::pair<double, const Facet*> Surface::Index::lowest_facet(const Region& region) const {
  Slab slab;
  std::pair<double, const Facet*> best{kInfinity, nullptr};
  visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi || z.lo > best.first) return false;
    if (z.lo == best.first && best.second != nullptr && facet.triangle > best.second->triangle) return false;
    best = {z.lo, &facet};
    slab.hi_mm = z.lo;
    return false;
  });
  return best;
}

template <class Region>
double Surface::Index::highest(const Region& region, Slab slab) const {
  double best = -kInfinity;
  visit(region, slab, kHigherFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    if (z.lo > z.hi) return false;
    best = z.hi;
    slab.lo_mm = std::nextafter(z.hi, kInfinity);  // what is as high need not be looked at
    return best >= slab.hi_mm;
  });
  return best;
}

template <class Region>
bool Surface::Index::meets(const Region& region, const Slab& slab) const {
  bool met = false;
  visit(region, slab, kLowerFirst, [&](const Facet& facet) {
    const Interval z = within(z_range_over(facet, region), slab);
    met = z.lo <= z.hi;
    return met;
  });
  return met;
}

Surface::Surface(TriangleMesh mesh) : index_(std::make_shared<const Index>(std::move(mesh))) {}

double Surface::lowest_z_mm(const Sweep& region, const Slab& slab) const {
  return index_->lowest(Stadium(region), slab);
}

double Surface::highest_z_mm(const Sweep& region, const Slab& slab) const {
  return index_->highest(Stadium(region), slab);
}

bool Surface::meets(const Sweep& region, const Slab& slab) const {
  return index_->meets(Stadium(region), slab);
}

bool Surface::meets(const Rectangle& region, const Slab& slab) const {
  return index_->meets(Oblong(region), slab);
}

std::optional<Hit> Surface::lowest_above(const Vector2d& p_mm) const {
  const auto [z_mm, facet] = index_->lowest_facet(Stadium({p_mm, p_mm, 0}));
  if (facet == nullptr) return std::nullopt;
  return index_->hit_of(*facet, z_mm - index_->box.lo.z(), {p_mm.x(), p_mm.y(), z_mm});
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
