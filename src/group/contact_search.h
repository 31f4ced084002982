#pragma once
// Which triangles of the skin may meet which shapes.

#include <array>

#include "body/body.h"
#include "collision/barrier.h"
#include "collision/shapes.h"
#include "fem/links.h"
#include "group/friction_load.h"
#include "group/grip_springs.h"
#include "group/self_contact.h"

namespace calot {

/// Skin that is touched lies within this of the true surface, m, on either side.
inline constexpr double contact_gap = 0.05e-3;
/// Contact acts on shapes that are smaller than what they stand for by this, m: a little less than contact_gap, as the
/// hardest pressed points go a little way below them.
inline constexpr double contact_inset = 0.04e-3;
/// Presses by 14 kPa 0.037 mm before the true surface, by 0.32 MPa there, by 4.3 MPa 0.035 mm below and, from 11 MPa on,
/// by 5.7 MPa more for every um. Soft where it begins, as friction follows what presses; at the end stiffer than the
/// grips of a fold, which press it into the jaws where they are at odds; no stiffer, as each halving of the soft share
/// takes Newton's method another iteration to come out of what a tool has moved into.
inline constexpr Barrier contact_barrier{
    .range = contact_gap + contact_inset, .stiffness = 200e3, .soft_share = 0.02};

/// What contact acts on for a shape as it is made.
inline Shape contact_shape(const Shape& made) { return offset(made, -contact_inset); }
/// What no trial may reach, of a contact shape.
inline Shape core_of(const Shape& contact_shape) { return offset(contact_shape, -contact_guard); }

class Inertia;

/// Springs of one stiffness, N/m, from every node to where it was.
struct Drag {
  VecX from;  ///< m, 3 a node
  double stiffness = 0;
};

/// What acts on an organ during one solve; shapes do not move within it.
struct ContactLoads {
  std::vector<Shape> shapes;     ///< contact shapes: what they are in truth, inset
  std::vector<char> broad = {};  ///< one a shape, or none: whether it is felt by few points (broad_points)
  Barrier barrier = contact_barrier;
  GripSprings grip;          ///< rows of the skin's stencils
  GripSprings leaving = {};  ///< what has been let go and is dragged still
  FrictionLoad friction;
  /// N/m, springs that hold the details at rest, one each; none: all are free.
  std::vector<double> detail_holds = {};
  VecX load = {};                               ///< N, 3 a node; empty: none
  std::shared_ptr<const Inertia> inertia = {};  ///< null: masses do not count
  std::optional<Drag> drag = {};

  bool is_broad(int shape) const { return !broad.empty() && broad[static_cast<std::size_t>(shape)] != 0; }
};

/// A triangle of the skin near enough to a shape to meet it within a solve.
struct ContactPair {
  int triangle = 0;
  int shape = 0;        ///< index into ContactLoads::shapes
  double distance = 0;  ///< m, when it was gathered: none of its points was nearer
};

/// How far outside the contact range pairs are gathered at first, m; no solve may move a place of the skin further.
inline constexpr double contact_margin = 2.5e-3;
inline constexpr double widest_margin = 20e-3;  ///< m, of bodies that move far

/// Calls use(contact point, index of the shape, its place, distance and gradient there) for the points of the pairs that are in range of
/// the shapes when the nodes are at x, m. No pair has come nearer than by `approach` since it was gathered.
template <class Use>
void for_touching(const Body& body, const VecX& x, const ContactLoads& loads,
                  const std::vector<ContactPair>& pairs, double approach, const Use& use) {
  ContactPlaces places(body.skin(), x, body.skin_radii());
  for (const ContactPair& pair : pairs) {
    const double range = loads.barrier.range;
    if (pair.distance >= range + approach) continue;
    const Shape& shape = loads.shapes[pair.shape];
    const Nearness near = places.nearness(pair.triangle, shape);
    if (near.of_all() >= range) continue;
    for (int local : body.contact_points(loads.is_broad(pair.shape))) {
      const int point = pair.triangle * contacts_each + local;
      if (near.of(point) >= range) continue;
      const Vec3 at = places.at(point);
      DistanceSlope d = distance_slope(shape, at);
      d.distance -= places.radius(point);
      if (d.distance < range) use(point, pair.shape, at, d);
    }
  }
}

/// A contact point in range of a shape.
struct Touch {
  int point = 0, shape = 0;
  Vec3 at = Vec3::Zero();  ///< m
  DistanceSlope slope;     ///< of the surface there (Body::skin_radii)
  BarrierSample answer;    ///< of the body to it there, a unit of area
  double area = 0;         ///< m^2 that it stands for
  double radius = 0;       ///< m, of the surface around it
  Vec3 force_on_shape() const { return area * answer.derivative * slope.gradient; }  ///< N
  /// Hessian of its energy by its place, N/m, as if its distance did not curve.
  Mat3 flat_hessian() const { return area * answer.second * slope.gradient * slope.gradient.transpose(); }
};

/// All contact points in range when the nodes are at x, m, ordered by shape, then point. `pairs` are ordered and hold
/// all that may meet; none has come nearer than by `approach` since it was gathered.
std::vector<Touch> touches_of(const Body& body, const VecX& x, const ContactLoads& loads,
                              const std::vector<ContactPair>& pairs, double approach);

/// Adds what touches to a gradient, N.
void add_touch_gradient(const Body& body, const std::vector<Touch>& touches, VecX& gradient);
/// Hessian of a contact point's energy by its place, N/m.
Mat3 contact_hessian(const ContactLoads& loads, const Touch& touch);
/// What the shape's curvature adds to that, N/m, negative semidefinite.
Mat3 contact_bend(const ContactLoads& loads, const Touch& touch);
/// The same of any point at a place (m) that a shape pushes with -`push` N; `slope` is of the surface that lies `radius` m
/// around it.
Mat3 contact_bend(const Shape& shape, const Vec3& at, const DistanceSlope& slope, double radius, double push);

/// What touches, found once for a state: a solve's energies and their derivatives, and after it pads, forces and report
/// ask for the same place. For one organ.
class TouchMemory {
 public:
  /// touches_of(), valid until the next call.
  const std::vector<Touch>& at(const Body& body, const VecX& x, const ContactLoads& loads,
                               const std::vector<ContactPair>& pairs, double approach);
  /// The same where it is known, else null.
  const std::vector<Touch>* known(const Body& body, const VecX& x, const ContactLoads& loads) const;

 private:
  struct State {
    VecX x;
    std::vector<int> details;
    std::vector<Shape> shapes;
    std::optional<Barrier> barrier;  ///< none: nothing yet
    std::vector<Touch> touches;
  };
  std::array<State, 2> states_;  ///< where a step began and where it is tried
  std::size_t newest_ = 0;
};

/// Pairs within range + contact_margin + extra of the shapes, ordered by shape, then triangle.
std::vector<ContactPair> gather_pairs(const Body& body, const VecX& x, const ContactLoads& loads,
                                      double extra);

/// The same pairs with less work: triangles a little further away are remembered, and only these are looked at
/// until the skin and a shape have moved so far that others could have come near. Distances beyond `exact` are
/// bounds of bounds, so some pairs beyond the reach are among them. For one organ.
class ContactSearch {
 public:
  static constexpr double exact = 0.5e-3;  ///< m
  /// Those within range + margin + extra.
  std::vector<ContactPair> pairs(const Body& body, const VecX& x, const ContactLoads& loads, double extra);
  /// Only those with one of the shapes, within `reach` of it, m, ordered by triangle; added to `out`.
  void pairs_with(int shape, const Body& body, const VecX& x, const ContactLoads& loads, double reach,
                  std::vector<ContactPair>& out);

  /// What touches at x, looked for only where that is not known yet. Valid until the next call or solve.
  const std::vector<Touch>& touching(const Body& body, const VecX& x, const ContactLoads& loads);

  /// A solve that was held up by the margin is followed by one with a wider one. Whether it is wider now.
  bool widen();

  SelfContact own;  ///< the skin's with itself
  TouchMemory touches;
  double margin = contact_margin;  ///< m
  bool held_up = false;            ///< a step of a solve was cut down for the margin

 private:
  /// What was near one shape when it was looked at last.
  struct Memory {
    std::vector<ContactPair> near;  ///< distances as they were then
    std::optional<Shape> shape;
    std::vector<int> details;
    VecX x;
    double reach = -1;  ///< m
  };
  std::vector<Memory> memory_;  ///< of each shape
};

}  // namespace calot
