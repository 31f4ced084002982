#include "world/rest_state.h"

#include "field/field_tissues.h"
#include "field/moving_bodies.h"
#include "geometry/matrix_bytes.h"
#include "motion/settle_field.h"

namespace calot {
namespace {

bool fits(const RestState& state, const Field& field) {
  const std::size_t bodies = moving_bodies(field);
  if (state.places.size() != bodies || state.pressures.size() != field.organs.size()) return false;
  if (state.searched() ? state.own.size() != bodies : state.factored) return false;
  for (std::size_t k = 0; k < bodies; ++k)
    if (state.places[k].size() != state_of(field, k).x.size()) return false;
  return fit(state.sharp, field) && (!state.factored || state.constraints.rows() == BodyParts(field).total());
}

/// As the search left them: values are written anew by each solve.
void take_patterns(const RestState& state, Field& field) {
  GroupPatterns& patterns = field.group.patterns;
  patterns.own.clear();
  for (std::size_t k = 0; k < moving_bodies(field); ++k) {
    const Body& body = body_of(field, k);
    patterns.own.push_back(state.own[k].empty() ? body.pattern() : BlockMatrix(body.nodes(), state.own[k]));
  }
  patterns.joined = state.joined;
}

bool take_factor(const RestState& state, Workers* workers, NewtonWorkspace& work) {
  if (work.matrix.entries().size() != state.matrix.size()) return false;
  work.matrix.assign(state.matrix);
  if (work.factor.factorise(work.matrix, workers) != FactorStatus::ok) return false;
  work.border.gradients = state.constraints;
  work.border.compliances = state.compliances;
  work.border.solve_with(work.factor, workers);
  work.sharp = state.sharp;
  work.factored = true;
  return true;
}

}  // namespace

RestState rest_state(const Field& field) {
  RestState out;
  for (std::size_t k = 0; k < moving_bodies(field); ++k) out.places.push_back(state_of(field, k).x);
  for (const Organ& organ : field.organs) out.pressures.push_back(organ.state.datum_pressure);
  const Group& group = field.group;
  if (group.patterns.own.empty()) return out;
  for (std::size_t k = 0; k < moving_bodies(field); ++k) {
    const BlockMatrix& own = group.patterns.own[k];
    const bool widened = own.entries().size() != body_of(field, k).pattern().entries().size();
    out.own.push_back(widened ? own.couplings() : std::vector<std::vector<int>>());
  }
  out.joined = group.patterns.joined;
  out.shifted = group.work.shifted;
  out.factored = group.work.factored;
  if (!out.factored) return out;
  out.matrix = group.work.matrix.entries();
  out.constraints = group.work.border.gradients;
  out.compliances = group.work.border.compliances;
  out.sharp = group.work.sharp;
  return out;
}

bool take_rest_state(const RestState& state, Field& field) {
  if (!fits(state, field)) return false;
  const GroupSnapshot before = snapshot(field);
  for (std::size_t k = 0; k < moving_bodies(field); ++k) state_of(field, k).x = state.places[k];
  for (std::size_t k = 0; k < field.organs.size(); ++k)
    field.organs[k].state.datum_pressure = state.pressures[k];
  Group& group = field.group;
  if (state.searched()) take_patterns(state, field);
  const std::vector<ContactLoads> loads = solve_loads(field, present_poses(field));
  std::vector<Member> members = members_of(field, loads);
  TissueMembers tissues(field);
  tissues.add_to(members);
  // A solve begins here, too: what joins the bodies is told who they are.
  const std::vector<JoinPointer> joins = all_joins(field, present_poses(field));
  const GroupProblem problem(members, joins, group.patterns);
  if (!state.searched()) return true;
  group.work = problem.workspace();
  group.work.shifted = state.shifted;
  if (!state.factored || take_factor(state, problem.workers(), group.work)) return true;
  restore(field, before);
  return false;
}

namespace {

std::span<const double> numbers_of(const VecX& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

VecX vector_of(const std::vector<double>& numbers) {
  return Eigen::Map<const VecX>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

}  // namespace

std::string to_bytes(const RestState& state) {
  ByteWriter out;
  out.add(state.places.size());
  for (const VecX& x : state.places) out.add(numbers_of(x));
  out.add(std::span<const double>(state.pressures));
  out.add(state.own.size());
  for (const std::vector<std::vector<int>>& own : state.own) out.add(own);
  out.add(state.joined);
  out.add(static_cast<char>(state.factored));
  out.add(static_cast<char>(state.shifted));
  out.add(std::span<const double>(state.matrix));
  add_matrix(state.constraints, out);
  out.add(numbers_of(state.compliances));
  MemberWriter{out}(state.sharp);
  return out.bytes();
}

std::optional<RestState> rest_state_of(std::string_view bytes) {
  constexpr std::size_t counts = sizeof(std::size_t);
  ByteReader in(bytes);
  RestState state;
  state.places.resize(in.counted(counts));
  for (VecX& x : state.places) x = vector_of(in.numbers<double>());
  state.pressures = in.numbers<double>();
  state.own.resize(in.counted(counts));
  for (std::vector<std::vector<int>>& own : state.own) own = in.lists();
  state.joined = in.lists();
  state.factored = in.number<char>() != 0;
  state.shifted = in.number<char>() != 0;
  state.matrix = in.numbers<double>();
  state.constraints = matrix_of(in);
  state.compliances = vector_of(in.numbers<double>());
  MemberReader{in}(state.sharp);
  if (!in.complete()) return std::nullopt;
  return state;
}

}  // namespace calot
