#include "joins/strand_join.h"

#include <algorithm>

#include "joins/strand_balance.h"

namespace calot {

StrandJoin::StrandJoin(std::array<int, 2> bodies, std::vector<PlacedStrand> strands)
    : bodies_(bodies), strands_(std::move(strands)), pasts_(strands_.size()) {}

void StrandJoin::set_past(const std::vector<double>& opened, double duration) {
  for (std::size_t i = 0; i < strands_.size(); ++i)
    pasts_[i] = {opened[i], duration > 0 ? tearing_delay / duration : 0};
}

void StrandJoin::begin(std::span<const GroupPlace> bodies) const {
  const std::array<int, 3> of{bodies_[0], bodies_[1], nodes_body_};
  if (nodes_body_ < 0 || *std::max_element(of.begin(), of.end()) >= static_cast<int>(bodies.size())) {
    rows_ = {};
    first_.fill(-1);
    return;
  }
  bool same = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const GroupPlace& place = bodies[of[k]];
    same &= first_[k] == place.first_node;
    first_[k] = place.first_node;
    if (k == 2) continue;
    same &= details_[k] == place.body->details();
    details_[k] = place.body->details();
  }
  if (same) return;
  rows_ = {};
  blocks_ = {};
  const auto skin = [&](int k) -> const StencilTable& { return bodies[bodies_[k]].body->skin().stencils; };
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    append_place(strands_[i].one, skin(0), first_[0], rows_);
    rows_.node.push_back(first_[2] + static_cast<int>(i));
    rows_.value.push_back(1);
    rows_.begin.push_back(static_cast<int>(rows_.node.size()));
    append_place(strands_[i].other, skin(1), first_[1], rows_);
  }
}

StrandVector StrandJoin::places(std::size_t strand, const VecX& x) const {
  StrandVector out;
  for (int k = 0; k < 3; ++k)
    out.segment<3>(3 * k) = blend(rows_, rows_.value, 3 * static_cast<int>(strand) + k, x);
  return out;
}

void StrandJoin::add_force(std::size_t strand, int piece, double share, const Vec3& force,
                           VecX& nodes) const {
  const int row = 3 * static_cast<int>(strand) + piece;
  spread(rows_, row, (1 - share) * force, nodes);
  spread(rows_, row + 1, share * force, nodes);
}

double StrandJoin::value(const VecX& x) const {
  double sum = 0;
  for (std::size_t i = 0; active() && i < strands_.size(); ++i) {
    const StrandVector at = places(i, x);
    sum += strands_[i].strand.value(at, pasts_[i]);
    if (const StrandThread* met = thread(i)) sum += touch_.value(*met, at);
  }
  return sum;
}

void StrandJoin::add_gradient(const VecX& x, VecX& gradient) const {
  for (std::size_t i = 0; active() && i < strands_.size(); ++i) {
    const StrandVector at = places(i, x);
    StrandVector pull = strands_[i].strand.gradient(at, pasts_[i]);
    if (const StrandThread* met = thread(i)) pull += touch_.gradient(*met, at);
    for (int k = 0; k < 3; ++k) spread(rows_, 3 * static_cast<int>(i) + k, pull.segment<3>(3 * k), gradient);
  }
}

std::array<int, 3> StrandJoin::ordered_rows(std::size_t strand) const {
  std::array<int, 3> out{0, 1, 2};
  constexpr std::array<int, 3> body{0, 2, 1};  // of the rows
  std::sort(out.begin(), out.end(), [&](int a, int b) { return first_[body[a]] < first_[body[b]]; });
  for (int& row : out) row += 3 * static_cast<int>(strand);
  return out;
}

void StrandJoin::find_blocks(const BlockMatrix& matrix) const {
  if (matrix.same_pattern(blocks_.pattern)) return;
  blocks_ = {matrix.pattern_only(), {}};
  std::vector<int> nodes;
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    nodes.clear();
    for (int row : ordered_rows(i))
      nodes.insert(nodes.end(), rows_.node.begin() + rows_.begin[row],
                   rows_.node.begin() + rows_.begin[row + 1]);
    for (std::size_t column = 0; column < nodes.size(); ++column)
      for (std::size_t below = column; below < nodes.size(); ++below)
        blocks_.slots.push_back(matrix.slot(nodes[below], nodes[column]));
  }
}

template <class Of>
bool StrandJoin::add_matrices(const VecX& x, BlockMatrix& matrix, const Of& of) const {
  find_blocks(matrix);
  struct Node {
    int node, point;
    double weight;
  };
  std::vector<Node> nodes;
  std::size_t next = 0;
  bool any = false;
  StrandMatrix own;
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    nodes.clear();
    for (int row : ordered_rows(i))
      for (int e = rows_.begin[row]; e < rows_.begin[row + 1]; ++e)
        nodes.push_back({rows_.node[e], row % 3, rows_.value[e]});
    if (!of(i, places(i, x), own)) {
      next += nodes.size() * (nodes.size() + 1) / 2;
      continue;
    }
    any = true;
    for (std::size_t column = 0; column < nodes.size(); ++column) {
      const Node& at = nodes[column];
      const Eigen::OuterStride<> stride(matrix.stride(at.node));
      const Eigen::Matrix<double, 9, 3> by = at.weight * own.middleCols<3>(3 * at.point);
      for (std::size_t below = column; below < nodes.size(); ++below)
        Eigen::Map<Mat3, 0, Eigen::OuterStride<>>(matrix.values() + blocks_.slots[next++], stride) +=
            nodes[below].weight * by.middleRows<3>(3 * nodes[below].point);
    }
  }
  return any;
}

void StrandJoin::add_hessian(const VecX& x, BlockMatrix& matrix) const {
  if (!active()) return;
  add_matrices(x, matrix, [&](std::size_t i, const StrandVector& at, StrandMatrix& own) {
    own = strands_[i].strand.hessian(at, pasts_[i]);
    if (const StrandThread* met = thread(i)) own += touch_.hessian(*met, at);
    return true;
  });
}

bool StrandJoin::add_convexity(const VecX& x, BlockMatrix& matrix) const {
  return active() && add_matrices(x, matrix, [&](std::size_t i, const StrandVector& at, StrandMatrix& own) {
           const double softens = strands_[i].strand.convexity(at, pasts_[i]);
           const StrandThread* met = thread(i);
           own = met ? touch_.convexity(*met, at) : StrandMatrix(StrandMatrix::Zero());
           if (softens > 0) {
             const StrandVector slope = strands_[i].strand.slope(at);
             own += softens * slope * slope.transpose();
           }
           return !own.isZero(0);
         });
}

// They stay what they are while the bodies do: a matrix that was made with room for them has it.
void StrandJoin::add_cliques(const VecX&, bool close, std::vector<std::vector<int>>& cliques) const {
  for (int row = 0; !close && row < rows_.rows(); row += 3) {
    std::vector<int>& nodes = cliques.emplace_back(rows_.node.begin() + rows_.begin[row],
                                                   rows_.node.begin() + rows_.begin[row + 3]);
    std::sort(nodes.begin(), nodes.end());
  }
}

void StrandJoin::relax(const LooseNodes& nodes, VecX& x) const {
  if (!active() || nodes.first != first_[2]) return;
  for (std::size_t i = 0; i < strands_.size(); ++i) {
    const auto node = static_cast<Eigen::Index>(i);
    const NodeLoad load{nodes.gradient.segment<3>(3 * node), nodes.stiffness[node]};
    x.segment<3>(3 * (first_[2] + node)) =
        balanced_node({strands_[i].strand, pasts_[i], thread(i), touch_}, load, places(i, x));
  }
}

double StrandJoin::safe_share(const VecX& x, const VecX& step, double share) const {
  for (std::size_t i = 0; meets() && i < strands_.size(); ++i)
    if (const StrandThread* met = thread(i))
      share = touch_.safe_share(*met, places(i, x), places(i, step), share);
  return share;
}

std::vector<double> StrandJoin::strains(const VecX& x) const {
  std::vector<double> out(strands_.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Strand& strand = strands_[i].strand;
    out[i] = strand.law.strain(strand.way(places(i, x)));
  }
  return out;
}

Vec3 StrandJoin::force(const VecX& x) const {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; active() && i < strands_.size(); ++i)
    sum -= strands_[i].strand.gradient(places(i, x), pasts_[i]).head<3>();
  return sum;
}

}  // namespace calot
