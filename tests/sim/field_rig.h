#pragma once
// The field below the world: where held points, bed forces and supports can be looked at.

#include "acts/advance.h"
#include "base/units.h"
#include "field/grip.h"
#include "motion/structural_extension.h"
#include "motion/tool_loads.h"
#include "organs/body_kinds.h"
#include "rig.h"

namespace calot::test {

/// A ball of 20 mm radius with 61 nodes whose lowest point is the neck.
inline OrganDefinition ball(const Vec3& neck = Vec3::Zero()) {
  OrganDefinition organ;
  organ.shape = SphereShape{20e-3};
  organ.nodes = 61;
  organ.neck = neck;
  organ.fundus = neck + Vec3(0, 0, 40e-3);
  return organ;
}
/// The same, grown on by its base.
inline OrganDefinition held_ball() {
  OrganDefinition organ = ball();
  organ.held = {{"base", "neck", 10e-3, 1e6}};
  return organ;
}

/// One organ and, at `trocar`, one grasper pulled far back.
inline Field make_field(const OrganDefinition& definition, double tolerance, const Vec3& up,
                        const std::optional<Plane>& support = {}, int levels = 0) {
  Field field;
  field.tolerance = tolerance;
  if (support) field.ground.push_back({"support", *support, 0, false});
  ContactLoads still;
  if (support) still.shapes.push_back(contact_shape(*support));
  field.add(make_organ(definition, still, up, tolerance, levels).value());
  return field;
}

/// Lays extensions around skin points of the first organ without seeking the equilibrium that follows.
inline void extend(Field& field, const std::vector<int>& centres) {
  Organ& organ = field.organs[0];
  organ.extensions.clear();
  for (int row : centres) organ.extensions.push_back({0, row});
  const ShellBody& shell = *organ.body->as_shell();
  ShellBody next = shell.with_details(details_around(shell, organ.extensions)).value();
  organ.state.x = shell.coordinates_in(next, organ.state.x);
  organ.state.shares.clear();  // free at once
  organ.state.fading_load.resize(0);
  organ.body = std::make_shared<const ShellBody>(std::move(next));
  field.group.forget_bodies();
}

inline void add_grasper(Field& field, const Vec3& trocar) {
  Tool tool;
  tool.definition.name = "left";
  tool.trocar = trocar;
  tool.pose = pose_reaching(trocar, trocar - 1e-3 * Vec3::UnitZ(), 0, 0);  // the shaft above it
  tool.pose.insertion = 0;
  field.tools.push_back(tool);
}

/// Moves the first grasper's tip in `parts` even parts. The failure's text, empty when it arrived.
inline std::string move_tip(Field& field, const Vec3& tip, double jaw, int parts = 4, double roll = 0) {
  const InstrumentPose from = field.tools[0].pose, to = pose_reaching(field.tools[0].trocar, tip, roll, jaw);
  for (int k = 1; k <= parts; ++k) {
    SolveStatistics statistics;
    const auto events = advance(field, {interpolate(from, to, static_cast<double>(k) / parts)}, statistics);
    if (!events) return to_text(events.failure());
  }
  return {};
}

/// A scene's first organ, and its first instrument outside of the fundus.
struct FundusField {
  Field field;
  Vec3 fundus, out;  ///< and the way to the trocar

  explicit FundusField(const SceneDefinition& scene) {
    const World world = World::create(scene).value();  // for the landmark and up
    field = make_field(scene.anatomy.organs[0], 1e-6, world.up());
    add_grasper(field, world.port_position("right_subcostal"));
    field.tools[0].definition = scene.instruments[0];
    fundus = world.landmark(scene.anatomy.organs[0].name + ".fundus");
    out = (field.tools[0].trocar - fundus).normalized();
  }
  /// The tip to `height` (m) above the fundus, as move_tip.
  std::string reach(double height, double jaw, int parts = 4) {
    return move_tip(field, fundus + height * out, jaw, parts);
  }
  /// Open jaws come down on the fundus and close on it.
  std::string grasp() {
    for (const auto& [height, jaw] : {std::pair{15e-3, open_jaw}, {-4e-3, open_jaw}, {-4e-3, 0.0}})
      if (const std::string why = reach(height, jaw); !why.empty()) return why;
    return field.tools[0].jaw_stopped ? "" : "the jaws are empty";
  }
};

/// Force of the bed and other held regions on the organ, N.
inline Vec3 bed_force(const Organ& organ) {
  const Links& bed = organ.body->as_shell()->foundation();
  const StencilTable& table = organ.body->as_shell()->bed_points();
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < bed.row.size(); ++i)
    sum += bed.stiffness[i] * (bed.target[i] - blend(table, table.value, bed.row[i], organ.state.x));
  return sum;
}

/// Weight of the organ's bile, N.
inline double bile_weight(const Organ& organ) {
  return organ.body->as_shell()->bile()->specific_weight() *
         organ.body->as_shell()->bile()->volume(organ.state.x);
}

/// Force of the tissue on the first tool, N.
inline Vec3 tool_force(const Field& field) { return tool_loads(field)[0].force; }

}  // namespace calot::test
