#include "skin/subdivision.h"

#include <fmt/format.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>

#include "skin/tessellate.h"

namespace calot {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

using Refiner = std::unique_ptr<Far::TopologyRefiner>;
using Stencils = std::unique_ptr<const Far::StencilTableReal<double>>;
using Patches = std::unique_ptr<const Far::PatchTable>;

/// Each level halves the cap around an extraordinary node that is not the exact limit surface. At six the
/// cap ends 1/64 of an edge from the node, well inside any quadrature point; the tests hold it against
/// explicit subdivision.
constexpr int kIsolationLevel = 6;

/// Nodes of a boundary in fewer than three triangles.
std::vector<Far::Index> sharp_corners(const TriMesh& control) {
  std::map<std::pair<int, int>, int> edges;
  std::vector<int> triangles(control.points.size(), 0);
  for (const Triangle& t : control.triangles) {
    for (int k = 0; k < 3; ++k) {
      ++edges[std::minmax(t[k], t[(k + 1) % 3])];
      ++triangles[t[k]];
    }
  }
  std::set<Far::Index> corners;
  for (const auto& [edge, count] : edges) {
    for (int node : {edge.first, edge.second})
      if (count == 1 && triangles[node] < 3) corners.insert(node);
  }
  return {corners.begin(), corners.end()};
}

Refiner refine(const TriMesh& control) {
  std::vector<int> sizes(control.triangles.size(), 3), corners;
  corners.reserve(3 * control.triangles.size());
  for (const Triangle& t : control.triangles) corners.insert(corners.end(), t.begin(), t.end());
  Far::TopologyDescriptor topology;
  topology.numVertices = static_cast<int>(control.points.size());
  topology.numFaces = static_cast<int>(control.triangles.size());
  topology.numVertsPerFace = sizes.data();
  topology.vertIndicesPerFace = corners.data();
  const std::vector<Far::Index> sharp = sharp_corners(control);
  const std::vector<float> infinite(sharp.size(), Sdc::Crease::SHARPNESS_INFINITE);
  topology.numCorners = static_cast<int>(sharp.size());
  topology.cornerVertexIndices = sharp.data();
  topology.cornerWeights = infinite.data();
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  Refiner refiner(Factory::Create(topology, Factory::Options(Sdc::SCHEME_LOOP, options)));
  Far::TopologyRefiner::AdaptiveOptions adaptive(kIsolationLevel);
  adaptive.useInfSharpPatch = true;
  if (refiner) refiner->RefineAdaptive(adaptive);
  return refiner;
}

Patches patches_of(const Far::TopologyRefiner& refiner) {
  Far::PatchTableFactory::Options options(kIsolationLevel);
  options.SetEndCapType(Far::PatchTableFactory::Options::ENDCAP_GREGORY_BASIS);
  options.useInfSharpPatch = true;
  options.SetPatchPrecision<double>();
  return Patches(Far::PatchTableFactory::Create(refiner, options));
}

/// Stencils of the refined points and of the patches' local points, both over the control points.
Stencils control_stencils(const Far::TopologyRefiner& refiner, const Far::PatchTable& patches) {
  using Factory = Far::StencilTableFactoryReal<double>;
  Factory::Options options;
  options.generateOffsets = true;
  options.generateControlVerts = true;
  options.generateIntermediateLevels = true;
  options.factorizeIntermediateLevels = true;
  Stencils refined(Factory::Create(refiner, options));
  const auto* local = patches.GetLocalPointStencilTable<double>();
  if (!local || local->GetNumStencils() == 0) return refined;
  return Stencils(Factory::AppendLocalPointStencilTable(refiner, refined.get(), local));
}

/// One row at a time: sums over the nodes, kept apart by derivative.
class RowWriter {
 public:
  RowWriter(StencilTable& table, int order, int nodes)
      : table_(table),
        columns_(order == 0   ? 1
                 : order == 1 ? 3
                              : 6),
        sums_(nodes),
        touched_(nodes, false) {}

  /// Adds the columns' weights of a patch's point, itself a stencil of nodes.
  void add(std::span<const int> nodes, std::span<const double> share, const double* weights) {
    for (std::size_t e = 0; e < nodes.size(); ++e) {
      if (!touched_[nodes[e]]) used_.push_back(nodes[e]);
      touched_[nodes[e]] = true;
      for (int k = 0; k < columns_; ++k) sums_[nodes[e]][k] += share[e] * weights[k];
    }
  }

  /// Ends the row: nodes increasing, entries dropped that are zero throughout.
  void finish() {
    std::sort(used_.begin(), used_.end());
    for (int node : used_) flush(node);
    used_.clear();
    table_.begin.push_back(static_cast<int>(table_.node.size()));
  }

 private:
  void flush(int node) {
    std::vector<double>* const to[6] = {&table_.value, &table_.du,  &table_.dv,
                                        &table_.duu,   &table_.duv, &table_.dvv};
    std::array<double, 6>& sum = sums_[node];
    if (std::any_of(sum.begin(), sum.end(), [](double w) { return w != 0; })) {
      table_.node.push_back(node);
      for (int k = 0; k < columns_; ++k) to[k]->push_back(sum[k]);
    }
    sum.fill(0.0);
    touched_[node] = false;
  }

  StencilTable& table_;
  int columns_;
  std::vector<std::array<double, 6>> sums_;
  std::vector<bool> touched_;
  std::vector<int> used_;
};

/// Most points that a patch blends: 12 of a regular one, 18 of an end cap.
constexpr int patch_points = 20;

/// Weights of a patch's points: position, du, dv, duu, duv, dvv.
struct PatchBasis {
  double by_column[6][patch_points];

  void evaluate(const Far::PatchTable& patches, const Far::PatchTable::PatchHandle& patch, double u, double v,
                int order) {
    double* first = order >= 1 ? by_column[1] : nullptr;
    double* second = order >= 2 ? by_column[3] : nullptr;
    patches.EvaluateBasis(patch, u, v, by_column[0], first, first ? by_column[2] : nullptr, second,
                          second ? by_column[4] : nullptr, second ? by_column[5] : nullptr);
    // OpenSubdiv 3.5 turns the sign of second derivatives in triangles that refinement leaves upside down (it
    // scales by the sign as well as by the square of the size). They are turned back here.
    if (order < 2 || !patches.GetPatchParam(patch).IsTriangleRotated()) return;
    for (int k = 3; k < 6; ++k)
      for (double& w : by_column[k]) w = -w;
  }
};

}  // namespace

struct LoopSurface::Impl {
  int nodes = 0;
  std::vector<Triangle> triangles;
  Refiner refiner;
  Patches patches;
  Stencils stencils;
  std::unique_ptr<const Far::PatchMap> map;
};

LoopSurface::LoopSurface(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
LoopSurface::LoopSurface(LoopSurface&&) noexcept = default;
LoopSurface& LoopSurface::operator=(LoopSurface&&) noexcept = default;
LoopSurface::~LoopSurface() = default;

Result<LoopSurface> LoopSurface::create(const TriMesh& control) {
  auto impl = std::make_unique<Impl>();
  impl->nodes = static_cast<int>(control.points.size());
  impl->triangles = control.triangles;
  impl->refiner = refine(control);
  if (!impl->refiner) {
    return fail(FailureKind::scenario, "the control mesh has no subdivision surface",
                "check() names the triangles that are wrong");
  }
  impl->patches = patches_of(*impl->refiner);
  impl->stencils = control_stencils(*impl->refiner, *impl->patches);
  impl->map = std::make_unique<const Far::PatchMap>(*impl->patches);
  return LoopSurface(std::move(impl));
}

int LoopSurface::nodes() const { return impl_->nodes; }
int LoopSurface::faces() const { return static_cast<int>(impl_->triangles.size()); }

StencilTable LoopSurface::evaluate(std::span<const FacePoint> points, int order) const {
  StencilTable table;
  RowWriter writer(table, order, impl_->nodes);
  PatchBasis basis{};
  for (const FacePoint& at : points) {
    const auto* patch = impl_->map->FindPatch(at.face, at.u, at.v);
    if (!patch) std::abort();
    basis.evaluate(*impl_->patches, *patch, at.u, at.v, order);
    const Far::ConstIndexArray corners = impl_->patches->GetPatchVertices(*patch);
    for (int c = 0; c < corners.size(); ++c) {
      double weights[6];
      for (int k = 0; k < 6; ++k) weights[k] = basis.by_column[k][c];
      const int start = impl_->stencils->GetOffsets()[corners[c]];
      const int size = impl_->stencils->GetSizes()[corners[c]];
      writer.add(std::span(impl_->stencils->GetControlIndices()).subspan(start, size),
                 std::span(impl_->stencils->GetWeights()).subspan(start, size), weights);
    }
    writer.finish();
  }
  return table;
}

Tessellation LoopSurface::tessellate(int parts) const {
  Tessellation result = split_faces(impl_->nodes, impl_->triangles, parts);
  result.stencils = evaluate(result.at, 1);
  return result;
}

Result<std::vector<Vec3>> fit_to_limit(const LoopSurface& surface, std::span<const Vec3> targets) {
  const int n = surface.nodes();
  if (static_cast<int>(targets.size()) != n)
    return fail(FailureKind::usage, fmt::format("{} targets for {} control points", targets.size(), n));
  const StencilTable rows = surface.tessellate(1).stencils;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX3d right(n, 3);
  for (int r = 0; r < n; ++r) {
    right.row(r) = targets[r].transpose();
    for (int e = rows.begin[r]; e < rows.begin[r + 1]; ++e)
      entries.emplace_back(r, rows.node[e], rows.value[e]);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> factor(matrix);
  const Eigen::MatrixX3d solution = factor.info() == Eigen::Success ? Eigen::MatrixX3d(factor.solve(right))
                                                                    : Eigen::MatrixX3d::Constant(n, 3, NAN);
  if (!solution.allFinite()) {
    return fail(FailureKind::scenario, "no control net has its limit surface through the given points",
                "the points must be finite and the mesh must pass check()");
  }
  std::vector<Vec3> points(n);
  for (int i = 0; i < n; ++i) points[i] = solution.row(i).transpose();
  return points;
}

}  // namespace calot
