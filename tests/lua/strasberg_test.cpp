// Strasberg's classes of injuries to bile ducts, each by one act on the ducts of the operating field's anatomy.

#include <gtest/gtest.h>

#include "base/units.h"
#include "body/rod_body.h"
#include "field/field.h"
#include "lua/scenario_files.h"
#include "session/runner.h"
#include "sim/act_rig.h"

namespace calot {
namespace {

using test::Acting;
using units::mm;

/// The ducts alone: nothing else is in the way, and they come to rest at once. The common duct is as wide as a clip shuts.
SceneDefinition ducts_alone() {
  test::ScenarioText text;
  text.head = "local anatomy = require 'anatomy'\n";
  text.scene =
      "return { anatomy = anatomy.variant('aberrant_right_duct', { common_duct_diameter = 0.005, without = { "
      "'gallbladder', 'liver', "
      "'cystic_duct', 'right_hepatic_artery', 'cystic_artery', 'cystic_node' } }),\n"
      "solver = { motion = 'dynamic' }, laparoscope = { look_at = 'common_duct.middle' },\n"
      "instruments = { right = { port = 'right_lateral' } } }";
  const test::Folder folder;
  const auto loaded = test::load_text(folder, text.text());
  EXPECT_TRUE(loaded) << to_text(loaded.failure());
  SceneDefinition scene = loaded ? loaded.value()->definition().scene : SceneDefinition{};
  scene.anatomy.ground.clear();
  scene.ports = default_ports();
  scene.ports.push_back({"above", Vec3::Zero()});
  return scene;
}

/// A place on a duct and an instrument's way to it, from in front and across it.
struct Aim {
  Vec3 port, place;
  double roll = 0;
};

Aim aim_at(const SceneDefinition& scene, const std::string& duct, double share, InstrumentType type) {
  const Result<World> made = World::create(scene);
  EXPECT_TRUE(made) << to_text(made.failure());
  const World& world = made.value();
  const Organ& organ = world.field().organ(world.organ(duct).value());
  const RodBody& rod = *organ.body->as_tube();
  const double at = rod.at_share(share);
  const Vec3 along = rod.frame_at(at, organ.state.x).col(0), front = Vec3::UnitZ();
  Aim aim;
  aim.place = rod.place_at(at, organ.state.x);
  aim.port = aim.place + 100 * mm * (front - along * along.dot(front)).normalized();
  const InstrumentGeometry geometry = instrument_geometry(type);
  double best = 0;
  for (int degree = 0; degree < 180; ++degree) {
    const double roll = degree * units::deg;
    const InstrumentPose pose = pose_reaching(aim.port, aim.place, roll, 0, geometry);
    const double across = std::abs(hinge_frame(aim.port, pose, geometry).linear().col(1).dot(along));
    if (across <= best) continue;
    best = across;
    aim.roll = roll;
  }
  return aim;
}

/// Classes that the events carry of one act: a clip as far past the duct's middle as `past` (m), half of its leg unless
/// it is said, or a cut.
std::vector<std::string> classes(InstrumentType type, const std::string& duct, double share,
                                 const std::function<void(World&)>& before = {}, double past = 4.5 * mm) {
  SceneDefinition scene = ducts_alone();
  const Aim aim = aim_at(scene, duct, share, type);
  scene.ports.back().position = aim.port;
  scene.instruments = {default_instrument(type)};
  scene.instruments[0].name = "right";
  scene.instruments[0].port = "above";
  Acting acting(scene);
  if (before) before(acting.world);
  const double jaw = 0.5, shorter = 18 * mm * (1 - std::cos(0.5 * jaw));  // open jaws reach less far
  const InstrumentGeometry geometry = instrument_geometry(type);
  InstrumentPose there = pose_reaching(aim.port, aim.place, aim.roll, jaw, geometry);
  there.insertion += past + shorter;
  InstrumentPose above = there;
  above.insertion -= 25 * mm;
  EXPECT_TRUE(acting.go(above, 4));
  EXPECT_TRUE(acting.go(there, 10));
  if (type == InstrumentType::clip_applier) {
    EXPECT_TRUE(acting.fire());
  } else {
    there.jaw = 0;
    EXPECT_TRUE(acting.go(there, 12));
  }
  std::vector<std::string> out;
  for (const WorldEvent& event : acting.events)
    if (event.kind == EventKind::injury) {
      out.push_back(event.text);
      EXPECT_EQ(event.organ, duct);
    }
  return out;
}

using Classes = std::vector<std::string>;
constexpr auto clip = InstrumentType::clip_applier, cut = InstrumentType::scissors;

TEST(Strasberg, ACommonDuctIsNamedByHowMuchOfItIsLeftBelowTheConfluence) {
  EXPECT_EQ(classes(clip, "common_duct", 0.5), Classes{"Strasberg E1"});
  EXPECT_EQ(classes(cut, "common_duct", 0.12), Classes{"Strasberg E2"}) << "13 mm below it";
  EXPECT_EQ(classes(clip, "common_duct", 0.05), Classes{"Strasberg E3"}) << "5 mm below it";
  EXPECT_EQ(classes(clip, "common_duct", 0.5, {}, 1 * mm), Classes{"Strasberg D"}) << "in part";
}

TEST(Strasberg, BeyondTheConfluenceRightAndLeftAreSevered) {
  EXPECT_EQ(classes(cut, "right_hepatic_duct", 0.5), Classes{"Strasberg E4"});
  EXPECT_EQ(classes(clip, "left_hepatic_duct", 0.5), Classes{"Strasberg E4"});
}

TEST(Strasberg, AnAberrantRightDuctIsShutOrLeaks) {
  const std::string duct = "aberrant_right_duct";
  EXPECT_EQ(classes(clip, duct, 0.5), Classes{"Strasberg B"});
  EXPECT_EQ(classes(cut, duct, 0.5), Classes{"Strasberg C"});
  const auto clipped = [&](World& world) { ASSERT_TRUE(world.clip(duct, 0.25, ClipSize::m)); };
  EXPECT_EQ(classes(cut, duct, 0.6, clipped), Classes{}) << "on the liver's side: it stays shut";
}

TEST(Strasberg, BothTogetherAreE5WhicheverWasFirst) {
  const auto shut_aberrant = [](World& world) {
    ASSERT_TRUE(world.clip("aberrant_right_duct", 0.5, ClipSize::m));
  };
  const auto cut_common = [](World& world) { ASSERT_TRUE(world.divide("common_duct", 0.5)); };
  EXPECT_EQ(classes(clip, "common_duct", 0.5, shut_aberrant), Classes{"Strasberg E5"});
  EXPECT_EQ(classes(cut, "aberrant_right_duct", 0.5, cut_common), Classes{"Strasberg E5"});
}

}  // namespace
}  // namespace calot
