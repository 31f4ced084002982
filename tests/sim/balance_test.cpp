// Newton's third law over the organ: what tools, bed and plane put on it carries its bile.

#include <gtest/gtest.h>

#include "field_rig.h"
#include "rig.h"
#include "support/long_run.h"

namespace calot {
namespace {

const Vec3 up = Vec3(0.1, -0.2, 0.9).normalized();

/// Equilibrium to 1e-9 of the nodal forces (below 1 N), on some 100 nodes.
constexpr double tight = 1e-9, slack = 1e-7;  // N

TEST(Balance, ForceOnTheToolIsWhatBedAndWeightLeave) {
  CALOT_SLOW_WHEN_SANITIZED("a motion in small steps");
  Field field = test::make_field(test::bedded_ball(), tight, up);
  const Organ& organ = field.organs[0];
  EXPECT_LT((test::bed_force(organ) - test::bile_weight(organ) * up).norm(), slack);

  const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
  const Vec3 fundus = skin[organ.landmarks.at("fundus")];
  const Vec3 out = organ.body->skin_normals(organ.state.x)[organ.landmarks.at("fundus")];
  test::add_grasper(field, fundus + 150e-3 * out);
  const auto expect_balance = [&](const char* when) {
    const Vec3 on_organ = test::bed_force(organ) - test::bile_weight(organ) * up - test::tool_force(field);
    EXPECT_LT(on_organ.norm(), slack) << when;
  };
  ASSERT_EQ(test::move_tip(field, fundus + 15e-3 * out, test::open_jaw), "");
  EXPECT_EQ(test::tool_force(field), Vec3::Zero());
  ASSERT_EQ(test::move_tip(field, fundus - 4e-3 * out, test::open_jaw), "");
  EXPECT_GT(test::tool_force(field).dot(out), 0.1) << "a pressed organ pushes the tool out";
  expect_balance("pressed");
  ASSERT_EQ(test::move_tip(field, fundus - 4e-3 * out, 0.0), "");
  ASSERT_TRUE(field.tools[0].jaw_stopped);
  expect_balance("grasped");
  ASSERT_EQ(test::move_tip(field, fundus + 6e-3 * out, 0.0), "");
  EXPECT_LT(test::tool_force(field).dot(out), -0.5) << "a lifted organ pulls the tool in";
  expect_balance("lifted");
}

TEST(Balance, PlaneAndHeldPoleCarryTheWeightTogether) {
  OrganDefinition organ = test::ball({0, 0, 0.6e-3});
  organ.held = {
      {"top", "fundus", 8e-3, 1e3}};  // soft: the ball sinks onto the plane and is kept from rolling
  const Vec3 vertical = Vec3::UnitZ();
  const Field field = test::make_field(organ, tight, vertical, Plane{Vec3::Zero(), vertical});
  const Organ& placed = field.organs[0];
  ContactLoads now;
  now.shapes = {contact_shape(field.ground[0].shape)};
  Vec3 push = Vec3::Zero();
  for (const ContactForce& contact : contact_forces(*placed.body, placed.state.x, now,
                                                    gather_pairs(*placed.body, placed.state.x, now, 0.0)))
    push += contact.on_shape;
  const double weight = test::bile_weight(placed);
  const double on_plane = -push.z();
  EXPECT_GT(on_plane, 0.2 * weight);
  EXPECT_LT((test::bed_force(placed) - push - weight * vertical).norm(), slack);
  EXPECT_NEAR(push.head<2>().norm(), 0, 1e-12) << "a frictionless plane pushes straight up";
}

TEST(Balance, BallThatNothingHoldsIsAMechanism) {
  SceneDefinition scene;
  scene.anatomy.organs = {test::ball({0, 0, 0.6e-3})};
  for (bool on_plane : {false, true}) {
    if (on_plane) scene.anatomy.support = SupportDefinition{};  // frictionless: free to roll
    const Result<World> world = World::create(scene);
    ASSERT_FALSE(world);
    EXPECT_EQ(world.failure().kind, FailureKind::scenario);
    const std::string text = to_text(world.failure());
    EXPECT_NE(text.find("nothing holds"), std::string::npos) << text;
    EXPECT_NE(text.find("held region"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace calot
