#pragma once
// Thin shell whose finite elements are the faces of a subdivision surface (Cirak, Ortiz and Schroeder 2000,
// doi 10.1002/(SICI)1097-0207(20000430)47:12<2039::AID-NME872>3.0.CO;2-1): membrane energy from the first
// fundamental form, Koiter bending from the second. It knows stencils only: linear triangles, Loop faces and
// refined faces differ in nothing else.

#include <optional>
#include <span>
#include <vector>

#include "base/status.h"
#include "fem/assembly.h"
#include "fem/membrane_material.h"
#include "fem/shell_point.h"

namespace calot {

/// Two equal families of fibres in the middle surface, at `angle` to either side of the axis' projection p
/// into the rest tangent plane (0: along the axis, pi / 2: around it). Where the axis meets the surface at
/// right angles, at the poles, there is no such direction: the fibres' energy is scaled by |p|^2 (1 where the
/// axis lies in the surface, 0 at the poles), which makes |p|^2 m m', and so the wall, smooth there.
struct FibreLayout {
  FibreFamily family;
  double angle = 0;           ///< rad
  Vec3 axis = Vec3::UnitZ();  ///< world at rest, of any length but 0
};

struct ShellMaterial {
  Demiray membrane;
  KoiterBending bending;  ///< of the isotropic wall at rest: fibres and stiffening do not take part
  bool bends = true;
  std::optional<FibreLayout> fibres = {};
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

/// Where a surface's energy is sampled. Rows of one element follow each other, elements count from 0.
struct Quadrature {
  StencilTable stencils;        ///< a row a point, derivatives to order 2 (order 1 without bending)
  std::vector<int> element;     ///< of each row
  std::vector<double> weights;  ///< parametric area of each row, in the parameters of its derivatives

  int elements() const { return element.empty() ? 0 : element.back() + 1; }
};

/// `table` has the rule's points of face 0, then of face 1, ...
Quadrature face_by_face(StencilTable table, const std::vector<QuadraturePoint>& rule);

class Shell {
 public:
  /// `rest` are 3 * nodes coordinates, m. Fails (scenario) where the rest surface is degenerate, where an
  /// element depends on too many nodes, and when fibres have no axis. Rows of an element that stands in `known`, a shell
  /// of the same material and rest, under other numbers may be taken from there: known_rows[r] is r's row there, for
  /// all rows of the element; -1 where it is not.
  static Result<Shell> create(const Quadrature& quadrature, const VecX& rest, const ShellMaterial& material,
                              const Shell* known = nullptr, std::span<const int> known_rows = {});

  /// Wall energy, J; infinite where the surface is degenerate.
  double value(const VecX& x) const;
  /// Adds the gradient (N) to `gradient`, 3 * nodes.
  void add_gradient(const VecX& x, VecX& gradient) const;
  /// Adds the exact Hessian (N/m); with an assembly by its threads, to the same bits.
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly = nullptr) const;

  std::vector<double> point_areas() const;  ///< rest area of each row of the table, m^2
  /// Largest principal stretch over the quadrature points.
  double max_stretch(const VecX& x) const;
  /// Nodes of each element: the cliques of the matrix pattern.
  std::vector<std::vector<int>> cliques() const;

 private:
  /// Weights of one node for the derivatives du, dv, duu, duv, dvv at four points.
  struct NodeWeights {
    Lanes row[5];
  };
  /// Up to four points of one element. Lanes that are not used repeat the last point and have no area.
  struct Points {
    int face = 0;
    int used = 0;
    int first = 0;            ///< number of its first point
    std::size_t weights = 0;  ///< offset in weights_: one for each of the face's nodes
    Lanes area = {};          ///< rest area, m^2
    Lanes rest_inverse[3], rest_curvature[3], rest_determinant;
    LanesForm bending = {};
  };
  /// The fibres at a point: their families' directions and |p|^2.
  struct Fibres {
    SurfaceTensor directions[2];
    double share = 0;
  };
  /// The points from `row` on of `known`, which become those from points.first on.
  void take_over(const Shell& known, int row, Points& points);
  void lay_weights(const Quadrature& quadrature, int row, Points& points);
  /// False where the rest surface is degenerate.
  bool lay_points(const VecX& rest, const std::vector<double>& weights, Points& points);
  void lay_fibres(const ShellPoint& at, const Points& points, int lane);
  ShellPoint local(const Points& points, const VecX& x) const;
  double membrane_energy(const Points& points, int lane, const SurfaceTensor& metric) const;
  MembraneSample membrane(const Points& points, int lane, const SurfaceTensor& metric) const;
  ShellStress stress(const Points& points, const ShellPoint& at) const;
  template <bool Bends>
  void add_gradient(const Points& points, const VecX& x, VecX& gradient) const;
  template <bool Bends>
  void add_hessian(const Points& points, const VecX& x, ElementMatrix& element) const;
  void face_hessian(std::size_t face, const VecX& x, ElementMatrix& element) const;

  ShellMaterial material_;
  std::vector<FaceNodes> faces_;
  std::vector<Points> points_;
  std::vector<std::size_t> first_points_;  ///< of each face, and their number
  std::vector<Fibres> fibres_;             ///< of each point; none without
  std::vector<NodeWeights> weights_;
};

}  // namespace calot
