#pragma once
// A closed jaw that lies flat on a ball, is pressed down on it and drawn along its own shaft.

#include "field_rig.h"
#include "motion/rubbing.h"
#include "motion/settle_field.h"

namespace calot::test {

/// A taut ball that hangs by its lower half, so that it can neither roll nor fall over.
inline OrganDefinition taut_ball(int nodes) {
  OrganDefinition organ;
  organ.name = "ball";
  organ.shape = SphereShape{20e-3};
  organ.nodes = nodes;
  organ.neck = {0, 0, 0};
  organ.fundus = {0, 0, 40e-3};
  organ.held = {{"base", "neck", 20e-3, 1e7}};
  organ.bile.fill_pressure = 1500;
  return organ;
}

struct Slide {
  Field field;
  SolveStatistics statistics;
  Vec3 top;               ///< of the ball at rest, m
  double height = 10e-3;  ///< of the jaws' lower side over the ball's top, m
  double way = 0;         ///< along the shaft, m
  double work = 0;        ///< of the tool on the tissue so far, J, by the trapezoidal rule

  explicit Slide(double friction, int nodes = 40)
      : field(make_field(taut_ball(nodes), 1e-6, -Vec3::UnitZ())) {
    top = organ().body->skin_point(organ().landmarks.at("fundus"), organ().state.x);
    add_grasper(field, top - 150e-3 * Vec3::UnitY());
    field.tools[0].definition.friction = friction;
    field.tools[0].pose = pose();
  }
  const Organ& organ() const { return field.organs[0]; }

  InstrumentPose pose() const {
    const Tool& tool = field.tools[0];
    const Vec3 tip = top + Vec3(0, 10e-3 + way, tool.geometry.jaw_thickness + height);
    return pose_reaching(tool.trocar, tip, 90 * units::deg, 0);
  }
  /// Evenly; the failure's text, empty when it arrived.
  std::string go(double to_height, double to_way, int steps) {
    const double h = height, w = way;
    for (int k = 1; k <= steps; ++k) {
      height = h + k * (to_height - h) / steps;
      way = w + k * (to_way - w) / steps;
      const ToolLoad load = tool_loads(field)[0];
      const InstrumentPose from = field.tools[0].pose;
      const auto events = advance(field, {pose()}, statistics);
      if (!events) return to_text(events.failure());
      add_work(load, tool_loads(field)[0], part_motion(field.tools[0], from, field.tools[0].pose, 0));
    }
    return {};
  }
  std::string press(int steps = 5) {
    const std::string why = go(1.2e-3, 0, 1);
    return why.empty() ? go(-4e-3, 0, steps) : why;
  }

  /// Sums over the contact points that touch.
  struct Contact {
    double normal = 0;          ///< N, of the lengths
    double rubbing = 0;         ///< N, of the lengths
    double beyond = 0;          ///< N, what rubbing exceeds friction times normal by
    Vec3 push = Vec3::Zero();   ///< N, of the skin on the tool
    Vec3 along = Vec3::Zero();  ///< N, of the skin on the tool, what rubs of it
  };
  Contact contact() const {
    Contact out;
    const ContactLoads now = contact_loads(field, organ(), present_poses(field));
    const std::vector<ContactPair> pairs = gather_pairs(*organ().body, organ().state.x, now, -contact_margin);
    for (const ContactForce& force : contact_forces(*organ().body, organ().state.x, now, pairs)) {
      const RubbingPoint* point = now.friction.find(force.shape, force.point);
      const Vec3 rub = point ? point->hold.sample(force.at).gradient : Vec3(Vec3::Zero());
      out.normal += force.on_shape.norm();
      out.rubbing += rub.norm();
      out.beyond += std::max(0.0, rub.norm() - field.tools[0].definition.friction * force.on_shape.norm());
      out.push += force.on_shape;
      out.along += rub;
    }
    return out;
  }

 private:
  /// A rigid motion takes the trocar's place by `shift` and turns about it.
  void add_work(const ToolLoad& a, const ToolLoad& b, const Pose& motion) {
    const Vec3 shift = motion * field.tools[0].trocar - field.tools[0].trocar;
    const Eigen::AngleAxisd turn(motion.linear());
    work -=
        0.5 * (a.force + b.force).dot(shift) + 0.5 * (a.moment + b.moment).dot(turn.angle() * turn.axis());
  }
};

}  // namespace calot::test
