#include "view/jaw_mould.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "field/grip.h"
#include "view/surfaces.h"

namespace calot {
namespace {

double smooth(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

double window_half(const JawWindow& window, double z) {
  const double along = (z - window.start) / (window.end - window.start);
  return window.start_half + (window.end_half - window.start_half) * along;
}

/// Share of the mould at a place of the pad: none at its rim, so that points come and go without a jump.
double share_on_pad(const InstrumentGeometry& g, double y, double z) {
  constexpr double rim = 1.2e-3;  // m
  const double inside = std::min({0.5 * g.jaw_width - std::abs(y), z - g.jaw_rounding, g.jaw_length - z});
  return smooth(inside / rim);
}

}  // namespace

double moulded_height(const InstrumentGeometry& g, double y, double z) {
  double bulge = 0;
  const std::optional<JawWindow> window = jaw_window(g);
  if (window && z > window->start && z < window->end) {
    const double across = std::abs(y) / window_half(*window, z);
    const double along = std::abs(2 * z - window->start - window->end) / (window->end - window->start);
    bulge = window_bulge * smooth((1 - across) / 0.7) * smooth((1 - along) / 0.3);
  }
  return bulge - pad_clearance;
}

Solids::Solids(const Field& field) {
  for (const Ground& ground : field.ground) parts_.push_back({ground.shape, std::nullopt, Pose::Identity()});
  for (const Tool& tool : field.tools) {
    const std::vector<Shape> shapes = instrument_shapes(tool.trocar, tool.pose, tool.geometry);
    const std::optional<JawWindow> window = jaw_window(tool.geometry);
    for (int part = 0; part < shapes_per_tool; ++part) {
      const Pose frame = jaw_frame(tool.trocar, tool.pose, tool.geometry, std::max(0, part - 1));
      parts_.push_back({shapes[static_cast<std::size_t>(part)], part > 0 ? window : std::nullopt,
                        frame.inverse(Eigen::Isometry)});
    }
  }
}

double Solids::distance(const Vec3& x) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Part& part : parts_) {
    double distance = signed_distance(part.shape, x);
    if (distance <= 0 && part.window) {
      constexpr double corner = 0.4e-3;  // m: the window's ends are round
      const Vec3 q = part.to_jaw * x;
      const double from_wall =
          std::min({window_half(*part.window, q.z()) - std::abs(q.y()), q.z() - part.window->start - corner,
                    part.window->end - corner - q.z()});
      distance = std::max(distance, from_wall);
    }
    nearest = std::min(nearest, distance);
  }
  return nearest;
}

std::optional<Vec3> Solids::pushed_out(Vec3 x, double least) const {
  constexpr double step = 1e-7, slack = 1e-9;  // m
  for (int round = 0; round < 8; ++round) {
    const double room = distance(x);
    if (room >= least - slack) return x;
    Vec3 slope;
    for (int c = 0; c < 3; ++c)
      slope[c] = (distance(x + step * Vec3::Unit(c)) - distance(x - step * Vec3::Unit(c))) / (2 * step);
    if (slope.squaredNorm() < 0.01) return std::nullopt;  // between two walls
    x += (least - room) * slope / slope.squaredNorm();
  }
  return std::nullopt;
}

void JawMould::follow(const Field& field, ToolIndex instrument, double dt) {
  const Tool& tool = field.tool(instrument);
  std::vector<Held> held;
  for (std::size_t k = 0; tool.jaws_rest() && k < field.organs.size(); ++k) {
    const Organ& organ = field.organs[k];
    for (const GripPoint& grip : organ.grips) {
      if (grip.instrument != instrument) continue;
      const Pose jaw = jaw_frame(tool.trocar, tool.pose, tool.geometry, grip.jaw);
      const Vec3 at = organ.body->skin_point(grip.skin_point, organ.state.x);
      const Vec3 local = jaw.inverse(Eigen::Isometry) * at;
      Vec3 moved = local;
      moved.x() += share_on_pad(tool.geometry, local.y(), local.z()) *
                   (moulded_height(tool.geometry, local.y(), local.z()) - local.x());
      held.push_back({organ.record, grip.skin_point, jaw.linear() * (moved - local)});
    }
  }
  if (!held.empty()) {
    held_ = std::move(held);
    hinge_ = hinge_frame(tool.trocar, tool.pose, tool.geometry);
    jaw_ = tool.pose.jaw;
    weight_ = std::min(1.0, weight_ + dt / mould_ease);
    return;
  }
  weight_ = std::max(0.0, weight_ - dt / mould_ease);
  if (weight_ == 0) held_.clear();
}

bool JawMould::holds(const Organ& organ) const {
  return active() && std::any_of(held_.begin(), held_.end(),
                                 [&](const Held& held) { return held.record == organ.record; });
}

std::optional<FreeForm> JawMould::fitted(const InstrumentGeometry& g, const Organ& organ,
                                         const std::vector<int>* points,
                                         const std::vector<Vec3>& positions) const {
  // Functions about 1 mm apart across the pads, so that the two sides of a fold move apart, and 2 mm along them.
  constexpr double around = 2.5e-3;  // m beyond the pads
  FreeForm::Lattice lattice;
  lattice.frame = hinge_ * Pose(Eigen::Translation3d(0, 0, 0.5 * g.jaw_length));
  lattice.half = Vec3(g.jaw_length * std::sin(0.5 * jaw_), 0.5 * g.jaw_width, 0.5 * g.jaw_length);
  lattice.half.array() += around;
  lattice.nodes = {5, 7, 9};
  FreeForm form(lattice);
  std::map<int, Vec3> ways;  // of skin points that are held
  for (const Held& held : held_)
    if (held.record == organ.record) ways[held.skin_point] = smooth(weight_) * held.way;
  std::vector<Vec3> from, to;
  const auto goes = [&](const Vec3& place, const Vec3& way) {
    if (!form.contains(place)) return;
    from.push_back(place);
    to.push_back(place + way);
  };
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const auto held = ways.find(points == nullptr ? static_cast<int>(p) : (*points)[p]);
    goes(positions[p], held != ways.end() ? held->second : Vec3(Vec3::Zero()));
    if (held != ways.end()) ways.erase(held);
  }
  // Held points that are not drawn shape the mould too.
  for (const auto& [point, way] : ways) goes(organ.body->skin_point(point, organ.state.x), way);
  // Neighbours on a fold come close to each other: without damping their small differences would be blown up.
  constexpr double damping = 0.06;
  if (!form.manipulate(from, to, damping)) return std::nullopt;  // finite and paired: it does not fail
  return form;
}

void JawMould::apply(const Field& field, ToolIndex instrument, OrganIndex organ,
                     const std::vector<int>* points, DrawnSkin& skin) const {
  const Organ& moulded = field.organ(organ);
  if (!holds(moulded)) return;
  const std::optional<FreeForm> form =
      fitted(field.tool(instrument).geometry, moulded, points, skin.positions);
  if (!form) return;
  const Solids solids(field);
  for (std::size_t p = 0; p < skin.positions.size(); ++p) {
    const Vec3 start = skin.positions[p];
    if (!form->contains(start)) continue;
    const double least = std::min(pad_clearance, solids.distance(start));
    const std::optional<Vec3> place = solids.pushed_out(start + form->displacement(start), least);
    if (!place) continue;
    skin.positions[p] = *place;
    if (!skin.normals.empty()) skin.normals[p] = form->moved_normal(start, skin.normals[p]);
  }
}

JawMoulds::JawMoulds(const World& world) : moulds_(world.field().tools.size()), time_(world.report().time) {}

void JawMoulds::follow(const World& world) {
  if (world.report().time == time_) return;
  time_ = world.report().time;
  for (std::size_t i = 0; i < moulds_.size(); ++i)
    moulds_[i].follow(world.field(), ToolIndex(i), 1.0 / world.scene().solver.rate);
}

DrawnSkin JawMoulds::skin(const World& world, OrganIndex organ) const {
  DrawnSurface surface = world.drawn(organ);
  DrawnSkin skin{std::move(surface.positions), std::move(surface.normals)};
  // What is drawn around a line has no skin points to be moulded by.
  if (world.field().organ(organ).body->is_line()) return skin;
  for (std::size_t i = 0; i < moulds_.size(); ++i)
    moulds_[i].apply(world.field(), ToolIndex(i), organ, nullptr, skin);
  return skin;
}

DrawnSkin JawMoulds::skin(const World& world, OrganIndex organ, const std::vector<int>& points,
                          const std::vector<Triangle>& triangles) const {
  const Organ& drawn = world.field().organ(organ);
  DrawnSkin out;
  for (const int point : points) out.positions.push_back(drawn.body->skin_point(point, drawn.state.x));
  for (std::size_t i = 0; i < moulds_.size(); ++i)
    moulds_[i].apply(world.field(), ToolIndex(i), organ, &points, out);
  out.normals = mean_normals(out.positions, triangles);
  return out;
}

}  // namespace calot
