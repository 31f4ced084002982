#include "fem/kept_reduction.h"

#include <algorithm>

#include "base/digest.h"
#include "geometry/matrix_bytes.h"

namespace calot {
namespace {

// Structs are taken apart by all of their members: one that gets another member is an error here until that is named.

void add_piece(const FramedSolid::Piece& piece, ByteWriter& out) {
  const auto& [nodes, slopes, turning] = piece;
  out.add(std::span<const int>(nodes));
  add_matrix(slopes, out);
  out.add(turning);
}

void add_stiffness(const FramedSolid::Stiffness& stiffness, ByteWriter& out) {
  const auto& [one, other, block] = stiffness;
  out.add(one);
  out.add(other);
  add_matrix(block, out);
}

FramedSolid::Piece piece_of(ByteReader& in, int nodes) {
  FramedSolid::Piece out;
  out.nodes = in.numbers<int>();
  const Eigen::MatrixXd slopes = matrix_of(in);
  out.turning = in.number<double>();
  const bool known =
      std::all_of(out.nodes.begin(), out.nodes.end(), [&](int node) { return node >= 0 && node < nodes; });
  if (known && slopes.rows() == 3 && slopes.cols() == static_cast<Eigen::Index>(out.nodes.size()))
    out.slopes = slopes;
  else
    in.refuse();
  return out;
}

FramedSolid::Stiffness stiffness_of(ByteReader& in, const std::vector<FramedSolid::Piece>& pieces) {
  FramedSolid::Stiffness out;
  out.one = in.number<int>();
  out.other = in.number<int>();
  out.block = matrix_of(in);
  const auto fits = [&](int piece, Eigen::Index size) {
    return piece >= 0 && piece < static_cast<int>(pieces.size()) &&
           size == 3 * pieces[static_cast<std::size_t>(piece)].slopes.cols();
  };
  if (!fits(out.one, out.block.rows()) || !fits(out.other, out.block.cols())) in.refuse();
  return out;
}

Eigen::MatrixXd matrix_of_size(ByteReader& in, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd out = matrix_of(in);
  if (out.rows() == rows && out.cols() == columns) return out;
  in.refuse();
  return Eigen::MatrixXd::Zero(rows, columns);
}

}  // namespace

std::string reduction_key(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid) {
  const auto& [tets, rows, averaged, piece_of, nodes] = mesh;
  const auto& [begin, node, value, du, dv, duu, duv, dvv] = rows;
  const auto& [young, poisson] = solid;
  Digest digest;
  digest.add(std::string_view("solid reduction"));
  digest.add(tets.size());
  for (const QuadraticTet& tet : tets) digest.add(std::span<const int>(tet));
  digest.add(std::span<const int>(begin));
  digest.add(std::span<const int>(node));
  for (const std::vector<double>* weights : {&value, &du, &dv, &duu, &duv, &dvv})
    digest.add(std::span<const double>(*weights));
  digest.add(std::span<const char>(averaged));
  digest.add(std::span<const int>(piece_of));
  digest.add(nodes);
  digest.add(std::span<const double>(rest.data(), static_cast<std::size_t>(rest.size())));
  digest.add(young);
  digest.add(poisson);
  return digest.hex();
}

std::string to_bytes(const ReducedSolid& reduced) {
  const auto& [parts, mass, mode_inertia, mode_stiffness, mode_coupling] = reduced;
  const auto& [pieces, stiffness] = parts;
  ByteWriter out;
  out.add(pieces.size());
  for (const FramedSolid::Piece& piece : pieces) add_piece(piece, out);
  out.add(stiffness.size());
  for (const FramedSolid::Stiffness& each : stiffness) add_stiffness(each, out);
  add_matrix(mass, out);
  add_matrix(mode_inertia, out);
  add_matrix(mode_stiffness, out);
  add_matrix(mode_coupling, out);
  return out.bytes();
}

std::optional<ReducedSolid> reduced_solid_of(std::string_view bytes, int nodes) {
  constexpr std::size_t counts = sizeof(std::size_t);
  ByteReader in(bytes);
  ReducedSolid out;
  auto& [pieces, stiffness] = out.parts;
  for (std::size_t left = in.counted(counts); left > 0; --left) pieces.push_back(piece_of(in, nodes));
  for (std::size_t left = in.counted(counts); left > 0; --left) stiffness.push_back(stiffness_of(in, pieces));
  const Eigen::Index ways = 3 * Eigen::Index{nodes};
  out.mass = matrix_of_size(in, ways, ways);
  out.mode_inertia = matrix_of_size(in, inner_modes, 1);
  out.mode_stiffness = matrix_of_size(in, inner_modes, 1);
  out.mode_coupling = matrix_of_size(in, ways, inner_modes);
  if (!in.complete()) return std::nullopt;
  return out;
}

Result<ReducedSolid> kept_or_reduced(const SolidMesh& mesh, const VecX& rest, const ElasticSolid& solid,
                                     KeptResults* kept) {
  if (kept == nullptr) return reduce(mesh, rest, solid);
  const std::string key = reduction_key(mesh, rest, solid);
  if (const std::optional<std::string> bytes = kept->find(key))
    if (std::optional<ReducedSolid> reduced = reduced_solid_of(*bytes, mesh.nodes))
      return std::move(*reduced);
  Result<ReducedSolid> reduced = reduce(mesh, rest, solid);
  if (reduced) kept->keep(key, to_bytes(reduced.value()));
  return reduced;
}

}  // namespace calot
