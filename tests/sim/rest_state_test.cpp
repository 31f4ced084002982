// A rest state that was kept is as good as one that is found anew, to the last bit, and no other scene's.

#include "world/rest_state.h"

#include <gtest/gtest.h>

#include "anatomy/key_table.h"
#include "field/field_hash.h"
#include "support/remembered_results.h"
#include "triangle_rig.h"
#include "world/definition_digest.h"

namespace calot::rest_state_test {
namespace {

World made(const SceneDefinition& scene, KeptResults* kept) {
  return World::create(scene, nullptr, 1, kept).value();
}

/// State hashes at rest and as an instrument comes in.
std::vector<std::uint64_t> played(World world) {
  std::vector<std::uint64_t> out{world.state_hash()};
  StepInput input;
  for (const Tool& tool : world.field().tools) input.instruments.push_back(tool.pose);
  for (int step = 0; step < 10; ++step) {
    for (InstrumentPose& pose : input.instruments) pose.insertion += 1e-3;
    out.push_back(world.step(input).value().state_hash);
  }
  return out;
}

SceneDefinition triangle(SolverMotion motion = SolverMotion::statics) {
  SceneDefinition scene = test::triangle_scene();
  scene.solver.motion = motion;
  return scene;
}

void expect_same_bits(const SceneDefinition& scene) {
  test::RememberedResults results;
  const std::vector<std::uint64_t> anew = played(made(scene, nullptr));
  EXPECT_EQ(played(made(scene, &results)), anew) << "to keep it changes nothing";
  ASSERT_EQ(results.kept, 1);
  EXPECT_EQ(played(made(scene, &results)), anew);
  EXPECT_EQ(results.found, 1);
  EXPECT_EQ(results.kept, 1) << "it was not looked for again";
}

TEST(RestState, ThatWasKeptPlaysToTheSameBits) { expect_same_bits(triangle()); }
TEST(RestState, ThatWasKeptPlaysToTheSameBitsInDynamics) {
  expect_same_bits(triangle(SolverMotion::dynamics));
}

// A search may end in a solve whose last matrix was not positive definite.
TEST(RestState, WithoutAFactorHasThePatternsThatLaterStepsGoOnFrom) {
  const World world = made(triangle(), nullptr);
  Field found = world.field();
  ASSERT_FALSE(found.group.patterns.joined.empty());
  found.group.work.factored = false;
  found.group.work.shifted = true;
  const std::optional<RestState> kept = rest_state_of(to_bytes(rest_state(found)));
  ASSERT_TRUE(kept);
  Field other = world.field();
  other.group.patterns = {};
  other.group.work = NewtonWorkspace(BlockMatrix(0, {}));
  ASSERT_NE(hash_of(other), hash_of(found));
  ASSERT_TRUE(take_rest_state(*kept, other));
  EXPECT_EQ(hash_of(other), hash_of(found));
}

TEST(RestState, OfAFieldWithALobeIsKeptBesideTheLobesReduction) {
  SceneDefinition scene = triangle();
  scene.anatomy.organs[1] = test::lobe_behind();
  const std::vector<std::uint64_t> anew = played(made(scene, nullptr));
  test::RememberedResults results;
  EXPECT_EQ(played(made(scene, &results)), anew);
  EXPECT_EQ(results.kept, 2);
  EXPECT_EQ(played(made(scene, &results)), anew);
  EXPECT_EQ(results.found, 2);
  EXPECT_EQ(results.kept, 2) << "neither was made again";
  SceneDefinition other = scene;
  other.anatomy.organs[0].bile.fill_volume.reset();
  other.anatomy.organs[0].bile.fill_pressure = 900;
  made(other, &results);
  EXPECT_EQ(results.found, 3) << "beside another gallbladder it is the same lobe";
  other.anatomy.organs[1].shape = LobeShape{.bed_width = 0, .bed_depth = 0, .young = 7e3};
  made(other, &results);
  EXPECT_EQ(results.found, 3);
  EXPECT_EQ(results.kept, 5);
}

TEST(RestState, ThatWasKeptIsReportedAlike) {
  test::RememberedResults results;
  const World first = made(triangle(), &results), second = made(triangle(), &results);
  ASSERT_EQ(results.found, 1);
  ASSERT_EQ(first.rest_shifts().size(), second.rest_shifts().size());
  for (std::size_t k = 0; k < first.rest_shifts().size(); ++k) {
    EXPECT_EQ(first.rest_shifts()[k].distance, second.rest_shifts()[k].distance);
    EXPECT_EQ(first.rest_shifts()[k].landmark, second.rest_shifts()[k].landmark);
  }
  const StepReport &one = first.report(), &other = second.report();
  ASSERT_EQ(one.organs.size(), other.organs.size());
  for (std::size_t k = 0; k < one.organs.size(); ++k)
    EXPECT_EQ(one.organs[k].pressure, other.organs[k].pressure);
}

TEST(RestState, ThatIsBrokenIsFoundAnew) {
  test::RememberedResults results;
  const std::uint64_t anew = made(triangle(), &results).state_hash();
  const std::string whole = results.all.begin()->second;
  std::string longer = whole + "x", other_organs = whole;
  other_organs[0] = static_cast<char>(other_organs[0] + 1);
  for (const std::string& broken : {std::string(), whole.substr(0, whole.size() / 2),
                                    whole.substr(0, whole.size() - 1), longer, other_organs}) {
    results.all.begin()->second = broken;
    EXPECT_EQ(made(triangle(), &results).state_hash(), anew);
    EXPECT_EQ(results.all.begin()->second, whole) << "and takes its place";
  }
}

TEST(RestState, OfAnotherFieldIsRefusedAndChangesNothing) {
  test::RememberedResults results;
  made(triangle(), &results);
  const RestState state = rest_state_of(results.all.begin()->second).value();
  EXPECT_EQ(to_bytes(state), results.all.begin()->second);
  SceneDefinition fewer = triangle();
  fewer.anatomy.tissue.pop_back();
  World other = made(fewer, nullptr);
  Field field = other.field();
  const VecX x = field.organs[0].state.x;
  EXPECT_FALSE(take_rest_state(state, field));
  EXPECT_EQ(field.organs[0].state.x, x);
}

/// Every key of a struct's table, changed on its own, changes the key.
template <class T>
void expect_each_key_counts(const std::string& table,
                            const std::function<void(SceneDefinition&, const T&)>& put) {
  SceneDefinition usual = triangle();
  put(usual, T{});
  const std::string before = rest_key(usual, {});
  int tried = 0;
  for (const Key& key : scene_key_table(table, typeid(T)).keys) {
    if (!key.field) continue;
    T other;
    const KeyTarget field = key.field(&other);
    if (auto* const* number = std::get_if<double*>(&field)) **number += 1e-9;
    if (auto* const* number = std::get_if<std::optional<double>*>(&field)) **number = 1;
    if (auto* const* number = std::get_if<int*>(&field)) **number += 1;
    if (auto* const* flag = std::get_if<bool*>(&field)) **flag = !**flag;
    if (auto* const* text = std::get_if<std::string*>(&field)) **text += "x";
    if (auto* const* place = std::get_if<Vec3*>(&field)) (*place)->z() += 1e-9;
    if (const EnumField* choice = std::get_if<EnumField>(&field)) {
      choice->set(choice->place, 1);
      T first;
      const KeyTarget same = key.field(&first);
      const EnumField zero = std::get<EnumField>(same);
      zero.set(zero.place, 0);
      SceneDefinition at_zero = triangle();
      put(at_zero, first);
      SceneDefinition at_one = triangle();
      put(at_one, other);
      EXPECT_NE(rest_key(at_one, {}), rest_key(at_zero, {})) << table << "." << key.name;
      ++tried;
      continue;
    }
    SceneDefinition scene = triangle();
    put(scene, other);
    EXPECT_NE(rest_key(scene, {}), before) << table << "." << key.name;
    ++tried;
  }
  EXPECT_GT(tried, 0) << table;
}

TEST(RestState, OfAnotherDefinitionHasAnotherKey) {
  using Scene = SceneDefinition;
  expect_each_key_counts<AnatomyDefinition>("anatomy",
                                            [](Scene& s, const AnatomyDefinition& d) { s.anatomy = d; });
  expect_each_key_counts<SolverDefinition>("solver",
                                           [](Scene& s, const SolverDefinition& d) { s.solver = d; });
  expect_each_key_counts<OrganDefinition>(
      "organ", [](Scene& s, const OrganDefinition& d) { s.anatomy.organs[1] = d; });
  expect_each_key_counts<WallDefinition>(
      "wall", [](Scene& s, const WallDefinition& d) { s.anatomy.organs[1].wall = d; });
  expect_each_key_counts<BileDefinition>(
      "bile", [](Scene& s, const BileDefinition& d) { s.anatomy.organs[1].bile = d; });
  expect_each_key_counts<JointDefinition>(
      "joint", [](Scene& s, const JointDefinition& d) { s.anatomy.joints[1] = d; });
  expect_each_key_counts<TissueDefinition>(
      "tissue", [](Scene& s, const TissueDefinition& d) { s.anatomy.tissue[1] = d; });
  expect_each_key_counts<GroundDefinition>(
      "ground", [](Scene& s, const GroundDefinition& d) { s.anatomy.ground = {d}; });
  expect_each_key_counts<SupportDefinition>(
      "support", [](Scene& s, const SupportDefinition& d) { s.anatomy.support = d; });
}

TEST(RestState, OfAnotherShapeOrFieldHasAnotherKey) {
  const World world = made(triangle(), nullptr);
  const std::string usual = rest_key(triangle(), world.field());
  SceneDefinition moved = triangle();
  std::get<TubeShape>(moved.anatomy.organs[1].shape).points[1].x() += 1e-12;
  EXPECT_NE(rest_key(moved, world.field()), usual);
  Field field = world.field();
  field.organs[0].state.x[0] += 1e-12;
  EXPECT_NE(rest_key(triangle(), field), usual) << "what a mesh's file holds is known by its nodes alone";
  SceneDefinition other_tools = triangle();
  other_tools.instruments.clear();
  EXPECT_EQ(rest_key(other_tools, world.field()), usual) << "instruments come after the rest state";
}

}  // namespace
}  // namespace calot::rest_state_test
