// Places on an instrument's parts and distances from them, with their derivatives by the pose.

#include "tools/posed_part.h"

#include "support/derivatives.h"
#include "support/random.h"

namespace calot {
namespace {

class PosedPartOfType : public ::testing::TestWithParam<std::string> {
 protected:
  PosedPartOfType() {
    tool.trocar = Vec3(0.1, -0.02, 0.05);
    tool.geometry = instrument_geometry(*instrument_type_called(GetParam()));
  }
  InstrumentPose random_pose() {
    return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(0.05, 0.25), rng.uniform(-3, 3),
            tool.geometry.has_jaws() ? rng.uniform(0.1, 1) : 0.0};
  }
  /// A point within 20 mm of the hinge, in the part's frame.
  Vec3 random_point() { return test::random_vector(rng, 20e-3); }

  Rng rng{7};
  Tool tool;
};
INSTANTIATE_TEST_SUITE_P(Each, PosedPartOfType, ::testing::ValuesIn(instrument_type_names()),
                         [](const auto& one) { return one.param; });

constexpr double pose_step = 1e-6;  // m, of unknowns and places of 0.01 to 0.25 m

TEST_P(PosedPartOfType, CoordinatesAndPoseAreOneAnother) {
  const InstrumentPose pose = random_pose();
  const ToolVector q = tool_coordinates(pose);
  EXPECT_NEAR(q[0], pose.pitch * turn_lever, 1e-16);
  EXPECT_EQ(q[5], 0);
  EXPECT_LT((tool_coordinates(pose_at(q)) - q).norm(), 1e-16);
}

TEST_P(PosedPartOfType, APlaceOnAPartHasTheDerivativesOfTheFrames) {
  for (int part = 0; part < shapes_per_tool; ++part)
    for (int k = 0; k < 5; ++k) {
      const InstrumentPose pose = random_pose();
      const Vec3 local = random_point(), force = test::random_vector(rng, 1.0);
      const PosedPart posed(tool, pose, part);
      const VecX q = tool_coordinates(pose);
      const Vec3 at = posed.frame() * local;
      // A rod's end is fixed to its shaft; it has no jaw's frame.
      const Pose frame = tool.geometry.has_jaws() ? part_frame(tool, pose, part)
                                                  : hinge_frame(tool.trocar, pose, tool.geometry);
      EXPECT_EQ(at, frame * local);
      const auto work = [&](const VecX& near) {
        return force.dot(PosedPart(tool, pose_at(near), part).frame() * local);
      };
      const auto slope = [&](const VecX& near) -> VecX {
        const PosedPart other(tool, pose_at(near), part);
        return other.slopes(other.frame() * local).transpose() * force;
      };
      EXPECT_LT(test::relative_error(slope(q), test::difference_gradient(work, q, pose_step)), 1e-8);
      EXPECT_LT(
          test::relative_error(posed.curvature(at, force), test::difference_hessian(slope, q, pose_step)),
          1e-7);
      EXPECT_GT(std::abs(slope(q)[3]), 1e-3);  // it does turn with the roll
      EXPECT_EQ(std::abs(slope(q)[4]) > 1e-3, part > 0 && tool.geometry.has_jaws());
    }
}

TEST_P(PosedPartOfType, TheDistanceFromAPartHasItsDerivativesByPlaceAndPose) {
  constexpr double grown = -0.3e-3;
  for (int part = 0; part < shapes_per_tool; ++part)
    for (int k = 0; k < 8; ++k) {
      const InstrumentPose pose = random_pose();
      VecX both(9);
      both << part_frame(tool, pose, part) * random_point(), tool_coordinates(pose);
      const auto at = [&](const VecX& near) {
        return carried_distance(tool, pose_at(near.tail<6>()), part, grown, near.head<3>());
      };
      const CarriedDistance d = at(both);
      EXPECT_NEAR(
          d.distance,
          signed_distance(instrument_shapes(tool.trocar, pose, tool.geometry)[part], both.head<3>()) - grown,
          1e-15);
      const VecX gradient =
          test::difference_gradient([&](const VecX& near) { return at(near).distance; }, both, pose_step);
      const Eigen::MatrixXd hessian = test::difference_hessian(
          [&](const VecX& near) -> VecX { return at(near).gradient; }, both, pose_step);
      EXPECT_LT(test::relative_error(d.gradient, gradient), 1e-7) << part << " " << k;
      EXPECT_LT((d.hessian - hessian).cwiseAbs().maxCoeff(), 1e-5 * (hessian.norm() + 1)) << part << " " << k;
      EXPECT_GT(d.gradient.tail<6>().norm(), 0.1);
      EXPECT_GT(d.hessian.bottomRows<6>().norm(), 0.1);
    }
}

TEST_P(PosedPartOfType, WhatMovesWithThePartKeepsItsDistance) {
  for (int part = 0; part < shapes_per_tool; ++part) {
    const InstrumentPose pose = random_pose();
    const PosedPart posed(tool, pose, part);
    const Vec3 x = posed.frame() * random_point();
    const CarriedDistance d = carried_distance(tool, pose, part, 0, x);
    const ToolVector along = d.gradient.tail<6>() + posed.slopes(x).transpose() * d.gradient.head<3>();
    EXPECT_LT(along.norm(), 1e-14);
  }
}

}  // namespace
}  // namespace calot
