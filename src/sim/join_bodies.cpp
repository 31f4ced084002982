#include "sim/join_bodies.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/joint.h"
#include "sim/skin_join.h"

namespace calot {
namespace {

struct TiedPlace {
  std::array<int, 2> bodies{};
  JoinedPlace place;
};

Result<TiedPlace> tie(const JointDefinition& joint, Field& field) {
  const auto [one, from] = find_landmark(field.organs, joint.from);  // validation has found both
  const int other = find_landmark(field.organs, joint.to).first;
  const Body &first = *field.organs[one].body, &second = *field.organs[other].body;
  const Vec3 place = first.skin_rest()[from];
  Result<JointLinks> links = joint_links(first, second, {one, other}, place, joint.radius, joint.stiffness);
  if (!links) return links.failure();
  field.group.joins.push_back(std::make_shared<Joint>(std::move(links).value()));
  // Where one grows out of the other they lie in each other: as far as both are thick there.
  constexpr double fold = 3e-3;  // m, of the wall around it
  return TiedPlace{{std::min(one, other), std::max(one, other)},
                   {place, joint.radius + 2 * (first.thickest() + second.thickest()) + fold}};
}

}  // namespace

Result<bool> join_bodies(const AnatomyDefinition& anatomy, Field& field) {
  std::vector<TiedPlace> tied;
  for (std::size_t i = 0; i < anatomy.joints.size(); ++i) {
    Result<TiedPlace> made = tie(anatomy.joints[i], field);
    if (!made) {
      Failure failure = made.failure();
      for (Problem& problem : failure.problems)
        problem.place = {"", 0, fmt::format("scene.anatomy.joints[{}]", i + 1)};
      return failure;
    }
    tied.push_back(made.value());
  }
  field.group.friction = anatomy.friction;
  const int bodies = static_cast<int>(field.organs.size());
  for (int one = 0; one < bodies; ++one)
    for (int other = one + 1; other < bodies; ++other) {
      std::vector<JoinedPlace> places;
      for (const TiedPlace& place : tied)
        if (place.bodies == std::array{one, other}) places.push_back(place.place);
      field.group.joins.push_back(std::make_shared<SkinJoin>(
          *field.organs[one].body, *field.organs[other].body, std::array{one, other}, places));
    }
  return true;
}

}  // namespace calot
