#include "sim/contact_search.h"

#include <algorithm>

namespace calot {
namespace {

/// Pairs nearer than `reach`.
std::vector<ContactPair> pairs_within(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                                      double reach) {
  std::vector<Eigen::AlignedBox3d> faces;
  for (const std::vector<int>& nodes : body.face_nodes()) {
    Eigen::AlignedBox3d box;
    double details = 0;
    for (int node : nodes) {
      const Vec3 at = x.segment<3>(Eigen::Index{3} * node);
      if (node < body.coarse_nodes())
        box.extend(at);
      else
        details += 0.5 * at.norm();
    }
    const Vec3 wider = Vec3::Constant(details);
    faces.emplace_back(box.min() - wider, box.max() + wider);
  }
  const int each = body.triangles_each();
  std::vector<ContactPair> pairs;
  ContactPlaces places(body.skin(), x);
  for (int shape = 0; shape < static_cast<int>(loads.shapes.size()); ++shape) {
    const Bounds b = bounds(loads.shapes[shape]);
    const Eigen::AlignedBox3d near(b.lower - Vec3::Constant(reach), b.upper + Vec3::Constant(reach));
    for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
      const double far = reach + 0.5 * faces[f].diagonal().norm();
      if (!near.intersects(faces[f]) || signed_distance(loads.shapes[shape], faces[f].center()) > far)
        continue;
      for (int triangle = f * each; triangle < (f + 1) * each; ++triangle) {
        const double distance = places.nearness(triangle, loads.shapes[shape]).of_all();
        if (distance < reach) pairs.push_back({triangle, shape, distance});
      }
    }
  }
  return pairs;
}

double reach_of(const ContactLoads& loads, double extra) {
  return loads.barrier.range + contact_margin + extra;
}

}  // namespace

std::vector<ContactPair> gather_pairs(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                                      double extra) {
  return pairs_within(body, x, loads, reach_of(loads, extra));
}

void ContactSearch::look_again(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                               double approach) {
  ContactPlaces places(body.skin(), x);
  for (ContactPair& pair : near_)
    pair.distance = places.nearness(pair.triangle, loads.shapes[pair.shape]).of_all();
  reach_ -= approach;
  shapes_ = loads.shapes;
  x_ = x;
}

std::vector<ContactPair> ContactSearch::pairs(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                                              double extra) {
  constexpr double ahead = 4e-3;    // m remembered beyond what is asked for
  constexpr double stale = 0.5e-3;  // m of motion after which remembered distances are measured again
  const double reach = reach_of(loads, extra);
  bool usable = reach_ > 0 && x_.size() == x.size() && details_ == body.details() &&
                shapes_.size() == loads.shapes.size();
  std::vector<double> approach(loads.shapes.size());  // how much nearer a pair of the shape may have come
  double most = 0;
  if (usable) {
    const double moved = body.largest_motion(x - x_);
    for (std::size_t k = 0; k < approach.size(); ++k) {
      approach[k] = moved + distance_change(loads.shapes[k], shapes_[k]);
      usable &= reach + approach[k] <= reach_;  // false for a NaN
      most = std::max(most, approach[k]);
    }
  }
  if (!usable) {
    // Distances from a place that is not finite say nothing about the next one.
    reach_ = x.allFinite() ? reach + ahead : -1;
    near_ = pairs_within(body, x, loads, reach + ahead);
    details_ = body.details();
    shapes_ = loads.shapes;
    x_ = x;
    approach.assign(approach.size(), 0.0);
  } else if (most > stale) {
    look_again(body, x, loads, most);
    approach.assign(approach.size(), 0.0);
  }
  std::vector<ContactPair> out;
  ContactPlaces places(body.skin(), x);
  for (const ContactPair& pair : near_) {
    ContactPair now = pair;
    now.distance -= approach[pair.shape];
    if (now.distance >= reach) continue;
    if (now.distance < exact)
      now.distance = places.nearness(pair.triangle, loads.shapes[pair.shape]).of_all();
    if (now.distance < reach) out.push_back(now);
  }
  return out;
}

const std::vector<Touch>* TouchMemory::known(const ShellBody& body, const VecX& x,
                                             const ContactLoads& loads) const {
  for (const State& state : states_)
    if (state.range == loads.barrier.range && state.x.size() == x.size() && state.x == x &&
        state.shapes == loads.shapes && state.details == body.details())
      return &state.touches;
  return nullptr;
}

const std::vector<Touch>& TouchMemory::at(const ShellBody& body, const VecX& x, const ContactLoads& loads,
                                          const std::vector<ContactPair>& pairs, double approach) {
  if (const std::vector<Touch>* touches = known(body, x, loads)) {
    newest_ = &states_[0].touches == touches ? 0 : 1;
    return *touches;
  }
  newest_ = 1 - newest_;
  State& state = states_[newest_];
  state.x = x;
  state.details = body.details();
  state.shapes = loads.shapes;
  state.range = loads.barrier.range;
  state.touches.clear();
  for_touching(body, x, loads, pairs, approach,
               [&](int point, int shape, const Vec3& at, const DistanceSlope& slope) {
                 state.touches.push_back({point, shape, at, slope});
               });
  return state.touches;
}

const std::vector<Touch>& ContactSearch::touching(const ShellBody& body, const VecX& x,
                                                  const ContactLoads& loads) {
  if (const std::vector<Touch>* known = touches.known(body, x, loads)) return *known;
  return touches.at(body, x, loads, pairs(body, x, loads, -contact_margin), 0.0);
}

}  // namespace calot
