#include "group/pressed_laws.h"

#include <limits>
#include <map>

#include "fem/assembly.h"

namespace calot {
namespace {

/// How much nearer pairs may have come since they were gathered: all are looked at.
constexpr double however_much = std::numeric_limits<double>::infinity();
/// A tangent's law that is a grip, its point a row of the skin's; others are shapes.
constexpr int of_grip = -1;

/// A shape and a triangle, or a grip and its row.
using Law = std::array<int, 2>;
Law law_of(int shape, int point) { return {shape, shape == of_grip ? point : point / contacts_each}; }

Mat3 stiffness_of(const ContactLoads& loads, const Touch& touch, bool convex) {
  return convex ? touch.flat_hessian() : contact_hessian(loads, touch);
}

}  // namespace

std::vector<SharpTangent> pressed_tangents(const Body& body, const ContactLoads& loads,
                                           const std::vector<Touch>& touches, const VecX& x, bool convex) {
  std::vector<SharpTangent> out;
  for (const Touch& touch : touches)
    out.push_back({0, touch.shape, touch.point, stiffness_of(loads, touch, convex)});
  for (std::size_t i = 0; i < loads.grip.pad.size(); ++i) {
    const int row = loads.grip.row[i];
    out.push_back({0, of_grip, row, loads.grip.sample(i, body.skin_point(row, x)).hessian});
  }
  return out;
}

bool fits(const SharpTangent& tangent, const Body& body) {
  const Tessellation& skin = body.skin();
  const std::size_t points = tangent.law == of_grip ? skin.at.size() : contacts_each * skin.triangles.size();
  return tangent.law >= of_grip && tangent.point >= 0 && static_cast<std::size_t>(tangent.point) < points &&
         tangent.stiffness.allFinite();
}

PressedLaws::PressedLaws(const Body& body, const ContactLoads& loads, const std::vector<ContactPair>& pairs,
                         const Step& step, double least, std::span<const SharpTangent> tangents)
    : body_(body), loads_(loads) {
  std::map<Law, Vec3> missed;  // N: the force at x + step less what the tangents say
  const auto of = [&](const Law& law) -> Vec3& {
    return missed.try_emplace(law, Vec3::Zero()).first->second;
  };
  for (const Touch& touch : step.before) of(law_of(touch.shape, touch.point)) -= touch.force_on_shape();
  for (const Touch& touch : step.after) of(law_of(touch.shape, touch.point)) += touch.force_on_shape();
  const GripSprings& grip = loads.grip;
  const VecX there = step.x + step.step;
  for (std::size_t i = 0; i < grip.pad.size(); ++i)
    of({of_grip, grip.row[i]}) += grip.sample(i, body.skin_point(grip.row[i], there)).gradient -
                                  grip.sample(i, body.skin_point(grip.row[i], step.x)).gradient;
  ContactPlaces ways(body.skin(), step.step);
  for (const SharpTangent& tangent : tangents)
    of(law_of(tangent.law, tangent.point)) -=
        tangent.stiffness *
        (tangent.law == of_grip ? body.skin_point(tangent.point, step.step) : ways.at(tangent.point));

  const auto misses = [&](const Law& law) {
    const auto found = missed.find(law);
    return found != missed.end() && found->second.norm() > least;
  };
  for (const ContactPair& pair : pairs)
    if (misses({pair.shape, pair.triangle})) pairs_.push_back(pair);
  for (const SharpTangent& tangent : tangents)
    if (misses(law_of(tangent.law, tangent.point))) tangents_.push_back(tangent);
  for (std::size_t i = 0; i < grip.pad.size(); ++i) {
    if (!misses({of_grip, grip.row[i]})) continue;
    grip_.row.push_back(grip.row[i]);
    grip_.target.push_back(grip.target[i]);
    grip_.stiffness.push_back(grip.stiffness[i]);
    grip_.pad.push_back(grip.pad[i]);
  }
}

void PressedLaws::mark_nodes(std::vector<char>& marks) const {
  const StencilTable& table = body_.skin().stencils;
  const auto mark = [&](int row) {
    for (int e = table.begin[row]; e < table.begin[row + 1]; ++e)
      marks[static_cast<std::size_t>(table.node[e])] = 1;
  };
  const auto mark_corners = [&](int triangle) {
    for (int corner : body_.skin().triangles[triangle]) mark(corner);
  };
  for (const ContactPair& pair : pairs_) mark_corners(pair.triangle);
  for (int row : grip_.row) mark(row);
  for (const SharpTangent& tangent : tangents_)
    if (tangent.law == of_grip)
      mark(tangent.point);
    else
      mark_corners(tangent.point / contacts_each);
}

std::vector<Touch> PressedLaws::touching(const VecX& x) const {
  return touches_of(body_, x, loads_, pairs_, however_much);
}

double PressedLaws::value(const VecX& x) const {
  double sum = grip_.value(body_.skin().stencils, x);
  for (const Touch& touch : touching(x)) sum += touch.area * touch.answer.energy;
  return sum;
}

void PressedLaws::add_gradient(const VecX& x, VecX& gradient) const {
  grip_.add_gradient(body_.skin().stencils, x, gradient);
  add_touch_gradient(body_, touching(x), gradient);
}

void PressedLaws::add_hessian(const VecX& x, bool convex, BlockMatrix& matrix) const {
  grip_.add_hessian(body_.skin().stencils, x, matrix);
  ContactStiffness pressed(body_.skin(), matrix);
  for (const Touch& touch : touching(x)) pressed.add(touch.point, stiffness_of(loads_, touch, convex));
  pressed.finish();
}

void PressedLaws::add_tangents(BlockMatrix& matrix) const {
  ContactStiffness pressed(body_.skin(), matrix);
  for (const SharpTangent& tangent : tangents_)
    if (tangent.law == of_grip)
      add_point_hessian(body_.skin().stencils, tangent.point, tangent.stiffness, matrix);
    else
      pressed.add(tangent.point, tangent.stiffness);
  pressed.finish();
}

}  // namespace calot
