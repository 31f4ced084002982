#include "group/group_problem.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fem/assembly.h"

namespace calot {
namespace {

/// Bodies of fewer nodes are too little to share.
constexpr int large_body = 32;

}  // namespace

std::vector<Eigen::Index> volume_constraints(std::span<const int> counts) {
  std::vector<Eigen::Index> out;
  Eigen::Index before = 0;
  for (int count : counts) {
    out.push_back(count > 0 ? before : -1);
    before += count;
  }
  return out;
}

GroupProblem::GroupProblem(std::span<const Member> members, std::span<const JoinPointer> joins,
                           GroupPatterns& patterns, bool fixed_pressures)
    : members_(members), joins_(joins), patterns_(patterns) {
  problems_.reserve(members.size());
  std::vector<int> counts;
  for (const Member& member : members) {
    const bool large = member.body.nodes() >= large_body;
    small_ += large ? 0 : 1;
    by_size_.push_back(problems_.size());
    problems_.emplace_back(member.body, member.loads, member.search, member.state, fixed_pressures,
                           large ? members[0].assembly : nullptr);
    counts.push_back(problems_.back().constraints());
    const Eigen::Index size = member.state.x.size();
    ranges_.push_back({size_, size, constraints_, counts.back()});
    size_ += size;
    constraints_ += counts.back();
  }
  volumes_ = volume_constraints(counts);
  std::stable_sort(by_size_.begin(), by_size_.end(),
                   [&](std::size_t a, std::size_t b) { return ranges_[a].size < ranges_[b].size; });
  if (joins.empty()) return;
  std::vector<GroupPlace> bodies;
  for (std::size_t k = 0; k < members.size(); ++k)
    bodies.push_back({&members[k].body, static_cast<int>(ranges_[k].first) / 3, workers()});
  for (const JoinPointer& join : joins) join->begin(bodies);
}

VecX GroupProblem::coordinates() const {
  VecX out(size_);
  for (std::size_t k = 0; k < members_.size(); ++k)
    out.segment(ranges_[k].first, ranges_[k].size) = members_[k].state.x;
  return out;
}

VecX GroupProblem::multipliers() const {
  VecX out(constraints_);
  for (std::size_t k = 0; k < members_.size(); ++k)
    out.segment(ranges_[k].constraint, ranges_[k].constraints) = problems_[k].multipliers();
  return out;
}

VecX GroupProblem::resting_multipliers() const {
  const VecX given = compliances();
  VecX out = multipliers();
  for (Eigen::Index k = 0; k < out.size(); ++k)
    if (given[k] > 0) out[k] = 0;
  return out;
}

void GroupProblem::keep(const VecX& x, const VecX& multipliers) const {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    members_[k].state.x = part_of(k, x);
    if (volumes_[k] >= 0) members_[k].state.datum_pressure = multipliers[volumes_[k]];
  }
}

std::vector<Part> GroupProblem::parts() const {
  std::vector<Part> out;
  for (std::size_t k = 0; k < problems_.size(); ++k) {
    const int first = static_cast<int>(ranges_[k].first) / 3;
    for (Part part : problems_[k].parts()) {
      for (NodeRange* range : {&part.places, &part.displacements})
        range->first += first, range->last += first;
      out.push_back(part);
    }
  }
  return out;
}

template <class Work>
void GroupProblem::for_each_member(const Work& work, std::span<const Join* const> joins,
                                   const VecX* x) const {
  // The last are begun first: what takes longest.
  const std::size_t found = small_ + joins.size();
  for_each_chunk(workers(), static_cast<int>(by_size_.size() + joins.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    if (k >= small_ && k < found) return joins[k - small_]->find(*x);
    work(by_size_[k < small_ ? k : k - joins.size()]);
  });
}

Workers* GroupProblem::workers() const {
  return members_.empty() ? nullptr : workers_of(members_[0].assembly);
}

std::vector<const Join*> GroupProblem::joins_at(const VecX& x, const VecX* step) const {
  std::vector<const Join*> out;
  if (joins_.empty()) return out;
  std::vector<SkinBounds> bounds;
  for (std::size_t k = 0; k < problems_.size(); ++k) {
    bounds.push_back({skin_box(members_[k].body, part_of(k, x)), {}});
    if (step) bounds.back().motion = skin_motion(members_[k].body, part_of(k, *step));
  }
  for (const JoinPointer& join : joins_)
    if (!join->idle(bounds)) out.push_back(join.get());
  return out;
}

double GroupProblem::value(const VecX& x) const {
  std::vector<double> values(problems_.size());
  const std::vector<const Join*> joins = joins_at(x);
  for_each_member([&](std::size_t k) { values[k] = problems_[k].value(part_of(k, x)); }, joins, &x);
  double sum = 0;
  for (std::size_t k = 0; k < problems_.size() && std::isfinite(sum); ++k) sum += values[k];
  if (!std::isfinite(sum)) return sum;
  for (const Join* join : joins) {
    sum += join->value(x);
    if (!std::isfinite(sum)) return sum;
  }
  return sum;
}

double GroupProblem::cancelling() const {
  double sum = 0;
  for (const BodyProblem& problem : problems_) sum += problem.cancelling();
  return sum;
}

void GroupProblem::add_joins(std::span<const Join* const> joins, const VecX& x, VecX& gradient,
                             VecX& largest_internal) const {
  if (joins_.empty()) return;
  for (const Join* join : joins) join->add_gradient(x, gradient);
  for (std::size_t k = 0; k < problems_.size(); ++k)
    largest_internal[static_cast<Eigen::Index>(k)] =
        force_scale(largest_internal[static_cast<Eigen::Index>(k)], part_of(k, gradient));
}

void GroupProblem::gradient(const VecX& x, VecX& gradient, VecX& largest_internal) const {
  const std::vector<const Join*> joins = joins_at(x);
  if (alone()) {
    problems_[0].gradient(x, gradient, largest_internal);
    return add_joins(joins, x, gradient, largest_internal);
  }
  gradient.resize(size_);
  largest_internal.resize(static_cast<Eigen::Index>(problems_.size()));
  const auto own_part = [&](std::size_t k) {
    VecX own, internal;
    problems_[k].gradient(part_of(k, x), own, internal);
    gradient.segment(ranges_[k].first, ranges_[k].size) = own;
    largest_internal[static_cast<Eigen::Index>(k)] = internal[0];
  };
  for_each_member(own_part, joins, &x);
  add_joins(joins, x, gradient, largest_internal);
}

void GroupProblem::hessian(const VecX& x, const VecX& multipliers, BlockMatrix& matrix) const {
  if (alone()) {
    problems_[0].hessian(x, multipliers, matrix);
  } else {
    matrix.set_zero();
    for_each_member([&](std::size_t k) { add_own_hessian(k, x, multipliers, matrix); });
  }
  for (const Join* join : joins_at(x)) join->add_hessian(x, matrix);
}

void GroupProblem::add_own_hessian(std::size_t k, const VecX& x, const VecX& multipliers,
                                   BlockMatrix& matrix) const {
  const Range& range = ranges_[k];
  BlockMatrix& own = patterns_.own[k];
  problems_[k].hessian(part_of(k, x), multipliers.segment(range.constraint, range.constraints), own);
  matrix.add_part(own, static_cast<int>(range.first) / 3);
}

bool GroupProblem::add_convexity(const VecX& x, BlockMatrix& matrix) const {
  std::vector<char> added(problems_.size(), 0);
  if (alone()) {
    added[0] = problems_[0].add_convexity(x, matrix);
  } else {
    for_each_member([&](std::size_t k) noexcept {
      BlockMatrix& own = patterns_.own[k];
      own.set_zero();
      added[k] = problems_[k].add_convexity(part_of(k, x), own);
      if (added[k]) matrix.add_part(own, static_cast<int>(ranges_[k].first) / 3);
    });
  }
  bool any = std::find(added.begin(), added.end(), 1) != added.end();
  for (const Join* join : joins_at(x)) any |= join->add_convexity(x, matrix);
  return any;
}

void GroupProblem::constraint(const VecX& x, VecX& values, Eigen::MatrixXd& gradients) const {
  if (alone()) return problems_[0].constraint(x, values, gradients);
  values.resize(constraints_);
  gradients.setZero(size_, constraints_);
  VecX own_values;
  Eigen::MatrixXd own;
  for (std::size_t k = 0; k < problems_.size(); ++k) {
    const Range& range = ranges_[k];
    if (range.constraints == 0) continue;
    problems_[k].constraint(part_of(k, x), own_values, own);
    values.segment(range.constraint, range.constraints) = own_values;
    gradients.block(range.first, range.constraint, range.size, range.constraints) = own;
  }
}

VecX GroupProblem::constraint_values(const VecX& x) const {
  VecX values(constraints_);
  for_each_member([&](std::size_t k) {
    const Range& range = ranges_[k];
    if (range.constraints > 0)
      values.segment(range.constraint, range.constraints) = problems_[k].constraint_values(part_of(k, x));
  });
  return values;
}

void GroupProblem::gradient_and_constraint(const VecX& x, VecX& of_energy, VecX& largest_internal,
                                           VecX& values, Eigen::MatrixXd& of_constraints) const {
  const std::vector<const Join*> joins = joins_at(x);
  if (alone()) {
    problems_[0].gradient_and_constraint(x, of_energy, largest_internal, values, of_constraints);
    return add_joins(joins, x, of_energy, largest_internal);
  }
  of_energy.resize(size_);
  largest_internal.resize(static_cast<Eigen::Index>(problems_.size()));
  values.resize(constraints_);
  of_constraints.setZero(size_, constraints_);
  // A solve begins with tissues put in balance between bodies that stay: of these nothing is asked twice.
  last_.resize(problems_.size());
  const auto own_part = [&](std::size_t k) {
    const Range& range = ranges_[k];
    OwnSlopes& own = last_[k];
    const VecX at = part_of(k, x);
    if (own.x.size() != at.size() || own.x != at) {
      if (range.constraints == 0)
        problems_[k].gradient(at, own.gradient, own.internal);
      else
        problems_[k].gradient_and_constraint(at, own.gradient, own.internal, own.values, own.of_constraints);
      own.x = at;
    }
    of_energy.segment(range.first, range.size) = own.gradient;
    largest_internal[static_cast<Eigen::Index>(k)] = own.internal[0];
    if (range.constraints == 0) return;
    values.segment(range.constraint, range.constraints) = own.values;
    of_constraints.block(range.first, range.constraint, range.size, range.constraints) = own.of_constraints;
  };
  for_each_member(own_part, joins, &x);
  add_joins(joins, x, of_energy, largest_internal);
}

VecX GroupProblem::constraint_scales() const {
  VecX out(constraints_);
  for (std::size_t k = 0; k < problems_.size(); ++k)
    out.segment(ranges_[k].constraint, ranges_[k].constraints) = problems_[k].constraint_scales();
  return out;
}

VecX GroupProblem::compliances() const {
  VecX out(constraints_);
  for (std::size_t k = 0; k < members_.size(); ++k)
    out.segment(ranges_[k].constraint, ranges_[k].constraints) = problems_[k].compliances();
  return out;
}

VecX GroupProblem::pressures(const VecX& multipliers) const {
  VecX out = VecX::Zero(static_cast<Eigen::Index>(members_.size()));
  for (std::size_t k = 0; k < members_.size(); ++k)
    if (volumes_[k] >= 0) out[static_cast<Eigen::Index>(k)] = multipliers[volumes_[k]];
  return out;
}

void GroupProblem::prepare_alone(NewtonWorkspace& work) const {
  const Body& body = members_[0].body;
  if (work.matrix.size() != size_) work = NewtonWorkspace(body.pattern(), body.coarse_nodes());
  if (std::optional<BlockMatrix> pattern = problems_[0].new_pattern(work.matrix))
    work = NewtonWorkspace(std::move(*pattern), body.coarse_nodes());
}

namespace {

/// Whether each node is coupled with each other one.
bool couples_all(const BlockMatrix& matrix) {
  const auto nodes = static_cast<std::size_t>(matrix.nodes());
  return matrix.block_rows().size() == nodes * (nodes + 1) / 2;
}

/// Whether all nodes of each group are coupled.
bool holds(const BlockMatrix& matrix, const std::vector<std::vector<int>>& cliques) {
  for (const std::vector<int>& clique : cliques)
    for (int j : clique)
      for (int i : clique)
        if (i > j && matrix.slot(i, j) < 0) return false;
  return true;
}

}  // namespace

void GroupProblem::prepare(NewtonWorkspace& work) const {
  if (alone()) return prepare_alone(work);
  bool changed = work.matrix.size() != size_;
  patterns_.own.resize(problems_.size(), BlockMatrix(0, {}));
  for (std::size_t k = 0; k < problems_.size(); ++k) {
    BlockMatrix& own = patterns_.own[k];
    const bool other_body = own.size() != ranges_[k].size;
    if (other_body) own = members_[k].body.pattern();
    std::optional<BlockMatrix> pattern = problems_[k].new_pattern(own);
    if (pattern) own = std::move(*pattern);
    changed |= other_body || pattern.has_value();
  }
  // What had to be coupled and is apart again costs room in the factor, but a new one costs more.
  constexpr std::size_t most_idle = 3;  // times as many groups as are close
  if (!changed) {
    const std::vector<std::vector<int>> close = cliques(true);
    std::size_t needed = close.size();
    for (const JoinPointer& join : joins_) needed += join->lasting_cliques();
    if (patterns_.joined.size() <= most_idle * needed && holds(work.matrix, close)) return;
  }
  patterns_.joined = cliques(false);
  work = workspace();
}

NewtonWorkspace GroupProblem::workspace() const {
  return NewtonWorkspace(BlockMatrix(patterns_.own, patterns_.joined), kept_nodes());
}

std::vector<char> GroupProblem::kept_nodes() const {
  std::vector<char> joined(static_cast<std::size_t>(size_ / 3), 0), kept;
  for (const std::vector<int>& clique : patterns_.joined)
    for (int node : clique) joined[static_cast<std::size_t>(node)] = 1;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const Body& body = members_[k].body;
    const bool full = couples_all(patterns_.own[k]);
    for (int node = 0; node < body.nodes(); ++node)
      kept.push_back(node < body.kept_nodes() && (!full || joined[kept.size()]));
  }
  return kept;
}

std::vector<std::vector<int>> GroupProblem::cliques(bool close) const {
  std::vector<std::vector<int>> out;
  if (joins_.empty()) return out;
  const VecX x = coordinates();
  const std::vector<const Join*> joins = joins_at(x);
  std::vector<std::vector<std::vector<int>>> of_join(joins.size());
  for_each_chunk(workers(), static_cast<int>(joins.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    joins[k]->add_cliques(x, close, of_join[k]);
  });
  for (std::vector<std::vector<int>>& own : of_join)
    out.insert(out.end(), std::make_move_iterator(own.begin()), std::make_move_iterator(own.end()));
  return out;
}

VecX GroupProblem::curved(const VecX& x, VecX step) const {
  for (std::size_t k = 0; k < members_.size(); ++k) {
    const Range& range = ranges_[k];
    if (members_[k].body.turns_as_a_whole())
      step.segment(range.first, range.size) = members_[k].body.curved(part_of(k, x), part_of(k, step));
  }
  return step;
}

LooseNodes GroupProblem::loose_nodes(std::size_t k, const VecX& x) const {
  const Body& body = members_[k].body;
  LooseNodes out;
  out.first = static_cast<int>(ranges_[k].first) / 3;
  VecX largest_internal;
  problems_[k].gradient(x, out.gradient, largest_internal);
  BlockMatrix own = body.pattern();
  problems_[k].hessian(x, VecX(), own);
  out.stiffness.resize(body.nodes());
  for (int node = 0; node < body.nodes(); ++node) out.stiffness[node] = own.diagonal(3 * node);
  return out;
}

VecX GroupProblem::relaxed(VecX x) const {
  // No strand ends on another tissue's nodes: members may be relaxed at once.
  for_each_chunk(workers(), static_cast<int>(members_.size()), [&](int chunk) {
    const auto k = static_cast<std::size_t>(chunk);
    if (!members_[k].body.has_loose_nodes()) return;
    const LooseNodes nodes = loose_nodes(k, part_of(k, x));
    for (const JoinPointer& join : joins_) join->relax(nodes, x);
  });
  return x;
}

class GroupProblem::Pressed : public SharpTerms {
 public:
  Pressed(const GroupProblem& group, const VecX& x, const VecX& step, double least,
          std::span<const SharpTangent> tangents)
      : group_(group) {
    for (std::size_t k = 0; k < group.problems_.size(); ++k) {
      const auto own = std::equal_range(tangents.begin(), tangents.end(), SharpTangent{static_cast<int>(k)},
                                        [](const auto& a, const auto& b) { return a.part < b.part; });
      PressedLaws laws = group.problems_[k].pressed_laws(group.part_of(k, x), group.part_of(k, step), least,
                                                         {own.first, own.second});
      if (laws.none()) continue;
      std::vector<char> marks(static_cast<std::size_t>(group.ranges_[k].size / 3), 0);
      laws.mark_nodes(marks);
      for (std::size_t node = 0; node < marks.size(); ++node)
        if (marks[node]) nodes_.push_back(group.first_node(k) + static_cast<int>(node));
      laws_.push_back({k, std::move(laws), group.problems_[k].pairs_on(marks)});
    }
  }

  double value(const VecX& x) const override {
    double sum = 0;
    for (const auto& [k, laws, pairs] : laws_) sum += laws.value(group_.part_of(k, x));
    return sum;
  }
  VecX gradient(const VecX& x) const override {
    VecX out = VecX::Zero(x.size());
    for (const auto& [k, laws, pairs] : laws_) {
      VecX own = VecX::Zero(group_.ranges_[k].size);
      laws.add_gradient(group_.part_of(k, x), own);
      out.segment(group_.ranges_[k].first, own.size()) = own;
    }
    return out;
  }
  SharpHessian hessian(const VecX& x, bool convex) const override {
    return of_each([&](std::size_t k, const PressedLaws& laws, BlockMatrix& matrix) {
      laws.add_hessian(group_.part_of(k, x), convex, matrix);
    });
  }
  SharpHessian factorised() const override {
    return of_each(
        [](std::size_t, const PressedLaws& laws, BlockMatrix& matrix) { laws.add_tangents(matrix); });
  }
  double safe_share(const VecX& x, const VecX& step) const override {
    double share = group_.longest_share(x, step);
    for (const auto& [k, laws, pairs] : laws_)
      share = group_.problems_[k].share_beside_shapes(group_.part_of(k, x), group_.part_of(k, step), share,
                                                      pairs);
    return share;
  }

 private:
  struct OfMember {
    std::size_t k;
    PressedLaws laws;
    std::vector<ContactPair> pairs;  ///< all that hang on the laws' nodes
  };
  /// add(member, its laws, a matrix of zeros of its nodes) for each.
  template <class Add>
  SharpHessian of_each(const Add& add) const {
    SharpHessian out;
    for (const auto& [k, laws, pairs] : laws_) {
      out.parts.push_back({group_.first_node(k), group_.members_[k].body.pattern().blank()});
      add(k, laws, out.parts.back().matrix);
    }
    return out;
  }

  const GroupProblem& group_;
  std::vector<OfMember> laws_;
};

std::vector<SharpTangent> GroupProblem::sharp_tangents(const VecX& x, bool convex) const {
  std::vector<SharpTangent> out;
  for (std::size_t k = 0; k < problems_.size(); ++k)
    for (SharpTangent& tangent : problems_[k].pressed_tangents(part_of(k, x), convex)) {
      tangent.part = static_cast<int>(k);
      out.push_back(tangent);
    }
  return out;
}

std::unique_ptr<const SharpTerms> GroupProblem::sharp_terms(const VecX& x, const VecX& step, double least,
                                                            std::span<const SharpTangent> tangents) const {
  auto out = std::make_unique<Pressed>(*this, x, step, least, tangents);
  return out->nodes().empty() ? nullptr : std::move(out);
}

double GroupProblem::longest_share(const VecX& x, const VecX& step) const {
  double share = 1;
  for (std::size_t k = 0; k < problems_.size(); ++k)
    share = std::min(share, problems_[k].longest_share(part_of(k, x), part_of(k, step)));
  return share;
}

double GroupProblem::safe_share(const VecX& x, const VecX& step) const {
  return safe_part(x, step, longest_share(x, step));
}

double GroupProblem::share_if_whole(const VecX& x, const VecX& step) const {
  const double longest = longest_share(x, step);
  return longest < 1 ? longest : safe_part(x, step, longest);
}

double GroupProblem::safe_part(const VecX& x, const VecX& step, double share) const {
  if (share == 0) return 0;
  std::vector<double> shares(problems_.size());
  for_each_member([&](std::size_t k) {
    shares[k] = problems_[k].share_beside_shapes(part_of(k, x), part_of(k, step), share);
  });
  // Skins are looked at last, as that takes longest: on what the others have left of the way.
  double left = share;
  for (double own : shares) left = std::min(left, own);
  const VecX way = left * step;
  const std::vector<const Join*> joins = joins_at(x, &way);
  return least_safe(workers(), joins.size() + problems_.size(), left, [&](std::size_t k) {
    if (k < joins.size()) return joins[k]->safe_share(x, step, left);
    const std::size_t member = by_size_[k - joins.size()];
    return problems_[member].share_beside_itself(part_of(member, x), part_of(member, step), left);
  });
}

}  // namespace calot
