// What a fired clip does, on one tube that is held at both ends.

#include "acts/clips.h"

#include <gtest/gtest.h>

#include "act_rig.h"
#include "acts/grip_slip.h"
#include "body/rod_body.h"
#include "field/field_state.h"
#include "field/grip.h"
#include "liquid/films.h"

namespace calot {
namespace {

using test::about;
using test::across;
using test::Acting;
using test::tube_depth;

constexpr double applier_jaw = 0.5;  // rad

/// The tip that many m past the tube's middle.
InstrumentPose past(double reach) {
  const double back = 18e-3 * (1 - std::cos(0.5 * applier_jaw));
  return about(applier_jaw, tube_depth + reach + back);
}

/// The tube with the clip that an applier sets so far past its middle, and by how much it sags, m.
std::pair<OrganState, double> clipped_at(double reach, ClipSize size = ClipSize::ml) {
  SceneDefinition scene = across(InstrumentType::clip_applier);
  scene.instruments[0].clip = size;
  Acting acting(scene);
  EXPECT_TRUE(acting.go(about(applier_jaw, tube_depth - 20e-3), 2) && acting.go(past(reach), 6) &&
              acting.fire());
  EXPECT_EQ(acting.count(EventKind::clip), 1);
  for (const WorldEvent& event : acting.events) {
    if (event.kind != EventKind::clip) continue;
    EXPECT_EQ(event.value, acting.world.report().organs[0].clips.at(0).opening);
  }
  const Organ& organ = acting.world.field().organs[0];
  const double middle = 0.5 * static_cast<double>(organ.body->skin_rest().size() - 1);
  return {acting.world.report().organs[0],
          -tube_depth - organ.body->as_tube()->place_at(middle, organ.state.x).z()};
}

TEST(Clips, ShutATubeThatIsWhollyBetweenTheirLegs) {
  const OrganState state = clipped_at(5e-3).first;
  ASSERT_EQ(state.clips.size(), 1u);
  EXPECT_EQ(state.clips[0].opening, 0);
  EXPECT_NEAR(state.clips[0].share, 0.5, 0.01);
}

TEST(Clips, LeaveOpenWhatIsNotBetweenTheirLegs) {
  // A duct of 1.8 mm radius and 0.8 mm wall is pressed to a stadium of its own outline, 4.74 mm wide.
  const double width = 2 * (1.8e-3 + (std::numbers::pi / 2 - 1) * 1.0e-3);
  for (const double reach : {1.5e-3, 0.6e-3}) {
    const auto [state, sag] = clipped_at(reach);
    ASSERT_EQ(state.clips.size(), 1u) << reach;
    EXPECT_NEAR(state.clips[0].opening, 0.5 - (reach - sag) / width, 0.01) << reach;
  }
  // A smaller clip's crown is before the tube's near side when it is well past it.
  EXPECT_EQ(clipped_at(3e-3, ClipSize::m).first.clips[0].opening, 0);
  EXPECT_GT(clipped_at(5.5e-3, ClipSize::m).first.clips[0].opening, 0.2);
}

TEST(Clips, LieWhereTheyFellAndAreGoneOnceThatIsUndone) {
  SceneDefinition scene = across(InstrumentType::clip_applier);
  constexpr double floor = -150e-3;  // m
  scene.anatomy.support = SupportDefinition{Vec3(0, 0, floor), Vec3::UnitZ(), 0};
  Acting acting(scene);
  InstrumentPose aside = about(applier_jaw, tube_depth - 30e-3);
  aside.yaw = 0.4;
  ASSERT_TRUE(acting.go(aside, 4));
  const FieldState before = acting.world.state();
  ASSERT_TRUE(acting.fire());
  const std::vector<FallenClip>& fallen = acting.world.field().spill.clips;
  ASSERT_EQ(fallen.size(), 1u);
  const Vec3 lies = wet_surface(acting.world.field(), fallen[0].on).at.at(fallen[0].point);
  const Vec3 tip = acting.world.report().instruments[0].tip;
  // Straight below the jaws, to within the clip and the points of the ground.
  EXPECT_LT((lies - tip).head<2>().norm(), 10e-3);
  EXPECT_NEAR(lies.z(), floor, 1e-9);
  EXPECT_NEAR(fallen[0].legs.norm(), 1, 1e-12);
  ASSERT_TRUE(acting.world.restore(before));
  EXPECT_TRUE(acting.world.field().spill.clips.empty());
}

TEST(Clips, FallBesideATubeAndAreCounted) {
  SceneDefinition scene = across(InstrumentType::clip_applier);
  scene.instruments[0].clips = 2;
  Acting acting(scene);
  ASSERT_TRUE(acting.go(about(applier_jaw, tube_depth - 30e-3), 2));
  for (int left : {1, 0, 0}) {
    ASSERT_TRUE(acting.fire());
    EXPECT_EQ(acting.world.report().instruments[0].clips, left);
  }
  EXPECT_EQ(acting.count(EventKind::clip_dropped), 2) << "there were no more";
  EXPECT_EQ(acting.count(EventKind::clip), 0);
  EXPECT_TRUE(acting.world.report().organs[0].clips.empty());
}

TEST(Clips, AreSetOnNoOtherClipAndNotCutThrough) {
  test::Acting applier(test::across(InstrumentType::clip_applier));
  ASSERT_TRUE(applier.reach(0.35) && applier.fire() &&
              applier.go(applier.world.report().instruments[0].pose, 2));
  ASSERT_EQ(applier.world.report().organs[0].clips.size(), 1u);
  ASSERT_TRUE(applier.fire());
  EXPECT_EQ(applier.world.report().organs[0].clips.size(), 1u);
  EXPECT_EQ(applier.count(EventKind::clip_dropped), 1) << "its legs find the first one";
  test::Acting scissors(test::across(InstrumentType::scissors));
  ASSERT_TRUE(scissors.world.clip("duct", 0.5, ClipSize::ml));
  ASSERT_TRUE(scissors.reach() && scissors.go(test::about(0), 12));
  EXPECT_EQ(scissors.count(EventKind::cut), 0);
  EXPECT_EQ(scissors.world.report().organs.size(), 1u);
}

TEST(Clips, AreSetOnceHoweverLongTheTriggerIsHeld) {
  Acting acting(across(InstrumentType::clip_applier));
  ASSERT_TRUE(acting.go(about(applier_jaw, tube_depth - 20e-3), 2) && acting.go(past(5e-3), 6));
  for (int k = 0; k < 3; ++k) ASSERT_TRUE(acting.world.step({{past(5e-3)}, {InstrumentAction::fire}}));
  EXPECT_EQ(acting.world.report().organs[0].clips.size(), 1u);
}

TEST(Clips, AreInTheStateAndItsHash) {
  Acting acting(across(InstrumentType::clip_applier));
  ASSERT_TRUE(acting.go(about(applier_jaw, tube_depth - 20e-3), 2) && acting.go(past(5e-3), 6));
  const FieldState before = acting.world.state();
  ASSERT_TRUE(acting.fire());
  const FieldState clipped = acting.world.state();
  const std::uint64_t hash = acting.world.state_hash();
  ASSERT_TRUE(acting.world.restore(before));
  EXPECT_TRUE(acting.world.field().organs[0].clips.empty());
  EXPECT_EQ(acting.world.field().tools[0].clips, before.tools[0].clips);
  ASSERT_TRUE(acting.world.step({{past(5e-3)}}));
  EXPECT_NE(acting.world.state_hash(), hash);
  ASSERT_TRUE(acting.world.restore(clipped));
  EXPECT_EQ(acting.world.state_hash(), hash);
  ASSERT_EQ(acting.world.field().organs[0].clips.size(), 1u);
}

TEST(Clips, ATubeIsFlatUnderThemAndRoundAside) {
  Acting acting(across(InstrumentType::clip_applier));
  ASSERT_TRUE(acting.go(about(applier_jaw, tube_depth - 20e-3), 2) && acting.go(past(5e-3), 6) &&
              acting.fire());
  const Organ& organ = acting.world.field().organs[0];
  const RodBody& rod = *organ.body->as_tube();
  const auto height = [&](double from, double to) {  // across the legs, along x
    double most = 0;
    for (const Vec3& p : rod.drawn(organ.state.x).positions)
      if (p.y() > from && p.y() < to) most = std::max(most, std::abs(p.x()));
    return most;
  };
  EXPECT_NEAR(height(-0.6e-3, 0.6e-3), 0.8e-3, 0.05e-3);  // two walls of 0.8 mm
  EXPECT_NEAR(height(5e-3, 9e-3), 1.8e-3, 0.05e-3);
  const auto radius = std::minmax_element(rod.skin_radii().begin(), rod.skin_radii().end());
  EXPECT_NEAR(*radius.first, 0.8e-3, 1e-9);
  EXPECT_NEAR(*radius.second, 1.8e-3, 1e-9);
}

/// An applier and scissors through one port, the applier first.
struct ClipAndCut {
  World world;
  std::vector<WorldEvent> events = {};
  static SceneDefinition scene(InstrumentType second) {
    SceneDefinition scene = across(InstrumentType::clip_applier);
    InstrumentDefinition other = default_instrument(second);
    other.name = "second";
    other.port = scene.instruments[0].port;
    other.waits = true;
    scene.instruments.push_back(other);
    std::get<TubeShape>(scene.anatomy.organs[0].shape).points = {
        {0, -20e-3, -tube_depth}, {0, 0, -tube_depth}, {0, 20e-3, -tube_depth}};
    return scene;
  }
  explicit ClipAndCut(const SceneDefinition& scene = ClipAndCut::scene(InstrumentType::scissors))
      : world(World::create(scene).value()) {}
  /// The one that is in the port goes to a pose; the action is the applier's or the blades'.
  bool step(const InstrumentPose& pose, std::vector<InstrumentAction> actions = {}) {
    StepInput input;
    for (const InstrumentState& state : world.report().instruments)
      input.instruments.push_back(state.waits ? state.pose : pose);
    input.actions = std::move(actions);
    const Result<StepReport> done = world.step(input);
    EXPECT_TRUE(done) << to_text(done.failure());
    if (!done) return false;
    events.insert(events.end(), done->events.begin(), done->events.end());
    return true;
  }
  static InstrumentPose away() { return {0, 0, 30e-3, 0, 0}; }
  /// The applier about the tube at a place along it, which it comes to from above.
  bool clip_at(double y) {
    const double pitch = std::atan2(y, tube_depth);
    const double far = std::hypot(y, tube_depth) + 5e-3 + 18e-3 * (1 - std::cos(0.5 * applier_jaw));
    for (int k = 0; k <= 6; ++k)
      if (!step({pitch, 0, far - 25e-3 * (1 - k / 6.0), 0, applier_jaw})) return false;
    if (!step({pitch, 0, far, 0, applier_jaw}, {InstrumentAction::fire, InstrumentAction::none}))
      return false;
    for (int k = 0; k <= 6; ++k)
      if (!step({pitch, 0, far - 25e-3 * k / 6.0, 0, applier_jaw})) return false;
    return step(away());
  }
  /// The blades come in and divide the tube in its middle.
  bool cut() {
    if (!step(away(), {InstrumentAction::none, InstrumentAction::exchange})) return false;
    for (int k = 0; k <= 6; ++k)
      if (!step(about(0.7, tube_depth + 6e-3 - 25e-3 * (1 - k / 6.0)))) return false;
    for (int k = 0; k <= 12; ++k)
      if (!step(about(0.7 * (1 - k / 12.0)))) return false;
    return true;
  }
  int count(EventKind kind) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(),
                                          [&](const WorldEvent& event) { return event.kind == kind; }));
  }
};

TEST(Clips, GoWithThePieceOfADividedTubeThatTheyAreOn) {
  ClipAndCut hands;
  ASSERT_TRUE(hands.clip_at(-6e-3) && hands.clip_at(-9e-3) && hands.clip_at(6e-3));
  ASSERT_EQ(hands.world.report().organs[0].clips.size(), 3u);
  std::vector<Vec3> places;
  const auto note = [&] {
    places.clear();
    for (const Organ& organ : hands.world.field().organs)
      for (const Clip& clip : organ.clips)
        places.push_back(organ.body->as_tube()->place_at(clip.at, organ.body->rest()));
    return places;
  };
  const std::vector<Vec3> before = note();
  ASSERT_TRUE(hands.cut());
  const OrganState &patient = hands.world.report().organs[0], &specimen = hands.world.report().organs[1];
  EXPECT_EQ(patient.name + " " + specimen.name, "duct.patient duct.specimen");
  ASSERT_EQ(patient.clips.size(), 2u);
  ASSERT_EQ(specimen.clips.size(), 1u);
  EXPECT_EQ(hands.count(EventKind::cut), 1);
  EXPECT_EQ(hands.count(EventKind::cut_unclipped), 0);
  const std::vector<Vec3> after = note();
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT((after[i] - before[i]).norm(), 1e-9) << "where it was on the tube";
  for (const Organ& organ : hands.world.field().organs) {
    const auto least = *std::min_element(organ.body->as_tube()->skin_radii().begin(),
                                         organ.body->as_tube()->skin_radii().end());
    EXPECT_NEAR(least, 0.8e-3, 1e-9) << "it is flat there still";
  }
}

/// A clip near the end of a stump, and jaws of which `pads` N hold it across that are closed on it and draw it off.
struct DrawnClip : ClipAndCut {
  static constexpr double clip = 6e-3;  // m, along the tube
  double cut_at = 7.5e-3;               // m, likewise
  double grasped = clip;                // m, likewise: the middle of the pads
  static SceneDefinition stiff(double pads) {
    SceneDefinition scene = ClipAndCut::scene(InstrumentType::atraumatic_grasper);
    // A tube that gives way less than a point's distance to what a clip holds.
    scene.anatomy.organs[0].wall.shear_modulus = 10e6;
    scene.anatomy.organs[0].held[0].stiffness = 1e8;
    scene.instruments[1].pad_friction = 0.5 * pads / scene.instruments[1].pinch_force;
    return scene;
  }
  explicit DrawnClip(double pads) : ClipAndCut(stiff(pads)) {}
  static InstrumentPose at(double y, double jaw) {
    const double reach = 14e-3;  // m, past the tube: well between the pads
    return {std::atan2(y, tube_depth), 0, std::hypot(y, tube_depth) + reach, 0, jaw};
  }
  bool grasp() {
    if (!clip_at(clip) || !world.divide("duct", 0.5 + cut_at / 40e-3)) return false;
    if (!step(away(), {InstrumentAction::none, InstrumentAction::exchange})) return false;
    for (int k = 0; k <= 6; ++k) {
      InstrumentPose near = at(grasped, 0.5);
      near.insertion -= 30e-3 * (1 - k / 6.0);
      if (!step(near)) return false;
    }
    for (int k = 1; k <= 30; ++k)
      if (!step(at(grasped, 0.5 * (1 - k / 30.0)))) return false;
    return true;
  }
  /// Largest pull on the pads as they go that far along the tube, or until the clip is off, N. So slowly that few
  /// steps spend their budget on what slips; what these ask is not judged.
  double draw(double way) {
    double largest = 0;
    for (double y = 0; y < way && !stump().clips.empty(); y += 0.05e-3) {
      EXPECT_TRUE(step(at(grasped + y, 0)));
      const Vec3 pull = pad_load(world.field(), ToolIndex(1)).pull;
      largest = std::max(largest, pull.norm());
      if (grip_count(stump(), ToolIndex(1)) > 0 && world.report().balanced)
        asked = std::max(asked, asked_of_friction(world.field().tools[1], pull).norm());
    }
    return largest;
  }
  const Organ& stump() const { return world.field().organs[0]; }
  double asked = 0;  ///< N, of the pads' friction at most
};

TEST(Clips, DrawnAlongTheirTubeHarderThanTheyHoldTheySlipOffItsEnd) {
  DrawnClip hands(3 * clip_hold);
  ASSERT_TRUE(hands.grasp());
  ASSERT_EQ(hands.stump().clips.size(), 1u);
  ASSERT_EQ(hands.count(EventKind::grasp), 1);
  EXPECT_NEAR(hands.draw(4e-3), clip_hold, 0.02 * clip_hold);
  EXPECT_EQ(hands.count(EventKind::slip), 1);
  ASSERT_EQ(hands.count(EventKind::clip_dropped), 1);
  const auto fell = std::find_if(hands.events.begin(), hands.events.end(), [](const WorldEvent& event) {
    return event.kind == EventKind::clip_dropped;
  });
  EXPECT_EQ(fell->cause, EventCause::slipping);
  EXPECT_TRUE(hands.stump().clips.empty());
  EXPECT_TRUE(hands.stump().body->as_tube()->pinches().empty());
}

TEST(Clips, PushTheNextOneAlongWithWhatBothHoldAndFallOneAfterTheOther) {
  DrawnClip hands(3 * clip_hold);
  constexpr double other = 9e-3;  // m, along the tube
  hands.cut_at = 11e-3;
  // The first one lies just between the pads' edges: where it comes to the other, that is not between them.
  const double pad = 0.5 * instrument_geometry(InstrumentType::atraumatic_grasper).jaw_width;
  hands.grasped = DrawnClip::clip - pad + 0.3e-3;
  ASSERT_TRUE(hands.clip_at(other) && hands.grasp());
  ASSERT_EQ(hands.stump().clips.size(), 2u);
  const auto apart = [&] {
    const std::vector<Clip>& clips = hands.stump().clips;
    const RodBody& rod = *hands.stump().body->as_tube();
    return rod.way_to(clips[1].at) - rod.way_to(clips[0].at);
  };
  const double wire = clip_row(hands.stump().clips[0].size).wire, stood = hands.stump().clips[1].at;
  constexpr double alone = 3e-3;  // m, on which the first one does not come to the other yet
  EXPECT_NEAR(hands.draw(alone), clip_hold, 0.02 * clip_hold);
  ASSERT_EQ(hands.stump().clips.size(), 2u);
  EXPECT_EQ(hands.stump().clips[1].at, stood);
  EXPECT_GT(apart(), wire);
  double largest = 0, nearest = apart();
  std::vector<std::size_t> left;
  for (double y = alone; y < 12e-3 && !hands.stump().clips.empty(); y += 0.2e-3) {
    ASSERT_TRUE(hands.step(DrawnClip::at(hands.grasped + y, 0)));
    largest = std::max(largest, pad_load(hands.world.field(), ToolIndex(1)).pull.norm());
    const std::size_t now = hands.stump().clips.size();
    if (left.empty() || left.back() != now) left.push_back(now);
    if (now == 2) nearest = std::min(nearest, apart());
  }
  EXPECT_NEAR(nearest, wire, 0.02 * wire) << "neither is in the other";
  EXPECT_NEAR(largest, 2 * clip_hold, 0.02 * 2 * clip_hold);
  EXPECT_EQ(left, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_EQ(hands.count(EventKind::clip_dropped), 2);
}

TEST(Clips, StayWhereJawsSlideOverThem) {
  DrawnClip hands(0.5 * clip_hold);
  ASSERT_TRUE(hands.grasp());
  const double before = hands.stump().clips.at(0).at;
  // The jaws rest on the clip a little open: friction holds what they press out, too.
  EXPECT_GT(hands.draw(4e-3), 0.38 * clip_hold);
  EXPECT_NEAR(hands.asked, 0.5 * clip_hold, 0.01 * clip_hold);
  EXPECT_EQ(hands.count(EventKind::clip_dropped), 0);
  ASSERT_EQ(hands.stump().clips.size(), 1u);
  EXPECT_EQ(hands.stump().clips[0].at, before);
}

TEST(Clips, AreSetAtSharesOfATubeAlone) {
  Acting acting(across(InstrumentType::clip_applier));
  for (const double share : {-0.1, 1.2, std::numeric_limits<double>::quiet_NaN()}) {
    const Result<bool> set = acting.world.clip("duct", share, ClipSize::m);
    ASSERT_FALSE(set) << share;
    EXPECT_EQ(set.failure().kind, FailureKind::scenario);
    EXPECT_TRUE(acting.world.field().organs[0].clips.empty());
  }
  for (const double share : {0.0, 1.0}) {
    ASSERT_TRUE(acting.world.clip("duct", share, ClipSize::m));
    const Organ& organ = acting.world.field().organs[0];
    EXPECT_TRUE(organ.body->as_tube()->has(organ.clips.back().at)) << share;
  }
}

TEST(Clips, OnTheSpecimensSideAloneDoNotMakeACutSafe) {
  ClipAndCut hands;
  ASSERT_TRUE(hands.clip_at(6e-3) && hands.cut());
  EXPECT_EQ(hands.count(EventKind::cut_unclipped), 1);
}

}  // namespace
}  // namespace calot
