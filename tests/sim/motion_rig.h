#pragma once
// Fields whose organs move by their masses.

#include "body/inertia.h"
#include "body/rod_body.h"
#include "field_rig.h"

namespace calot::test {

inline OrganDefinition heavy(OrganDefinition organ) {
  organ.wall.density = 1050;
  return organ;
}

/// A small heavy ball that nothing holds, unstressed and full, its lowest point `height` above the origin.
inline Field free_ball(double height, double step_time, const std::optional<Plane>& support = {}) {
  const OrganDefinition definition = heavy(ball(Vec3(0, 0, height)));
  OrganDefinition held = definition;
  held.held = {{"base", "neck", 10e-3, 1e6}};
  const Field like = make_field(held, 1e-6, Vec3::UnitZ());
  ShellBody::Setup setup;
  setup.control = like.organs[0].body->as_shell()->control();
  setup.material.membrane = {definition.wall.shear_modulus, definition.wall.thickness};
  setup.material.bending = {definition.wall.shear_modulus, definition.wall.thickness};
  setup.bile = definition.bile;
  setup.wall_density = definition.wall.density;
  const auto body = std::make_shared<const ShellBody>(ShellBody::create(setup).value());
  Field field;
  if (support) field.ground.push_back({"support", *support, 0, false});
  field.step_time = step_time;
  Organ organ(definition, body);
  organ.state.volume = body->bile()->volume(body->rest());
  field.add({organ, NewtonWorkspace(body->pattern())});
  return field;
}

/// Gives an organ nodal velocities, m/s, as if it had come from where they say in the last `duration` s.
inline void set_moving(Organ& organ, const VecX& velocity, double duration) {
  const BodyState& state = organ.state;
  MotionPart part{{state.x - duration * velocity, velocity, Vec3::Zero()}, duration};
  organ.state.motion = part;
  part.begin.centroid = present_motion(*organ.body, state).centroid;
  organ.state.motion = part;
}

/// Nodal velocities of a field of velocities, m/s, at the nodes' places.
template <class Velocity>
VecX velocities(const VecX& x, const Velocity& velocity) {
  VecX out(x.size());
  for (Eigen::Index i = 0; i < x.size(); i += 3) out.segment<3>(i) = velocity(Vec3(x.segment<3>(i)));
  return out;
}

/// Of wall and liquid, kg m/s, as it moves now.
inline Vec3 momentum(const Organ& organ) {
  const LiquidMotion motion = present_motion(*organ.body, organ.state);
  const VecX of_wall = organ.body->mass()->multiply(motion.velocity);
  Vec3 sum = organ.definition.bile.density * organ.state.volume * motion.centroid;
  for (Eigen::Index i = 0; i < of_wall.size(); i += 3) sum += of_wall.segment<3>(i);
  return sum;
}

/// Of the wall and liquid, kg.
inline double mass_of(const Organ& organ) {
  const VecX ones = VecX::Ones(organ.state.x.size());
  return ones.dot(organ.body->mass()->multiply(ones)) / 3 +
         (organ.body->liquid() ? organ.definition.bile.density * organ.state.volume : 0.0);
}

/// A step in which no tool moves; the failure's text, empty when it went well.
inline std::string wait(Field& field, SolveStatistics& statistics) {
  const auto events = advance(field, present_poses(field), statistics);
  return events ? std::string() : to_text(events.failure());
}
inline std::string wait(Field& field) {
  SolveStatistics statistics;
  return wait(field, statistics);
}

}  // namespace calot::test
