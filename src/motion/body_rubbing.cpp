#include "motion/body_rubbing.h"

#include <algorithm>

#include "joins/skin_join.h"
#include "motion/rubbing.h"

namespace calot {
namespace {

std::vector<GroupPlace> places_in_group(const Field& field) {
  std::vector<GroupPlace> out;
  int first = 0;
  for (const Organ& organ : field.organs) {
    out.push_back({organ.body.get(), first});
    first += organ.body->nodes();
  }
  return out;
}

VecX joined(const std::vector<VecX>& organs) {
  Eigen::Index size = 0;
  for (const VecX& x : organs) size += x.size();
  VecX out(size);
  Eigen::Index first = 0;
  for (const VecX& x : organs) {
    out.segment(first, x.size()) = x;
    first += x.size();
  }
  return out;
}

Vec3 push(const BodyPlaces& places, const SkinHold& held) {
  return places.frame(held).turn * (held.hold.limit * held.hold.normal);
}

/// Sum of the changes of the points' limits along their normals, over the sum of the limits.
double change(const BodyPlaces& places, std::span<const SkinHold> from, std::span<const SkinHold> to) {
  double changed = 0, sum = 0;
  for (const SkinHold& held : to) {
    const SkinHold* old = find_hold(from, held.pair);
    sum += held.hold.limit;
    const Vec3 now = push(places, held), was = old ? push(places, *old) : Vec3(Vec3::Zero());
    changed += (now - was).norm();
  }
  for (const SkinHold& held : from)
    if (!find_hold(to, held.pair)) changed += held.hold.limit;
  return changed / std::max(sum, least_friction);
}

/// Where the spring of `old` pulls to, in the frame of `now`: what it is stretched by stays, wherever it is measured.
Vec3 anchor_of(const BodyPlaces& before, const SkinHold& now, const SkinHold* old) {
  if (old && old->place == now.place && old->across == now.across) return old->hold.anchor;
  const RubbingFrame frame = before.frame(now);
  if (!old) return frame.at;
  const RubbingFrame old_frame = before.frame(*old);
  return frame.at - frame.turn.transpose() * (old_frame.turn * (old_frame.at - old->hold.anchor));
}

}  // namespace

std::vector<JoinPointer> joins_with(std::vector<JoinPointer> joins, const std::vector<SkinHold>& rubbing) {
  if (!rubbing.empty()) joins.push_back(std::make_shared<SkinRubbing>(rubbing));
  return joins;
}

double renew_body_friction(const Field& field, const std::vector<VecX>& before, double share,
                           std::vector<SkinHold>& rubbing) {
  if (!(field.group.friction > 0)) return 0;
  const std::vector<GroupPlace> bodies = places_in_group(field);
  const VecX x = joined(present_places(field)), x_before = joined(before);
  const BodyPlaces places(bodies, x), places_before(bodies, x_before);
  std::vector<SkinHold> now;
  for (const JoinPointer& join : field.group.joins) {
    if (join->skins() == nullptr) continue;
    for (const SkinPress& press : join->skins()->pressing(x)) {
      const double normal = press.force.norm();
      if (!(normal > 0)) continue;
      SkinHold held{press.pair, press.place, places_before.across(press.place), {}};
      held.hold.normal = places.frame(held).turn.transpose() * (press.force / normal);
      held.hold.limit = field.group.friction * normal;
      held.hold.stiffness = stick_stiffness * press.area;
      held.hold.anchor = anchor_of(places_before, held, find_hold(field.group.rubbing, press.pair));
      now.push_back(held);
    }
  }
  std::sort(now.begin(), now.end(), [](const SkinHold& a, const SkinHold& b) { return a.pair < b.pair; });
  const double changed = change(places, rubbing, now);
  for (SkinHold& held : now) {
    const SkinHold* old = find_hold(rubbing, held.pair);
    const double limit = old ? old->hold.limit : 0.0;
    held.hold.limit = limit + share * (held.hold.limit - limit);
  }
  rubbing = std::move(now);
  return changed;
}

void keep_body_friction(Field& field, std::vector<SkinHold> rubbing) {
  const std::vector<GroupPlace> bodies = places_in_group(field);
  const VecX x = joined(present_places(field));
  const BodyPlaces places(bodies, x);
  for (SkinHold& held : rubbing) held.hold.anchor = held.hold.anchor_after(places.frame(held).at);
  field.group.rubbing = std::move(rubbing);
}

}  // namespace calot
