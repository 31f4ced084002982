// A tool that is drawn over the skin: what it feels changes as evenly as it moves.

#include <gtest/gtest.h>

#include <set>

#include "field/field_state.h"
#include "field_rig.h"
#include "motion/settle_field.h"
#include "support/long_run.h"

namespace calot {
namespace {

/// A grasper drawn over a ball along a line.
struct DrawnGrasper {
  Field field;
  Vec3 from, way;
  std::set<int> faces;  ///< touched so far
  double range = 0;     ///< N, largest force so far

  explicit DrawnGrasper(int levels)
      : field(test::make_field(test::bedded_ball(), 1e-6, Vec3::UnitZ(), {}, levels)) {
    const Organ& organ = field.organs[0];
    const Vec3 top = organ.body->skin_point(organ.landmarks.at("fundus"), organ.state.x);
    test::add_grasper(field, top + Vec3(-10e-3, 60e-3, 150e-3));
    from = top + Vec3(-9e-3, -2e-3, -3e-3);
    way = Vec3(18e-3, 5e-3, 0);
    field.tools[0].pose = pose_reaching(field.tools[0].trocar, from + Vec3(0, 0, 5e-3), 0.3, 0);
    EXPECT_EQ(test::move_tip(field, from, 0, 20, 0.3), "");
  }
  /// The force after a motion to a share of the way, N.
  Vec3 force_at(double share) {
    EXPECT_EQ(test::move_tip(field, from + share * way, 0, 1, 0.3), "");
    const Vec3 force = test::tool_force(field);
    range = std::max(range, force.norm());
    return force;
  }
  void look_at_faces() {
    const Organ& organ = field.organs[0];
    const ContactLoads now = contact_loads(field, organ, present_poses(field));
    const auto pairs = gather_pairs(*organ.body, organ.state.x, now, -contact_margin);
    for (const ContactForce& contact : contact_forces(*organ.body, organ.state.x, now, pairs))
      faces.insert(contact.point / contacts_each / organ.body->triangles_each());
  }
};

/// The largest change of force, N, over the pieces of a part of the way, each as short as `finest` (m) or of less
/// change than `enough` (N): a piece that changes more is taken back and gone over again in halves. `force`: that
/// where the part begins, then that where it ends.
double largest_change(DrawnGrasper& drawn, double begin, double end, Vec3& force, double finest,
                      double enough) {
  const FieldState before = field_state(drawn.field);
  const Vec3 there = drawn.force_at(end);
  const double change = (there - force).norm();
  if (change < enough || (end - begin) * drawn.way.norm() <= finest) {
    force = there;
    return change;
  }
  restore(drawn.field, before);
  const double middle = 0.5 * (begin + end);
  const double first = largest_change(drawn, begin, middle, force, finest, enough);
  return std::max(first, largest_change(drawn, middle, end, force, finest, enough));
}

class SlidingContact : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(WithLevels, SlidingContact, ::testing::Values(1, 2));

TEST_P(SlidingContact, AcrossFacesHasNoJumpOfForce) {
  CALOT_SLOW_WHEN_SANITIZED("a thousand motions");
  // In steps of 5 um what changes evenly changes by 0.05 % of the range in the median, and by up to 0.6 % where the
  // wall passes from one edge of the jaws' blunt end to the other.
  constexpr double finest = 5e-6, coarsest = 40e-6;  // m
  DrawnGrasper drawn(GetParam());
  Vec3 force = test::tool_force(drawn.field);
  ASSERT_GT(force.norm(), 0.1);
  const double enough = 0.01 * force.norm();
  const int parts = static_cast<int>(std::ceil(drawn.way.norm() / coarsest));
  double jump = 0;  // N
  for (int k = 0; k < parts; ++k) {
    const double begin = static_cast<double>(k) / parts, end = static_cast<double>(k + 1) / parts;
    jump = std::max(jump, largest_change(drawn, begin, end, force, finest, enough));
    drawn.look_at_faces();
  }
  EXPECT_GT(drawn.range, 0.2);
  EXPECT_GE(drawn.faces.size(), 5u);
  EXPECT_LT(jump, 0.01 * drawn.range);  // what the project asks for
  RecordProperty("jump_pct", std::to_string(100 * jump / drawn.range));
}

}  // namespace
}  // namespace calot
