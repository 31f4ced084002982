#pragma once
// Thin shell whose finite elements are the faces of a subdivision surface (Cirak, Ortiz and Schroeder 2000,
// doi 10.1002/(SICI)1097-0207(20000430)47:12<2039::AID-NME872>3.0.CO;2-1): membrane energy from the first
// fundamental form, Koiter bending from the second. It knows stencils only: linear triangles, Loop faces and
// refined faces differ in nothing else.

#include <vector>

#include "base/status.h"
#include "fem/element_layout.h"
#include "fem/membrane_material.h"

namespace calot {

struct ShellMaterial {
  NeoHookean membrane;
  KoiterBending bending;
  bool bends = true;
};

/// A point of a quadrature rule on the triangle (0,0), (1,0), (0,1).
struct QuadraturePoint {
  double u = 0, v = 0;
  double weight = 0;  ///< weights sum to 1/2, the triangle's parametric area
};

/// Three points, exact to degree 2 (Strang and Fix).
std::vector<QuadraturePoint> three_point_rule();
/// Six points, exact to degree 4 (Dunavant 1985).
std::vector<QuadraturePoint> six_point_rule();

class Shell {
 public:
  /// `table` has the rule's points of face 0, then of face 1, ..., with derivatives to order 2 (order 1 is
  /// enough without bending); `rest` are 3 * nodes coordinates, m. Fails (scenario) where the rest surface is
  /// degenerate.
  static Result<Shell> create(const StencilTable& table, const std::vector<QuadraturePoint>& rule,
                              const VecX& rest, const ShellMaterial& material);

  /// Wall energy, J; infinite where the surface is degenerate.
  double value(const VecX& x) const;
  /// Adds the gradient (N) to `gradient`, 3 * nodes.
  void add_gradient(const VecX& x, VecX& gradient) const;
  /// Adds the exact Hessian (N/m).
  void add_hessian(const VecX& x, BlockMatrix& matrix) const;

  double rest_area() const;                 ///< m^2
  std::vector<double> point_areas() const;  ///< rest area of each row of the table, m^2
  /// Largest principal stretch over the quadrature points.
  double max_stretch(const VecX& x) const;
  /// Nodes of each face: the cliques of the matrix pattern.
  std::vector<std::vector<int>> cliques() const;

 private:
  struct Point {
    int face = 0;
    int weights = 0;  ///< offset in weights_: 5 rows (du, dv, duu, duv, dvv) of padded length
    double area = 0;  ///< rest area of the point, m^2
    SurfaceTensor rest_inverse = Vec3::Zero(), rest_curvature = Vec3::Zero();
    double rest_determinant = 1;
    Mat3 bending = Mat3::Zero();
  };
  struct Local;
  Local local(const Point& point, const VecX& x) const;

  ShellMaterial material_;
  std::vector<FaceNodes> faces_;
  std::vector<Point> points_;
  std::vector<double> weights_;
};

}  // namespace calot
