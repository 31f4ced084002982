#include "field/join_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "geometry/tri_mesh.h"
#include "joins/skin_place.h"

namespace calot {

namespace {

/// What is tied as it is drawn has to reach what it is tied to.
std::optional<Failure> ends_nowhere(const JointDefinition& joint, const Vec3& end, const Organ& other) {
  const double within = joint.radius + other.body->thickest();
  const SkinFinder skin(*other.body, other.body->skin_rest());
  if (!skin.nearest(end, within).place.points.empty()) return std::nullopt;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& p : other.body->skin_rest()) nearest = std::min(nearest, (p - end).norm());
  return fail(
      FailureKind::scenario,
      fmt::format(
          "{} ends nowhere: it lies {:.3g} mm from '{}', further than the joint's radius of {:.3g} mm",
          joint.from, 1e3 * (nearest - other.body->thickest()), other.definition.name, 1e3 * joint.radius),
      "draw it up to there, or raise the joint's radius");
}

}  // namespace

Result<bool> add_joint(const JointDefinition& joint, bool at_rest, Field& field) {
  const OrganPoint at = *find_landmark(field.organs, joint.from);  // both are known to be there
  const OrganPoint to = *find_landmark(field.organs, joint.to);
  const Organ &first = field.organ(at.organ), &second = field.organ(to.organ);
  const int one = at.organ.value, other = to.organ.value, from = at.skin_point;
  std::array<std::vector<Vec3>, 2> skins{first.body->skin_rest(), second.body->skin_rest()};
  if (at_rest)
    if (std::optional<Failure> failure = ends_nowhere(joint, skins[0][from], second)) return *failure;
  if (!at_rest)
    skins = {first.body->skin_positions(first.state.x), second.body->skin_positions(second.state.x)};
  Result<JointLinks> links = joint_links(*first.body, *second.body, skins, {one, other}, skins[0][from],
                                         joint.radius, joint.stiffness);
  if (!links) return links.failure();
  field.membership.joints.push_back({std::make_shared<const Joint>(std::move(links).value())});
  // Where one grows out of the other they lie in each other: as far as both are thick there.
  const double within = joint.radius + 2 * (first.body->thickest() + second.body->thickest()) + joint_fold;
  const std::array bodies{std::min(one, other), std::max(one, other)};
  field.membership.tied.push_back({bodies, {first.body->skin_rest()[from], within}});
  if (!at_rest) {  // at rest they may have been far apart
    const int there = nearest_of(skins[1], skins[0][from]);
    field.membership.tied.push_back({bodies, {second.body->skin_rest()[there], within}});
  }
  return true;
}

void renew_joins(Field& field) {
  std::vector<JoinPointer>& joins = field.group.joins;
  joins.clear();
  field.group.rubbing.clear();  // it knows bodies by their places: they begin to stick anew
  for (const FieldJoint& joint : field.membership.joints) joins.push_back(joint.joint);
  const int bodies = static_cast<int>(field.organs.size());
  for (int one = 0; one < bodies; ++one)
    for (int other = one + 1; other < bodies; ++other) {
      std::vector<JoinedPlace> places;
      for (const TiedPlace& tied : field.membership.tied)
        if (tied.bodies == std::array{one, other}) places.push_back(tied.place);
      joins.push_back(std::make_shared<SkinJoin>(*field.organs[one].body, *field.organs[other].body,
                                                 std::array{one, other}, places));
    }
}

namespace {

std::optional<SkinOverlap> overlap_of(const SkinJoin& join, const Organ& one, const Organ& other,
                                      const VecX& x) {
  const auto may_hold = [](const Organ& outer, const Organ& inner) {
    return is_hollow(outer.definition.shape) && std::holds_alternative<RigidShape>(inner.definition.shape);
  };
  return join.overlap(x, {may_hold(one, other), may_hold(other, one)});
}

/// Calls use(join, one organ's index, the other's, where all are) for the contact of each two organs.
template <class Use>
void for_pairs(const Field& field, const Use& use) {
  std::vector<GroupPlace> places;
  std::vector<double> all;
  for (const Organ& organ : field.organs) {
    places.push_back({organ.body.get(), static_cast<int>(all.size()) / 3});
    all.insert(all.end(), organ.state.x.begin(), organ.state.x.end());
  }
  const VecX x = Eigen::Map<const VecX>(all.data(), static_cast<Eigen::Index>(all.size()));
  for (const JoinPointer& join : field.group.joins) {
    const SkinJoin* skins = join->skins();
    if (skins == nullptr) continue;
    skins->begin(places);
    use(*skins, skins->bodies()[0], skins->bodies()[1], x);
  }
}

}  // namespace

std::optional<Problem> overlap_problem(const SkinJoin& join, const Organ& one, const Organ& other,
                                       const VecX& x) {
  const std::optional<SkinOverlap> found = overlap_of(join, one, other, x);
  if (!found) return std::nullopt;
  const Vec3 at = 1e3 * found->place;
  return Problem{
      {},
      fmt::format(
          "organ '{}' and organ '{}' are {:.2g} mm deep in each other, at ({:.0f}, {:.0f}, {:.0f}) mm",
          one.definition.name, other.definition.name, 1e3 * found->depth, at.x(), at.y(), at.z()),
      "move one away by as much and a little more; where one grows out of the other, tie them "
      "there by a joint"};
}

std::vector<Vec3> overlap_places(const Field& field) {
  std::vector<Vec3> out;
  for_pairs(field, [&](const SkinJoin& join, int one, int other, const VecX& x) {
    if (const auto found = overlap_of(join, field.organs[one], field.organs[other], x))
      out.push_back(found->place);
  });
  for (const Organ& organ : field.organs)
    for (const Ground& ground : field.ground) {
      const std::vector<Vec3> skin = organ.body->skin_positions(organ.state.x);
      double least = 0;
      const Vec3* deepest = nullptr;
      for (std::size_t row = 0; row < skin.size(); ++row) {
        const double radius = organ.body->is_line() ? organ.body->skin_radii()[row] : 0;
        const double distance = signed_distance(ground.shape, skin[row]) - radius;
        if (distance < least) least = distance, deepest = &skin[row];
      }
      if (deepest != nullptr) out.push_back(*deepest);
    }
  return out;
}

namespace {

std::vector<Problem> overlap_problems(const Field& field) {
  std::vector<Problem> problems;
  for_pairs(field, [&](const SkinJoin& join, int one, int other, const VecX& x) {
    std::optional<Problem> problem = overlap_problem(join, field.organs[one], field.organs[other], x);
    if (!problem) return;
    problem->place.path = fmt::format("scene.anatomy.organs[{}]", other + 1);
    problems.push_back(std::move(*problem));
  });
  return problems;
}

}  // namespace

Result<bool> join_bodies(const AnatomyDefinition& anatomy, Field& field) {
  field.group.friction = anatomy.friction;
  for (std::size_t i = 0; i < anatomy.joints.size(); ++i) {
    Result<bool> made = add_joint(anatomy.joints[i], true, field);
    if (made) continue;
    Failure failure = made.failure();
    for (Problem& problem : failure.problems)
      problem.place = {"", 0, fmt::format("scene.anatomy.joints[{}]", i + 1)};
    return failure;
  }
  renew_joins(field);
  std::vector<Problem> problems = overlap_problems(field);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  return true;
}

}  // namespace calot
