#pragma once
// What lies across open jaws: in the plane in which they open, y = 0 of the hinge's frame, between their pads. Nothing lies
// across those of a tool that waits outside.

#include "field/field.h"

namespace calot {

/// Share of a tube's width or lumen that is left open: none (0) where it is less than can be told from shut.
inline double open_share(double left) {
  constexpr double shut = 0.02;
  return left < shut ? 0.0 : left;
}

/// Where a duct or a vessel passes between the pads.
struct TubeBetween {
  OrganIndex organ;
  double at = 0;              ///< skin points from its start
  Vec3 place = Vec3::Zero();  ///< m, in the hinge's frame
  Vec3 along = Vec3::Zero();  ///< unit, the tube's way, in the hinge's frame
  double gap = 0;             ///< m, of the pads there
  double radius = 0;          ///< m, outer
};

/// Whether an organ feels the jaws of a tool: not while it lies between blades that have cut it.
bool feels(const Organ& organ, ToolIndex instrument);

/// Of all tubes that feel the jaws, in the order of organs and places.
std::vector<TubeBetween> tubes_between(const Field& field, ToolIndex instrument);

/// Whether the line between two places (m) lies between a tool's pads now, and would not if its jaws were closed by `angle`
/// (rad) more: then the jaws' edge passes it as they close by that.
bool is_passed(const Tool& tool, const Vec3& from, const Vec3& to, double angle);

/// A clip on a tube that is between the pads of a tool, anywhere over their width.
struct ClipBetween {
  int clip = 0;                    ///< place among the organ's
  Vec3 place = Vec3::Zero();       ///< m, the tube's middle there
  double half_height = 0;          ///< m, of the clip across its legs
  std::array<int, 2> points = {};  ///< skin points of the tube before and behind it
};
/// Of an organ, in the order of their places; of one that does not feel the jaws there are none.
std::vector<ClipBetween> clips_between(const Field& field, ToolIndex instrument, const Organ& organ);

}  // namespace calot
