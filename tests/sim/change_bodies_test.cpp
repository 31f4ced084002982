
#include <gtest/gtest.h>

#include <numbers>

#include "anatomy/definitions.h"
#include "base/rng.h"
#include "base/units.h"
#include "body/rod_body.h"
#include "field/divide_body.h"
#include "field/field_state.h"
#include "motion/settle_field.h"
#include "support/bodies.h"
#include "world/world.h"

namespace calot {
namespace {

OrganDefinition duct(const std::string& name, const Vec3& from, const Vec3& to) {
  OrganDefinition organ;
  organ.name = name;
  TubeShape shape;
  shape.points = {from, 0.5 * (from + to) + Vec3(0, 2e-3, 0), to};
  shape.radius = 2e-3;
  organ.shape = shape;
  organ.wall.thickness = 0.8e-3;
  organ.wall.density = 1050;
  return organ;
}

OrganDefinition stone(const std::string& name, const Vec3& centre) {
  OrganDefinition organ;
  organ.name = name;
  organ.shape = RigidShape{Vec3::Zero(), 3e-3, centre, 1500};
  return organ;
}

/// A duct from a stone that hangs on nothing to a vessel that is held at both ends, a second duct across, and a grasper.
SceneDefinition ducts_scene(SolverMotion motion = SolverMotion::dynamics) {
  SceneDefinition scene;
  const Vec3 at(-60e-3, 110e-3, -80e-3);
  scene.anatomy.organs = {duct("cystic_duct", at, at + Vec3(40e-3, 0, 0)),
                          stone("stone", at - Vec3(3e-3, 0, 0)),
                          duct("common_duct", at + Vec3(40e-3, -30e-3, 0), at + Vec3(40e-3, 30e-3, 0)),
                          duct("artery", at + Vec3(0, -15e-3, 5e-3), at + Vec3(30e-3, -15e-3, 5e-3))};
  for (OrganDefinition* held : {&scene.anatomy.organs[2], &scene.anatomy.organs[3]})
    held->held = {{"first", "start", 6e-3, 1e6}, {"second", "end", 6e-3, 1e6}};
  std::get<TubeShape>(scene.anatomy.organs[2].shape).points[1] = at + Vec3(40e-3, 0, 0);
  scene.anatomy.joints = {{"stone.centre", "cystic_duct.start", 4e-3, 2e3},
                          {"cystic_duct.end", "common_duct.middle", 4e-3, 2e3}};
  InstrumentDefinition grasper;
  grasper.name = "left";
  grasper.port = "right_subcostal";
  scene.instruments = {grasper};
  scene.laparoscope.look_at = "common_duct.middle";
  scene.solver.motion = motion;
  return scene;
}

StepInput staying(const World& world) {
  StepInput input;
  for (const InstrumentState& state : world.report().instruments) input.instruments.push_back(state.pose);
  return input;
}

std::vector<std::string> names_in(const World& world) {
  std::vector<std::string> names;
  for (const OrganState& organ : world.report().organs) names.push_back(organ.name);
  return names;
}

std::string why(const Failure& failure) { return to_text(failure); }

const Organ& organ_of(const World& world, const std::string& name) {
  return world.field().organ(world.organ(name).value());
}

const RodBody& rod_of(const World& world, const std::string& name) {
  return *organ_of(world, name).body->as_tube();
}

double mass_of(const RodBody& rod) {
  double sum = 0;
  for (int row = 0; row < rod.rod().stencils().rows(); ++row) sum += rod.row_mass(row);
  return sum;
}

class ChangedBodies : public testing::Test {
 protected:
  World world = World::create(ducts_scene()).value();
};

/// Some way into a motion: bent, and with velocities.
void shake(World& world, int steps = 2) {
  for (int k = 0; k < steps; ++k) {
    const Result<StepReport> report = world.step(staying(world));
    ASSERT_TRUE(report) << why(report.failure());
  }
}

TEST_F(ChangedBodies, APieceIsTheSameCurveWithTheSameVelocities) {
  ASSERT_TRUE(world.untie("stone", "cystic_duct"));  // it swings then
  shake(world);
  const Organ whole = organ_of(world, "cystic_duct");
  ASSERT_GT(whole.state.motion.duration, 0);
  const Result<Division> done = world.divide("cystic_duct", 0.37);
  ASSERT_TRUE(done) << why(done.failure());
  EXPECT_NEAR(done->share, 0.37, 0.04);  // off the knots, one every 5 mm
  const RodBody& rod = *whole.body->as_tube();
  const std::vector<Vec3> before = rod.skin_positions(whole.state.x);
  EXPECT_EQ(organ_of(world, "cystic_duct.patient").body->name(), "cystic_duct.patient");
  // The specimen's first: it hangs on the stone.
  std::vector<Vec3> after, velocity;
  for (const char* name : {"cystic_duct.specimen", "cystic_duct.patient"}) {
    const Organ& piece = organ_of(world, name);
    const MotionPart& motion = piece.state.motion;
    const std::vector<Vec3> at = piece.body->skin_positions(piece.state.x),
                            from = piece.body->skin_positions(motion.begin.x);
    for (std::size_t p = after.empty() ? 0 : 1; p < at.size(); ++p) {
      after.push_back(at[p]);
      velocity.push_back((at[p] - from[p]) / motion.duration);
    }
  }
  const MotionPart& motion = whole.state.motion;
  const std::vector<Vec3> from = rod.skin_positions(motion.begin.x);
  ASSERT_EQ(after.size(), before.size());
  double fastest = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    EXPECT_LT((after[p] - before[p]).norm(), 1e-15);  // rounding
    const Vec3 was = (before[p] - from[p]) / motion.duration;
    EXPECT_LT((velocity[p] - was).norm(), 1e-12);
    fastest = std::max(fastest, was.norm());
  }
  EXPECT_GT(fastest, 1e-3) << "nothing moved";
}

TEST_F(ChangedBodies, PiecesShareMassRestLengthAndEnergyOfTheWhole) {
  shake(world);
  const Organ whole = organ_of(world, "cystic_duct");
  const RodBody& rod = *whole.body->as_tube();
  ASSERT_TRUE(world.divide("cystic_duct", 0.6));
  const RodBody &patient = rod_of(world, "cystic_duct.patient"),
                &specimen = rod_of(world, "cystic_duct.specimen");
  // The span of the cut has twice the points of quadrature: only there does it round otherwise.
  EXPECT_NEAR(patient.length() + specimen.length(), rod.length(), 1e-5 * rod.length());
  EXPECT_NEAR(mass_of(patient) + mass_of(specimen), mass_of(rod), 1e-5 * mass_of(rod));
  const double energy = organ_of(world, "cystic_duct.patient")
                            .body->strain_energy(organ_of(world, "cystic_duct.patient").state.x) +
                        organ_of(world, "cystic_duct.specimen")
                            .body->strain_energy(organ_of(world, "cystic_duct.specimen").state.x);
  EXPECT_NEAR(energy, rod.strain_energy(whole.state.x), 1e-3 * rod.strain_energy(whole.state.x));
}

TEST_F(ChangedBodies, TheCutCarriesNoForce) {
  ASSERT_TRUE(world.divide("cystic_duct", 0.5));
  const Field& field = world.field();
  const int patient = world.organ("cystic_duct.patient")->value,
            specimen = world.organ("cystic_duct.specimen")->value;
  std::vector<GroupPlace> places;
  std::vector<double> all;
  for (const Organ& organ : field.organs) {
    places.push_back({organ.body.get(), static_cast<int>(all.size()) / 3});
    all.insert(all.end(), organ.state.x.begin(), organ.state.x.end());
  }
  VecX x = Eigen::Map<VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
  const auto between = [&](const VecX& at) {
    double most = 0;
    for (const JoinPointer& join : field.group.joins) {
      const SkinJoin* skins = join->skins();
      const auto* joint = dynamic_cast<const Joint*>(join.get());
      const std::array<int, 2> bodies = skins ? skins->bodies() : joint->links().bodies;
      if (std::minmax(bodies[0], bodies[1]) != std::minmax(patient, specimen)) continue;
      EXPECT_EQ(joint, nullptr) << "the pieces are tied";
      join->begin(places);
      VecX g = VecX::Zero(at.size());
      join->add_gradient(at, g);
      most = std::max(most, g.lpNorm<Eigen::Infinity>());
    }
    return most;
  };
  EXPECT_EQ(between(x), 0);
  // Nor when the specimen is drawn off by a mm.
  for (int node = 0; node < places[specimen].body->nodes(); ++node)
    x[3 * (places[specimen].first_node + node)] -= 1e-3;
  EXPECT_EQ(between(x), 0);
  // It falls: 24 mm in three steps of implicit Euler.
  shake(world, 3);
  const double apart =
      (world.landmark("cystic_duct.patient.start") - world.landmark("cystic_duct.specimen.end")).norm();
  EXPECT_GT(apart, 20e-3);
  EXPECT_LT(apart, 30e-3);
}

TEST_F(ChangedBodies, ThePieceThatHangsOnWhatIsHeldIsThePatients) {
  const Vec3 start = world.landmark("cystic_duct.start"), end = world.landmark("cystic_duct.end");
  ASSERT_TRUE(world.divide("cystic_duct", 0.5));
  EXPECT_LT((world.landmark("cystic_duct.patient.end") - end).norm(), 1e-12);
  EXPECT_LT((world.landmark("cystic_duct.specimen.start") - start).norm(), 1e-12);
  // The artery is held at both ends: its end.
  const Vec3 far = world.landmark("artery.end");
  ASSERT_TRUE(world.divide("artery", 0.5));
  EXPECT_LT((world.landmark("artery.patient.end") - far).norm(), 1e-12);
}

TEST(PatientsPiece, IsTheOneAtTheEndThatTheDefinitionNames) {
  for (const PatientEnd named : {PatientEnd::start, PatientEnd::end}) {
    SceneDefinition scene = ducts_scene();
    std::get<TubeShape>(scene.anatomy.organs[0].shape).patient_end = named;
    World world = World::create(scene).value();
    const Vec3 start = world.landmark("cystic_duct.start");
    ASSERT_TRUE(world.divide("cystic_duct", 0.5));
    const char* piece =
        named == PatientEnd::start ? "cystic_duct.patient.start" : "cystic_duct.specimen.start";
    EXPECT_LT((world.landmark(piece) - start).norm(), 1e-12);
  }
}

TEST_F(ChangedBodies, PiecesStandWhereTheBodyStoodThePatientsFirst) {
  ASSERT_TRUE(world.divide("common_duct", 0.5));
  EXPECT_EQ(names_in(world), (std::vector<std::string>{"cystic_duct", "stone", "common_duct.patient",
                                                       "common_duct.specimen", "artery"}));
  ASSERT_TRUE(world.divide("common_duct.specimen", 0.5)) << "a piece is a tube like any other";
  EXPECT_EQ(names_in(world), (std::vector<std::string>{"cystic_duct", "stone", "common_duct.patient",
                                                       "common_duct.specimen.patient",
                                                       "common_duct.specimen.specimen", "artery"}));
}

TEST_F(ChangedBodies, JointsGoWithThePieceThatTheyAreOn) {
  const auto tied_to = [&](const std::string& name) {
    std::vector<std::string> out;
    for (const FieldJoint& joint : world.field().membership.joints) {
      const auto [one, other] = joint.joint->links().bodies;
      const std::string first = names_in(world)[static_cast<std::size_t>(one)],
                        second = names_in(world)[static_cast<std::size_t>(other)];
      if (first == name) out.push_back(second);
      if (second == name) out.push_back(first);
    }
    return out;
  };
  ASSERT_TRUE(world.divide("cystic_duct", 0.5));
  EXPECT_EQ(tied_to("cystic_duct.patient"), std::vector<std::string>{"common_duct"});
  EXPECT_EQ(tied_to("cystic_duct.specimen"), std::vector<std::string>{"stone"});
  // Within the joint: it is divided, too, and no link is lost.
  std::size_t links = 0, after = 0;
  for (const FieldJoint& joint : world.field().membership.joints) links += joint.joint->links().links.size();
  ASSERT_TRUE(world.divide("common_duct", 0.5));
  for (const FieldJoint& joint : world.field().membership.joints) after += joint.joint->links().links.size();
  EXPECT_EQ(after, links);
  ASSERT_TRUE(world.remove("stone", "taken out"));
  EXPECT_TRUE(tied_to("cystic_duct.specimen").empty());
}

TEST_F(ChangedBodies, HoldsAndPulledAnchorsStayAtTheirPlacesOnThePieces) {
  Field field = world.field();
  Organ& whole = field.organs[0];
  const auto points = static_cast<int>(whole.body->skin_rest().size());
  for (int row : {2, points / 2, points - 3})
    whole.grips.push_back({ToolIndex(0), row % 2, row, Vec3::Zero(), 4e4});
  std::vector<Vec3> held;
  for (const GripPoint& grip : whole.grips)
    held.push_back(whole.body->skin_point(grip.skin_point, whole.state.x));
  ContactPlaces places(whole.body->skin(), whole.state.x);
  std::vector<Vec3> rubbed;
  const int contacts = static_cast<int>(whole.body->skin().triangles.size()) * contacts_each;
  for (int point : {5, contacts / 3, contacts / 2 + 7, contacts - 9}) {
    whole.friction.points.push_back({point, 9, StickSlip{.limit = 1e-3, .stiffness = 1}});
    rubbed.push_back(places.at(point));
  }
  const Result<Division> done = divide_body(field, OrganIndex(0), 0.5, 1.0);
  ASSERT_TRUE(done) << why(done.failure());
  const auto near_one = [](const std::vector<Vec3>& of, const Vec3& at) {
    return std::any_of(of.begin(), of.end(), [&](const Vec3& one) { return (one - at).norm() < 1e-14; });
  };
  std::size_t holds = 0, anchors = 0;
  for (OrganIndex k : {done->patient, done->specimen}) {
    const Organ& piece = field.organ(k);
    EXPECT_FALSE(piece.grips.empty());
    EXPECT_FALSE(piece.friction.points.empty());
    for (const GripPoint& grip : piece.grips)
      EXPECT_TRUE(near_one(held, piece.body->skin_point(grip.skin_point, piece.state.x)));
    ContactPlaces of_piece(piece.body->skin(), piece.state.x);
    for (const RubbingPoint& rubbing : piece.friction.points)
      EXPECT_TRUE(near_one(rubbed, of_piece.at(rubbing.point)));
    holds += piece.grips.size();
    anchors += piece.friction.points.size();
  }
  EXPECT_EQ(holds, held.size());
  EXPECT_EQ(anchors, rubbed.size());
}

TEST_F(ChangedBodies, AHandleToWhatIsGoneSaysWhenAndWhyItWent) {
  const BodyHandle duct_then = world.handle(world.organ("cystic_duct").value()),
                   stone_then = world.handle(world.organ("stone").value());
  shake(world, 3);
  ASSERT_TRUE(world.divide("cystic_duct", 0.4));
  shake(world, 2);
  ASSERT_TRUE(world.remove("stone", "taken out"));
  const std::string of_duct =
      "cystic_duct was divided at 0.06 s (its pieces are cystic_duct.patient and cystic_duct.specimen)";
  const std::string of_stone = "stone was removed: taken out at 0.10 s";
  for (const Result<OrganIndex>& found : {world.organ(duct_then), world.organ("cystic_duct")}) {
    ASSERT_FALSE(found);
    EXPECT_NE(why(found.failure()).find(of_duct), std::string::npos) << why(found.failure());
  }
  for (const Result<OrganIndex>& found : {world.organ(stone_then), world.organ("stone")}) {
    ASSERT_FALSE(found);
    EXPECT_NE(why(found.failure()).find(of_stone), std::string::npos) << why(found.failure());
  }
  EXPECT_FALSE(world.divide("cystic_duct", 0.5));
  EXPECT_FALSE(world.place("stone.centre"));
  // Another one of that name is another one.
  ASSERT_TRUE(world.add(stone("stone", Vec3(-60e-3, 60e-3, -60e-3))));
  EXPECT_TRUE(world.organ("stone"));
  EXPECT_FALSE(world.organ(stone_then));
}

TEST_F(ChangedBodies, AHandleFromATimeThatWasUndoneIsOfNobody) {
  const FieldState before = world.state();
  const OrganDefinition fresh = stone("second", Vec3(-60e-3, 60e-3, -60e-3));
  const Result<OrganIndex> added = world.add(fresh);
  ASSERT_TRUE(added) << why(added.failure());
  const BodyHandle then = world.handle(added.value());
  ASSERT_TRUE(world.restore(before));
  EXPECT_FALSE(world.organ(then));
  ASSERT_TRUE(world.add(fresh));
  EXPECT_FALSE(world.organ(then)) << "the same place on the roll, another life";
}

TEST_F(ChangedBodies, SetBackAcrossAChangeTheSameStepsHaveTheSameBits) {
  shake(world, 3);
  const FieldState before = world.state();
  const std::uint64_t hash = world.state_hash();
  const auto two_steps = [&] {
    std::vector<std::uint64_t> hashes;
    for (int k = 0; k < 2; ++k) hashes.push_back(world.step(staying(world)).value().state_hash);
    return hashes;
  };
  const std::vector<std::uint64_t> plain = two_steps();
  ASSERT_TRUE(world.restore(before));
  ASSERT_TRUE(world.divide("cystic_duct", 0.4));
  EXPECT_NE(world.state_hash(), hash);
  const FieldState divided = world.state();
  const std::vector<std::uint64_t> with_pieces = two_steps();
  EXPECT_NE(with_pieces, plain);
  ASSERT_TRUE(world.remove("cystic_duct.specimen", ""));
  ASSERT_TRUE(world.restore(before));
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(names_in(world), (std::vector<std::string>{"cystic_duct", "stone", "common_duct", "artery"}));
  EXPECT_EQ(two_steps(), plain);
  ASSERT_TRUE(world.restore(divided));
  EXPECT_EQ(two_steps(), with_pieces);
}

TEST_F(ChangedBodies, WhoIsThereIsInTheStateHash) {
  const FieldState before = world.state();
  std::vector<std::uint64_t> hashes{world.state_hash()};
  const auto differs = [&](const char* what, bool changed) {
    ASSERT_TRUE(changed) << what;
    EXPECT_EQ(std::count(hashes.begin(), hashes.end(), world.state_hash()), 0) << what;
    hashes.push_back(world.state_hash());
    EXPECT_EQ(world.report().state_hash, world.state_hash());
    ASSERT_TRUE(world.restore(before));
  };
  differs("divided", bool(world.divide("artery", 0.4)));
  differs("divided elsewhere", bool(world.divide("artery", 0.6)));
  differs("removed", bool(world.remove("artery", "")));
  differs("untied", bool(world.untie("stone", "cystic_duct")));
  differs("tied", bool(world.tie({"artery.end", "common_duct.start", 4e-3, 2e3})));
  differs("added", bool(world.add(stone("second", Vec3(-60e-3, 60e-3, -60e-3)))));
  differs("another added", bool(world.add(stone("third", Vec3(-60e-3, 60e-3, -60e-3)))));
}

TEST_F(ChangedBodies, SplitAndJoinedAThousandTimesTheStateWithoutThemReturns) {
  // What was factorised is not remembered across a change: the state to return to is one after a change.
  ASSERT_TRUE(world.add(stone("first", Vec3(-60e-3, 60e-3, -60e-3))));
  ASSERT_TRUE(world.remove("first", ""));
  const std::uint64_t at_start = world.state_hash();
  const FieldState start = world.state();
  Rng rng(7);
  int changes = 0, divided = 0;
  std::vector<std::string> joined;
  while (changes < 1000) {
    const double kind = rng.uniform(0.0, 1.0);
    if (kind < 0.5 && joined.size() < 6) {
      const int slot = static_cast<int>(rng.uniform(0.0, 8.0));
      const std::string name = "guest" + std::to_string(slot);
      if (world.organ(name)) continue;
      ASSERT_TRUE(world.add(stone(name, Vec3(-90e-3 + 10e-3 * slot, 60e-3, -60e-3))));
      joined.push_back(name);
      ++changes;
      if (kind < 0.15) {
        ASSERT_TRUE(world.tie({name + ".centre", "artery.middle", 4e-3, 2e3}));
        ++changes;
      }
    } else if (kind < 0.93 && !joined.empty()) {
      const auto which = joined.begin() +
                         static_cast<int>(rng.uniform(0.0, 1.0) * 0.999 * static_cast<double>(joined.size()));
      ASSERT_TRUE(world.remove(*which, "taken out"));
      joined.erase(which);
      ++changes;
    } else if (kind >= 0.93) {
      // A duct is divided, its pieces once more, and all is undone.
      const FieldState before = world.state();
      const std::uint64_t hash = world.state_hash();
      ASSERT_TRUE(world.divide("cystic_duct", rng.uniform(0.3, 0.7)));
      ASSERT_TRUE(world.divide("artery", rng.uniform(0.2, 0.8)));
      ASSERT_TRUE(world.remove("cystic_duct.specimen", "taken out"));
      ASSERT_TRUE(world.restore(before));
      ASSERT_EQ(world.state_hash(), hash);
      changes += 3;
      ++divided;
    }
    std::vector<std::string> all = {"cystic_duct", "stone", "common_duct", "artery"};
    all.insert(all.end(), joined.begin(), joined.end());
    ASSERT_EQ(names_in(world), all) << "the others stay in their order";
    for (const FieldJoint& joint : world.field().membership.joints) {
      const auto [one, other] = joint.joint->links().bodies;
      const std::string guest = all[static_cast<std::size_t>(one)];
      ASSERT_TRUE(static_cast<std::size_t>(std::max(one, other)) < 4 ||
                  (guest.starts_with("guest") && all[static_cast<std::size_t>(other)] == "artery"));
    }
  }
  EXPECT_GT(divided, 15);
  while (!joined.empty()) {
    ASSERT_TRUE(world.remove(joined.back(), ""));
    joined.pop_back();
  }
  EXPECT_EQ(world.state_hash(), at_start);
  const std::uint64_t stepped = world.step(staying(world)).value().state_hash;
  ASSERT_TRUE(world.restore(start));
  EXPECT_EQ(world.step(staying(world)).value().state_hash, stepped);
}

TEST_F(ChangedBodies, AreFollowedStepByStepAfterEachChange) {
  shake(world, 2);
  ASSERT_TRUE(world.divide("cystic_duct", 0.5));
  shake(world, 2);
  ASSERT_TRUE(world.remove("stone", "taken out"));
  shake(world, 2);
  ASSERT_TRUE(world.tie({"cystic_duct.specimen.end", "artery.middle", 3e-3, 500}));
  shake(world, 2);
  ASSERT_TRUE(world.add(stone("second", Vec3(-60e-3, 60e-3, -60e-3))));
  shake(world, 2);
  ASSERT_TRUE(world.untie("cystic_duct.specimen", "artery"));
  shake(world, 2);
}

/// How a place moves in four steps, m.
Vec3 way_of(World& world, const std::string& place) {
  const Vec3 from = world.landmark(place);
  shake(world, 4);
  return world.landmark(place) - from;
}

TEST_F(ChangedBodies, WhatIsReleasedFallsThereAndStaysWhereItIsHeldStill) {
  shake(world, 4);
  EXPECT_LT(way_of(world, "artery.start").norm(), 0.1e-3) << "it was at rest";
  ASSERT_TRUE(world.release("artery", "first"));
  EXPECT_EQ(organ_of(world, "artery").definition.held.size(), 1u);
  const Vec3 start = way_of(world, "artery.start"), end = world.landmark("artery.end");
  EXPECT_LT(start.dot(world.up()), -5e-3);
  EXPECT_LT((end - (world.landmark("artery.end"))).norm(), 1e-3);
  ASSERT_TRUE(world.release("artery", "second"));
  const Vec3 fallen = way_of(world, "artery.end");
  EXPECT_LT(fallen.dot(world.up()), -5e-3) << "now nothing holds it";
}

TEST_F(ChangedBodies, APieceIsReleasedAloneOfTheOther) {
  ASSERT_TRUE(world.divide("common_duct", 0.5));
  ASSERT_TRUE(world.release("common_duct.patient", "second"));
  EXPECT_EQ(organ_of(world, "common_duct.patient").definition.held.size(), 1u);
  EXPECT_EQ(organ_of(world, "common_duct.specimen").definition.held.size(), 2u);
  EXPECT_EQ(*organ_of(world, "common_duct.patient").body->bedded(), false);
  EXPECT_EQ(*organ_of(world, "common_duct.specimen").body->bedded(), true);
}

TEST_F(ChangedBodies, TissueThatIsAddedHoldsWhatItIsBetweenAndNotOnceItIsRemoved) {
  TissueDefinition tissue;
  tissue.name = "bands";
  tissue.from = "cystic_duct", tissue.to = "common_duct";
  tissue.within = 20e-3;
  tissue.strands = 12;
  tissue.slack = 0;
  tissue.stiffness = 400e3, tissue.strength = 4e6, tissue.break_energy = 1e5;
  ASSERT_TRUE(world.add_tissue(tissue));
  ASSERT_EQ(world.report().tissues.size(), 1u);
  EXPECT_GT(world.report().tissues[0].strands, 6);
  ASSERT_TRUE(world.untie("cystic_duct", "common_duct"));
  const FieldState begun = world.state();
  EXPECT_GT(way_of(world, "cystic_duct.end").dot(world.up()), -8e-3) << "nothing else holds it";
  ASSERT_TRUE(world.restore(begun));
  ASSERT_TRUE(world.remove_tissue("bands"));
  EXPECT_TRUE(world.report().tissues.empty());
  EXPECT_LT(way_of(world, "cystic_duct.end").dot(world.up()), -20e-3) << "it falls freely";
}

TEST_F(ChangedBodies, WhatCannotBeDoneIsSaidAndLeavesTheFieldAsItWas) {
  const std::uint64_t hash = world.state_hash();
  const auto says = [&](const auto& result, const std::string& text) {
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.failure().kind, FailureKind::scenario);
    EXPECT_NE(why(result.failure()).find(text), std::string::npos) << why(result.failure());
    EXPECT_EQ(world.state_hash(), hash);
  };
  says(world.divide("stone", 0.5), "'stone' cannot be divided: its shape is \"rigid\" (divide a tube");
  says(world.divide("artery", 0.02), "shorter than it is thick (4 mm)");
  says(world.divide("arterie", 0.5), "unknown organ \"arterie\" (did you mean \"artery\"?)");
  says(world.add(stone("stone", Vec3(-60e-3, 60e-3, -60e-3))), "there is 'stone' already");
  says(world.add(stone("second", world.landmark("artery.middle"))), "'second' and organ 'artery' are ");
  says(world.add(stone("second", world.report().instruments[0].tip)),
       "'second' would begin inside instrument 'left'");
  says(world.untie("stone", "artery"), "'stone' and 'artery' are not tied to each other");
  says(world.tie({"stone.centre", "stone.centre", 4e-3, 2e3}), "an organ is tied to itself");
  says(world.tie({"stone.centre", "artery.mitte", 4e-3, 2e3}), "unknown landmark \"artery.mitte\"");
  says(world.release("stone", "bed"), "nothing called \"bed\" holds 'stone' (nothing holds it)");
  says(world.release("artery", "frist"), "nothing called \"frist\" holds 'artery' (known: first, second)");
  says(world.remove_tissue("plate"), "there is no tissue 'plate'");
  TissueDefinition tissue;
  tissue.name = "plate";
  tissue.from = "artery", tissue.to = "liver";
  says(world.add_tissue(tissue), "tissue.to: unknown organ \"liver\"");
  tissue.to = "stone";
  tissue.within = 0.5e-3;
  says(world.add_tissue(tissue), "tissue.within");
  says(world.open_tube("stone", 0.5, 1e-3), "'stone' cannot be opened: its shape is \"rigid\" (open a tube");
  OrganDefinition thin = stone("second", Vec3(-60e-3, 60e-3, -60e-3));
  std::get<RigidShape>(thin.shape).density = -1;
  says(world.add(thin), "organ.shape.density");
}

TEST(ChangedBodiesAtRest, ComeToRestBeforeTheNextStepOrNothingIsChanged) {
  SceneDefinition scene = ducts_scene(SolverMotion::statics);
  scene.anatomy.organs.erase(scene.anatomy.organs.begin() + 1);
  scene.anatomy.joints.erase(scene.anatomy.joints.begin());
  World world = World::create(scene).value();
  const std::uint64_t hash = world.state_hash();
  // The specimen would hang on nothing.
  const Result<Division> loose = world.divide("cystic_duct", 0.5);
  ASSERT_FALSE(loose);
  EXPECT_EQ(loose.failure().kind, FailureKind::simulation);
  EXPECT_NE(why(loose.failure()).find("after 'cystic_duct' was divided"), std::string::npos)
      << why(loose.failure());
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_TRUE(world.organ("cystic_duct"));
  ASSERT_TRUE(world.divide("artery", 0.5));
  Field field = world.field();
  SolveStatistics statistics;
  const std::vector<VecX> before = present_places(field);
  ASSERT_TRUE(settle_field(field, "again", statistics));
  for (std::size_t k = 0; k < before.size(); ++k)
    EXPECT_LT((field.organs[k].state.x - before[k]).norm(), 1e-6) << "it was not at rest";
}

}  // namespace
}  // namespace calot
