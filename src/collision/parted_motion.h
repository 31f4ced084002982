#pragma once
// How far two sets of corners may move before what they span comes too near: the one loop behind points against
// triangles and edges against edges.

#include <span>

#include "geometry/types.h"

namespace calot {

/// Corners of a point, an edge or a triangle, m, and how they are to move.
struct MovingCorners {
  std::span<const Vec3> at, motion;
};

/// Of what two sets of corners span: the distance, m, and the unit normal from the other's nearest place to one's.
struct Parting {
  double distance = 0;
  Vec3 normal = Vec3::Zero();
};

/// The largest share found (0 to 1) such that for every share s up to it distance(s) >= keep * distance(0); with a
/// thickness between the two, m, such that what is left beside it keeps that share.
/// `parting(share)` is what parts the two once they have gone that share. A plane across the line between the nearest
/// places parts the two: how far they stay on their sides of it is linear in the share, and the distance is at least
/// that (conservative advancement). A share below 1 is not needlessly small: unless all steps are used up, what is
/// left of the distance is at most that + 1e-9 of the longest motion of a corner against another; and
/// each step goes at least as far as the room (the distance less that) takes at that longest motion.
template <class PartingAt>
double safe_share_of(const MovingCorners& one, const MovingCorners& other, double keep, int max_steps,
                     const PartingAt& parting, double thickness = 0) {
  constexpr double negligible = 1e-9;  // of the whole motion
  double share = 0, target = 0;
  for (int step = 0; step < max_steps; ++step) {
    const Parting now = parting(share);
    if (step == 0) target = thickness + keep * (now.distance - thickness);
    if (!(now.distance > target)) return share;
    double advance = 1.0 - share;
    for (std::size_t i = 0; i < one.at.size(); ++i) {
      const Vec3 at = one.at[i] + share * one.motion[i];
      for (std::size_t k = 0; k < other.at.size(); ++k) {
        const Vec3 there = other.at[k] + share * other.motion[k];
        const double room = now.normal.dot(at - there) - target;
        const double approach = now.normal.dot(other.motion[k] - one.motion[i]);
        if (!(approach * advance <= room)) advance = room / approach;
        if (!(advance > 0)) return share;  // a NaN, which the next corner must not hide
      }
    }
    if (advance >= 1.0 - share) return 1.0;
    if (!(advance > negligible)) return share;
    share += advance;
  }
  return share;
}

}  // namespace calot
