#include "numerics/condense.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "numerics/node_rows.h"

namespace calot {
namespace {

using Block = Eigen::Map<Eigen::MatrixXd, Eigen::AlignedMax>;
using ConstBlock = Eigen::Map<const Eigen::MatrixXd, Eigen::AlignedMax>;

/// Calls see(row, column, offset of entry (0, 0)) for each block of the pattern.
template <class See>
void for_blocks(const BlockMatrix& pattern, See see) {
  for (int column = 0; column < pattern.nodes(); ++column) {
    const int begin = pattern.column_starts()[3 * column], end = pattern.column_starts()[3 * column + 1];
    for (int e = begin; e < end; e += 3) see(pattern.rows()[e] / 3, column, e);
  }
}

/// Sets that are joined one by one; the least of each leads it.
class Sets {
 public:
  explicit Sets(int count) : leader_(static_cast<std::size_t>(count)) {
    for (int i = 0; i < count; ++i) leader_[i] = i;
  }
  int leader(int i) {
    while (leader_[i] != i) i = leader_[i] = leader_[leader_[i]];
    return i;
  }
  void join(int i, int j) {
    const int a = leader(i), b = leader(j);
    leader_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> leader_;
};

/// Pieces that are eliminated at once: more products would not stay in the processor's cache.
constexpr int pieces_at_once = 32;

void sort_once(std::vector<int>& nodes) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
}

Eigen::Index place_of(int node, const std::vector<int>& nodes) {
  return 3 * (std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin());
}

}  // namespace

Condensation::Condensation(const BlockMatrix& pattern, std::span<const char> kept) {
  auto layout = std::make_shared<Layout>();
  std::vector<int> number(kept.size(), -1);  // of kept nodes
  for (int node = 0; node < pattern.nodes(); ++node)
    if (kept[node]) {
      number[node] = static_cast<int>(layout->kept.size());
      layout->kept.push_back(node);
    }
  find_pieces(pattern, number, *layout);
  lay_out(pattern, number, *layout);
  layout_ = std::move(layout);
}

Condensation Condensation::blank() const { return Condensation(layout_); }

void Condensation::find_pieces(const BlockMatrix& pattern, const std::vector<int>& number, Layout& layout) {
  Sets sets(pattern.nodes());
  for_blocks(pattern, [&](int row, int column, int) {
    if (number[row] < 0 && number[column] < 0) sets.join(row, column);
  });
  std::vector<int> piece_of(number.size(), -1);  // of leaders
  for (int node = 0; node < pattern.nodes(); ++node) {
    if (number[node] >= 0) continue;
    int& piece = piece_of[sets.leader(node)];
    if (piece < 0) {
      piece = static_cast<int>(layout.pieces.size());
      layout.pieces.emplace_back();
    }
    layout.pieces[piece].inner.push_back(node);
  }
  for_blocks(pattern, [&](int row, int column, int) {
    if (number[row] < 0 && number[column] >= 0)
      layout.pieces[piece_of[sets.leader(row)]].outer.push_back(number[column]);
    if (number[row] >= 0 && number[column] < 0)
      layout.pieces[piece_of[sets.leader(column)]].outer.push_back(number[row]);
  });
  std::map<std::vector<int>, std::size_t> singles;  // by what they meet
  std::vector<Piece> pieces;
  for (Piece& piece : layout.pieces) {
    sort_once(piece.outer);
    piece.single = piece.inner.size() == 1;
    if (piece.single) {
      const auto [at, is_new] = singles.try_emplace(piece.outer, pieces.size());
      if (!is_new) {
        pieces[at->second].inner.push_back(piece.inner.front());
        continue;
      }
    }
    pieces.push_back(std::move(piece));
  }
  layout.pieces = std::move(pieces);
}

void Condensation::lay_out(const BlockMatrix& pattern, const std::vector<int>& number, Layout& layout) {
  const auto room = [](Eigen::Index size, Eigen::Index& end) {
    const Eigen::Index at = end;
    end += (size + 3) / 4 * 4;  // the next one is aligned too
    return at;
  };
  Eigen::Index products = 0;
  std::vector<int> piece_of(number.size(), -1);
  for (std::size_t p = 0; p < layout.pieces.size(); ++p) {
    Piece& piece = layout.pieces[p];
    for (int node : piece.inner) piece_of[node] = static_cast<int>(p);
    piece.factor = room(piece.rows() * (piece.single ? 3 : piece.rows()), layout.size);
    piece.coupling = room(piece.rows() * piece.meets(), layout.size);
    piece.size = layout.size - piece.factor;
    if (p % pieces_at_once == 0) products = 0;
    piece.product = room(piece.meets() * piece.meets(), products);
    layout.products = std::max(layout.products, products);
  }
  for_blocks(pattern, [&](int row, int column, int from) {
    const int stride = pattern.stride(column);
    if (number[row] >= 0 && number[column] >= 0) {
      layout.kept_blocks.push_back({from, stride, number[row], number[column]});
      return;
    }
    const bool row_is_inner = number[row] < 0;
    Piece& piece = layout.pieces[piece_of[row_is_inner ? row : column]];
    const Eigen::Index inner = place_of(row_is_inner ? row : column, piece.inner), rows = piece.rows();
    if (row_is_inner && number[column] < 0) {
      if (piece.single)
        piece.moves.push_back({from, stride, piece.factor + 3 * inner, 1, 3});
      else
        piece.moves.push_back(
            {from, stride, piece.factor + inner + place_of(column, piece.inner) * rows, 1, rows});
      return;
    }
    const Eigen::Index outer = place_of(row_is_inner ? number[column] : number[row], piece.outer);
    // Steps of a condensed unknown and of a kept one.
    const Eigen::Index by_inner = piece.single ? piece.meets() : 1, by_outer = piece.single ? 1 : rows;
    const Eigen::Index to = piece.coupling + inner * by_inner + outer * by_outer;
    piece.moves.push_back(
        {from, stride, to, row_is_inner ? by_inner : by_outer, row_is_inner ? by_outer : by_inner});
  });
}

std::vector<std::vector<int>> Condensation::kept_couplings() const {
  const std::size_t count = layout_->kept.size();
  std::vector<char> coupled(count * count, 0);  // pieces that meet the same nodes say the same again
  const auto couple = [&](int a, int b) { coupled[a * count + b] = coupled[b * count + a] = 1; };
  for (const KeptBlock& block : layout_->kept_blocks) couple(block.i, block.j);
  for (const Piece& piece : layout_->pieces)
    for (int a : piece.outer)
      for (int b : piece.outer) couple(a, b);
  std::vector<std::vector<int>> out(count);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b)
      if (a != b && coupled[a * count + b]) out[a].push_back(static_cast<int>(b));
  return out;
}

void Condensation::gather(const Piece& piece, const BlockMatrix& matrix) {
  values_.segment(piece.factor, piece.size).setZero();
  for (const Move& move : piece.moves)
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        values_[move.to + r * move.by_row + c * move.by_column] =
            matrix.entries()[static_cast<std::size_t>(move.from + c * move.stride + r)];
}

FactorStatus Condensation::eliminate(const BlockMatrix& matrix, EnvelopeFactor& kept, Workers* workers) {
  values_.resize(layout_->size);
  products_.resize(layout_->products);
  kept.clear(workers);
  constexpr int shares = 4;
  for_each_chunk(workers, shares, [&](int k) {
    const Chunk blocks = chunk_of(static_cast<int>(layout_->kept_blocks.size()), shares, k);
    for (int b = blocks.begin; b < blocks.end; ++b) {
      const KeptBlock& block = layout_->kept_blocks[static_cast<std::size_t>(b)];
      kept.set(block.i, block.j, matrix.entries().data() + block.from, block.stride);
    }
  });
  for (int first = 0; first < pieces(); first += pieces_at_once) {
    const int count = std::min(pieces_at_once, pieces() - first);
    const auto piece = [&](int k) -> const Piece& {
      return layout_->pieces[static_cast<std::size_t>(first + k)];
    };
    std::array<char, pieces_at_once> done{};
    for_each_chunk(workers, count, [&](int k) {
      gather(piece(k), matrix);
      done[k] = eliminate(piece(k), products_.data() + piece(k).product) ? 1 : 0;
    });
    if (std::find(done.begin(), done.begin() + count, 0) != done.begin() + count)
      return FactorStatus::not_positive_definite;
    for_each_chunk(workers, shares, [&](int share) {
      for (int k = 0; k < count; ++k)
        kept.subtract(piece(k).outer, products_.data() + piece(k).product, share, shares);
    });
  }
  return FactorStatus::ok;
}

bool Condensation::eliminate(const Piece& piece, double* product) {
  return piece.single ? eliminate_single(piece, product) : eliminate_coupled(piece, product);
}

bool Condensation::eliminate_coupled(const Piece& piece, double* to) {
  Block factor(values_.data() + piece.factor, piece.rows(), piece.rows());
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(factor);
  if (in_place.info() != Eigen::Success) return false;
  if (piece.outer.empty()) return true;
  Block coupling(values_.data() + piece.coupling, piece.rows(), piece.meets());
  in_place.matrixL().solveInPlace(coupling);
  Block product(to, piece.meets(), piece.meets());
  product.setZero();
  product.selfadjointView<Eigen::Lower>().rankUpdate(coupling.transpose());
  return true;
}

bool Condensation::eliminate_single(const Piece& piece, double* to) {
  Block coupling(values_.data() + piece.coupling, piece.meets(), piece.rows());
  for (Eigen::Index i = 0; i < piece.rows(); i += 3) {
    Eigen::Map<Mat3> factor(values_.data() + piece.factor + 3 * i);
    const Eigen::LLT<Mat3> found(factor);
    if (found.info() != Eigen::Success) return false;
    factor = found.matrixLLT();
    const Mat3& l = found.matrixLLT();
    coupling.col(i) /= l(0, 0);
    coupling.col(i + 1) = (coupling.col(i + 1) - l(1, 0) * coupling.col(i)) / l(1, 1);
    coupling.col(i + 2) =
        (coupling.col(i + 2) - l(2, 0) * coupling.col(i) - l(2, 1) * coupling.col(i + 1)) / l(2, 2);
  }
  Block product(to, piece.meets(), piece.meets());
  product.setZero();
  product.selfadjointView<Eigen::Lower>().rankUpdate(coupling);
  return true;
}

template <class Columns>
void Condensation::solve_lower(const Piece& piece, Columns& x) const {
  const double* factor = values_.data() + piece.factor;
  if (!piece.single)
    return ConstBlock(factor, piece.rows(), piece.rows()).triangularView<Eigen::Lower>().solveInPlace(x);
  for (Eigen::Index i = 0; i < piece.rows(); i += 3) {
    auto here = x.template middleRows<3>(i);
    Eigen::Map<const Mat3>(factor + 3 * i).triangularView<Eigen::Lower>().solveInPlace(here);
  }
}

template <class Columns>
void Condensation::solve_upper(const Piece& piece, Columns& x) const {
  const double* factor = values_.data() + piece.factor;
  if (!piece.single) {
    const ConstBlock l(factor, piece.rows(), piece.rows());
    return l.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  }
  for (Eigen::Index i = 0; i < piece.rows(); i += 3) {
    const Eigen::Map<const Mat3> l(factor + 3 * i);
    auto here = x.template middleRows<3>(i);
    l.transpose().triangularView<Eigen::Upper>().solveInPlace(here);
  }
}

template <class Columns>
Columns Condensation::reduce(const Columns& right) const {
  Columns out, inner;
  pick(right, layout_->kept, out);
  for (const Piece& piece : layout_->pieces) {
    if (piece.outer.empty()) continue;
    pick(right, piece.inner, inner);
    solve_lower(piece, inner);
    pass_on(piece, inner, out);
  }
  return out;
}

Eigen::MatrixXd Condensation::reduce_units(std::span<const int> nodes, Eigen::MatrixXd& gram) const {
  const auto columns = 3 * static_cast<Eigen::Index>(nodes.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(layout_->kept.size()), columns);
  const auto in = [](int node, const std::vector<int>& some) {
    return std::binary_search(some.begin(), some.end(), node);
  };
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (in(nodes[i], layout_->kept))
      out.block<3, 3>(place_of(nodes[i], layout_->kept), 3 * static_cast<Eigen::Index>(i)).setIdentity();
  for (const Piece& piece : layout_->pieces) {
    if (std::none_of(nodes.begin(), nodes.end(), [&](int node) { return in(node, piece.inner); })) continue;
    Eigen::MatrixXd inner = Eigen::MatrixXd::Zero(piece.rows(), columns);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (in(nodes[i], piece.inner))
        inner.block<3, 3>(place_of(nodes[i], piece.inner), 3 * static_cast<Eigen::Index>(i)).setIdentity();
    solve_lower(piece, inner);
    gram.noalias() += inner.transpose() * inner;
    pass_on(piece, inner, out);
  }
  return out;
}

template <class Columns>
void Condensation::pass_on(const Piece& piece, const Columns& inner, Columns& kept) const {
  if (piece.outer.empty()) return;
  Columns passed;
  const double* coupling = values_.data() + piece.coupling;
  if (piece.single)
    passed.noalias() = ConstBlock(coupling, piece.meets(), piece.rows()) * inner;
  else
    passed.noalias() = ConstBlock(coupling, piece.rows(), piece.meets()).transpose() * inner;
  for (std::size_t i = 0; i < piece.outer.size(); ++i)
    kept.template middleRows<3>(3 * Eigen::Index{piece.outer[i]}) -=
        passed.template middleRows<3>(3 * static_cast<Eigen::Index>(i));
}

template <class Columns>
Columns Condensation::expand(const Columns& right, const Columns& kept) const {
  Columns out(right.rows(), right.cols()), inner, outer, passed;
  put(kept, layout_->kept, out);
  for (const Piece& piece : layout_->pieces) {
    pick(right, piece.inner, inner);
    solve_lower(piece, inner);
    if (!piece.outer.empty()) {
      pick(kept, piece.outer, outer);
      const double* coupling = values_.data() + piece.coupling;
      if (piece.single)
        passed.noalias() = ConstBlock(coupling, piece.meets(), piece.rows()).transpose() * outer;
      else
        passed.noalias() = ConstBlock(coupling, piece.rows(), piece.meets()) * outer;
      inner -= passed;
    }
    solve_upper(piece, inner);
    put(inner, piece.inner, out);
  }
  return out;
}

template VecX Condensation::reduce(const VecX&) const;
template VecX Condensation::expand(const VecX&, const VecX&) const;
template Eigen::MatrixXd Condensation::reduce(const Eigen::MatrixXd&) const;
template Eigen::MatrixXd Condensation::expand(const Eigen::MatrixXd&, const Eigen::MatrixXd&) const;

double Condensation::flops() const {
  double sum = 0;
  for (const Piece& piece : layout_->pieces) {
    const double inner = static_cast<double>(piece.rows()), outer = static_cast<double>(piece.meets()),
                 coupled = piece.single ? 3 : inner;
    sum += inner * coupled * coupled / 3 + inner * coupled * outer + inner * outer * outer;
  }
  return sum;
}

long Condensation::nonzeros() const {
  long sum = 0;
  for (const Piece& piece : layout_->pieces)
    sum += piece.rows() * ((piece.single ? 3 : piece.rows()) + 1) / 2 + piece.rows() * piece.meets();
  return sum;
}

double Condensation::pivot(const Piece& piece, Eigen::Index i) const {
  return values_[piece.factor + (piece.single ? 3 * i + i % 3 : i * piece.rows() + i)];
}

double Condensation::smallest_pivot() const {
  double out = std::numeric_limits<double>::infinity();
  for (const Piece& piece : layout_->pieces)
    for (Eigen::Index i = 0; i < piece.rows(); ++i) out = std::min(out, pivot(piece, i));
  return out;
}
double Condensation::largest_pivot() const {
  double out = 0;
  for (const Piece& piece : layout_->pieces)
    for (Eigen::Index i = 0; i < piece.rows(); ++i) out = std::max(out, pivot(piece, i));
  return out;
}

}  // namespace calot
