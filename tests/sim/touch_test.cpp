// Where skin touches: on the instrument's surface, however hard it is pressed, and nowhere far inside it.

#include <gtest/gtest.h>

#include "field_rig.h"
#include "motion/settle_field.h"
#include "rig.h"
#include "support/long_run.h"
#include "support/random.h"

namespace calot {
namespace {

constexpr double most_gap = 0.05e-3, most_sinking = 0.1e-3;  // m, what the project asks for

/// What was seen of all touched points after every part of a motion.
struct Touch {
  double lowest = 1, highest = -1;  ///< m, true distance from the instrument
  double deepest = 0;               ///< m, of the skin between them too
  int points = 0;
};

void look(const Field& field, Touch& touch) {
  const Organ& organ = field.organs[0];
  const Tool& tool = field.tools[0];
  const ContactLoads now = contact_loads(field, organ, present_poses(field));
  const std::vector<Shape> made = instrument_shapes(tool.trocar, tool.pose, tool.geometry);
  const auto pairs = gather_pairs(*organ.body, organ.state.x, now, -contact_margin);
  for (const ContactForce& contact : contact_forces(*organ.body, organ.state.x, now, pairs)) {
    const double distance = signed_distance(made[contact.shape], contact.at);
    touch.lowest = std::min(touch.lowest, distance);
    touch.highest = std::max(touch.highest, distance);
    ++touch.points;
  }
  touch.deepest = std::max(touch.deepest, deepest_penetration(field));
}

/// A ball and a grasper that comes along `out` from its fundus, or across it.
struct Handled {
  Field field;
  Vec3 fundus, out, across;
  Touch touch;

  Handled(int levels, bool from_the_side) : field(make(levels)) {
    const Organ& organ = field.organs[0];
    const int row = organ.landmarks.at("fundus");
    fundus = organ.body->skin_point(row, organ.state.x);
    out = organ.body->skin_normals(organ.state.x)[row];
    across = out.unitOrthogonal();
    test::add_grasper(
        field, from_the_side ? Vec3(fundus + 20e-3 * out - 150e-3 * across) : Vec3(fundus + 150e-3 * out));
  }
  static Field make(int levels) {
    return test::make_field(test::bedded_ball(), 1e-6, Vec3::UnitZ(), {}, levels);
  }
  void go(const Vec3& tip, double jaw, int parts) {
    for (int k = 1; k <= parts; ++k) {
      const InstrumentPose to = pose_reaching(field.tools[0].trocar, tip, 0, jaw);
      const InstrumentPose next = interpolate(field.tools[0].pose, to, 1.0 / (parts - k + 1));
      SolveStatistics statistics;
      const auto events = advance(field, {next}, statistics);
      ASSERT_TRUE(events) << to_text(events.failure());
      look(field, touch);
    }
  }
  void expect_on_the_surface() const {
    EXPECT_GT(touch.points, 50) << "nothing was touched";
    EXPECT_GT(touch.lowest, -most_gap);
    EXPECT_LT(touch.highest, most_gap);
    EXPECT_LT(touch.deepest, most_sinking);
  }
};

class TouchedPoints : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(WithLevels, TouchedPoints, ::testing::Values(0, 1));

TEST_P(TouchedPoints, LieOnTheInstrumentThatPushesThem) {
  CALOT_SLOW_WHEN_SANITIZED("looks at every contact of three motions");
  Handled pushed(GetParam(), false);
  pushed.go(pushed.fundus + 5e-3 * pushed.out, 0, 1);
  pushed.go(pushed.fundus - 8e-3 * pushed.out, 0, 6);
  pushed.go(pushed.fundus - 8e-3 * pushed.out + 4e-3 * pushed.across, 0, 4);
  pushed.expect_on_the_surface();
}

TEST_P(TouchedPoints, LieOnTheShaftThatLiesAcrossThem) {
  CALOT_SLOW_WHEN_SANITIZED("looks at every contact of three motions");
  Handled crossed(GetParam(), true);
  const Vec3 beyond = crossed.fundus + 50e-3 * crossed.across;
  crossed.go(beyond + 20e-3 * crossed.out, 0, 2);
  crossed.go(beyond - 4e-3 * crossed.out, 0, 8);
  crossed.expect_on_the_surface();
}

TEST_P(TouchedPoints, LieOnTheJawsThatGraspThem) {
  CALOT_SLOW_WHEN_SANITIZED("looks at every contact of three motions");
  Handled grasped(GetParam(), false);
  grasped.go(grasped.fundus + 15e-3 * grasped.out, test::open_jaw, 1);
  grasped.go(grasped.fundus - 4e-3 * grasped.out, test::open_jaw, 5);
  grasped.go(grasped.fundus - 4e-3 * grasped.out, 0, 6);
  EXPECT_TRUE(grasped.field.tools[0].jaw_stopped);
  grasped.go(grasped.fundus + 4e-3 * grasped.out, 0, 4);
  grasped.expect_on_the_surface();
}

TEST(ContactPoints, StandForAllOfTheSkin) {
  const Field field = Handled::make(0);
  const ShellBody& body = *field.organs[0].body->as_shell();
  double skin = 0, felt = 0;
  for (const Triangle& t : body.skin().triangles)
    skin += 0.5 * (body.skin_rest()[t[1]] - body.skin_rest()[t[0]])
                      .cross(body.skin_rest()[t[2]] - body.skin_rest()[t[0]])
                      .norm();
  for (int point = 0; point < contacts_each * static_cast<int>(body.skin().triangles.size()); ++point) {
    EXPECT_GT(body.contact_area(point), 0);
    felt += body.contact_area(point);
  }
  EXPECT_NEAR(felt / skin, 1, 1e-12);  // rounding
}

TEST(ContactPoints, LieEvenlyOnTheirTriangles) {
  Field field = Handled::make(1);
  Organ& organ = field.organs[0];
  test::extend(field, {organ.landmarks.at("fundus")});
  VecX x = organ.state.x;
  for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += 1e-3 * std::sin(static_cast<double>(i));
  const std::vector<Vec3> skin = organ.body->skin_positions(x);
  ContactPlaces places(organ.body->skin(), x);
  // Half as far apart as the corners of the equal triangles that they are the middles of, at most.
  const double apart = 0.5 * organ.body->as_shell()->widest_skin_gap() / contact_parts;
  for (int triangle : {0, 777, static_cast<int>(organ.body->skin().triangles.size()) - 1}) {
    const Triangle& t = organ.body->skin().triangles[triangle];
    Vec3 sum = Vec3::Zero();
    double least = 1;
    for (int point = triangle * contacts_each; point < (triangle + 1) * contacts_each; ++point) {
      const Vec3& weights = contact_weights(point);
      EXPECT_GT(weights.minCoeff(), 0);
      EXPECT_NEAR(weights.sum(), 1, 1e-15);
      const Vec3 at = weights[0] * skin[t[0]] + weights[1] * skin[t[1]] + weights[2] * skin[t[2]];
      EXPECT_LT((places.at(point) - at).norm(), 1e-15);  // m, rounding
      sum += at / contacts_each;
      for (int other = triangle * contacts_each; other < point; ++other)
        least = std::min(least, (places.at(other) - at).norm());
    }
    EXPECT_LT((sum - (skin[t[0]] + skin[t[1]] + skin[t[2]]) / 3.0).norm(), 1e-15);
    EXPECT_GT(least, 0.1 * apart);
  }
}

TEST(ContactPoints, BringForcesToTheNodesWithTheirVirtualWork) {
  Field field = Handled::make(1);
  Organ& organ = field.organs[0];
  test::extend(field, {organ.landmarks.at("fundus")});
  const VecX& x = organ.state.x;
  Rng rng(3);
  VecX move(x.size());
  for (double& d : move) d = rng.uniform(-1e-3, 1e-3);
  VecX nodes = VecX::Zero(x.size());
  BlockMatrix matrix = organ.body->pattern();
  matrix.set_zero();
  ContactLoad load(organ.body->skin(), nodes);
  ContactStiffness stiffness(organ.body->skin(), matrix);
  ContactPlaces moves(organ.body->skin(), move);
  double work = 0, squared = 0;
  const int last = contacts_each * static_cast<int>(organ.body->skin().triangles.size());
  for (int point = 5; point < last; point += point % 7 == 0 ? 1 : 211) {
    const Vec3 force = test::random_vector(rng, 1.0), way = moves.at(point);
    const Mat3 h = force * force.transpose() + 0.3 * Mat3::Identity();
    load.add(point, force);
    stiffness.add(point, h);
    work += force.dot(way);
    squared += way.dot(h * way);
  }
  load.finish();
  stiffness.finish();
  EXPECT_GT(std::abs(work), 1e-4);  // J
  EXPECT_NEAR(nodes.dot(move), work, 1e-12);
  EXPECT_NEAR(move.dot(matrix.multiply(move)), squared, 1e-12 * squared);
}

}  // namespace
}  // namespace calot
