#pragma once
// What drawn instruments have in common. All in the hinge's frame (tools/instrument.h) unless said otherwise.

#include <array>
#include <functional>
#include <vector>

#include "render/scene.h"
#include "tools/instrument.h"

namespace calot {

/// rad: rounded edges stay smooth, cut ones sharp.
inline constexpr double instrument_crease = 0.6;

/// A surface of revolution about z through (radius, height) points, outward for rising heights.
SceneMesh turned(Material material, const std::vector<Vec2>& profile, int around);

/// Outline of a jaw (or of its window) in the plane of its width y and length z: a rounded strip that
/// narrows or widens.
struct Outline {
  double start, end;            // z, m
  double start_half, end_half;  // half width, m
  double half_width(double z) const;
  /// t in [0, 1) runs once around, counter-clockwise seen from +x; `inset` moves inward.
  Vec2 at(double t, double inset) const;
};

/// How far inside a jaw's outline and how far behind its pad a ring of a jaw's surface runs, m.
struct JawRing {
  double inset, x;
  bool on_axis = false;  ///< drawn together onto its middle: front and back close there
};

/// A solid within an outline: rings from the middle of its front over its flank to the middle of its back. `place` may
/// move points of it, told of their row.
SceneMesh jaw_slab(Material material, const Outline& outline, const std::vector<JawRing>& rings,
                   const std::function<void(int row, Vec3& at)>& place);

/// A round bar along a line in the plane of the hinge frame's x and z, its far end a half ball about the last point.
SceneMesh bent_bar(Material material, const std::vector<Vec3>& line, double radius);

/// What is steel and what is insulated of one part that moves as a whole.
struct InstrumentPart {
  SceneMesh steel, insulation;  ///< without points where it has none
};

/// An instrument as it is drawn, wherever it stands: laid out once, and only moved for each picture.
struct InstrumentModel {
  InstrumentGeometry geometry;
  InstrumentPart shaft;  ///< in the hinge's frame
  /// Each in its jaw's frame (tools/instrument.h); empty where it has none.
  std::array<InstrumentPart, 2> jaws;
};

/// Insulated shaft and its steel end with a clevis and its pin.
InstrumentPart forceps_shaft(const InstrumentGeometry& geometry);

}  // namespace calot
