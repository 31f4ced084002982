#include "group/body_problem.h"

#include <cmath>

#include "fem/assembly.h"

namespace calot {

int constraints_of(const Body& body, bool masses_count, bool fixed_pressure) {
  const int volumes = body.liquid() != nullptr && !fixed_pressure ? 1 : 0;
  return volumes + (masses_count ? Inertia::constraints(body) : 0);
}

BodyProblem::BodyProblem(const Body& body, const ContactLoads& loads, std::vector<ContactPair> pairs,
                         const BodyState& start, bool fixed_pressure)
    : body_(body),
      loads_(loads),
      pairs_(std::move(pairs)),
      start_(start.x),
      volume_(start.volume),
      multiplier_(start.datum_pressure),
      fixed_pressure_(fixed_pressure),
      search_(nullptr) {
  for (const Shape& shape : loads.shapes) cores_.push_back(core_of(shape));
}

BodyProblem::BodyProblem(const Body& body, const ContactLoads& loads, ContactSearch& search,
                         const BodyState& start, bool fixed_pressure, Assembly* assembly)
    : BodyProblem(body, loads, std::vector<ContactPair>(), start, fixed_pressure) {
  search_ = &search;
  assembly_ = assembly;
  search.own.workers = workers();
  pairs_.reset();
}

Workers* BodyProblem::workers() const { return workers_of(assembly_); }

const std::vector<ContactPair>& BodyProblem::pairs() const {
  if (!pairs_) pairs_ = search_->pairs(body_, start_, loads_, 0.0);
  return *pairs_;
}

const std::vector<Touch>& BodyProblem::touching(const VecX& x) const {
  TouchMemory& touches = search_ ? search_->touches : touches_;
  static const std::vector<ContactPair> none;
  const bool known = touches.known(body_, x, loads_);
  return touches.at(body_, x, loads_, known ? none : pairs(), moved(x));
}

VecX BodyProblem::multipliers() const {
  VecX out = VecX::Constant(constraints(), multiplier_);
  if (liquid_mass()) out.tail(LiquidMass::constraints) = loads_.inertia->multipliers(start_);
  return out;
}

std::optional<BlockMatrix> BodyProblem::new_pattern(const BlockMatrix& present) const {
  return search_ ? search_->own.new_pattern(body_, start_, present) : std::nullopt;
}

std::vector<Part> BodyProblem::parts() const {
  const bool weighed = loads_.inertia != nullptr && body_.mass() != nullptr;
  return {{{0, body_.coarse_nodes()}, {body_.coarse_nodes(), body_.nodes()}, body_.size(), weighed}};
}

double BodyProblem::cancelling() const { return fixed_pressure_ ? std::abs(multiplier_) * volume_ : 0.0; }

double BodyProblem::moved(const VecX& x) const { return body_.largest_motion(x - start_); }

template <class Use>
void BodyProblem::for_held_details(const Use& use) const {
  const auto first = 3 * Eigen::Index{body_.coarse_nodes()};
  for (std::size_t i = 0; i < loads_.detail_holds.size(); ++i)
    use(first + 3 * static_cast<Eigen::Index>(i), loads_.detail_holds[i]);
}

template <class... Work>
void BodyProblem::beside_touches(const VecX& x, const Work&... work) const {
  const auto own = [&] {
    if (search_) search_->own.touching(body_, x);
  };
  do_at_once(
      workers(), own, [&] { touching(x); }, work...);
}

double BodyProblem::value(const VecX& x) const {
  double sum = 0;
  beside_touches(x, [&] { sum = loads_.inertia ? loads_.inertia->value(x) : body_.value(x); });
  if (!std::isfinite(sum)) return sum;
  for (const GripSprings* springs : {&loads_.grip, &loads_.leaving})
    sum += springs->value(body_.skin().stencils, x);
  sum += loads_.friction.value(body_.skin(), x);
  if (const Liquid* liquid = body_.liquid()) {
    sum += liquid->weight_value(x);
    if (fixed_pressure_) sum -= multiplier_ * liquid->volume(x);
  }
  if (body_.kept_load().size() > 0) sum -= body_.kept_load().dot(x);
  if (loads_.load.size() > 0) sum -= loads_.load.dot(x);
  for (const Touch& touch : touching(x)) sum += touch.area * touch.answer.energy;
  for_held_details(
      [&](Eigen::Index at, double stiffness) { sum += 0.5 * stiffness * x.segment<3>(at).squaredNorm(); });
  if (loads_.drag) sum += 0.5 * loads_.drag->stiffness * (x - loads_.drag->from).squaredNorm();
  if (search_) sum += search_->own.value(body_, x);
  return sum;
}

template <class... Work>
double BodyProblem::add_dry_gradient(const VecX& x, VecX& gradient, const Work&... beside) const {
  double largest_internal = 0;
  const auto wall = [&] {
    if (loads_.inertia)
      largest_internal = loads_.inertia->add_gradient(x, gradient);
    else
      body_.add_gradient(x, gradient, largest_internal);
  };
  beside_touches(x, beside..., wall);
  for (const GripSprings* springs : {&loads_.grip, &loads_.leaving})
    springs->add_gradient(body_.skin().stencils, x, gradient);
  loads_.friction.add_gradient(body_.skin(), x, gradient);
  if (body_.kept_load().size() > 0) gradient -= body_.kept_load();
  if (loads_.load.size() > 0) gradient -= loads_.load;
  add_touch_gradient(body_, touching(x), gradient);
  for_held_details(
      [&](Eigen::Index at, double stiffness) { gradient.segment<3>(at) += stiffness * x.segment<3>(at); });
  if (loads_.drag) gradient += loads_.drag->stiffness * (x - loads_.drag->from);
  if (search_) search_->own.add_gradient(body_, x, gradient);
  return largest_internal;
}

void BodyProblem::gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const {
  gradient.setZero(x.size());
  const Liquid* liquid = body_.liquid();
  VecX weight = VecX::Zero(x.size());
  const double internal = add_dry_gradient(x, gradient, [&] {
    if (liquid) liquid->add_load(x, fixed_pressure_ ? multiplier_ : 0.0, weight);
  });
  gradient += weight;
  largest_internal = VecX::Constant(1, force_scale(internal, gradient));
}

void BodyProblem::gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal,
                                          VecX& values, Eigen::MatrixXd& of_constraints) const {
  of_energy.setZero(x.size());
  values.resize(constraints());
  of_constraints.resize(x.size(), constraints());
  VecX weight = VecX::Zero(x.size()), of_volume = weight;
  const auto inertia = [&] { fill_inertia(x, values, of_constraints); };
  const auto liquid = [&] {
    const double volume = body_.liquid()->add_weight_and_volume_gradient(x, weight, of_volume);
    fill_volume(volume, of_volume, values, of_constraints);
  };
  const double internal = add_dry_gradient(x, of_energy, inertia, liquid);
  of_energy += weight;
  largest_internal = VecX::Constant(1, force_scale(internal, of_energy));
}

void BodyProblem::hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const {
  if (loads_.inertia) {
    loads_.inertia->hessian(x, matrix, assembly_);
  } else {
    matrix.assign(body_.pattern());
    body_.add_hessian(x, matrix, assembly_);
  }
  for (const GripSprings* springs : {&loads_.grip, &loads_.leaving})
    springs->add_hessian(body_.skin().stencils, x, matrix);
  loads_.friction.add_hessian(body_.skin(), x, matrix, workers());
  if (const LiquidMass* mass = liquid_mass())
    body_.liquid()->add_hessian(x, multipliers[0], mass->weight(multipliers.tail(LiquidMass::constraints)),
                                matrix, assembly_);
  else if (const Liquid* liquid = body_.liquid())
    liquid->add_hessian(x, fixed_pressure_ ? multiplier_ : multipliers[0], matrix, assembly_);
  ContactStiffness pressed(body_.skin(), matrix, workers());
  for (const Touch& touch : touching(x)) pressed.add(touch.point, contact_hessian(loads_, touch));
  pressed.finish();
  for_held_details([&](Eigen::Index at, double stiffness) {
    const int node = static_cast<int>(at / 3);
    matrix.add(node, node, stiffness * Mat3::Identity());
  });
  if (loads_.drag) matrix.add_to_diagonal(loads_.drag->stiffness);
  if (search_) search_->own.add_hessian(body_, x, matrix);
}

std::vector<SharpTangent> BodyProblem::pressed_tangents(const VecX& x, bool convex) const {
  return calot::pressed_tangents(body_, loads_, touching(x), x, convex);
}

PressedLaws BodyProblem::pressed_laws(const VecX& x, const VecX& step, double least,
                                      std::span<const SharpTangent> tangents) const {
  const std::vector<Touch> before = touching(x), after = touching(x + step);
  return PressedLaws(body_, loads_, pairs(), {x, step, before, after}, least, tangents);
}

bool BodyProblem::add_convexity(const VecX& x, BlockMatrix& matrix) const {
  const std::vector<Touch>& touches = touching(x);
  if (!touches.empty()) {
    ContactStiffness pressed(body_.skin(), matrix, workers());
    for (const Touch& touch : touches) pressed.add(touch.point, -contact_bend(loads_, touch));
    pressed.finish();
  }
  const bool own = search_ && search_->own.add_convexity(body_, x, matrix);
  return own || !touches.empty();
}

void BodyProblem::constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const {
  values.resize(constraints());
  gradients.resize(x.size(), constraints());
  const auto inertia = [&] { fill_inertia(x, values, gradients); };
  do_at_once(workers(), inertia, [&] {
    VecX of_volume = VecX::Zero(x.size());
    const double volume = body_.liquid()->add_volume_gradient(x, of_volume);
    fill_volume(volume, of_volume, values, gradients);
  });
}

void BodyProblem::fill_volume(double volume, const VecX& of_volume, VecX& values,
                              Eigen::MatrixXd& gradients) const {
  values[0] = volume - volume_;
  gradients.col(0) = of_volume;
}

void BodyProblem::fill_inertia(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const {
  const LiquidMass* mass = liquid_mass();
  if (mass == nullptr) return;
  values.tail(LiquidMass::constraints) = mass->constraint_values(x);
  gradients.rightCols(LiquidMass::constraints) = mass->constraint_gradients(x);
}

VecX BodyProblem::constraint_values(const VecX& x) const {
  VecX out = VecX::Constant(constraints(), body_.liquid()->volume(x) - volume_);
  if (const LiquidMass* mass = liquid_mass()) out.tail(LiquidMass::constraints) = mass->constraint_values(x);
  return out;
}

VecX BodyProblem::constraint_scales() const {
  VecX out = VecX::Constant(constraints(), volume_);
  if (const LiquidMass* mass = liquid_mass()) out.tail(LiquidMass::constraints) = mass->constraint_scales();
  return out;
}

VecX BodyProblem::compliances() const {
  VecX out = VecX::Zero(constraints());
  if (const LiquidMass* mass = liquid_mass()) out.tail(LiquidMass::constraints) = mass->compliances();
  return out;
}

double BodyProblem::unfolding_share(const VecX& step) const {
  const auto move = [&](int node) { return step.segment<3>(3 * Eigen::Index{node}); };
  const std::vector<double>& edges = body_.edge_lengths();
  const int coarse = body_.coarse_nodes();
  double share = 1.0;
  const auto limit = [&](const Vec3& moved, double edge) {
    constexpr double surely_less = 0.999;  // of the squares: most need no root
    const double squared = moved.squaredNorm();
    if (squared < surely_less * edge * edge) return;
    const double way = std::sqrt(squared);
    if (way * share > edge) share = edge / way;
  };
  std::vector<char> beside(static_cast<std::size_t>(body_.nodes()), 0);
  for (const std::vector<int>& face : body_.face_nodes())
    for (int node : face) {
      if (node >= coarse) continue;
      beside[static_cast<std::size_t>(node)] = 1;
      limit(move(node) - move(face.front()), std::min(edges[node], edges[face.front()]));
    }
  for (int node = 0; node < body_.nodes(); ++node)
    if (beside[static_cast<std::size_t>(node)] == 0) limit(move(node), edges[node]);
  return share;
}

double BodyProblem::margin_share(double gone, double way, double share) const {
  if (loads_.shapes.empty()) return share;
  const double margin = search_ ? search_->margin : contact_margin;
  if (gone + share * way <= margin) return share;
  if (search_) search_->held_up = true;
  // Better gather anew than go on in ever shorter steps.
  return margin - gone < 0.5 * margin ? 0.0 : std::min(share, (margin - gone) / way);
}

double BodyProblem::longest_share(const VecX& x, const VecX& step) const {
  return margin_share(moved(x), body_.largest_motion(step), unfolding_share(step));
}

std::vector<ContactPair> BodyProblem::pairs_on(const std::vector<char>& marked) const {
  const Tessellation& skin = body_.skin();
  const auto hangs = [&](int row) {
    const auto nodes = skin.stencils.node.begin();
    return std::any_of(nodes + skin.stencils.begin[row], nodes + skin.stencils.begin[row + 1],
                       [&](int node) { return marked[static_cast<std::size_t>(node)] != 0; });
  };
  std::vector<ContactPair> out;
  for (const ContactPair& pair : pairs()) {
    const Triangle& corners = skin.triangles[pair.triangle];
    if (std::any_of(corners.begin(), corners.end(), hangs)) out.push_back(pair);
  }
  return out;
}

double BodyProblem::share_beside_shapes(const VecX& x, const VecX& step, double share,
                                        const std::vector<ContactPair>& pairs) const {
  const double depth = body_.core_depth(), gone = moved(x), longest = body_.largest_motion(step);
  ContactPlaces places(body_.skin(), x, body_.core_radii()), moves(body_.skin(), step);
  for (const ContactPair& pair : pairs) {
    if (share * longest < (1.0 - contact_keep) * (pair.distance + depth - gone)) continue;
    const Shape& shape = cores_[pair.shape];
    const Nearness near = places.nearness(pair.triangle, shape);
    const double way = share * std::sqrt(moves.corners(pair.triangle).colwise().squaredNorm().maxCoeff());
    if (way < (1.0 - contact_keep) * near.of_all()) continue;
    for (int local : body_.contact_points(loads_.is_broad(pair.shape))) {
      const int point = pair.triangle * contacts_each + local;
      if (way < (1.0 - contact_keep) * near.of(point)) continue;
      const Vec3 motion = share * moves.at(point), at = places.at(point);
      const double radius = places.radius(point);
      if (motion.norm() < (1.0 - contact_keep) * (signed_distance(shape, at) - radius)) continue;
      share *= calot::safe_share(at, motion, radius > 0 ? offset(shape, radius) : shape, contact_keep);
    }
  }
  return share;
}

double BodyProblem::share_beside_itself(const VecX& x, const VecX& step, double share) const {
  return search_ ? search_->own.safe_share(body_, x, step, contact_keep, share) : share;
}

double BodyProblem::safe_share(const VecX& x, const VecX& step) const {
  const double longest = longest_share(x, step);
  return longest > 0 ? share_beside_itself(x, step, share_beside_shapes(x, step, longest)) : 0;
}

std::vector<ContactForce> contact_forces(const std::vector<Touch>& touches) {
  std::vector<ContactForce> out;
  for (const Touch& touch : touches)
    out.push_back({touch.shape, touch.point, touch.at, touch.force_on_shape()});
  return out;
}

std::vector<ContactForce> contact_forces(const Body& body, const VecX& x, const ContactLoads& loads,
                                         const std::vector<ContactPair>& pairs) {
  TouchMemory memory;
  return contact_forces(memory.at(body, x, loads, pairs, 0.0));
}

}  // namespace calot
