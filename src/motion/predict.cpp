#include "motion/predict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/timed.h"
#include "fem/assembly.h"
#include "field/field_tissues.h"
#include "field/grip.h"
#include "field/moving_bodies.h"
#include "motion/body_rubbing.h"
#include "motion/room.h"
#include "motion/rubbing.h"
#include "motion/settle_field.h"
#include "numerics/response.h"

namespace calot {
namespace {

using Poses = std::vector<InstrumentPose>;

/// Motion of `part` of a tool from one pose to another, at x.
Vec3 carried(const Pose& motion, const Vec3& x) { return motion * x - x; }

/// The load that the tools' motion to `to` puts on the organ to first order (then `loaded` becomes true); none for a
/// tool that stays, not even rounding.
VecX motion_load(const Field& field, const Organ& organ, const ContactLoads& now,
                 const std::vector<ContactPair>& pairs, const Poses& from, const Poses& to, bool& loaded) {
  VecX load = VecX::Zero(organ.state.x.size());
  ContactLoad pressed(organ.body->skin(), load);
  std::vector<std::optional<Pose>> motions;  // of the shapes; the ground stays
  for (int shape = 0; shape < static_cast<int>(now.shapes.size()); ++shape) {
    const auto [tool, part, ground] = field.shape(shape);
    motions.emplace_back();
    if (ground < 0 && from[tool.value] != to[tool.value])
      motions.back() = part_motion(field.tool(tool), from[tool.value], to[tool.value], part);
  }
  for (const Touch& touch : organ.search.touches.at(*organ.body, organ.state.x, now, pairs, 0.0)) {
    if (!motions[touch.shape]) continue;
    pressed.add(touch.point, contact_hessian(now, touch) * carried(*motions[touch.shape], touch.at));
    loaded = true;
  }
  const GripSprings target = grip_springs(organ, field.tools, to);
  for (std::size_t i = 0; i < target.row.size(); ++i) {
    const int tool = organ.grips[i].instrument.value;
    if (from[tool] == to[tool]) continue;
    const Vec3 at = organ.body->skin_point(target.row[i], organ.state.x);
    spread(organ.body->skin().stencils, target.row[i],
           now.grip.sample(i, at).hessian * (target.target[i] - now.grip.target[i]), load);
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

/// Adds the load that the tools' motion to `to` puts on the strands that they touch at x, to first order.
void add_strand_load(const Field& field, const VecX& x, const Poses& from, const Poses& to, VecX& load,
                     bool& loaded) {
  for (const Tissue& tissue : field.tissues) {
    const StrandJoin& strands = *tissue.strands;
    strands.for_contacts(x, [&](std::size_t strand, const StrandContact& contact) {
      const FieldShape which = field.shape(contact.shape);
      const InstrumentPose &before = from[which.tool.value], &after = to[which.tool.value];
      if (before == after) return;
      const Pose motion = part_motion(field.tool(which.tool), before, after, which.part);
      strands.add_force(strand, contact.piece, contact.share,
                        strands.touch().hessian_at(contact) * carried(motion, contact.at), load);
      loaded = true;
    });
  }
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

std::vector<double> all_edge_lengths(const Field& field) {
  std::vector<double> out;
  for (const Organ& organ : field.organs)
    out.insert(out.end(), organ.body->edge_lengths().begin(), organ.body->edge_lengths().end());
  for (const Tissue& tissue : field.tissues)  // see make_believable()
    out.insert(out.end(), tissue.body->edge_lengths().size(), std::numeric_limits<double>::infinity());
  return out;
}

/// A strand's node that a tool pushes about may have next to no stiffness along some way. One that would go further
/// than solves take it goes with its ends instead: the solve finds where it lies.
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

/// The prediction that nothing moves.
Prediction no_answer(const Field& field) {
  Prediction out;
  out.dx = out.first_order = VecX::Zero(BodyParts(field).total());
  out.dpressures = out.first_order_pressures = VecX::Zero(static_cast<Eigen::Index>(field.organs.size()));
  return out;
}

/// Predicts into `out` how the bodies move to first order by `load`, N, the change of what the tools do to them, and by
/// what moves them beside the tools, which is added to it. `joins`: all of the field's group. Fails (simulation) where
/// the tangent answers nothing that can be believed.
std::optional<Failure> answer_load(Field& field, const std::vector<ContactLoads>& loads,
                                   const std::vector<JoinPointer>& joins, VecX& load, bool fresh,
                                   SolveStatistics& statistics, Prediction& out) {
  std::vector<Member> members = members_of(field, loads);
  TissueMembers tissues(field);
  tissues.add_to(members);
  Group& group = field.group;
  const std::vector<JoinPointer> with_rubbing = joins_with(joins, group.rubbing);
  const GroupProblem problem(members, with_rubbing, group.patterns);
  const VecX multipliers = problem.resting_multipliers();
  VecX values;
  if (field.step_time > 0) values = add_inertia(problem, multipliers, load);
  FirstOrderAnswer answer = first_order_answer(problem, group.work, problem.coordinates(), multipliers, load,
                                               all_edge_lengths(field), fresh, values);
  count(field, answer.result, statistics);
  if (!answer.result.converged())
    return solve_failure(answer.result, member_name(field, answer.result.part), "under its instruments");
  out.fresh = fresh || answer.result.factorisations > 0;
  make_believable(field, answer.dx);
  out.first_order = std::move(answer.dx);
  out.first_order_pressures = problem.pressures(answer.dmultipliers);
  out.share = answer.share;
  out.dx = out.first_order;
  out.dpressures = out.first_order_pressures;
  if (field.step_time == 0) add_missed(group.missed, out);
  return std::nullopt;
}

using OrganPairs = std::vector<std::vector<ContactPair>>;  // one list an organ

/// The organs' pairs that a motion may bring together: tools and each organ go so far in all, m.
OrganPairs find_pairs(Field& field, const std::vector<ContactLoads>& loads,
                      const std::vector<double>& travels) {
  OrganPairs out(field.organs.size());
  for_each_chunk(field.workers(), static_cast<int>(out.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    Organ& organ = field.organs[k];
    out[k] = organ.search.pairs(*organ.body, organ.state.x, loads[k], travels[k]);
  });
  return out;
}

/// Gives an answer up that is by a tangent of elsewhere and not safe all the way; whether it did.
bool gives_up(Prediction& out) {
  const bool none = !out.fresh && out.share < 1;
  if (none) out.share = 0;
  return none;
}

/// Limits a prediction to what keeps skins and tools apart. Skins are looked at last, as that takes longest: on what tools
/// have left of the way.
void keep_apart(const Field& field, const std::vector<ContactLoads>& loads, const OrganPairs& pairs,
                const Poses& from, const Poses& to, Prediction& out) {
  const BodyParts parts(field);
  for (std::size_t k = 0; k < field.organs.size(); ++k) {
    const Poses partly = interpolate(from, to, out.share);
    out.share *= share_kept_apart(field, field.organs[k], loads[k], pairs[k],
                                  out.share * parts.of(k, std::as_const(out.dx)), from, partly);
  }
  const VecX x = parts.present(field);
  for (const Tissue& tissue : field.tissues)
    out.share = share_kept_apart(field, tissue, x, out.dx, from, to, out.share);
  if (gives_up(out)) return;
  // Where nothing is loaded nothing moves, and no solve told the joins of their bodies.
  const std::size_t joins = out.loaded ? field.group.joins.size() : 0;
  out.share = least_safe(field.workers(), joins + field.organs.size(), out.share, [&](std::size_t k) {
    if (k < joins) return field.group.joins[k]->safe_share(x, out.dx, out.share);
    const Organ& organ = field.organs[k - joins];
    return organ.search.own.safe_share(*organ.body, organ.state.x, parts.of(k - joins, std::as_const(out.dx)),
                                       contact_keep, out.share);
  });
  gives_up(out);
}

}  // namespace

Result<Prediction> predict(Field& field, const Poses& from, const Poses& to, bool fresh,
                           SolveStatistics& statistics) {
  const BodyParts parts(field);
  Prediction out = no_answer(field);
  const bool moving = !all_stand_still(field);
  if (from == to && !moving) return out;
  out.travel = largest_travel(field, to);
  const std::vector<ContactLoads> loads = solve_loads(field, from);
  // What moves by itself seldom goes further in a step: then its pairs need not be looked for again.
  const double seldom_further = moving ? 1e-3 : 0;  // m
  std::vector<double> travels(field.organs.size(), out.travel + seldom_further);
  OrganPairs pairs;
  {
    const Timed timed(statistics.contact_s);
    pairs = find_pairs(field, loads, travels);
  }
  VecX load = VecX::Zero(parts.total());
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    parts.of(k, load) = motion_load(field, field.organs[k], loads[k], pairs[k], from, to, out.loaded);
  const std::vector<JoinPointer> all = all_joins(field, from);
  add_strand_load(field, place_strands(field), from, to, load, out.loaded);
  out.loaded |= moving;
  if (out.loaded)
    if (std::optional<Failure> failure = answer_load(field, loads, all, load, fresh, statistics, out))
      return *failure;
  const Timed timed(statistics.contact_s);
  if (gives_up(out)) return out;
  // What moves by itself may meet shapes that no tool brings near.
  if (moving) {
    double furthest = 0;
    for (std::size_t k = 0; k < travels.size(); ++k) {
      const double way = field.organs[k].body->largest_motion(parts.of(k, std::as_const(out.dx)));
      furthest = std::max(furthest, way);
      travels[k] = out.travel + way;
    }
    if (furthest > seldom_further) pairs = find_pairs(field, loads, travels);
  }
  keep_apart(field, loads, pairs, from, to, out);
  return out;
}

Prediction of_tools_alone(Field& field, const Poses& from, const Poses& to, SolveStatistics& statistics) {
  Prediction out = no_answer(field);
  out.travel = largest_travel(field, to);
  const std::vector<ContactLoads> loads = solve_loads(field, from);
  const Timed timed(statistics.contact_s);
  const std::vector<double> travels(field.organs.size(), out.travel);
  keep_apart(field, loads, find_pairs(field, loads, travels), from, to, out);
  return out;
}

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

bool factor_serves(const Group& group) {
  return group.missed.dx.size() > 0 && group.missed.by_last_factor <= 3;
}

}  // namespace calot
