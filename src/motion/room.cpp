#include "motion/room.h"

#include <algorithm>
#include <optional>

#include "field/field_tissues.h"
#include "tools/part_path.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// How the shapes move with the tools, by a share of that. The ground stays.
class ShapePaths {
 public:
  ShapePaths(const Field& field, const Poses& from, const Poses& to) : field_(field), from_(from), to_(to) {
    for (std::size_t i = 0; i < from.size(); ++i)
      travel_.push_back(travel_bound(field.tools[i], from[i], to[i]));
  }
  /// Bound on a shape's way, m.
  double travel(int shape) const {
    const FieldShape which = field_.shape(shape);
    return which.is_ground() ? 0.0 : travel_[which.tool.value];
  }
  /// Null: it stays. Valid until another one is asked for.
  const PartPath* of(int shape, double share) {
    const auto [tool, part, ground] = field_.shape(shape);
    if (ground >= 0) return nullptr;
    if (shape != shape_ || share != share_) {
      const InstrumentPose& from = from_[tool.value];
      path_.emplace(field_.tool(tool), part, from, interpolate(from, to_[tool.value], share));
      shape_ = shape, share_ = share;
    }
    return &*path_;
  }

 private:
  const Field& field_;
  const Poses &from_, &to_;
  std::vector<double> travel_;  ///< of the tools
  std::optional<PartPath> path_;
  int shape_ = -1;
  double share_ = 0;
};

}  // namespace

double share_kept_apart(const Field& field, const Organ& organ, const ContactLoads& now,
                        const std::vector<ContactPair>& pairs, const VecX& dx, const Poses& from,
                        const Poses& to) {
  const double longest = organ.body->largest_motion(dx), depth = organ.body->core_depth();
  ShapePaths paths(field, from, to);
  std::vector<Shape> cores;
  for (const Shape& shape : now.shapes) cores.push_back(core_of(shape));
  ContactPlaces places(organ.body->skin(), organ.state.x, organ.body->core_radii()),
      moves(organ.body->skin(), dx);
  double share = 1.0;
  for (const ContactPair& pair : pairs) {
    const Shape& core = cores[pair.shape];
    const double approach = longest + paths.travel(pair.shape);
    if (share * approach < (1.0 - contact_keep) * (pair.distance + depth)) continue;
    const Nearness near = places.nearness(pair.triangle, core);
    const PartPath* path = paths.of(pair.shape, share);
    double way = 0;  // of the triangle's corners
    for (int c = 0; c < 3; ++c) {
      const Vec3 motion = share * moves.corners(pair.triangle).col(c);
      way = std::max(way, path ? path->way(places.corners(pair.triangle).col(c), motion) : motion.norm());
    }
    if (way < (1.0 - contact_keep) * near.of_all()) continue;
    for (int local : organ.body->contact_points(now.is_broad(pair.shape))) {
      const int point = pair.triangle * contacts_each + local;
      if (way < (1.0 - contact_keep) * near.of(point)) continue;
      const Vec3 at = places.at(point), motion = share * moves.at(point);
      path = paths.of(pair.shape, share);
      const double radius = places.radius(point);
      const Shape around = radius > 0 ? offset(core, radius) : core;
      share *= path ? path->share_apart(around, at, motion, contact_keep)
                    : safe_share(at, motion, around, contact_keep);
    }
  }
  return share;
}

double share_kept_apart(const Field& field, const Tissue& tissue, const VecX& x, const VecX& dx,
                        const Poses& from, const Poses& to, double share) {
  const StrandJoin& strands = *tissue.strands;
  const std::vector<Shape>& shapes = strands.touch().shapes();
  ShapePaths paths(field, from, to);
  std::vector<Shape> cores;
  std::vector<Eigen::AlignedBox3d> near;
  for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
    cores.push_back(core_of(shapes[shape]));
    const double travel = paths.travel(static_cast<int>(shape)) / (1.0 - contact_keep);
    const Bounds around = bounds(offset(cores[shape], travel));
    near.emplace_back(around.lower, around.upper);
  }
  for (std::size_t i = 0; i < strands.strands().size(); ++i) {
    if (strands.torn(i) || strands.strands()[i].thread.points == 0) continue;
    const StrandVector places = strands.places(i, x), motion = strands.places(i, dx);
    for (int piece = 0; piece < 2; ++piece) {
      const StrandPiece at = piece_of(places, piece), whole = piece_of(motion, piece);
      const double further = std::max(whole[0].norm(), whole[1].norm()) / (1.0 - contact_keep);
      Eigen::AlignedBox3d box(at[0], at[0]);
      box.extend(at[1]);
      box.min().array() -= further;
      box.max().array() += further;
      for (std::size_t shape = 0; shape < shapes.size(); ++shape) {
        if (!near[shape].intersects(box)) continue;
        const int index = static_cast<int>(shape);
        const double gap = nearest_on_piece(cores[shape], at).slope.distance;
        // What is inside already is pushed out: it is not held there.
        if (!(gap > 0) || gap * (1.0 - contact_keep) > paths.travel(index) + further) continue;
        const StrandPiece by{share * whole[0], share * whole[1]};
        const PartPath* path = paths.of(index, share);
        share *= path ? path->share_apart(cores[shape], at, by, contact_keep)
                      : safe_share(at, by, cores[shape], contact_keep);
      }
    }
  }
  return share;
}

}  // namespace calot
