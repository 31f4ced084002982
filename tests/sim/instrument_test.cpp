#include "tools/instrument.h"

#include <gtest/gtest.h>

#include "base/rng.h"
#include "base/units.h"
#include "body/contact_points.h"

namespace calot {
namespace {

using units::deg;
using units::mm;

const Vec3 trocar(-80 * mm, 70 * mm, -5 * mm);
const InstrumentGeometry geometry;
constexpr double rounding = 1e-15;  // m, of coordinates below a metre after a few operations

InstrumentPose random_instrument(Rng& rng) {
  InstrumentPose pose;
  pose.pitch = rng.uniform(-70 * deg, 70 * deg);
  pose.yaw = rng.uniform(-70 * deg, 70 * deg);
  pose.insertion = rng.uniform(40 * mm, geometry.max_insertion);
  pose.roll = rng.uniform(-180 * deg, 180 * deg);
  pose.jaw = rng.uniform(0, geometry.jaw_opening);
  return pose;
}

Vec3 random_vector(Rng& rng) { return {rng.uniform(-1, 1), rng.uniform(-1, 1), rng.uniform(-1, 1)}; }

Shape part(const InstrumentPose& pose, int index) {
  return instrument_shapes(trocar, pose, geometry)[static_cast<std::size_t>(index)];
}

TEST(Instrument, PitchLiftsTheTipCephaladAndYawTurnsItToThePatientsLeft) {
  InstrumentPose pose;
  pose.insertion = 100 * mm;
  const auto tip = [&] { return Vec3(tip_position(trocar, pose, geometry) - trocar); };
  EXPECT_LT((tip() - Vec3(0, 0, -100 * mm)).norm(), rounding);
  pose.pitch = 30 * deg;
  EXPECT_LT((tip() - 100 * mm * Vec3(0, std::sin(30 * deg), -std::cos(30 * deg))).norm(), rounding);
  pose.pitch = 0;
  pose.yaw = 30 * deg;
  EXPECT_LT((tip() - 100 * mm * Vec3(std::sin(30 * deg), 0, -std::cos(30 * deg))).norm(), rounding);
  // Yaw turns about the pitched shaft's own y axis: pitched by 90 deg the shaft points cephalad, and so stays
  // in xy.
  pose.pitch = 90 * deg;
  EXPECT_LT((tip() - 100 * mm * Vec3(std::sin(30 * deg), std::cos(30 * deg), 0)).norm(), rounding);
}

TEST(Instrument, FramesAreRightHandedAndTheHingeFrameLooksAlongTheShaft) {
  Rng rng(1);
  for (int trial = 0; trial < 200; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const Pose hinge = hinge_frame(trocar, pose, geometry);
    for (const Pose& frame :
         {hinge, jaw_frame(trocar, pose, geometry, 0), jaw_frame(trocar, pose, geometry, 1)}) {
      EXPECT_LT((frame.linear().transpose() * frame.linear() - Mat3::Identity()).norm(), 1e-14);
      EXPECT_NEAR(frame.linear().determinant(), 1.0, 1e-14);
      EXPECT_LT((frame.translation() - hinge.translation()).norm(), rounding);
    }
    const Vec3 along = hinge.linear().col(2);
    EXPECT_LT((trocar + along * (pose.insertion - geometry.jaw_length) - hinge.translation()).norm(),
              rounding);
  }
}

TEST(Instrument, OpeningTheJawsMovesNeitherHingeNorHandle) {
  Rng rng(2);
  for (int trial = 0; trial < 50; ++trial) {
    const InstrumentPose open = random_instrument(rng);
    InstrumentPose closed = open;
    closed.jaw = 0;
    EXPECT_EQ(hinge_frame(trocar, open, geometry).matrix(), hinge_frame(trocar, closed, geometry).matrix());
    EXPECT_EQ(handle_position(trocar, open, geometry), handle_position(trocar, closed, geometry));
    EXPECT_NEAR((tip_position(trocar, closed, geometry) - trocar).norm(), closed.insertion, rounding);
  }
}

TEST(Instrument, PoseReachingPutsTheTipAtItsTarget) {
  Rng rng(3);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vec3 target = trocar + 200 * mm * random_vector(rng);
    const double roll = rng.uniform(-3, 3), jaw = rng.uniform(0, geometry.jaw_opening);
    const InstrumentPose pose = pose_reaching(trocar, target, roll, jaw);
    EXPECT_EQ(pose.roll, roll);
    EXPECT_EQ(pose.jaw, jaw);
    EXPECT_LT((tip_position(trocar, pose, geometry) - target).norm(), rounding);
  }
}

TEST(Instrument, PoseReachingUndoesTipPosition) {
  Rng rng(4);
  for (int trial = 0; trial < 1000; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const InstrumentPose back =
        pose_reaching(trocar, tip_position(trocar, pose, geometry), pose.roll, pose.jaw);
    EXPECT_NEAR(back.insertion, pose.insertion, rounding);
    // Coordinates rounded to 1e-17 m at 10 mm depth and more turn the shaft by 1e-15 a share of cos(yaw).
    EXPECT_NEAR(back.pitch, pose.pitch, 1e-13);
    EXPECT_NEAR(back.yaw, pose.yaw, 1e-13);
  }
}

TEST(Instrument, ATipInTheTrocarIsReachedPointingStraightDown) {
  const InstrumentPose pose = pose_reaching(trocar, trocar, 0.3, 0.5);
  EXPECT_EQ(pose.pitch, 0.0);
  EXPECT_EQ(pose.yaw, 0.0);
  EXPECT_LT((tip_position(trocar, pose, geometry) - trocar).norm(), rounding);
}

TEST(Instrument, TheTipIsTheMiddleOfThePadEnds) {
  Rng rng(5);
  for (int trial = 0; trial < 200; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const Vec3 pad_end(0, 0, geometry.jaw_length);
    const Vec3 middle =
        (jaw_frame(trocar, pose, geometry, 0) * pad_end + jaw_frame(trocar, pose, geometry, 1) * pad_end) / 2;
    EXPECT_LT((middle - tip_position(trocar, pose, geometry)).norm(), rounding);
  }
}

TEST(Instrument, JawsOpenSymmetricallyByTheJawAngle) {
  Rng rng(6);
  for (int trial = 0; trial < 100; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const Pose hinge = hinge_frame(trocar, pose, geometry);
    const Vec3 first = hinge.linear().transpose() * jaw_frame(trocar, pose, geometry, 0).linear().col(2);
    const Vec3 second = hinge.linear().transpose() * jaw_frame(trocar, pose, geometry, 1).linear().col(2);
    EXPECT_LT((first - Vec3(std::sin(pose.jaw / 2), 0, std::cos(pose.jaw / 2))).norm(),
              1e-14);  // rounding of turns
    EXPECT_LT((second - Vec3(-first.x(), first.y(), first.z())).norm(), 1e-14);
    for (int point = 0; point < 10; ++point) {
      const Vec3 x = 15 * mm * random_vector(rng), mirrored(-x.x(), x.y(), x.z());
      EXPECT_NEAR(signed_distance(part(pose, 1), hinge * x), signed_distance(part(pose, 2), hinge * mirrored),
                  rounding);
    }
  }
}

TEST(Instrument, AJawFillsExactlyItsThicknessWidthAndLength) {
  Rng rng(7);
  for (int trial = 0; trial < 20; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const double t = geometry.jaw_thickness, w = geometry.jaw_width, l = geometry.jaw_length;
    for (const int jaw : {0, 1}) {
      const Pose frame = jaw_frame(trocar, pose, geometry, jaw);
      for (const Vec3& face : {Vec3(0, 0, l / 2), Vec3(t, 0, l / 2), Vec3(t / 2, w / 2, l / 2),
                               Vec3(t / 2, -w / 2, l / 2), Vec3(t / 2, 0, 0), Vec3(t / 2, 0, l)})
        EXPECT_NEAR(signed_distance(part(pose, 1 + jaw), frame * face), 0.0, rounding);
      const DistanceSlope pad = distance_slope(part(pose, 1 + jaw), frame * Vec3(-1 * mm, 0, l / 2));
      EXPECT_NEAR(pad.distance, 1 * mm, rounding);
      EXPECT_LT((pad.gradient + frame.linear().col(0)).norm(), 1e-12);  // out of the pad is the frame's -x
    }
  }
}

TEST(Instrument, ClosedPadsCoincideOverTheirWholeFlatFaces) {
  Rng rng(8);
  for (int trial = 0; trial < 50; ++trial) {
    InstrumentPose pose = random_instrument(rng);
    pose.jaw = 0;
    const double flat_width = geometry.jaw_width / 2 - geometry.jaw_rounding;
    const Vec3 on_pad(0, rng.uniform(-flat_width, flat_width),
                      rng.uniform(geometry.jaw_rounding, geometry.jaw_length - geometry.jaw_rounding));
    const Vec3 x = hinge_frame(trocar, pose, geometry) * on_pad;
    EXPECT_NEAR(signed_distance(part(pose, 1), x), 0.0, rounding);
    EXPECT_NEAR(signed_distance(part(pose, 2), x), 0.0, rounding);
  }
}

TEST(Instrument, TheShaftRunsFromTheHandleThroughTheTrocarAndStopsAtTheHinge) {
  Rng rng(9);
  for (int trial = 0; trial < 100; ++trial) {
    const InstrumentPose pose = random_instrument(rng);
    const Shape shaft = part(pose, 0);
    EXPECT_NEAR(signed_distance(shaft, trocar), -geometry.shaft_radius, rounding);
    const Pose hinge = hinge_frame(trocar, pose, geometry);
    EXPECT_NEAR(signed_distance(shaft, hinge.translation()), 0.0, rounding);
    EXPECT_NEAR(signed_distance(shaft, hinge * Vec3(0, 0, geometry.jaw_length)), geometry.jaw_length,
                rounding);
    EXPECT_NEAR(signed_distance(shaft, handle_position(trocar, pose, geometry)), -geometry.shaft_radius,
                rounding);
  }
}

TEST(Instrument, HandleForceDoesTheWorkOfTheTipForce) {
  Rng rng(10);
  for (int trial = 0; trial < 200; ++trial) {
    InstrumentPose pose = random_instrument(rng);
    const Vec3 tip_force = 5 * random_vector(rng);
    const Vec3 felt = handle_force(trocar, pose, geometry, tip_force);
    constexpr double h = 1e-6;  // rad or m
    for (double InstrumentPose::*freedom :
         {&InstrumentPose::pitch, &InstrumentPose::yaw, &InstrumentPose::insertion}) {
      InstrumentPose ahead = pose, behind = pose;
      ahead.*freedom += h;
      behind.*freedom -= h;
      const Vec3 tip_move = tip_position(trocar, ahead, geometry) - tip_position(trocar, behind, geometry);
      const Vec3 handle_move =
          handle_position(trocar, ahead, geometry) - handle_position(trocar, behind, geometry);
      // Central differences err by h^2 of the move, rounding by 1e-17 m: 1e-10 of h times the force and the
      // lever.
      EXPECT_NEAR(felt.dot(handle_move), tip_force.dot(tip_move),
                  1e-10 * 2 * h * (felt.norm() + tip_force.norm()));
    }
  }
}

TEST(Instrument, TheHandFeelsAPushStraightAndASidewaysForceTurnedRoundAtEqualArms) {
  InstrumentPose pose;
  pose.insertion = geometry.working_length / 2;
  EXPECT_LT((handle_force(trocar, pose, geometry, {0, 0, 2}) - Vec3(0, 0, 2)).norm(), 1e-14);
  EXPECT_LT((handle_force(trocar, pose, geometry, {2, 1, 0}) + Vec3(2, 1, 0)).norm(), 1e-14);
}

TEST(Instrument, EveryTypeIsASoundBody) {
  for (const std::string& name : instrument_type_names()) {
    const InstrumentType type = *instrument_type_called(name);
    const InstrumentGeometry g = instrument_geometry(type);
    EXPECT_EQ(g.has_jaws(), has_jaws(type)) << name;
    EXPECT_LE(g.jaw_rounding, g.jaw_thickness / 2) << name;
    EXPECT_LE(g.jaw_rounding, g.jaw_width / 2) << name;
    EXPECT_LT(g.max_insertion, g.working_length) << name;
    EXPECT_EQ(instrument_shapes(trocar, {}, g).size(), static_cast<std::size_t>(shapes_per_tool)) << name;
    // Skin stands closer than half a grasper is wide, and is felt eight times as densely: what meets it has two rows of
    // these under it, and more than the guard to its middle.
    const double felt_every = 0.5 * geometry.jaw_width / contact_parts;
    const double width = g.has_jaws() ? g.jaw_width : 2 * g.electrode_radius;
    EXPECT_GE(width, 2 * felt_every) << name;
    EXPECT_GT(g.has_jaws() ? g.jaw_rounding : g.electrode_radius, contact_guard) << name;
  }
}

TEST(Instrument, AHooksFootStandsToOneSideAndTurnsWithTheShaft) {
  const InstrumentGeometry hook = instrument_geometry(InstrumentType::l_hook);
  for (const double roll : {0.0, 1.2}) {
    const InstrumentPose pose{0.2, -0.1, 0.1, roll, 0};
    const Pose frame = hinge_frame(trocar, pose, hook);
    const auto foot = std::get<Capsule>(instrument_shapes(trocar, pose, hook)[2]);
    const Vec3 end = frame.inverse() * foot.b;
    EXPECT_NEAR(end.x(), hook.electrode_aside, rounding);
    EXPECT_NEAR(end.y(), 0, rounding);
    EXPECT_NEAR(end.z(), hook.jaw_length - hook.electrode_radius, rounding);
    // It and the neck meet in the bend.
    EXPECT_LT((foot.a - std::get<Capsule>(instrument_shapes(trocar, pose, hook)[1]).b).norm(), rounding);
  }
}

TEST(Instrument, SemmsJawsAreShorterAndBroaderThanTheGraspers) {
  const InstrumentGeometry semm = instrument_geometry(InstrumentType::semm_forceps);
  EXPECT_LT(semm.jaw_length, geometry.jaw_length);
  EXPECT_GT(semm.jaw_width, geometry.jaw_width);
}

TEST(Instrument, AnElectrodeEndsRoundAtItsTipAndIsOneBody) {
  Rng rng(11);
  const InstrumentGeometry rod = instrument_geometry(InstrumentType::bipolar_electrode);
  for (int trial = 0; trial < 50; ++trial) {
    InstrumentPose pose = random_instrument(rng);
    pose.jaw = 0;
    const std::vector<Shape> shapes = instrument_shapes(trocar, pose, rod);
    const auto distance = [&](const Vec3& x) {
      double nearest = signed_distance(shapes[0], x);
      for (const Shape& shape : shapes) nearest = std::min(nearest, signed_distance(shape, x));
      return nearest;
    };
    const Vec3 tip = tip_position(trocar, pose, rod), along = (tip - trocar).normalized();
    const Vec3 across = along.unitOrthogonal();
    EXPECT_NEAR(distance(tip), 0, rounding);
    EXPECT_NEAR(distance(tip + 3 * mm * along), 3 * mm, rounding);
    const Vec3 centre = tip - rod.electrode_radius * along;
    EXPECT_NEAR(distance(centre + rod.electrode_radius * (along + across).normalized()), 0, rounding);
    EXPECT_NEAR((tip - trocar).norm(), pose.insertion, rounding);
    // No gap on the axis from the trocar to the tip.
    for (int k = 1; k < 40; ++k) EXPECT_LT(distance(trocar + (tip - trocar) * k / 40), -1 * mm);
  }
}

TEST(Instrument, AnElectrodesPoseReachesItsTarget) {
  Rng rng(12);
  const InstrumentGeometry rod = instrument_geometry(InstrumentType::bipolar_electrode);
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 target = trocar + 200 * mm * random_vector(rng);
    const InstrumentPose pose = pose_reaching(trocar, target, 0.3, 0, rod);
    EXPECT_LT((tip_position(trocar, pose, rod) - target).norm(), rounding);
  }
}

}  // namespace
}  // namespace calot
