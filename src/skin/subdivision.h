#pragma once
// The Loop subdivision surface of a control mesh (Loop 1987), evaluated through OpenSubdiv in double
// precision.

#include <memory>
#include <span>

#include "geometry/stencil.h"
#include "geometry/tri_mesh.h"

namespace calot {

/// Immutable after creation; knows the connectivity only, never positions: the weights do not depend on them.
class LoopSurface {
 public:
  /// `control` must pass check(); boundaries (open sheets) interpolate their edge curve and corners are
  /// sharp.
  static Result<LoopSurface> create(const TriMesh& control);
  LoopSurface(LoopSurface&&) noexcept;
  LoopSurface& operator=(LoopSurface&&) noexcept;
  ~LoopSurface();

  int nodes() const;
  int faces() const;

  /// Limit stencils at `points`, a row each, with derivatives by the face's (u, v) up to `order` 0, 1 or 2.
  /// Exact to rounding, but within 1/64 of an edge from an extraordinary node (not six triangles inside,
  /// three on an edge): there positions are within 1e-3 of an edge, exact at the node, and derivatives give
  /// the normal only. A point that is on no face ends the process.
  StencilTable evaluate(std::span<const FacePoint> points, int order) const;

  /// Each face split into parts^2 triangles whose corners lie on the limit surface.
  Tessellation tessellate(int parts) const;

 private:
  struct Impl;
  explicit LoopSurface(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Control points whose limit surface passes through `targets` (one a vertex, m): solves the sparse system of
/// vertex limit stencils.
Result<std::vector<Vec3>> fit_to_limit(const LoopSurface& surface, std::span<const Vec3> targets);

}  // namespace calot
