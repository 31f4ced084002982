#include "group/contact_search.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "body/skin_bounds.h"

namespace calot {
namespace {

/// Of each face of the control mesh, which holds its skin.
std::vector<Eigen::AlignedBox3d> face_boxes(const Body& body, const VecX& x) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const std::vector<int>& nodes : body.face_nodes()) boxes.push_back(body.box_of(nodes, x));
  return boxes;
}

/// Adds the pairs with a shape that are nearer than `reach`.
void pairs_within(int index, const Shape& shape, const Body& body,
                  const std::vector<Eigen::AlignedBox3d>& faces, double reach, ContactPlaces& places,
                  std::vector<ContactPair>& out) {
  const int each = body.triangles_each();
  const Bounds b = bounds(shape);
  const double thick = body.beyond_nodes() + body.thickest();  // outside the boxes
  const Eigen::AlignedBox3d near(b.lower - Vec3::Constant(reach + thick),
                                 b.upper + Vec3::Constant(reach + thick));
  for (int f = 0; f < static_cast<int>(faces.size()); ++f) {
    const double far = reach + thick + 0.5 * faces[f].diagonal().norm();
    if (!near.intersects(faces[f]) || signed_distance(shape, faces[f].center()) > far) continue;
    for (int triangle = f * each; triangle < (f + 1) * each; ++triangle) {
      const double distance = places.nearness(triangle, shape).of_all();
      if (distance < reach) out.push_back({triangle, index, distance});
    }
  }
}

double reach_of(const ContactLoads& loads, double margin, double extra) {
  return loads.barrier.range + margin + extra;
}

}  // namespace

std::vector<ContactPair> gather_pairs(const Body& body, const VecX& x, const ContactLoads& loads,
                                      double extra) {
  const std::vector<Eigen::AlignedBox3d> faces = face_boxes(body, x);
  ContactPlaces places(body.skin(), x, body.skin_radii());
  std::vector<ContactPair> pairs;
  for (int shape = 0; shape < static_cast<int>(loads.shapes.size()); ++shape)
    pairs_within(shape, loads.shapes[shape], body, faces, reach_of(loads, contact_margin, extra), places,
                 pairs);
  return pairs;
}

void ContactSearch::pairs_with(int index, const Body& body, const VecX& x, const ContactLoads& loads,
                               double reach, std::vector<ContactPair>& out) {
  constexpr double ahead = 4e-3;     // m remembered beyond what is asked for
  constexpr double stale = 0.5e-3;   // m of motion after which remembered distances are measured again
  constexpr double measured = 1e-3;  // m beyond what is asked for within which they are
  if (memory_.size() < loads.shapes.size()) memory_.resize(loads.shapes.size());
  Memory& memory = memory_[index];
  const Shape& shape = loads.shapes[index];
  ContactPlaces places(body.skin(), x, body.skin_radii());
  double approach = std::numeric_limits<double>::infinity();  // how much nearer a pair may have come
  if (memory.reach > 0 && memory.x.size() == x.size() && memory.details == body.details())
    approach = body.largest_motion(x - memory.x) + distance_change(shape, *memory.shape);
  const auto looked = [&] {
    memory.shape = shape;
    memory.x = x;
    approach = 0;
  };
  if (!(reach + approach <= memory.reach)) {  // a NaN is looked at anew, too
    // Distances from a place that is not finite say nothing about the next one.
    memory.reach = x.allFinite() ? reach + ahead : -1;
    memory.near.clear();
    pairs_within(index, shape, body, face_boxes(body, x), reach + ahead, places, memory.near);
    memory.details = body.details();
    looked();
  } else if (approach > stale) {
    // What was far stays known by how much nearer it may have come.
    for (ContactPair& pair : memory.near) {
      pair.distance -= approach;
      if (pair.distance < reach + measured) pair.distance = places.nearness(pair.triangle, shape).of_all();
    }
    memory.reach -= approach;
    looked();
  }
  for (ContactPair pair : memory.near) {
    pair.distance -= approach;
    if (pair.distance >= reach) continue;
    if (pair.distance < exact) pair.distance = places.nearness(pair.triangle, shape).of_all();
    if (pair.distance < reach) out.push_back(pair);
  }
}

std::vector<ContactPair> ContactSearch::pairs(const Body& body, const VecX& x, const ContactLoads& loads,
                                              double extra) {
  const std::size_t shapes = loads.shapes.size();
  if (memory_.size() < shapes) memory_.resize(shapes);
  const double reach = reach_of(loads, margin, extra);
  const Eigen::AlignedBox3d skin = skin_box(body, x);
  const double thick = body.thickest();
  std::vector<std::vector<ContactPair>> found(shapes);
  for_each_chunk(own.workers, static_cast<int>(shapes), [&](int chunk) {
    const auto shape = static_cast<std::size_t>(chunk);
    const Bounds b = bounds(loads.shapes[shape]);
    // Most are too far from all of the skin.
    if (skin.exteriorDistance(Eigen::AlignedBox3d(b.lower, b.upper)) > reach + thick) return;
    pairs_with(chunk, body, x, loads, reach, found[shape]);
  });
  std::vector<ContactPair> out;
  for (const std::vector<ContactPair>& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

bool ContactSearch::widen() {
  const double before = margin;
  if (std::exchange(held_up, false)) margin = std::min(4 * margin, widest_margin);
  return margin > before;
}

const std::vector<Touch>* TouchMemory::known(const Body& body, const VecX& x,
                                             const ContactLoads& loads) const {
  for (const State& state : states_)
    if (state.barrier == loads.barrier && state.x.size() == x.size() && state.x == x &&
        state.shapes == loads.shapes && state.details == body.details())
      return &state.touches;
  return nullptr;
}

namespace {

double touched_area(const Body& body, const ContactLoads& loads, int shape, int point) {
  const double area = body.contact_area(point);
  if (!loads.is_broad(shape)) return area;
  const auto all = static_cast<double>(body.contact_points(false).size());
  return area * all / static_cast<double>(body.contact_points(true).size());
}

}  // namespace

std::vector<Touch> touches_of(const Body& body, const VecX& x, const ContactLoads& loads,
                              const std::vector<ContactPair>& pairs, double approach) {
  std::vector<Touch> out;
  for_touching(
      body, x, loads, pairs, approach, [&](int point, int shape, const Vec3& at, const DistanceSlope& slope) {
        out.push_back({point, shape, at, slope, body.contact_sample(point, slope.distance, loads.barrier),
                       touched_area(body, loads, shape, point), body.radius_at_contact(point)});
      });
  return out;
}

void add_touch_gradient(const Body& body, const std::vector<Touch>& touches, VecX& gradient) {
  ContactLoad pressed(body.skin(), gradient);
  for (const Touch& touch : touches) pressed.add(touch.point, touch.force_on_shape());
  pressed.finish();
}

Mat3 contact_bend(const Shape& shape, const Vec3& at, const DistanceSlope& slope, double radius,
                  double push) {
  DistanceSlope of_point = slope;
  of_point.distance += radius;  // of the point itself, as the shape curves there
  return push * distance_hessian(shape, at, of_point);
}

Mat3 contact_bend(const ContactLoads& loads, const Touch& touch) {
  return contact_bend(loads.shapes[touch.shape], touch.at, touch.slope, touch.radius,
                      touch.area * touch.answer.derivative);
}

Mat3 contact_hessian(const ContactLoads& loads, const Touch& touch) {
  return touch.flat_hessian() + contact_bend(loads, touch);
}

const std::vector<Touch>& TouchMemory::at(const Body& body, const VecX& x, const ContactLoads& loads,
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
  state.barrier = loads.barrier;
  state.touches = touches_of(body, x, loads, pairs, approach);
  return state.touches;
}

const std::vector<Touch>& ContactSearch::touching(const Body& body, const VecX& x,
                                                  const ContactLoads& loads) {
  if (const std::vector<Touch>* known = touches.known(body, x, loads)) return *known;
  return touches.at(body, x, loads, pairs(body, x, loads, -margin), 0.0);
}

}  // namespace calot
