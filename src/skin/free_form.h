#pragma once
// Free-form deformation by direct manipulation (Hsu, Hughes and Kaufman 1992, doi 10.1145/142920.134036): a small
// lattice moves the space in a box, and the lattice's own motion follows from points that are to be moved.
//
//   u(x) = sum_i w_i(x) d_i,   w_i a product of uniform cubic B-splines in the box's three directions,
//
// with as many functions in a direction as fit into it whole. So u, its first and its second derivatives vanish on
// the box's faces and outside, and a surface that runs through a face stays smooth. With n functions across a box of
// half extent h each reaches 4 h / (n + 3) to either side of its middle. Cost: 64 terms to move a point. To fit
// N = n_x n_y n_z functions: N^3 / 3 operations, which is why the lattice is kept small: 400 functions take some
// milliseconds.

#include <array>
#include <vector>

#include "base/status.h"
#include "geometry/types.h"

namespace calot {

class FreeForm {
 public:
  struct Lattice {
    Pose frame = Pose::Identity();      ///< rigid, box to world; its origin is the box's middle
    Vec3 half = Vec3::Ones();           ///< m, half extents, > 0
    std::array<int, 3> nodes{5, 5, 5};  ///< functions in each direction, >= 1
  };
  /// Moves nothing until it is manipulated.
  explicit FreeForm(const Lattice& lattice);

  /// Brings `points` near `targets` (m, world, as many): the lattice displacement of least |miss|^2 + damping^2
  /// |lattice displacement|^2, `damping` > 0 (dimensionless, against weights below 1). It follows its targets
  /// continuously where points come together. The largest miss, m. Fails (internal) for lists of unequal length,
  /// values that are not finite, and a damping too small for the normal equations.
  Result<double> manipulate(const std::vector<Vec3>& points, const std::vector<Vec3>& targets,
                            double damping);

  bool contains(const Vec3& x) const;
  Vec3 displacement(const Vec3& x) const;  ///< m, world
  Mat3 gradient(const Vec3& x) const;      ///< of the displacement by x: J - I
  /// Unit normal at the moved point of a surface with unit normal n at x, where the surface is moved by `share` of
  /// the displacement: by J^-T. Needs det J > 0.
  Vec3 moved_normal(const Vec3& x, const Vec3& n, double share = 1) const;

  /// w_i(x), first direction fastest.
  VecX weights(const Vec3& x) const;
  /// d_i, m, world: a row a function.
  const Eigen::MatrixX3d& nodes() const { return nodes_; }
  void set_nodes(const Eigen::MatrixX3d& nodes) { nodes_ = nodes; }

 private:
  /// The functions that reach a point in one direction: the first one's index, values, slopes (1/m).
  struct Reach {
    int first = 0;
    std::array<double, 4> value{}, slope{};
  };
  Reach reach(int axis, double at) const;

  Lattice lattice_;
  Pose to_box_;
  Eigen::MatrixX3d nodes_;
};

}  // namespace calot
