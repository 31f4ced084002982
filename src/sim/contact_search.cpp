#include "sim/contact_search.h"

#include <algorithm>

namespace calot {
namespace {

/// Pairs nearer than `reach`.
std::vector<ContactPair> pairs_within(const VirtualStructure& body, const VecX& x, const Surroundings& field,
                                      double reach) {
  std::vector<Eigen::AlignedBox3d> faces;
  for (const VirtualStructure::SkinFace& face : body.skin_faces()) {
    Eigen::AlignedBox3d box;
    double details = 0;
    for (int node : face.nodes) {
      const Vec3 at = x.segment<3>(Eigen::Index{3} * node);
      if (node < body.coarse_nodes())
        box.extend(at);
      else
        details += 0.5 * at.norm();
    }
    const Vec3 wider = Vec3::Constant(details);
    faces.emplace_back(box.min() - wider, box.max() + wider);
  }
  std::vector<ContactPair> pairs;
  for (std::size_t k = 0; k < field.shapes.size(); ++k) {
    const Bounds b = bounds(field.shapes[k]);
    const Eigen::AlignedBox3d near(b.lower - Vec3::Constant(reach), b.upper + Vec3::Constant(reach));
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const double far = reach + 0.5 * faces[f].diagonal().norm();
      if (!near.intersects(faces[f]) || signed_distance(field.shapes[k], faces[f].center()) > far) continue;
      for (int row : body.skin_faces()[f].rows) {
        const Vec3 at = body.contact_point(row, x);
        if (!near.contains(at)) continue;
        const double distance = signed_distance(field.shapes[k], at);
        if (distance < reach) pairs.push_back({row, static_cast<int>(k), distance});
      }
    }
  }
  return pairs;
}

double reach_of(const Surroundings& field, double extra) {
  return field.barrier.range + contact_margin + extra;
}

}  // namespace

std::vector<ContactPair> gather_pairs(const VirtualStructure& body, const VecX& x, const Surroundings& field,
                                      double extra) {
  return pairs_within(body, x, field, reach_of(field, extra));
}

void ContactSearch::look_again(const VirtualStructure& body, const VecX& x, const Surroundings& field,
                               double approach) {
  for (ContactPair& pair : near_)
    pair.distance = signed_distance(field.shapes[pair.shape], body.contact_point(pair.row, x));
  reach_ -= approach;
  shapes_ = field.shapes;
  x_ = x;
}

std::vector<ContactPair> ContactSearch::pairs(const VirtualStructure& body, const VecX& x,
                                              const Surroundings& field, double extra) {
  constexpr double ahead = 4e-3;    // m remembered beyond what is asked for
  constexpr double stale = 0.5e-3;  // m of motion after which remembered distances are measured again
  const double reach = reach_of(field, extra);
  bool usable = reach_ > 0 && x_.size() == x.size() && shapes_.size() == field.shapes.size();
  std::vector<double> approach(field.shapes.size());  // how much nearer a pair of the shape may have come
  double most = 0;
  if (usable) {
    const double moved = body.largest_motion(x - x_);
    for (std::size_t k = 0; k < approach.size(); ++k) {
      approach[k] = moved + distance_change(field.shapes[k], shapes_[k]);
      usable &= reach + approach[k] <= reach_;  // false for a NaN
      most = std::max(most, approach[k]);
    }
  }
  if (!usable) {
    // What is found near a place that is no place is not to be remembered.
    reach_ = x.allFinite() ? reach + ahead : -1;
    near_ = pairs_within(body, x, field, reach + ahead);
    shapes_ = field.shapes;
    x_ = x;
    approach.assign(approach.size(), 0.0);
  } else if (most > stale) {
    look_again(body, x, field, most);
    approach.assign(approach.size(), 0.0);
  }
  std::vector<ContactPair> out;
  for (const ContactPair& pair : near_) {
    ContactPair now = pair;
    now.distance -= approach[pair.shape];
    if (now.distance >= reach) continue;
    if (now.distance < exact)
      now.distance = signed_distance(field.shapes[pair.shape], body.contact_point(pair.row, x));
    if (now.distance < reach) out.push_back(now);
  }
  return out;
}

}  // namespace calot
