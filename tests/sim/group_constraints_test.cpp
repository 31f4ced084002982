// Where the constraints of bodies stand among those of their group.

#include <gtest/gtest.h>

#include <numeric>

#include "field/moving_bodies.h"
#include "group/group_problem.h"
#include "motion/settle_field.h"
#include "motion_rig.h"

namespace calot {
namespace {

/// A duct, and two balls that are filled; in a part of a motion where masses count.
Field duct_and_balls(bool masses_count) {
  Field field;
  OrganDefinition duct = test::heavy(OrganDefinition{});
  duct.name = "duct";
  duct.shape = TubeShape{.points = {{0, 50e-3, 0}, {0, 50e-3, 30e-3}}, .radius = 1.8e-3};
  duct.wall.thickness = 0.8e-3;
  duct.held = {{"first", "start", 4e-3, 1e6}};
  OrganDefinition left = test::heavy(test::held_ball()), right = left;
  right.neck.x() = right.fundus.x() = 80e-3;
  for (const OrganDefinition& organ : {left, duct, right})
    field.add(make_organ(organ, {}, Vec3::UnitZ(), 1e-6).value());
  if (!masses_count) return field;
  field.step_time = 0.02;
  begin_parts(next_parts(field).value(), field.step_time, field);
  return field;
}

VecX constraint_values(Field& field, const std::vector<ContactLoads>& loads) {
  const std::vector<Member> members = members_of(field, loads);
  GroupPatterns patterns;
  const GroupProblem problem(members, {}, patterns);
  return problem.constraint_values(problem.coordinates());
}

TEST(GroupConstraints, AVolumesStandsWhereItIsSaidToWithAndWithoutMasses) {
  for (const bool masses_count : {false, true}) {
    Field field = duct_and_balls(masses_count);
    const std::vector<ContactLoads> loads = solve_loads(field, {});
    std::vector<int> counts;
    for (const Organ& organ : field.organs) counts.push_back(constraints_of(*organ.body, masses_count));
    const std::vector<Eigen::Index> volumes = volume_constraints(counts);
    const VecX before = constraint_values(field, loads);
    ASSERT_EQ(before.size(), std::accumulate(counts.begin(), counts.end(), 0)) << masses_count;
    EXPECT_EQ(volumes[1], -1) << "a duct is not filled";
    for (std::size_t k : {0u, 2u}) {
      constexpr double more = 1e-7;
      field.organs[k].state.volume += more;
      const VecX change = constraint_values(field, loads) - before;
      field.organs[k].state.volume -= more;
      VecX wanted = VecX::Zero(before.size());
      wanted[volumes[k]] = -more;
      EXPECT_LT((change - wanted).lpNorm<Eigen::Infinity>(), 1e-9 * more) << masses_count << k;
    }
  }
}

}  // namespace
}  // namespace calot
