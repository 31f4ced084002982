#pragma once
// The bile inside a closed surface: enclosed volume and the weight of the liquid, both over one closed
// triangulation of the limit surface, so that net load and torque are exact (the paper, section 4: the
// highest point and the specific weight; cost linear in triangles).

#include "base/status.h"
#include "fem/element_layout.h"

namespace calot {

class Assembly;

/// Closed triangulations of one surface, summed with weights. Inscribed triangulations lose volume with the square
/// of their edges, so 4/3 of one with four triangles a face less 1/3 of the one with the faces' corners is a
/// fourth-order rule (Richardson's extrapolation), and as a sum of closed surfaces still exactly balanced: 0.05%
/// of the volume is lost where four triangles a face lose 2%.
struct BileSurface {
  struct Part {
    Triangle corners;   ///< rows of `points`, outward
    double weight = 1;  ///< parts of one weight form a closed surface
  };
  StencilTable points;                   ///< positions only
  std::vector<std::vector<Part>> cells;  ///< parts that share points, at most 28 different ones a cell
};

/// What a m^3 of a liquid weighs: `size`, N/m^3, against the unit vector `up`.
struct LiquidWeight {
  double size = 0;
  Vec3 up = Vec3::UnitZ();

  /// From its vector, N/m^3, the way it pulls: density (g - a) in a liquid that is accelerated by a.
  static LiquidWeight pulling(const Vec3& weight) {
    const double size = weight.norm();
    return size > 0 ? LiquidWeight{size, -weight / size} : LiquidWeight{};
  }
  Vec3 vector() const { return -size * up; }
};

/// What a liquid holds, by coordinates counted from the datum.
struct LiquidMoments {
  double volume = 0;          ///< m^3
  Vec3 first = Vec3::Zero();  ///< integral of the position over the volume, m^4
};

/// The weight is that of the liquid at rest where none is given. Minus the scalar product of a vector and the first
/// moment has the value, load and Hessian of a weight of that vector, without pressure.
class Bile {
 public:
  /// `specific_weight` in N/m^3; `up` is unit; heights count from `datum` (m, a point; near the organ keeps
  /// rounding small). Fails (scenario) where a cell depends on too many nodes.
  static Result<Bile> create(const BileSurface& surface, double specific_weight, const Vec3& up,
                             const Vec3& datum);

  /// Enclosed volume, m^3.
  double volume(const VecX& x) const;
  /// Volume, and its gradient (m^2) added to `gradient`.
  double add_volume_gradient(const VecX& x, VecX& gradient) const;
  /// Potential energy of the liquid's weight, J, relative to the datum's height.
  double value(const VecX& x) const { return value(x, weight_); }
  double value(const VecX& x, const LiquidWeight& weight) const;
  /// Adds the gradient of weight - datum_pressure * volume (N): the load of pressure datum_pressure - weight *
  /// height.
  void add_load(const VecX& x, double datum_pressure, VecX& gradient) const {
    add_load(x, datum_pressure, weight_, gradient);
  }
  void add_load(const VecX& x, double datum_pressure, const LiquidWeight& weight, VecX& gradient) const;
  /// Both: add_load to `load`, add_volume_gradient to `by_volume`, for little more than one.
  double add_load_and_volume_gradient(const VecX& x, double datum_pressure, VecX& load,
                                      VecX& by_volume) const {
    return add_load_and_volume_gradient(x, datum_pressure, weight_, load, by_volume);
  }
  double add_load_and_volume_gradient(const VecX& x, double datum_pressure, const LiquidWeight& weight,
                                      VecX& load, VecX& by_volume) const;
  /// Adds the exact Hessian of weight - datum_pressure * volume (N/m).
  /// By several threads where there is an `assembly`, to the same bits.
  void add_hessian(const VecX& x, double datum_pressure, BlockMatrix& matrix,
                   Assembly* assembly = nullptr) const {
    add_hessian(x, datum_pressure, weight_, matrix, assembly);
  }
  void add_hessian(const VecX& x, double datum_pressure, const LiquidWeight& weight, BlockMatrix& matrix,
                   Assembly* assembly = nullptr) const;

  LiquidMoments moments(const VecX& x) const;
  /// The first moment's gradients, m^3: a column each for its x, y and z, 3 rows a node.
  Eigen::MatrixX3d moment_gradients(const VecX& x) const;

  /// Gauge pressure (Pa) at `position` when the datum_pressure is given: datum_pressure - specific weight * height.
  double pressure_at(const Vec3& position, double datum_pressure) const;
  double pressure_at(const Vec3& position, double datum_pressure, const LiquidWeight& weight) const;
  /// Gauge pressure at the surface's highest point.
  double pressure_at_top(const VecX& x, double datum_pressure) const;

  /// A triangle of the sum.
  struct Part {
    Triangle corners;  ///< rows of the surface's points
    int local[3];      ///< the corners among their cell's points
    double weight;
  };
  const std::vector<Part>& parts() const { return parts_; }

  const StencilTable& points() const { return points_; }
  const Vec3& datum() const { return datum_; }
  double specific_weight() const { return weight_.size; }
  const LiquidWeight& weight() const { return weight_; }
  std::vector<std::vector<int>> cliques() const;

 private:
  /// `at`: the surface's points.
  void cell_hessian(std::size_t cell, const std::vector<Vec3>& at, double datum_pressure,
                    const LiquidWeight& weight, ElementMatrix& element) const;
  std::vector<Vec3> positions(const VecX& x) const;
  struct Triangles;
  struct TriangleDerivatives;
  Triangles triangles(int first, int used, const std::vector<Vec3>& at) const;
  /// Forces on the surface's points.
  struct PointForces {
    std::vector<Vec3> load, by_volume;
    double volume = 0;
  };
  PointForces point_forces(const VecX& x, double datum_pressure, const LiquidWeight& weight) const;
  /// Adds the parts of a cell; returns its points.
  std::vector<int> add_parts(const std::vector<BileSurface::Part>& parts);
  struct CellHessian;
  void assemble(std::size_t cell, const std::vector<Vec3>& at, double datum_pressure,
                const LiquidWeight& weight, CellHessian& h) const;

  StencilTable points_;
  LiquidWeight weight_;
  Vec3 datum_ = Vec3::Zero();
  struct Cell {
    int points = 0;      ///< rows of weights
    int first_part = 0;  ///< in parts_, up to that of the next cell
    int weights = 0;     ///< offset in weights_ of the rows of padded weights
  };
  std::vector<Cell> cells_;
  std::vector<FaceNodes> cell_nodes_;  ///< of each
  std::vector<Part> parts_;
  std::vector<double> weights_;
};

}  // namespace calot
