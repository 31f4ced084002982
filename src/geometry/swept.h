#pragma once
// A closed surface along a curved axis, as a surface of revolution that is bent: an organ with a pouch and a neck.

#include <vector>

#include "geometry/shapes.h"
#include "geometry/tube.h"

namespace calot {

/// A place on the axis, and how thick the organ is there.
struct SweptStation {
  Vec3 at = Vec3::Zero();  ///< m
  double radius = 5e-3;    ///< m, about the axis
  double refine = 1;       ///< control nodes are closer by this factor around it
  bool operator==(const SweptStation&) const = default;
};

/// The axis goes through the stations, smooth, from pole to pole; radii in between lie between their neighbours', and
/// both ends are rounded off by their own radius.
class SweptForm {
 public:
  /// Two stations or more, neighbours apart; `side` is the axis' frames' side at its start, not along it.
  SweptForm(std::vector<SweptStation> stations, const Vec3& side);

  double length() const { return way_.back(); }  ///< m, of the axis
  double radius(double z) const;                 ///< m, at a way along the axis, before the ends are rounded
  Profile profile() const;                       ///< of the straightened organ, from its start at height 0
  double spacing(const Vec3& straight) const;    ///< of control nodes, relative: closer where it is thin
  Vec3 bent(const Vec3& straight) const;         ///< where a place of the straightened organ lies, m
  /// The way (m) at which the axis bends most sharply for its radius, and radius times curvature there: from 1 on the
  /// surface folds.
  struct Bend {
    double way = 0, radius_by_curvature = 0;
  };
  Bend sharpest() const;

 private:
  std::vector<SweptStation> stations_;
  std::vector<double> station_way_, slope_;  ///< of each station: m along the axis; of the radius there
  std::vector<Vec3> line_;                   ///< m, the axis in small steps
  std::vector<double> way_;                  ///< m, to each point of it
  std::vector<LineFrame> frames_;
};

}  // namespace calot
