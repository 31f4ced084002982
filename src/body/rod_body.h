#pragma once
// A duct or a vessel as a body: a rod on its centreline, touched as the tube around it and drawn as one.

#include <optional>

#include "body/body.h"
#include "body/tube_pinch.h"
#include "fem/centreline.h"
#include "fem/links.h"
#include "fem/ring.h"
#include "fem/rod.h"
#include "geometry/tube.h"

namespace calot {

struct BodyPiece;

class RodBody : public Body {
 public:
  /// An elastic foundation around a place on it.
  struct HeldPart {
    double share = 0;      ///< of the way, 0 to 1
    double radius = 0;     ///< m, of what is held
    double stiffness = 0;  ///< N/m per m^2 of skin
  };
  struct Setup {
    std::string name = "duct";
    std::vector<Vec3> points;                ///< m, the centreline at rest, from its start to its end
    double radius = 2.5e-3, end_radius = 0;  ///< m, outer, at both ends; 0: as at the start
    double wall = 0.8e-3;                    ///< m; as thick as the radius: a solid thread
    double shear_modulus = 100e3;            ///< Pa, of an incompressible wall: a third of Young's modulus
    double pressure = 0;                     ///< Pa, gauge, of what it carries
    double density = 0, liquid_density = 0;  ///< kg/m^3, of the wall and of what fills it
    int nodes = 11;
    Vec3 up = Vec3::UnitZ();
    std::vector<HeldPart> held;
    /// m, outer, one at each point and straight in between by the way along them; empty: from radius to end_radius.
    std::vector<double> radii = {};
    std::map<std::string, double> landmarks = {};  ///< share of the way from its first skin point to its last
  };
  using Pinch = TubePinch;
  /// Fails (scenario) where the line cannot be one.
  static Result<RodBody> create(const Setup& setup);

  /// Its part between two of its skin points, first < last: the same curve with the same sections, bed and skin points
  /// there.
  Result<RodBody> part(int first, int last) const;
  /// The same without one of the places that it is held at: of Setup::held, by its place there.
  RodBody without_held(std::size_t which) const;
  /// The same held flat at these places and at no others: there it does not give way to what presses, and is drawn
  /// flat.
  RodBody pinched(const std::vector<Pinch>& pinches) const;
  const std::vector<Pinch>& pinches() const { return pinches_; }
  /// Columns: along the line, the skin's normal there, and across both. `at`: skin points from its start.
  Mat3 frame_at(double at, const VecX& x) const;
  Vec3 place_at(double at, const VecX& x) const;  ///< m, on the line
  /// Of the tube as it is at rest where nothing pinches it.
  double outer_radius(double at) const;
  double lumen_radius(double at) const {  ///< m, 0 where it is solid
    return std::max(0.0, outer_radius(at) - setup_.wall);
  }
  /// m, of its section where it is pressed flat.
  double flat_width(double at) const {
    const FlatRing ring = ring_at(at);
    return 2 * (ring.lumen > 0 ? ring.half_width(ring.lumen) : ring.outer);
  }
  /// m, half of what its section is high, outside, where so much of its lumen's height is left open.
  double flat_half_height(double at, double opening) const {
    const FlatRing ring = ring_at(at);
    return ring.half_height((1 - opening) * ring.lumen);
  }
  double share_at(double at) const;     ///< of its length at rest
  double at_share(double share) const;  ///< the other way round
  /// Of its skin points that which lies nearest to a share of the length at rest and can be divided at: at a knot, or
  /// far enough from one to leave no span that would hold the solver up. None but at its ends: -1.
  int point_to_divide_at(double share) const;
  /// Where a skin point lies, as a share of the length at rest.
  double share_of_length(int point) const;
  /// Its end, skin points from its start; whether a place is on it.
  double last_point() const { return static_cast<double>(skin_rest_.size() - 1); }
  bool has(double at) const { return at >= 0 && at <= last_point(); }
  /// Along it at rest from its start to a place, m.
  double way_to(double at) const;
  std::optional<bool> bedded() const override { return !bed_.row.empty(); }
  std::map<std::string, int> landmarks() const override;
  /// Its skin points lie a mm apart. Fails (scenario) where a piece would be shorter than it is thick.
  Result<std::optional<BodyCut>> divide(double share) const override;
  std::shared_ptr<const Body> called(const std::string& name) const override;
  OrganShape shape_of_piece(const OrganShape& whole) const override;
  const RodBody* as_tube() const override { return this; }

  const std::string& name() const override { return setup_.name; }
  const VecX& rest() const override { return rest_; }
  double size() const override { return size_; }
  const std::vector<double>& edge_lengths() const override { return edge_lengths_; }
  const BlockMatrix& pattern() const override { return constant_; }

  double value(const VecX& x) const override;
  void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const override;
  void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const override;
  const VecX& kept_load() const override { return weight_; }
  const BlockMatrix* mass() const override { return mass_ ? &*mass_ : nullptr; }
  double strain_energy(const VecX& x) const override { return rod_.value(x, setup_.pressure); }
  double max_stretch(const VecX& x) const override;

  const Tessellation& skin() const override { return skin_; }
  const std::vector<double>& skin_radii() const override { return radii_; }
  const std::vector<double>& core_radii() const override { return core_radii_; }
  const std::vector<double>& skin_areas() const override { return skin_areas_; }
  /// Four of each triangle, eight a segment: a twelfth of it apart, as both its triangles are counted.
  std::span<const int> contact_points(bool /*broad*/) const override { return felt_points; }
  double contact_area(int point) const override;
  BarrierSample contact_sample(int point, double distance, const Barrier& barrier) const override;
  const std::vector<Vec3>& skin_rest() const override { return skin_rest_; }
  const std::vector<std::vector<int>>& face_nodes() const override { return face_nodes_; }
  std::vector<Vec3> skin_normals(const VecX& x) const override;

  const std::vector<Triangle>& drawn_triangles() const override { return tube_->triangles(); }
  const std::vector<Vec3>& drawn_rest() const override { return drawn_rest_; }
  std::vector<Vec3> drawn_positions(const VecX& x) const override { return drawn(x).positions; }
  DrawnSurface drawn(const VecX& x) const override;

  const Rod& rod() const { return rod_; }
  const Setup& setup() const { return setup_; }
  double length() const { return length_; }  ///< m, at rest
  /// kg that a row of the rod's quadrature stands for, with what fills it.
  double row_mass(int row) const;

 private:
  /// Of the rule's points those whose weights of the first corner are 11/12, 8/12, 5/12 and 2/12.
  static constexpr std::array<int, 4> felt_points = {0, 4, 8, 12};
  RodBody(const Setup& setup, Centreline line) : setup_(setup), line_(std::move(line)) {}
  /// All that follows from setup, line and rest line.
  Result<bool> build();
  Result<bool> lay_rod();
  void choose_skin_points();
  void lay_skin();
  void lay_sections();
  void lay_bed();
  void weigh();
  FlatRing ring_of(double radius) const;  ///< of lumen 0 where it is solid
  FlatRing ring_at(double at) const;
  void hold_flat(const Pinch& pinch);
  /// Of those that a cut at a skin point leaves.
  std::optional<Failure> check_pieces(int cut) const;
  Result<BodyPiece> piece(int first, int last) const;
  /// At a share of the whole line, by its parameter.
  double radius_along(double share) const;

  Setup setup_;
  Centreline line_;
  std::array<double, 2> part_{0, 1};   ///< of the whole, by parameter: what of it is left
  std::vector<Vec3> held_at_;          ///< m, middles of what is held
  std::vector<double> radius_shares_;  ///< of the whole: where setup's radii are, increasing
  /// Where the skin points are on the line, and as shares of the whole.
  std::vector<double> skin_parameters_, skin_shares_;
  Rod rod_;
  VecX rest_, weight_;
  double size_ = 0, length_ = 0;
  double least_force_ = 0;  ///< N
  double least_edge_ = 0;   ///< m, of the whole: a short span at a cut holds no step up
  std::vector<double> edge_lengths_;
  BlockMatrix constant_{0, {}};
  std::optional<BlockMatrix> mass_;
  std::vector<double> shares_;  ///< of the way, at the rows of the rod's quadrature
  Links bed_;                   ///< rows of the rod's quadrature
  Tessellation skin_;
  std::vector<double> radii_, core_radii_, skin_areas_;
  std::vector<double> segment_areas_;  ///< m^2, that press, one a segment between two skin points
  std::vector<FlatRing> rings_;        ///< of each segment
  std::vector<Pinch> pinches_;
  std::vector<Vec3> skin_rest_, drawn_rest_;
  std::vector<std::vector<int>> face_nodes_;
  std::optional<TubeMesh> tube_;
};

}  // namespace calot
