#pragma once
// What current does to walls: it heats those near to what it flows through, each by its distance. What a place of a wall
// has taken stays there: heat that comes back goes on from it. A hollow organ's wall opens where a place has taken its
// burn_energy; a liver loses its capsule by the area that what it took pays for.

#include <vector>

#include "field/field.h"
#include "tools/events.h"

namespace calot {

/// The weight of a wall among all that one instrument's current heats, 0 to 1, by the distance (m) of its surface from
/// what current flows through:
///
///   1                                            where they touch: distance <= contact_gap
///   (reach - distance) / (reach - contact_gap)   beyond that
///   0                                            from reach on
///
/// A design value, as the reach is: no figure of how heat spreads from an electrode beside wet tissue is in it.
double burn_weight(double distance, double reach);

/// A place of a wall that one piece of what current flows through heats.
struct HeatedPlace {
  Vec3 at = Vec3::Zero();  ///< m, of its surface: what is nearest to the piece
  double weight = 0;       ///< > 0, by the piece's distance
};
/// A wall that is nearer than its burn_reach to what current flows through, or touches it.
struct ReachedWall {
  Organ* organ = nullptr;
  std::vector<HeatedPlace> places;  ///< one or more, along what current flows through
  double weight() const;            ///< by what is nearest: the largest of them
};
/// Those of a field, in its organs' order. `shapes`: what current flows through, as it is made. It heats by pieces of 1 to
/// 2 mm along it: what lies along a wall burns a line, and a tip a spot.
std::vector<ReachedWall> reached_walls(Field& field, const std::vector<Shape>& shapes);

/// Shares energy (J, >= 0) among a wall's heated places by their weights. What that begins is an event, without a time: a
/// hollow organ's wall is opened (once a place), what should be kept is injured (once a place), a capsule is off by more
/// than 1 mm^2 in one piece (once a piece).
void burn(const ReachedWall& wall, const std::string& instrument, double energy,
          std::vector<WorldEvent>& events);

}  // namespace calot
