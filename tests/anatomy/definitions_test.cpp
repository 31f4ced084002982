#include "anatomy/definitions.h"

#include <gtest/gtest.h>

#include <set>

#include "anatomy/instruments.h"
#include "anatomy/scene_for_tests.h"
#include "base/units.h"

namespace calot {
namespace {

TEST(Anatomies, EveryNamedOneMakesASoundScene) {
  ASSERT_FALSE(anatomy_names().empty());
  for (const std::string& name : anatomy_names()) {
    SceneDefinition scene = test::sound_scene();
    const Result<AnatomyDefinition> anatomy = named_anatomy(name);
    ASSERT_TRUE(anatomy) << name;
    scene.anatomy = anatomy.value();
    for (const Problem& problem : validate(scene)) ADD_FAILURE() << name << ": " << to_text(problem);
  }
}

TEST(Anatomies, AnUnknownNameIsRefusedWithTheNearestOne) {
  const Result<AnatomyDefinition> anatomy = named_anatomy("hydrop");
  ASSERT_FALSE(anatomy);
  EXPECT_EQ(anatomy.failure().kind, FailureKind::scenario);
  const std::string text = to_text(anatomy.failure());
  EXPECT_NE(text.find("\"hydrop\""), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean \"hydrops\"?"), std::string::npos) << text;
}

TEST(Anatomies, HydropsIsLargerAndFullerThanStandard) {
  const OrganDefinition standard = named_anatomy("standard").value().organs.at(0);
  const OrganDefinition hydrops = named_anatomy("hydrops").value().organs.at(0);
  const auto &small = std::get<PearShape>(standard.shape), &large = std::get<PearShape>(hydrops.shape);
  EXPECT_GT(large.length, small.length);
  EXPECT_GT(large.width, small.width);
  // A pear fills less than the cylinder around it, and hydrops is stretched beyond its unstressed shape.
  const double cylinder = 3.14159 / 4 * large.width * large.width * large.length;
  ASSERT_TRUE(hydrops.bile.fill_volume);
  EXPECT_LT(*hydrops.bile.fill_volume, cylinder);
  EXPECT_GT(*hydrops.bile.fill_volume, 0.5 * cylinder);
  // Biliary pressure between meals: 10 to 15 mmHg.
  ASSERT_TRUE(standard.bile.fill_pressure);
  EXPECT_GE(*standard.bile.fill_pressure, 10 * units::mmHg);
  EXPECT_LE(*standard.bile.fill_pressure, 15 * units::mmHg);
}

TEST(Wall, IsIsotropicAndNeoHookeanUnlessAskedOtherwise) {
  for (const std::string& name : anatomy_names()) {
    const WallDefinition wall = named_anatomy(name).value().organs.at(0).wall;
    EXPECT_EQ(wall.stiffening, 0) << name;
    EXPECT_FALSE(wall.fibres) << name;
  }
}

TEST(Anatomies, EachIsHeldAtTheLiverAndAtTheNeck) {
  for (const std::string& name : anatomy_names()) {
    const AnatomyDefinition anatomy = named_anatomy(name).value();
    std::set<std::string> held;
    for (const HeldRegion& region : anatomy.organs.at(0).held) held.insert(region.landmark);
    EXPECT_EQ(held, (std::set<std::string>{"bed", "neck"})) << name;
  }
}

TEST(Ports, StandOnADomeAroundTheUmbilicus) {
  std::set<std::string> names;
  for (const PortDefinition& port : default_ports()) {
    EXPECT_TRUE(names.insert(port.name).second) << port.name;
    // The umbilicus is the dome's top: no port is above it, and the flanks are lower than the midline.
    EXPECT_LE(port.position.z(), 0.0) << port.name;
    const bool right = port.name.rfind("right_", 0) == 0, left = port.name.rfind("left_", 0) == 0;
    if (right) {
      EXPECT_LT(port.position.x(), 0.0) << port.name;
    }
    if (left) {
      EXPECT_GT(port.position.x(), 0.0) << port.name;
    }
  }
  EXPECT_TRUE(names.contains(LaparoscopeDefinition{}.port));
}

TEST(Ports, StandardGallbladderIsWithinReachOfEveryOne) {
  constexpr double longest_insertion = 300e-3;  // of the standard instruments
  const OrganDefinition organ = named_anatomy("standard").value().organs.at(0);
  for (const PortDefinition& port : default_ports())
    for (const Vec3& place : {organ.neck, organ.fundus}) {
      EXPECT_LT((place - port.position).norm(), longest_insertion) << port.name;
      EXPECT_LT(place.z(), port.position.z()) << port.name << ": instruments point inwards";
    }
}

TEST(Instruments, AreNamedBothWaysAndGiveWhatTheirTypeDoes) {
  for (const std::string& name : instrument_type_names()) {
    const std::optional<InstrumentType> type = instrument_type_called(name);
    ASSERT_TRUE(type) << name;
    EXPECT_EQ(to_text(*type), name);
    EXPECT_EQ(default_instrument(*type).type, *type);
  }
  for (std::size_t i = 0; i < instrument_rows().size(); ++i)
    EXPECT_EQ(instrument_rows()[i].type, static_cast<InstrumentType>(i))
        << "rows stand in the order of types";
  EXPECT_FALSE(instrument_type_called("grasper"));
  EXPECT_FALSE(has_jaws(InstrumentType::bipolar_electrode));
  EXPECT_TRUE(has_action(InstrumentType::l_hook, InstrumentAction::activate));
  EXPECT_TRUE(has_action(InstrumentType::clip_applier, InstrumentAction::fire));
  EXPECT_TRUE(has_action(InstrumentType::aspiration_needle, InstrumentAction::aspirate));
  EXPECT_FALSE(has_action(InstrumentType::scissors, InstrumentAction::activate));
  EXPECT_LT(default_instrument(InstrumentType::semm_forceps).pad_friction,
            default_instrument(InstrumentType::atraumatic_grasper).pad_friction);
}

}  // namespace
}  // namespace calot
