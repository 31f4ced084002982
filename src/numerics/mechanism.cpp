#include "numerics/mechanism.h"

#include "numerics/modes.h"

namespace calot {
namespace {

/// Orthonormal columns that span what `columns` do; what is but rounding of the others is left out.
Eigen::MatrixXd orthonormal(const Eigen::MatrixXd& columns) {
  constexpr double rounding = 1e-12;
  Eigen::MatrixXd out(columns.rows(), columns.cols());
  Eigen::Index kept = 0;
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    VecX left = columns.col(c);
    for (Eigen::Index k = 0; k < kept; ++k) left -= out.col(k).dot(left) * out.col(k);
    if (left.norm() <= rounding * columns.col(c).norm()) continue;
    out.col(kept++) = left.normalized();
  }
  return out.leftCols(kept);
}

/// Of a part at x: 6, orthonormal, or fewer where its nodes are in line. Displacements, which follow the places, turn
/// but do not shift.
Eigen::MatrixXd rigid_motions(const VecX& x, const Part& part) {
  Vec3 centre = Vec3::Zero();
  const NodeRange& places = part.places;
  for (int i = places.first; i < places.last; ++i) centre += x.segment<3>(3 * i) / places.size();
  Eigen::MatrixXd motions = Eigen::MatrixXd::Zero(x.size(), 6);
  part.for_nodes([&](int i) {
    const bool place = i >= places.first && i < places.last;
    const Vec3 arm = place ? Vec3(x.segment<3>(3 * i) - centre) : Vec3(x.segment<3>(3 * i));
    for (int axis = 0; axis < 3; ++axis) {
      if (place) motions.col(axis).segment<3>(3 * i) = Vec3::Unit(axis);
      motions.col(3 + axis).segment<3>(3 * i) = Vec3::Unit(axis).cross(arm);
    }
  });
  return orthonormal(motions);
}

/// Rigid motions of all parts, and whose each is.
struct Motions {
  Eigen::MatrixXd columns;
  std::vector<int> part;
};

Motions rigid_motions(const VecX& x, std::span<const Part> parts) {
  Motions out{Eigen::MatrixXd(x.size(), 0), {}};
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Eigen::MatrixXd own = rigid_motions(x, parts[p]);
    out.columns.conservativeResize(Eigen::NoChange, out.columns.cols() + own.cols());
    out.columns.rightCols(own.cols()) = own;
    out.part.insert(out.part.end(), static_cast<std::size_t>(own.cols()), static_cast<int>(p));
  }
  return out;
}

/// Whose the largest share of a combination of the motions is.
int part_of(const Motions& motions, const VecX& combination, std::size_t parts) {
  VecX squared = VecX::Zero(static_cast<Eigen::Index>(parts));
  for (std::size_t c = 0; c < motions.part.size(); ++c) {
    const double share = combination[static_cast<Eigen::Index>(c)];
    squared[motions.part[c]] += share * share;
  }
  Eigen::Index largest = 0;
  squared.maxCoeff(&largest);
  return static_cast<int>(largest);
}

}  // namespace

double mean_stiffness(const BlockMatrix& matrix, const Part& part) {
  double sum = 0;
  part.for_nodes([&](int node) {
    for (int c = 0; c < 3; ++c) sum += std::abs(matrix.diagonal(3 * node + c));
  });
  return sum / (3 * part.nodes());
}

// Motions and forces are taken in each part's own measure, so that softness is judged beside the part's stiffness: the
// matrix is D K D, D^-2 the parts' mean stiffnesses. A motion meets no resistance where its stiffness and the forces it
// causes, but for what the multipliers take up, are rounding. (The stiffness alone may change its sign where a motion
// is held softly.) Rigid motions keep volumes, so the constraints cannot hold them, but for those with a compliance: each
// is as stiff along its gradient as it allows.
std::optional<int> mechanism(const BlockMatrix& matrix, const Eigen::MatrixXd& gradients,
                             const VecX& compliances, const VecX& x, std::span<const Part> parts) {
  VecX measure(x.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const double stiffness = mean_stiffness(matrix, parts[p]);
    if (stiffness == 0) return static_cast<int>(p);
    parts[p].for_nodes([&](int node) { measure.segment<3>(3 * node).setConstant(1 / std::sqrt(stiffness)); });
  }
  const Motions motions = rigid_motions(x, parts);
  Eigen::MatrixXd forces(x.size(), motions.columns.cols());
  for (Eigen::Index c = 0; c < forces.cols(); ++c)
    forces.col(c) = measure.cwiseProduct(matrix.multiply(VecX(measure.cwiseProduct(motions.columns.col(c)))));
  const Eigen::MatrixXd measured = measure.asDiagonal() * gradients;
  const bool compliant = compliances.size() > 0;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index k = 0; k < measured.cols(); ++k) {
    if (!compliant || compliances[k] == 0) {
      kept.push_back(k);
      continue;
    }
    // No stiffer than the parts: beside what is stiffer by far the others' resistance would be rounding.
    const double allowed = std::max(compliances[k], measured.col(k).squaredNorm());
    forces += measured.col(k) / allowed * (measured.col(k).transpose() * motions.columns);
  }
  const std::optional<Modes> resisted = modes(Eigen::MatrixXd(motions.columns.transpose() * forces));
  if (!resisted) return std::nullopt;
  const Eigen::MatrixXd taken = orthonormal(measured(Eigen::all, kept));
  for (Eigen::Index m = 0; m < resisted->values.size(); ++m) {
    if (!(std::abs(resisted->values[m]) < 1e-9)) continue;
    VecX met = forces * resisted->vectors.col(m);
    for (Eigen::Index k = 0; k < taken.cols(); ++k) met -= taken.col(k).dot(met) * taken.col(k);
    if (met.norm() < 1e-8) return part_of(motions, resisted->vectors.col(m), parts.size());
  }
  return std::nullopt;
}

}  // namespace calot
