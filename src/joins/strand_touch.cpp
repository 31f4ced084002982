#include "joins/strand_touch.h"

#include <algorithm>
#include <cmath>

#include "collision/parted_motion.h"
#include "group/body_problem.h"

namespace calot {
namespace {

/// What lies between two points of a strand that is about to part, m: less than the thinnest part of an instrument is
/// thick, so that this goes less deep between them than contact_guard.
constexpr double widest_spacing = 0.4e-3;
constexpr int fewest_felt = 8;

/// Of a point at this share of a piece's way: of the strand's radius in the middle.
double swelling(int piece, double share) {
  const double along = 0.5 * (piece + share);
  return 4 * along * (1 - along);
}

}  // namespace

StrandThread strand_thread(const StrandLaw& law, double radius) {
  if (!(radius > 0)) return {};
  // One of its pieces may have all of the way.
  const StrandLaw::Setup& setup = law.setup();
  const double longest = setup.taut + (law.peak() + law.tail()) * setup.length;
  StrandThread out;
  out.radius = radius;
  out.points = std::max(fewest_felt, static_cast<int>(std::ceil(longest / widest_spacing)));
  out.area = 2 * radius * longest / out.points;
  return out;
}

StrandTouch::StrandTouch(std::vector<Shape> shapes, const Barrier& barrier)
    : shapes_(std::move(shapes)), barrier_(barrier) {
  for (const Shape& shape : shapes_) {
    const Bounds around = bounds(offset(shape, barrier.range));
    boxes_.emplace_back(around.lower, around.upper);
  }
}

template <class Use>
void StrandTouch::for_contacts(const StrandThread& thread, const StrandVector& places, const Use& use) const {
  if (thread.points == 0) return;
  Eigen::AlignedBox3d box(places.head<3>(), places.head<3>());
  box.extend(places.segment<3>(3)).extend(places.tail<3>());
  box.min().array() -= thread.radius;
  box.max().array() += thread.radius;
  const double reach = barrier_.range + thread.radius;
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    if (!boxes_[s].intersects(box)) continue;
    for (int piece = 0; piece < 2; ++piece) {
      const auto [from, to] = piece_of(places, piece);
      const double spacing = (to - from).norm() / thread.points;
      for (int k = 0; k < thread.points; ++k) {
        const double share = (k + 0.5) / thread.points;
        const Vec3 at = from + share * (to - from);
        const double distance = signed_distance(shapes_[s], at);
        // No point on the way there is nearer than by that way.
        if (const double far = distance - reach; far >= spacing) {
          const double skipped = far / spacing;
          k += (skipped < thread.points ? static_cast<int>(skipped) : thread.points) - 1;
          continue;
        }
        const double swollen = swelling(piece, share), radius = swollen * thread.radius;
        if (distance - radius >= barrier_.range) continue;
        DistanceSlope slope = distance_slope(shapes_[s], at);
        slope.distance -= radius;
        use(StrandContact{static_cast<int>(s), piece, share, at, swollen * thread.area, slope, radius,
                          barrier_.sample(slope.distance)});
      }
    }
  }
}

void StrandTouch::find(const StrandThread& thread, const StrandVector& places,
                       std::vector<StrandContact>& out) const {
  for_contacts(thread, places, [&](const StrandContact& contact) { out.push_back(contact); });
}

double StrandTouch::value(const StrandThread& thread, const StrandVector& places) const {
  double sum = 0;
  for_contacts(thread, places,
               [&](const StrandContact& contact) { sum += contact.area * contact.answer.energy; });
  return sum;
}

StrandVector StrandTouch::gradient(const StrandThread& thread, const StrandVector& places) const {
  StrandVector out = StrandVector::Zero();
  for_contacts(thread, places, [&](const StrandContact& contact) {
    const Vec3 force = contact.force_on_shape();
    out.segment<3>(3 * contact.piece) += (1 - contact.share) * force;
    out.segment<3>(3 * contact.piece + 3) += contact.share * force;
  });
  return out;
}

namespace {

Mat3 bend_at(const StrandContact& contact, const Shape& shape) {
  return contact_bend(shape, contact.at, contact.slope, contact.radius,
                      contact.area * contact.answer.derivative);
}

}  // namespace

Mat3 StrandTouch::hessian_at(const StrandContact& contact) const {
  const Vec3& normal = contact.slope.gradient;
  return contact.area * contact.answer.second * normal * normal.transpose() +
         bend_at(contact, shapes_[contact.shape]);
}

template <class At>
StrandMatrix StrandTouch::sum_at_contacts(const StrandThread& thread, const StrandVector& places,
                                          const At& at) const {
  StrandMatrix out = StrandMatrix::Zero();
  for_contacts(thread, places, [&](const StrandContact& contact) {
    const Mat3 by_point = at(contact);
    const std::array<double, 2> weight{1 - contact.share, contact.share};
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i)
        out.block<3, 3>(3 * (contact.piece + i), 3 * (contact.piece + j)) += weight[i] * weight[j] * by_point;
  });
  return out;
}

StrandMatrix StrandTouch::hessian(const StrandThread& thread, const StrandVector& places) const {
  return sum_at_contacts(thread, places, [&](const StrandContact& contact) { return hessian_at(contact); });
}

StrandMatrix StrandTouch::convexity(const StrandThread& thread, const StrandVector& places) const {
  return sum_at_contacts(thread, places, [&](const StrandContact& contact) -> Mat3 {
    return -bend_at(contact, shapes_[contact.shape]);
  });
}

double StrandTouch::safe_share(const StrandThread& thread, const StrandVector& places,
                               const StrandVector& motion, double share) const {
  if (thread.points == 0) return share;
  const auto swept = [&](int piece) {
    const auto [from, to] = piece_of(places, piece);
    const auto [by_from, by_to] = piece_of(motion, piece);
    Eigen::AlignedBox3d box(from, from);
    box.extend(to).extend(Vec3(from + share * by_from)).extend(Vec3(to + share * by_to));
    return box;
  };
  for (int piece = 0; piece < 2; ++piece) {
    const StrandPiece at = piece_of(places, piece);
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
      if (!boxes_[s].intersects(swept(piece))) continue;
      const Shape core = core_of(shapes_[s]);
      // What is inside already is pushed out: it is not held there.
      if (!(nearest_on_piece(core, at).slope.distance > 0)) continue;
      StrandPiece by = piece_of(motion, piece);
      for (Vec3& of_end : by) of_end *= share;
      share *= calot::safe_share(at, by, core, contact_keep);
    }
  }
  return share;
}

// The distance is convex along the piece: halvings find where its slope changes sign.
NearestOnPiece nearest_on_piece(const Shape& shape, const StrandPiece& piece) {
  constexpr int halvings = 50;
  const Vec3 way = piece[1] - piece[0];
  NearestOnPiece out{0, distance_slope(shape, piece[0])};
  if (!(out.slope.gradient.dot(way) < 0)) return out;
  out = {1, distance_slope(shape, piece[1])};
  if (!(out.slope.gradient.dot(way) > 0)) return out;
  double low = 0, high = 1;
  for (int k = 0; k < halvings; ++k) {
    const double share = 0.5 * (low + high);
    out = {share, distance_slope(shape, piece[0] + share * way)};
    const double rise = out.slope.gradient.dot(way);
    if (rise == 0) break;
    (rise < 0 ? low : high) = share;
  }
  return out;
}

double safe_share(const StrandPiece& piece, const StrandPiece& motion, const Shape& shape, double keep) {
  constexpr int max_steps = 256;
  Vec3 foot = Vec3::Zero();  // the shape's nearest place, which each parting says anew
  const Vec3 still = Vec3::Zero();
  const MovingCorners ends{piece, motion}, of_shape{{&foot, 1}, {&still, 1}};
  return safe_share_of(ends, of_shape, keep, max_steps, [&](double share) -> Parting {
    const StrandPiece now{piece[0] + share * motion[0], piece[1] + share * motion[1]};
    const NearestOnPiece nearest = nearest_on_piece(shape, now);
    const DistanceSlope& slope = nearest.slope;
    foot = now[0] + nearest.share * (now[1] - now[0]) - slope.distance * slope.gradient;
    return {slope.distance, slope.gradient};
  });
}

}  // namespace calot
