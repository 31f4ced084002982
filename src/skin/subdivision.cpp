#include "skin/subdivision.h"

#include <fmt/format.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include <Eigen/SparseCore>
#include <Eigen/SparseLU>
#include <algorithm>
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
using LimitFactory = Far::LimitStencilTableFactoryReal<double>;
using LimitTable = Far::LimitStencilTableReal<double>;

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

/// The points as the factory wants them: runs that share a face, in the order asked for.
struct Locations {
  std::vector<double> u, v;
  LimitFactory::LocationArrayVec runs;

  explicit Locations(std::span<const FacePoint> points) : u(points.size()), v(points.size()) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      u[i] = points[i].u;
      v[i] = points[i].v;
      if (i == 0 || points[i].face != points[i - 1].face) {
        LimitFactory::LocationArray run;
        run.ptexIdx = points[i].face;
        run.s = &u[i];
        run.t = &v[i];
        runs.push_back(run);
      }
      ++runs.back().numLocations;
    }
  }
};

/// Appends one row, with duplicate nodes merged, nodes increasing and entries dropped that are zero
/// throughout.
class RowWriter {
 public:
  RowWriter(StencilTable& table, std::vector<const std::vector<double>*> from,
            std::vector<std::vector<double>*> to, int nodes)
      : table_(table),
        from_(std::move(from)),
        to_(std::move(to)),
        sums_(nodes * from_.size(), 0.0),
        touched_(nodes, false) {}

  void append(const int* nodes, int offset, int size) {
    used_.clear();
    for (int e = 0; e < size; ++e) {
      if (!touched_[nodes[e]]) used_.push_back(nodes[e]);
      touched_[nodes[e]] = true;
      for (std::size_t k = 0; k < from_.size(); ++k)
        sums_[nodes[e] * from_.size() + k] += (*from_[k])[offset + e];
    }
    std::sort(used_.begin(), used_.end());
    for (int node : used_) flush(node);
    table_.begin.push_back(static_cast<int>(table_.node.size()));
  }

 private:
  void flush(int node) {
    const auto first = sums_.begin() + static_cast<std::ptrdiff_t>(node * from_.size());
    const auto last = first + static_cast<std::ptrdiff_t>(from_.size());
    if (std::any_of(first, last, [](double w) { return w != 0; })) {
      table_.node.push_back(node);
      for (std::size_t k = 0; k < to_.size(); ++k)
        to_[k]->push_back(*(first + static_cast<std::ptrdiff_t>(k)));
    }
    std::fill(first, last, 0.0);
    touched_[node] = false;
  }

  StencilTable& table_;
  std::vector<const std::vector<double>*> from_;
  std::vector<std::vector<double>*> to_;
  std::vector<double> sums_;
  std::vector<bool> touched_;
  std::vector<int> used_;
};

/// OpenSubdiv 3.5 turns the sign of second derivatives in triangles that refinement leaves upside down (it
/// scales by the sign as well as by the square of the size). Their rows are turned back here.
void turn_back(StencilTable& table, std::span<const FacePoint> points, const Far::PatchTable& patches,
               const Far::PatchMap& map) {
  for (int r = 0; r < table.rows(); ++r) {
    const auto* patch = map.FindPatch(points[r].face, points[r].u, points[r].v);
    if (!patches.GetPatchParam(*patch).IsTriangleRotated()) continue;
    for (auto* weights : {&table.duu, &table.duv, &table.dvv})
      for (int e = table.begin[r]; e < table.begin[r + 1]; ++e) (*weights)[e] = -(*weights)[e];
  }
}

StencilTable copy_rows(const LimitTable& limit, int order, int nodes) {
  StencilTable table;
  std::vector<const std::vector<double>*> from = {&limit.GetWeights()};
  std::vector<std::vector<double>*> to = {&table.value};
  if (order >= 1) {
    from.insert(from.end(), {&limit.GetDuWeights(), &limit.GetDvWeights()});
    to.insert(to.end(), {&table.du, &table.dv});
  }
  if (order >= 2) {
    from.insert(from.end(), {&limit.GetDuuWeights(), &limit.GetDuvWeights(), &limit.GetDvvWeights()});
    to.insert(to.end(), {&table.duu, &table.duv, &table.dvv});
  }
  RowWriter writer(table, std::move(from), std::move(to), nodes);
  int offset = 0;
  for (int size : limit.GetSizes()) {
    writer.append(limit.GetControlIndices().data() + offset, offset, size);
    offset += size;
  }
  return table;
}

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
  if (points.empty()) return {};
  const Locations locations(points);
  LimitFactory::Options options;
  options.generate1stDerivatives = order >= 1;
  options.generate2ndDerivatives = order >= 2;
  const std::unique_ptr<const LimitTable> limit(LimitFactory::Create(
      *impl_->refiner, locations.runs, impl_->stencils.get(), impl_->patches.get(), options));
  if (!limit || limit->GetNumStencils() != static_cast<int>(points.size())) std::abort();
  StencilTable table = copy_rows(*limit, order, impl_->nodes);
  if (order >= 2) turn_back(table, points, *impl_->patches, *impl_->map);
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
