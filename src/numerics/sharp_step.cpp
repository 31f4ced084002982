#include "numerics/sharp_step.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "numerics/node_rows.h"
#include "numerics/parts.h"

namespace calot {
namespace {

/// What each of the nodes answers to loads on them with constraints kept, m/N.
Eigen::MatrixXd compliance(const NewtonWorkspace& work, std::span<const int> nodes, Workers* workers) {
  Eigen::MatrixXd out = work.factor.compliance(nodes, workers);
  const Border& border = work.border;
  if (border.constraints() == 0) return out;
  const Eigen::MatrixXd answers = picked(border.answers, nodes);
  out.noalias() -= answers * Eigen::LDLT<Eigen::MatrixXd>(border.complement).solve(answers.transpose());
  return out;
}

/// The sum that sharp_load() makes least, of the way y of a few nodes; the others are where the step leads.
class Near {
 public:
  Near(const SharpTerms& terms, const SharpStart& start)
      : terms_(terms),
        start_(start),
        nodes_(terms.nodes()),
        slope_(picked(terms.gradient(start.x), nodes_)),
        step_(picked(start.step, nodes_)),
        own_(terms.factorised().over(nodes_)) {}

  std::span<const int> nodes() const { return nodes_; }
  Eigen::Index size() const { return step_.size(); }
  bool set_compliance(const Eigen::MatrixXd& of_nodes) {
    if (!of_nodes.allFinite()) return false;
    const Eigen::LLT<Eigen::MatrixXd> factor(of_nodes);
    if (factor.info() != Eigen::Success) return false;
    compliance_ = of_nodes;
    stiffness_ = factor.solve(Eigen::MatrixXd::Identity(of_nodes.rows(), of_nodes.cols()));
    return true;
  }

  VecX place(const VecX& y) const {
    VecX way = start_.step;
    put(y, nodes_, way);
    return start_.x + way;
  }
  double value(const VecX& y) const {
    const VecX off = y - step_;
    return 0.5 * off.dot(stiffness_ * off) + terms_.value(place(y)) - slope_.dot(y) - 0.5 * y.dot(own_ * y);
  }
  VecX gradient(const VecX& y) const {
    return stiffness_ * (y - step_) + picked(terms_.gradient(place(y)), nodes_) - slope_ - own_ * y;
  }
  /// Newton's way from y, where the sum's slope is this; by its convex part where it is not convex there.
  VecX way(const VecX& y, const VecX& slope) const {
    for (bool convex : {false, true}) {
      const Eigen::MatrixXd second = stiffness_ + terms_.hessian(place(y), convex).over(nodes_) - own_;
      if (!second.allFinite()) break;
      const Eigen::LLT<Eigen::MatrixXd> factor(second);
      if (factor.info() == Eigen::Success) return -factor.solve(slope);
    }
    return -compliance_ * slope;
  }
  double safe_share(const VecX& y, const VecX& way) const {
    VecX whole = VecX::Zero(start_.x.size());
    put(way, nodes_, whole);
    return terms_.safe_share(place(y), whole);
  }
  /// That makes the step end at y.
  VecX load(const VecX& y) const {
    VecX out = VecX::Zero(start_.x.size());
    put(VecX(stiffness_ * (y - step_)), nodes_, out);
    return out;
  }

 private:
  const SharpTerms& terms_;
  const SharpStart& start_;
  const std::vector<int>& nodes_;
  VecX slope_;                              ///< of the terms, N
  VecX step_;                               ///< u
  Eigen::MatrixXd own_;                     ///< the terms' part of the factor, N/m
  Eigen::MatrixXd compliance_, stiffness_;  ///< H^-1 and its inverse
};

/// Where the slope is below `enough`, N, by Newton's method with a line search from where the nodes stand. Empty if it does
/// not get there soon: from what it found by then nearly no step is taken.
VecX nearest_balance(const Near& near, double enough) {
  constexpr int most_rounds = 12, most_halvings = 12;
  VecX y = VecX::Zero(near.size());
  double value = near.value(y);
  for (int round = 0; round < most_rounds; ++round) {
    const VecX slope = near.gradient(y);
    if (largest_node(slope) <= enough) return y;
    const VecX way = near.way(y, slope);
    if (!way.allFinite()) break;
    double share = near.safe_share(y, way), next = 0;
    bool falls = false;
    for (int k = 0; k < most_halvings && !falls && share > 0; ++k) {
      next = near.value(y + share * way);
      falls = next <= value + 1e-4 * share * slope.dot(way) + 1e-13 * std::abs(value);
      if (!falls) share *= 0.5;
    }
    if (!falls) break;
    y += share * way;
    value = next;
  }
  return {};
}

}  // namespace

VecX sharp_load(const ConstrainedEnergy& problem, const NewtonWorkspace& work, const SharpStart& start,
                double least) {
  constexpr std::size_t most_nodes = 48;  // what these answer takes half as long as a factor of 300
  constexpr double enough = 1e-3;
  const std::unique_ptr<const SharpTerms> terms = problem.sharp_terms(start.x, start.step, least, work.sharp);
  if (terms == nullptr || terms->nodes().size() > most_nodes) return {};
  Near near(*terms, start);
  if (!near.set_compliance(compliance(work, near.nodes(), problem.workers()))) return {};
  const VecX balance = nearest_balance(near, enough * start.residual);
  return balance.size() > 0 ? near.load(balance) : balance;
}

}  // namespace calot
