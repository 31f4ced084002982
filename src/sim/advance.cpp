#include "sim/advance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/timed.h"
#include "fem/assembly.h"
#include "numerics/response.h"
#include "sim/blades.h"
#include "sim/body_rubbing.h"
#include "sim/clips.h"
#include "sim/exchange.h"
#include "sim/field_tissues.h"
#include "sim/grip.h"
#include "sim/grip_slip.h"
#include "sim/inertia.h"
#include "sim/leak.h"
#include "sim/rubbing.h"
#include "sim/settle_field.h"
#include "sim/structural_extension.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

constexpr int max_parts = 100;
/// No motion between two stops takes more: one that needs them is blocked, and says so within seconds.
constexpr int step_iterations = 1000;
/// A solve that takes more than this is broken off; where it got somewhere it goes on with fresh pairs, else the
/// part is cut in two.
constexpr int part_iterations = 30;
constexpr double smallest_share = 1e-3;

Poses between(const Poses& a, const Poses& b, double share) {
  Poses out;
  for (std::size_t i = 0; i < a.size(); ++i) out.push_back(interpolate(a[i], b[i], share));
  return out;
}

/// What the organs answer to a part of a motion.
struct Prediction {
  VecX first_order, dx;                    ///< m, 3 a node; dx with what the last answer missed
  VecX first_order_pressures, dpressures;  ///< Pa, one an organ
  double travel = 0;                       ///< of the tool that travels most, m
  double share = 1;                        ///< that can be believed, and is safe
  bool loaded = false;                     ///< whether the tools' motion or its own moves any organ
};

/// Motion of `part` of a tool from one pose to another, at x.
Vec3 carried(const Pose& motion, const Vec3& x) { return motion * x - x; }

/// The load that the tools' motion to `to` puts on the organ to first order (then `loaded` becomes true); none for a
/// tool that stays, not even rounding.
VecX motion_load(const Field& field, const Organ& organ, const ContactLoads& now,
                 const std::vector<ContactPair>& pairs, const Poses& from, const Poses& to, bool& loaded) {
  VecX load = VecX::Zero(organ.state.x.size());
  ContactLoad pressed(organ.body->skin(), load);
  std::vector<std::optional<Pose>> motions;  // of the shapes; the ground stays
  for (std::size_t shape = 0; shape < now.shapes.size(); ++shape) {
    const std::size_t tool = shape / shapes_per_tool;
    motions.emplace_back();
    if (tool < field.tools.size() && from[tool] != to[tool])
      motions.back() =
          part_motion(field.tools[tool], from[tool], to[tool], static_cast<int>(shape % shapes_per_tool));
  }
  for (const Touch& touch : organ.search.touches.at(*organ.body, organ.state.x, now, pairs, 0.0)) {
    if (!motions[touch.shape]) continue;
    pressed.add(touch.point, contact_hessian(now, touch) * carried(*motions[touch.shape], touch.at));
    loaded = true;
  }
  const Links target = grip_links(organ, field.tools, to);
  for (std::size_t i = 0; i < target.row.size(); ++i) {
    const int tool = organ.grips[i].instrument;
    if (from[tool] == to[tool]) continue;
    spread(organ.body->skin().stencils, target.row[i],
           target.stiffness[i] * (target.target[i] - now.grip.target[i]), load);
    loaded = true;
  }
  // What rubs touches as well: it has been found loaded above.
  const FrictionLoad carried_on = friction_load(field, organ, to);
  ContactPlaces places(organ.body->skin(), organ.state.x);
  for (std::size_t i = 0; i < carried_on.points.size(); ++i) {
    const RubbingPoint& rubbing = now.friction.points[i];
    const FrictionSample sample = rubbing.hold.sample(places.at(rubbing.point));
    pressed.add(rubbing.point, sample.hessian * (carried_on.points[i].hold.anchor - rubbing.hold.anchor));
  }
  pressed.finish();
  return load;
}

/// How the shapes move with the tools, by a share of that. The ground stays.
class ShapePaths {
 public:
  ShapePaths(const Field& field, const Poses& from, const Poses& to) : field_(field), from_(from), to_(to) {
    for (std::size_t i = 0; i < from.size(); ++i)
      travel_.push_back(travel_bound(field.tools[i], from[i], to[i]));
  }
  bool stays(int shape) const { return shape / shapes_per_tool >= static_cast<int>(field_.tools.size()); }
  /// Bound on its way, m.
  double travel(int shape) const { return stays(shape) ? 0.0 : travel_[shape / shapes_per_tool]; }
  /// Null: it stays. Valid until another one is asked for.
  const PartPath* of(int shape, double share) {
    if (stays(shape)) return nullptr;
    if (shape != shape_ || share != share_) {
      const int tool = shape / shapes_per_tool;
      path_.emplace(field_.tools[tool], shape % shapes_per_tool, from_[tool],
                    interpolate(from_[tool], to_[tool], share));
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

/// Largest share of the joint motion of skin and tools that keeps them apart.
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

/// Adds the load that the tools' motion to `to` puts on the strands that they touch at x, to first order.
void add_strand_load(const Field& field, const VecX& x, const Poses& from, const Poses& to, VecX& load,
                     bool& loaded) {
  for (const Tissue& tissue : field.tissues) {
    const StrandJoin& strands = *tissue.strands;
    strands.for_contacts(x, [&](std::size_t strand, const StrandContact& contact) {
      const std::size_t tool = static_cast<std::size_t>(contact.shape) / shapes_per_tool;
      if (from[tool] == to[tool]) return;
      const Pose motion =
          part_motion(field.tools[tool], from[tool], to[tool], contact.shape % shapes_per_tool);
      strands.add_force(strand, contact.piece, contact.share,
                        strands.touch().hessian_at(contact) * carried(motion, contact.at), load);
      loaded = true;
    });
  }
}

/// Largest share of the joint motion of strands and tools that keeps them apart.
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

/// What masses move: organs, then the nodes of tissues.
std::size_t moving_bodies(const Field& field) { return field.organs.size() + field.tissues.size(); }
BodyState& state_of(Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  return k < organs ? field.organs[k].state : field.tissues[k - organs].now.state;
}
const BodyState& state_of(const Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  return k < organs ? field.organs[k].state : field.tissues[k - organs].now.state;
}
const Body& body_of(const Field& field, std::size_t k) {
  const std::size_t organs = field.organs.size();
  if (k < organs) return *field.organs[k].body;
  return *field.tissues[k - organs].body;
}

/// The next part of each body's motion, from where it is as it moves there; none where the field is static.
Result<std::vector<MotionPart>> next_parts(const Field& field) {
  std::vector<MotionPart> out;
  for (std::size_t k = 0; k < moving_bodies(field) && field.step_time > 0; ++k) {
    const Body& body = body_of(field, k);
    Result<MotionPart> part = motion_part(body, present_motion(body, state_of(field, k)), 0);
    if (!part) return part.failure();
    out.push_back(std::move(part).value());
  }
  return out;
}

void begin(const std::vector<MotionPart>& parts, double duration, Field& field) {
  constexpr double alike = 0.1;  // another share than this of the time, and the factor is of another matrix
  for (std::size_t k = 0; k < parts.size(); ++k) {
    MotionPart& part = state_of(field, k).motion;
    if (!(std::abs(duration - part.duration) < alike * part.duration)) field.group.work.factored = false;
    part = parts[k];
    part.duration = duration;
  }
}

bool all_stand_still(const Field& field) {
  for (std::size_t k = 0; k < moving_bodies(field); ++k) {
    const MotionPart& motion = state_of(field, k).motion;
    if (motion.duration > 0 && !stands_still(motion.begin)) return false;
  }
  return true;
}

/// What moves the organs beside the tools: adds to `load` what is not in balance yet at the beginning of the part.
/// Returns by how much constraints are not met there.
VecX add_inertia(const GroupProblem& problem, const VecX& multipliers, VecX& load) {
  VecX gradient, internal, values;
  if (problem.constraints() == 0) {
    problem.gradient(problem.coordinates(), gradient, internal);
    load -= gradient;
    return {};
  }
  Eigen::MatrixXd gradients;
  problem.gradient_and_constraint(problem.coordinates(), gradient, internal, values, gradients);
  load -= gradient - gradients * multipliers;
  return values + problem.compliances().cwiseProduct(multipliers);
}

/// Adds what the last answer missed, where it was to a motion like this one: by the square of the way.
void add_missed(const MissedMotion& missed, Prediction& out) {
  constexpr double alike = 3.0;  // times as far
  if (missed.dx.size() != out.dx.size() || out.travel > alike * missed.travel) return;
  const double ratio_squared = std::pow(out.travel / missed.travel, 2);
  // No second order is believed that is not small beside the first.
  if (!(ratio_squared * missed.dx.norm() < out.first_order.norm())) return;
  out.dx += ratio_squared * missed.dx;
  out.dpressures += ratio_squared * missed.dpressures;
}

/// What the answer to a part of a motion missed, once the organs are in equilibrium.
MissedMotion missed_by(const Prediction& answer, double share, const GroupSnapshot& before,
                       const Field& field, int by_last_factor) {
  if (!answer.loaded || share < 1.0) return {};
  MissedMotion out{-answer.first_order, -answer.first_order_pressures, answer.travel, by_last_factor};
  Eigen::Index first = 0;
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const BodyState &was = before.organs[k].state, &is = field.organs[k].state;
    out.dx.segment(first, is.x.size()) += is.x - was.x;
    out.dpressures[static_cast<Eigen::Index>(k)] += is.datum_pressure - was.datum_pressure;
    first += is.x.size();
  }
  for (std::size_t t = 0; t < field.tissues.size(); ++t) {
    const VecX &was = before.tissues[t].state.x, &is = field.tissues[t].now.state.x;
    out.dx.segment(first, is.size()) += is - was;
    first += is.size();
  }
  return out;
}

/// Whether the last factor answered the last motion well: a new one takes as long as three iterations.
bool factor_serves(const Group& group) {
  return group.missed.dx.size() > 0 && group.missed.by_last_factor <= 3;
}

/// What of dx is a body's: organs, then tissues.
class BodyParts {
 public:
  explicit BodyParts(const Field& field) {
    for (std::size_t k = 0; k < moving_bodies(field); ++k) {
      first_.push_back(total_);
      sizes_.push_back(state_of(field, k).x.size());
      total_ += sizes_.back();
    }
  }
  Eigen::Index total() const { return total_; }
  auto of(std::size_t body, VecX& dx) const { return dx.segment(first_[body], sizes_[body]); }
  auto of(std::size_t body, const VecX& dx) const { return dx.segment(first_[body], sizes_[body]); }
  /// Where all nodes are, m.
  VecX present(const Field& field) const {
    VecX out(total_);
    for (std::size_t k = 0; k < sizes_.size(); ++k) of(k, out) = state_of(field, k).x;
    return out;
  }

 private:
  std::vector<Eigen::Index> first_, sizes_;
  Eigen::Index total_ = 0;
};

std::vector<double> all_edge_lengths(const Field& field) {
  std::vector<double> out;
  for (const Organ& organ : field.organs)
    out.insert(out.end(), organ.body->edge_lengths().begin(), organ.body->edge_lengths().end());
  for (const Tissue& tissue : field.tissues)  // see make_believable()
    out.insert(out.end(), tissue.body->edge_lengths().size(), std::numeric_limits<double>::infinity());
  return out;
}

/// A strand's node that a tool pushes about may have next to no stiffness along some way. One that would go further than
/// solves take it goes with its ends instead: the solve finds where it lies.
void make_believable(const Field& field, VecX& dx) {
  const BodyParts parts(field);
  for (std::size_t t = 0; t < field.tissues.size(); ++t) {
    const Tissue& tissue = field.tissues[t];
    auto nodes = parts.of(field.organs.size() + t, dx);
    for (std::size_t i = 0; i < tissue.strands->strands().size(); ++i) {
      const StrandVector way = tissue.strands->places(i, dx);
      const Vec3 mean = 0.5 * (way.head<3>() + way.tail<3>());
      if ((way.segment<3>(3) - mean).norm() > tissue.body->edge_lengths()[i])
        nodes.segment<3>(3 * static_cast<Eigen::Index>(i)) = mean;
    }
  }
}

/// Limits a prediction to what keeps skins and tools apart.
void keep_apart(const Field& field, const std::vector<ContactLoads>& loads,
                const std::vector<std::vector<ContactPair>>& pairs, const Poses& from, const Poses& to,
                Prediction& out) {
  const BodyParts parts(field);
  Workers* workers = field.assembly ? &field.assembly->workers() : nullptr;
  std::vector<double> own(field.organs.size(), out.share);
  for_each_chunk(workers, static_cast<int>(own.size()), [&](int chunk) noexcept {
    const auto k = static_cast<std::size_t>(chunk);
    const Organ& organ = field.organs[k];
    own[k] = organ.search.own.safe_share(*organ.body, organ.state.x, parts.of(k, std::as_const(out.dx)),
                                         contact_keep, own[k]);
  });
  for (double share : own) out.share = std::min(out.share, share);
  // Where nothing is loaded nothing moves, and no solve told the joins of their bodies.
  if (out.loaded && !field.group.joins.empty()) {
    std::vector<const Join*> joins;
    for (const JoinPointer& join : field.group.joins) joins.push_back(join.get());
    out.share = safe_share(joins, parts.present(field), out.dx, out.share, workers);
  }
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const Poses partly = between(from, to, out.share);
    out.share *= share_kept_apart(field, field.organs[k], loads[k], pairs[k],
                                  out.share * parts.of(k, std::as_const(out.dx)), from, partly);
  }
  if (field.tissues.empty()) return;
  const VecX x = parts.present(field);
  for (const Tissue& tissue : field.tissues)
    out.share = share_kept_apart(field, tissue, x, out.dx, from, to, out.share);
}

/// Answer of the organs to tools that move from `from` to `to`, and the share of it that is safe. With `fresh` the
/// tangent is factorised anew, else the last factor serves if there is one.
Result<Prediction> predict(Field& field, const Poses& from, const Poses& to, bool fresh,
                           SolveStatistics& statistics) {
  const BodyParts parts(field);
  Prediction out;
  out.dx = out.first_order = VecX::Zero(parts.total());
  out.dpressures = out.first_order_pressures = VecX::Zero(static_cast<Eigen::Index>(field.organs.size()));
  const bool moving = !all_stand_still(field);
  if (from == to && !moving) return out;
  out.travel = largest_travel(field, to);
  std::vector<ContactLoads> loads;
  std::vector<std::vector<ContactPair>> pairs;
  VecX load = VecX::Zero(parts.total());
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    Organ& organ = field.organs[k];
    loads.push_back(solve_loads(field, organ, from));
    {
      const Timed timed(statistics.contact_s);
      pairs.push_back(organ.search.pairs(*organ.body, organ.state.x, loads[k], out.travel));
    }
    parts.of(k, load) = motion_load(field, organ, loads[k], pairs[k], from, to, out.loaded);
  }
  const std::vector<JoinPointer> all = all_joins(field, from);
  add_strand_load(field, place_strands(field), from, to, load, out.loaded);
  out.loaded |= moving;
  if (out.loaded) {
    std::vector<Member> members = members_of(field, loads);
    TissueMembers tissues(field);
    tissues.add_to(members);
    Group& group = field.group;
    const std::vector<JoinPointer> joins = joins_with(all, group.rubbing);
    const GroupProblem problem(members, joins, group.patterns);
    const VecX multipliers = problem.resting_multipliers();
    VecX values;
    if (field.step_time > 0) values = add_inertia(problem, multipliers, load);
    FirstOrderAnswer answer = first_order_answer(problem, group.work, problem.coordinates(), multipliers,
                                                 load, all_edge_lengths(field), fresh, values);
    count(answer.result, statistics);
    if (!answer.result.converged())
      return solve_failure(answer.result, member_name(field, answer.result.part), "under its instruments");
    make_believable(field, answer.dx);
    out.first_order = std::move(answer.dx);
    out.first_order_pressures = problem.pressures(answer.dmultipliers);
    out.share = answer.share;
    out.dx = out.first_order;
    out.dpressures = out.first_order_pressures;
    if (field.step_time == 0) add_missed(group.missed, out);
  }
  const Timed timed(statistics.contact_s);
  // What moves by itself may meet shapes that no tool brings near.
  for (std::size_t k = 0; moving && k < field.organs.size(); ++k) {
    Organ& organ = field.organs[k];
    const double own = organ.body->largest_motion(parts.of(k, std::as_const(out.dx)));
    pairs[k] = organ.search.pairs(*organ.body, organ.state.x, loads[k], out.travel + own);
  }
  keep_apart(field, loads, pairs, from, to, out);
  return out;
}

/// The tools' motion while organs stay. Near the load at which a fold gives way the tangent is all but singular, and no
/// part of its answer can be believed: that says nothing of the room that there is, and the solve finds where organs go.
Prediction of_tools_alone(Field& field, const Poses& from, const Poses& to, SolveStatistics& statistics) {
  Prediction out;
  out.dx = out.first_order = VecX::Zero(BodyParts(field).total());
  out.dpressures = out.first_order_pressures = VecX::Zero(static_cast<Eigen::Index>(field.organs.size()));
  out.travel = largest_travel(field, to);
  std::vector<ContactLoads> loads;
  std::vector<std::vector<ContactPair>> pairs;
  const Timed timed(statistics.contact_s);
  for (Organ& organ : field.organs) {
    loads.push_back(solve_loads(field, organ, from));
    pairs.push_back(organ.search.pairs(*organ.body, organ.state.x, loads.back(), out.travel));
  }
  keep_apart(field, loads, pairs, from, to, out);
  return out;
}

Failure cannot_follow(const Field& field, const std::string& why, double done) {
  std::string tools;
  for (const Tool& tool : field.tools) {
    const Vec3 tip = 1e3 * tip_position(tool.trocar, tool.pose, tool.geometry);
    tools += fmt::format("{}'{}' with its tip at ({:.1f}, {:.1f}, {:.1f}) mm", tools.empty() ? "" : ", ",
                         tool.definition.name, tip.x(), tip.y(), tip.z());
  }
  return fail(
      FailureKind::simulation,
      fmt::format("the motion of {} could not be followed beyond {:.0f}% of a step: {}", tools, 100 * done,
                  why),
      "move more slowly or less far, keep the tool out of the tissue it already squeezes, or give the "
      "organ more nodes where it is handled");
}

/// Folds that are pulled harder than their pads hold slide; one that has left a pad is lost.
Result<bool> let_slip(Field& field, const std::vector<char>& slipped_before, std::vector<WorldEvent>& events,
                      SolveStatistics& statistics) {
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    const int index = static_cast<int>(i);
    if (!tool.jaw_stopped) continue;
    const std::string organ = held_organ(field, index);
    const Result<double> pull = slip(field, index, statistics);
    if (!pull) return pull.failure();
    if (pull.value() > 0 && !tool.slipping && !slipped_before[i])
      events.push_back({EventKind::slip, 0, tool.definition.name, organ, pull.value()});
    tool.slipping |= pull.value() > 0;
    if (pull.value() > 0) let_clips_fall(field, index, events);
    if (both_pads_hold(field, index)) continue;
    if (Result<bool> released = release(field, index, statistics); !released) return released.failure();
    tool.jaw_stopped = false;
    tool.lost = true;
    events.push_back(
        {EventKind::release, 0, tool.definition.name, organ, 0, std::nullopt, EventCause::slipping});
  }
  return true;
}

/// Moves the organs by a share of what is predicted.
void move_by(double share, const Prediction& prediction, Field& field) {
  const BodyParts parts(field);
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    BodyState& state = field.organs[k].state;
    state.x += share * parts.of(k, prediction.dx);
    state.datum_pressure += share * prediction.dpressures[static_cast<Eigen::Index>(k)];
  }
  for (std::size_t k = field.organs.size(); k < moving_bodies(field); ++k)
    state_of(field, k).x += share * parts.of(k, prediction.dx);
}

/// Moves all tools from their poses to `to`, organs in equilibrium and grips within what they hold at the end
/// of each part, in `duration` s where masses count.
Result<bool> follow(Field& field, const Poses& to, double duration, const std::vector<char>& slipped_before,
                    std::vector<WorldEvent>& events, SolveStatistics& statistics) {
  int iterations_before = statistics.newton_iterations;
  double done = 0;
  NewtonResult last;  // of the solve that failed last, if any did in this part
  for (int part = 0; done < 1.0; ++part) {
    const Poses from = present_poses(field);
    grow_damage(field);
    const Result<std::vector<MotionPart>> parts = next_parts(field);
    if (!parts) return parts.failure();
    const double time_left = (1.0 - done) * duration;
    begin(parts.value(), time_left, field);
    const bool fresh = !factor_serves(field.group);
    Result<Prediction> answer = predict(field, from, to, fresh, statistics);
    if (answer && answer->share < 1.0 && !fresh) answer = predict(field, from, to, true, statistics);
    if (!answer) return answer.failure();
    if (answer->share < smallest_share && from != to) answer = of_tools_alone(field, from, to, statistics);
    const Prediction& prediction = answer.value();
    // Organs that move by themselves have all the time there is: no tool stands where they begin to be looked for.
    double share = from == to ? 1.0 : prediction.share;
    const double left = 1.0 - done;
    bool accepted = false;
    while (!accepted) {
      const int iterations = statistics.newton_iterations - iterations_before;
      if (part >= max_parts || iterations > step_iterations)
        return cannot_follow(field, fmt::format("not in {} parts and {} Newton iterations", part, iterations),
                             done);
      if (share < smallest_share)
        return cannot_follow(field,
                             last.converged()
                                 ? "the tissue it touches leaves it no room"
                                 : fmt::format("{} (residual {:.2g})", to_text(last.status), last.residual),
                             done);
      const double next = share >= 1.0 ? 1.0 : done + share * left;
      const Poses poses = next >= 1.0 ? to : between(from, to, share);
      const GroupSnapshot before = snapshot(field);
      const std::vector<VecX> places = present_places(field);
      begin(parts.value(), share * time_left, field);
      move_by(std::min(share, prediction.share), prediction, field);
      last = settle_group(field, poses, places, part_iterations, statistics);
      accepted = last.converged();
      if (accepted) {
        field.group.missed = missed_by(prediction, share, before, field, last.by_last_factor);
        for (std::size_t i = 0; i < field.tools.size(); ++i) field.tools[i].pose = poses[i];
        for (Organ& organ : field.organs) follow_contacts(field, organ, statistics);
        done = next;
        last = {};
        ++statistics.substeps;
        const int iterations_moving = statistics.newton_iterations;
        Result<bool> held = let_slip(field, slipped_before, events, statistics);
        if (!held) return held;
        iterations_before += statistics.newton_iterations - iterations_moving;
      } else {
        restore(field, before);
        share *= 0.5;
      }
    }
  }
  return true;
}

/// Where the tools really go: jaws that rest on a fold close no further.
Poses reachable(const Field& field, const Poses& targets) {
  Poses poses = targets;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (field.tools[i].jaw_stopped && poses[i].jaw < field.tools[i].pose.jaw)
      poses[i].jaw = field.tools[i].pose.jaw;
  return poses;
}

/// Where the tools' motion halts: wherever one may take hold, and at its end.
std::vector<double> all_stops(const std::vector<std::vector<double>>& holding_stops) {
  std::vector<double> stops = {1.0};
  for (const std::vector<double>& of_tool : holding_stops)
    stops.insert(stops.end(), of_tool.begin(), of_tool.end());
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
  return stops;
}

/// What of a tissue was torn in a step.
void judge_tearing(Tissue& tissue, int torn_before, std::vector<WorldEvent>& events) {
  const int torn = tissue.torn(), strands = static_cast<int>(tissue.now.opened.size());
  const bool was_tearing = std::exchange(tissue.now.tearing, torn > torn_before);
  const std::string& name = tissue.definition.name;
  if (tissue.now.tearing && !was_tearing)
    events.push_back({EventKind::tear,
                      0,
                      {},
                      name,
                      static_cast<double>(torn) / strands,
                      std::nullopt,
                      EventCause::stretch});
  if (torn == strands && torn_before < strands)
    events.push_back({EventKind::parted, 0, {}, name, 0, std::nullopt, EventCause::stretch});
}

std::vector<int> torn_strands(const Field& field) {
  std::vector<int> out;
  for (const Tissue& tissue : field.tissues) out.push_back(tissue.torn());
  return out;
}

/// What it is that jaws close on what they hold.
EventKind closed_on(const Field& field, int instrument) {
  if (instrument_row(field.tools[instrument].definition.type).jaws != JawUse::cut) return EventKind::grasp;
  const bool liver = std::any_of(field.organs.begin(), field.organs.end(), [&](const Organ& organ) {
    return grip_count(organ, instrument) > 0 && std::holds_alternative<LobeShape>(organ.definition.shape);
  });
  return liver ? EventKind::cut_liver : EventKind::perforation;
}

/// A wall that jaws pinch harder than it bears is opened; so is one that blades stand on.
void note_hold(Field& field, int instrument, std::vector<WorldEvent>& events) {
  const InstrumentDefinition& tool = field.tools[instrument].definition;
  const EventKind kind = closed_on(field, instrument);
  const bool cuts = kind != EventKind::grasp;
  events.push_back({kind, 0, tool.name, held_organ(field, instrument), 0, std::nullopt,
                    cuts ? EventCause::blades : EventCause::none});
  for (const Organ& organ : field.organs) {
    if (cuts || !is_hollow(organ.definition.shape) || grip_count(organ, instrument) == 0) continue;
    if (tool.pinch_force <= organ.definition.wall.pinch_limit) continue;
    events.push_back(
        {EventKind::perforation, 0, tool.name, organ.definition.name, 0, std::nullopt, EventCause::pinch});
  }
  if (events.back().kind == EventKind::perforation) perforate(field, instrument);
}

}  // namespace

Result<std::vector<WorldEvent>> advance(Field& field, const Poses& targets, SolveStatistics& statistics) {
  std::vector<WorldEvent> events;
  std::vector<int> torn_before = torn_strands(field);
  std::vector<char> slipped_before;
  for (Tool& tool : field.tools) slipped_before.push_back(std::exchange(tool.slipping, false));
  for (std::size_t i = 0; i < field.tools.size(); ++i) {
    Tool& tool = field.tools[i];
    // Opening lets go; so do jaws that stop closing before a fold fills them, as they press on nothing.
    const bool closing = targets[i].jaw < tool.pose.jaw;
    if (targets[i].jaw > tool.pose.jaw) tool.lost = tool.beside = tool.has_cut = false;
    if (closing || (tool.jaw_stopped && targets[i].jaw == tool.pose.jaw)) continue;
    const int index = static_cast<int>(i);
    const std::string organ = held_organ(field, index);
    if (organ.empty()) continue;
    if (Result<bool> released = release(field, index, statistics); !released) return released.failure();
    const bool held = tool.jaw_stopped && closed_on(field, index) == EventKind::grasp;
    if (held)
      events.push_back(
          {EventKind::release, 0, tool.definition.name, organ, 0, std::nullopt, EventCause::opening});
    tool.jaw_stopped = false;
  }
  const Poses to = reachable(field, targets), start = present_poses(field);
  std::vector<std::vector<double>> holding_stops;
  for (std::size_t i = 0; i < to.size(); ++i)
    holding_stops.push_back(closing_stops(start[i], to[i], grip_grid));
  double reached = 0;
  for (double stop : all_stops(holding_stops)) {
    const double duration = (stop - std::exchange(reached, stop)) * field.step_time;
    Poses here = between(start, to, stop);
    for (std::size_t i = 0; i < here.size(); ++i)
      if (field.tools[i].jaw_stopped) here[i].jaw = field.tools[i].pose.jaw;
    for (std::size_t i = 0; i < here.size(); ++i)
      if (here[i].jaw < field.tools[i].pose.jaw) make_room(field, static_cast<int>(i), here[i].jaw);
    Result<bool> moved = follow(field, here, duration, slipped_before, events, statistics);
    if (!moved) return moved.failure();
    for (std::size_t i = 0; i < field.tools.size(); ++i) {
      Tool& tool = field.tools[i];
      const int index = static_cast<int>(i);
      const std::vector<double>& own = holding_stops[i];
      if (tool.jaw_stopped || !std::binary_search(own.begin(), own.end(), stop)) continue;
      const JawUse use = instrument_row(tool.definition.type).jaws;
      if (use == JawUse::cut) {
        for (std::size_t t = 0; t < field.tissues.size(); ++t)
          judge_tearing(field.tissues[t], torn_before[t], events);
        if (Result<bool> cut = close_blades(field, index, events, statistics); !cut) return cut.failure();
        torn_before = torn_strands(field);
      }
      take_hold(field, index);
      if (!fold_fills_jaws(field, index)) {
        if (tool.pose.jaw > 0.5 * grip_grid) continue;
        if (use != JawUse::carry && !tool.has_cut && !is_in_trocar(tool))
          events.push_back({use == JawUse::cut ? EventKind::empty_cut : EventKind::empty_grasp,
                            0,
                            tool.definition.name,
                            {},
                            0});
        tool.beside = !held_organ(field, index).empty();
        if (!tool.beside) continue;
        // Closed, and only one pad holds: what it dragged along slips back.
        if (Result<bool> slipped = release(field, index, statistics); !slipped) return slipped.failure();
        continue;
      }
      tool.jaw_stopped = true;
      tool.lost = tool.beside = false;
      note_hold(field, index, events);
    }
  }
  feel_again(field);
  grow_damage(field);
  for (std::size_t t = 0; t < field.tissues.size(); ++t)
    judge_tearing(field.tissues[t], torn_before[t], events);
  return events;
}

}  // namespace calot
