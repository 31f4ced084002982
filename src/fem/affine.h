#pragma once
// A rigid body as an affine one, x = A X + t, held to a rotation by its energy (Lan et al. 2022, "Affine body dynamics",
// ACM Trans. Graph. 41(4):67, doi 10.1145/3528223.3530064): rotations need no unknowns of their own kind.
//
// Its unknowns are four nodes, a tetrahedron of the body's points, so each of its points is a fixed weighted sum of
// them: a stencil row, as any skin point's. The nodes are those four points of equal mass that have the body's
// centroid and second moments: the consistent mass matrix is then the diagonal one, a quarter of the mass each, and
// weight and inertia act on the nodes alone.
//
// Energy kappa V |A'A - I|^2 (Frobenius): to first order 4 kappa V |strain|^2, as of a material with Young's modulus
// 8 kappa that does not thin when it is stretched.

#include <span>

#include "base/status.h"
#include "geometry/solid_moments.h"
#include "geometry/stencil.h"

namespace calot {

class AffineBody {
 public:
  static constexpr int nodes = 4;
  static constexpr double young_over_kappa = 8;
  using Coordinates = Eigen::Matrix<double, 12, 1>;  ///< x, y, z of node 0, then of node 1, ..., m
  using Hessian = Eigen::Matrix<double, 12, 12>;

  /// Pa. Two opposite forces F across a body of width w and volume V strain it by F w / (8 kappa V): 10 N on a ball of
  /// 10 mm, of 10 mm across, 2.4e-5; on a clip of 10 mm x 1 mm x 1 mm 1.3e-4. A hundred thousand times stiffer than
  /// tissue, which leaves the solver ten digits.
  static constexpr double default_stiffness = 1e9;

  /// Fails (scenario) where the solid has no volume or is flat, and where the stiffness is not above zero.
  static Result<AffineBody> create(const SolidMoments& solid, double stiffness = default_stiffness);

  /// The nodes of the body as it was made, and moved.
  const std::array<Vec3, nodes>& rest() const { return rest_; }
  Coordinates placed(const Pose& motion = Pose::Identity()) const;
  double volume() const { return volume_; }

  /// Of the nodes, of a point of the body as it was made; they sum to 1. Points outside are carried along as well.
  std::array<double, nodes> weights(const Vec3& point) const;
  /// A row for each such point, of the nodes `first` to first + 3; positions only.
  StencilTable stencils(std::span<const Vec3> points, int first = 0) const;

  /// J; zero in every rigid motion and in its mirror images.
  double value(const Coordinates& x) const;
  struct Sample {
    double energy = 0;     ///< J
    Coordinates gradient;  ///< N
    Hessian hessian;       ///< N/m, symmetric; indefinite where the body is squeezed
  };
  Sample sample(const Coordinates& x) const;

  /// kg, the same for x, y and z: of a solid (in the body's own frame as it was made) that moves with the body. The
  /// body's own is a quarter of its mass on the diagonal.
  Eigen::Matrix4d mass(const SolidMoments& solid, double density) const;

  /// A step from x to where it leads if what of it turns the body is followed along a circle, and its strain and shift as they
  /// are: the same to first order, without the strain of a straight way.
  Coordinates curved(const Coordinates& x, const Coordinates& step) const;

  /// The rotation and shift of the nodes as they were made that come nearest to x, by the body's mass.
  Pose pose(const Coordinates& x) const;
  /// The largest strain, to first order: half the largest eigenvalue of A'A - I in size.
  double distortion(const Coordinates& x) const;

 private:
  Mat3 deformation(const Coordinates& x) const;  ///< A

  std::array<Vec3, nodes> rest_;
  Vec3 centroid_ = Vec3::Zero();
  Eigen::Matrix<double, 3, nodes> slopes_;  ///< of the weights by the point, 1/m
  double volume_ = 0, stiffness_ = 0;
};

}  // namespace calot
