#include "host/planner/force/grasp.hpp"

namespace pinjaw::planner {

Grasp grasp_of(const model::Design& design, double mu) {
  Grasp grasp;
  grasp.mu = mu;
  const geometry::Pose2 X_PG = design.part_pose.inverse();
  grasp.x_P = X_PG.turned(Vector2d::UnitX());
  for (std::size_t pin = 0; pin < design.pins.size(); ++pin) {
    const model::PinDesign& of = design.pins[pin];
    const Vector2d p_P_mm = X_PG * of.contact_mm;
    PointContact contact;
    contact.n_P = X_PG.turned(of.normal);
    contact.jaw = of.hole.jaw;
    contact.pin = static_cast<int>(pin);
    contact.p_P_mm = {p_P_mm.x(), p_P_mm.y(), of.contact_z_mm.lo};
    grasp.contacts.push_back(contact);
    if (of.contact_z_mm.hi > of.contact_z_mm.lo) {
      contact.p_P_mm.z() = of.contact_z_mm.hi;
      grasp.contacts.push_back(contact);
    }
  }
  return grasp;
}

double squeeze_share(const Grasp& grasp, const PointContact& contact, const Vector3d& force_P) {
  const double along_x = grasp.x_P.dot(force_P.head<2>());
  return contact.jaw == model::JawSide::Left ? along_x : -along_x;
}

}  // namespace pinjaw::planner
