#include "host/planner/force/closure.hpp"

#include <array>
#include <cmath>

namespace pinjaw::planner {
namespace {

using geometry::cross;

constexpr double kMargin = 1e-9;  // relative; a boundary case is not closure, so it is not discarded

/// Nguyen: each contact sees the other inside its friction cone, squeezing inwards or spreading outwards.
bool two_contacts_close(const PlanarContact& a, const PlanarContact& b, double mu) {
  const Vector2d d = b.p_mm - a.p_mm;
  const double margin = kMargin * d.norm();
  const double a_normal = a.normal.dot(d);
  const double a_slip = std::abs(cross(a.normal, d));
  const double b_normal = -b.normal.dot(d);
  const double b_slip = std::abs(cross(b.normal, d));
  const bool between = a_slip < mu * a_normal - margin && b_slip < mu * b_normal - margin;
  const bool spread = a_slip < -mu * a_normal - margin && b_slip < -mu * b_normal - margin;
  return between || spread;
}

/// The edge rays of every cone as unit vectors (force, torque about the mean / extent).
std::vector<Vector3d> edge_rays(const std::vector<PlanarContact>& contacts, double mu) {
  Vector2d mean = Vector2d::Zero();
  for (const PlanarContact& contact : contacts) mean += contact.p_mm / static_cast<double>(contacts.size());
  double extent = 0;
  for (const PlanarContact& contact : contacts) extent = std::max(extent, (contact.p_mm - mean).norm());
  std::vector<Vector3d> rays;
  if (extent <= 0) return rays;
  for (const PlanarContact& contact : contacts) {
    const Vector2d tangent(-contact.normal.y(), contact.normal.x());
    for (const double slope : {mu, -mu}) {
      const Vector2d force = contact.normal + slope * tangent;
      rays.push_back(Vector3d(force.x(), force.y(), cross(contact.p_mm - mean, force) / extent).normalized());
    }
  }
  return rays;
}

/// Whether rays positively span space: every plane through two of them has some ray strictly on each side.
bool rays_span(const std::vector<Vector3d>& rays) {
  bool some_plane = false;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    for (std::size_t j = i + 1; j < rays.size(); ++j) {
      const Vector3d& a = rays[i];
      const Vector3d& b = rays[j];
      const Vector3d normal(a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(),
                            a.x() * b.y() - a.y() * b.x());
      if (normal.norm() < kMargin) continue;
      some_plane = true;
      bool above = false;
      bool below = false;
      for (const Vector3d& ray : rays) {
        above = above || normal.dot(ray) > kMargin;
        below = below || normal.dot(ray) < -kMargin;
      }
      if (!above || !below) return false;
    }
  }
  return some_plane;
}

}  // namespace

std::optional<PointContact> jamming_contact(const Grasp& grasp) {
  for (const PointContact& contact : grasp.contacts) {
    const double closing = squeeze_share(grasp, contact, {contact.n_P.x(), contact.n_P.y(), 0});
    if (closing <= grasp.mu * std::abs(cross(grasp.x_P, contact.n_P))) return contact;
  }
  return std::nullopt;
}

bool planar_force_closure(const std::vector<PlanarContact>& contacts, double mu) {
  if (contacts.size() < 2) return false;
  if (contacts.size() == 2) return two_contacts_close(contacts[0], contacts[1], mu);
  return rays_span(edge_rays(contacts, mu));
}

std::optional<model::JawSide> wedging_jaw(const Grasp& grasp) {
  for (const model::JawSide jaw : {model::JawSide::Left, model::JawSide::Right}) {
    std::vector<PlanarContact> contacts;
    int pin = -1;
    for (const PointContact& contact : grasp.contacts) {
      if (contact.jaw != jaw || contact.pin == pin) continue;
      pin = contact.pin;
      contacts.push_back({contact.p_P_mm.head<2>(), contact.n_P});
    }
    if (planar_force_closure(contacts, grasp.mu)) return jaw;
  }
  return std::nullopt;
}

}  // namespace pinjaw::planner
