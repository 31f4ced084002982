#pragma once
// A body of the group: its nodes, its energies, perhaps a liquid, and the skin that is touched and drawn. Everything
// here is fixed once built; what moves is in BodyState. Coordinates x are the body's own: 3 a node, m.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "anatomy/definitions.h"
#include "body/contact_points.h"
#include "collision/barrier.h"
#include "fem/liquid_mass.h"
#include "geometry/stencil.h"
#include "numerics/block_matrix.h"

namespace calot {

class Assembly;
class RodBody;
class ShellBody;
class SolidBody;
struct BodyCut;

/// How freely a detail moves (detail_fading.h).
struct DetailShare {
  double share = 1;      ///< 0: held at rest, 1: free
  bool leaving = false;  ///< its share falls
  bool operator==(const DetailShare&) const = default;
};
void visit_members(auto&& visit, MembersOf<DetailShare> auto& detail) {
  auto& [share, leaving] = detail;
  visit(share, leaving);
}

/// The part of a motion that a body has come to the end of, or is being brought to: a step of implicit Euler
/// (inertia.h).
struct MotionPart {
  LiquidMotion begin;   ///< places and velocities
  double duration = 0;  ///< s; 0: none has begun, or the field is static
  /// The liquid's flow at the beginning, made of that; null without a liquid.
  std::shared_ptr<const FlowModes> flow = {};
};
void visit_members(auto&& visit, MembersOf<MotionPart> auto& part) {
  auto& [begin, duration, flow] = part;  // the flow follows from where the body began
  visit(begin, duration);
}

struct BodyState {
  VecX x;                     ///< 3 a node, m: places of the control nodes, then displacements of the details
  double datum_pressure = 0;  ///< pressure at the datum's height, Pa
  double volume = 0;          ///< m^3, what the constraint keeps
  std::vector<DetailShare> shares = {};  ///< one a detail; none: all are free
  /// N, 3 a node: what a change of the details altered and is still made good; empty: nothing.
  VecX fading_load = {};
  MotionPart motion = {};  ///< that ends here
};
void visit_members(auto&& visit, MembersOf<BodyState> auto& state) {
  auto& [x, datum_pressure, volume, shares, fading_load, motion] = state;
  visit(x, datum_pressure, volume, shares, fading_load, motion);
}

/// What a closed body is filled with: its weight, and a volume that is kept.
class Liquid {
 public:
  virtual ~Liquid() = default;
  /// Enclosed volume, m^3.
  virtual double volume(const VecX& x) const = 0;
  /// The same, its gradient (m^2) added to `gradient`.
  virtual double add_volume_gradient(const VecX& x, VecX& gradient) const = 0;
  /// The same with the load of the liquid's weight added to `load`.
  virtual double add_weight_and_volume_gradient(const VecX& x, VecX& load, VecX& gradient) const = 0;
  /// Potential energy of the weight, J.
  virtual double weight_value(const VecX& x) const = 0;
  /// Adds the gradient of weight - datum_pressure * volume, N.
  virtual void add_load(const VecX& x, double datum_pressure, VecX& gradient) const = 0;
  /// Adds its Hessian, N/m; `assembly` as below.
  virtual void add_hessian(const VecX& x, double datum_pressure, BlockMatrix& matrix,
                           Assembly* assembly) const = 0;
  /// The same with a weight (N/m^3, the way it pulls) beside its own.
  virtual void add_hessian(const VecX& x, double datum_pressure, const Vec3& weight, BlockMatrix& matrix,
                           Assembly* assembly) const = 0;
  /// Of `kept` m^3 that it keeps, for a part of h seconds that begins so; the liquid must outlive it.
  virtual LiquidMass mass(const FlowModes& flow, double kept, const LiquidMotion& begin, double h) const = 0;
  /// Its centroid, m, from a point of its own.
  virtual Vec3 centroid(const VecX& x, double kept) const = 0;
  /// Gauge pressure at a place (m), and at the surface's highest point, Pa.
  virtual double pressure_at(const Vec3& place, double datum_pressure) const = 0;
  virtual double pressure_at_top(const VecX& x, double datum_pressure) const = 0;
};

/// One a point of what is drawn.
struct DrawnSurface {
  std::vector<Vec3> positions;  ///< m
  std::vector<Vec3> normals;    ///< unit
};

/// Longest edge of triangles, m.
double widest_gap(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles);

/// What a kind of body has to say of itself is what is pure here: its rest, its energy with derivatives, its skin. All
/// else it may: a mass where it moves in time, a liquid, radii that make a line of its skin, details; landmarks, how it
/// is divided, whether teeth sink into it and a bed holds it. No other room has to know a new kind (organs/body_kinds.h).
class Body {
 public:
  virtual ~Body() = default;

  virtual const std::string& name() const = 0;
  virtual const VecX& rest() const = 0;
  int nodes() const { return static_cast<int>(rest().size()) / 3; }
  /// The first nodes, which are places; the others are the details, displacements added to them.
  virtual int coarse_nodes() const { return nodes(); }
  /// The first nodes, onto which the others are condensed (numerics/condense.h).
  virtual int kept_nodes() const { return coarse_nodes(); }
  /// Whether its nodes are weights that nothing of its own couples: joins then bring each into balance by itself.
  virtual bool has_loose_nodes() const { return false; }
  virtual double size() const = 0;  ///< m, diagonal of the rest shape's box
  /// Shortest control edge at each node at rest (halved with each level for a detail), m: the scale of a safe step
  /// there.
  virtual const std::vector<double>& edge_lengths() const = 0;
  /// A matrix with this body's pattern that holds the constant part of its Hessian.
  virtual const BlockMatrix& pattern() const = 0;

  /// Energy of the body and of what it lies bedded in, J; not finite where x is not admissible.
  virtual double value(const VecX& x) const = 0;
  /// Adds the gradient, N, to zero; `largest_internal` receives the largest nodal force of the body itself, or of its
  /// weight where it may float or fall unstrained: the scale of its residual.
  virtual void add_gradient(const VecX& x, VecX& gradient, double& largest_internal) const = 0;
  /// Adds the Hessian but for its constant part, N/m. `assembly`: by several threads, to the same bits, where it pays;
  /// null: by this one.
  virtual void add_hessian(const VecX& x, BlockMatrix& matrix, Assembly* assembly) const = 0;
  /// A constant load, N, 3 a node, on top of that; empty: none.
  virtual const VecX& kept_load() const;
  /// Of the solid: kg, by the nodes, with the pattern of pattern(). Null: it is weightless.
  virtual const BlockMatrix* mass() const { return nullptr; }
  /// Null: it is not filled.
  virtual const Liquid* liquid() const { return nullptr; }
  /// How the liquid flows when the nodes are at x. Fails (simulation) where the surface is too coarse to tell.
  virtual Result<FlowModes> flow(const VecX& x) const {
    return FlowModes::inside(skin().stencils, skin().triangles, x, 0.5 * size());
  }
  /// Energy of the deformed body alone, J, and the largest principal stretch in it: for reports.
  virtual double strain_energy(const VecX& x) const = 0;
  virtual double max_stretch(const VecX& x) const = 0;
  /// Whether straight steps strain it where it turns: then nothing of it is asked ahead along them, as retardation is. curved() then is such a step from x to where it turns to, the same to
  /// first order.
  virtual bool turns_as_a_whole() const { return false; }
  virtual VecX curved(const VecX& /*x*/, const VecX& step) const { return step; }

  /// What is touched, by triangles; see skin_radii().
  virtual const Tessellation& skin() const = 0;
  /// Radius of the surface around each skin point, m. A rod has its skin points on its centreline, so its triangles are flat
  /// as lines and its surface lies this far from them. Empty: the skin itself is the surface.
  virtual const std::vector<double>& skin_radii() const;
  /// Whether its skin is a line with a radius about it.
  bool is_line() const { return !skin_radii().empty(); }
  /// The largest of them, 0 without any.
  double thickest() const;
  /// Of the surface around a contact point, m.
  double radius_at_contact(int point) const;
  /// As skin_radii(), of what no trial of a solver may reach (contact_search.h, contact_guard below the shapes).
  virtual const std::vector<double>& core_radii() const;
  /// How deep a shape may be in the surface before a trial reaches what it may not, at least, m.
  double core_depth() const;
  /// Rest area that each skin point stands for, m^2.
  virtual const std::vector<double>& skin_areas() const = 0;
  /// Which of a triangle's points (contact_points.h) are felt, increasing: by instruments, or by what is `broad` beside a
  /// triangle, such as the ground, where few do as well.
  virtual std::span<const int> contact_points(bool broad) const;
  /// Rest area that one of these stands for, m^2.
  virtual double contact_area(int point) const = 0;
  /// What it answers, a unit of that area, to a shape at this distance from its surface, m.
  virtual BarrierSample contact_sample(int /*point*/, double distance, const Barrier& barrier) const {
    return barrier.sample(distance);
  }
  virtual const std::vector<Vec3>& skin_rest() const = 0;
  /// Into how many parts the edges of each patch are split evenly (split_faces in skin/tessellate.h); 1: they are not.
  virtual int skin_parts() const { return 1; }
  /// Longest edge of the skin's triangles at rest, m.
  double widest_skin_gap() const { return widest_gap(skin_rest(), skin().triangles); }
  /// Nodes that each patch of skin depends on. As the weights are not negative it lies in the box of the coarse ones
  /// among them, widened by half of each detail's length, whatever the state.
  virtual const std::vector<std::vector<int>>& face_nodes() const = 0;
  /// That box of some nodes, `wider` (m) on all sides.
  Eigen::AlignedBox3d box_of(std::span<const int> nodes, const VecX& x, double wider = 0) const;
  /// How far the skin may be outside that box, m.
  virtual double beyond_nodes() const { return 0; }
  /// Triangles of each patch, which follow each other: those of the first patch first.
  int triangles_each() const { return static_cast<int>(skin().triangles.size() / face_nodes().size()); }
  /// Bound on how far any surface point moves when the nodes move by `dx`, m.
  virtual double largest_motion(const VecX& dx) const;
  std::vector<Vec3> skin_positions(const VecX& x) const;  ///< m
  Vec3 skin_point(int row, const VecX& x) const {
    return blend(skin().stencils, skin().stencils.value, row, x);
  }
  virtual std::vector<Vec3> skin_normals(const VecX& x) const = 0;  ///< unit, outward
  /// Of places where it is at rest, m.
  std::map<std::string, int> nearest_points(const std::map<std::string, Vec3>& places) const;
  /// Where the surface is at a skin point, along its normal there.
  Vec3 surface_point(int row, const VecX& x) const;
  /// Where a landmark at a skin point is, m: on the surface, but a rigid thing's is its centre.
  virtual Vec3 landmark_place(int row, const VecX& x) const { return surface_point(row, x); }

  /// What is drawn: the skin, or what is around it.
  virtual const std::vector<Triangle>& drawn_triangles() const { return skin().triangles; }
  virtual const std::vector<Vec3>& drawn_rest() const { return skin_rest(); }
  /// Its positions alone, which take half of the time.
  virtual std::vector<Vec3> drawn_positions(const VecX& x) const { return skin_positions(x); }
  virtual DrawnSurface drawn(const VecX& x) const { return {drawn_positions(x), skin_normals(x)}; }

  /// Nodes of finer levels that are active, increasing, and how many levels have some.
  virtual const std::vector<int>& details() const;
  virtual int levels_used() const { return 0; }
  /// Of a detail, by its place among details().
  virtual int level_of_detail(int /*index*/) const { return 0; }
  /// Levels that it can be refined by.
  virtual int most_levels() const { return 0; }

  /// Skin points of its landmarks.
  virtual std::map<std::string, int> landmarks() const { return {}; }
  /// The two that it becomes, divided at about a share of its length from its start; none: its kind cannot be divided.
  /// Fails (scenario) where it could be, but not there.
  virtual Result<std::optional<BodyCut>> divide(double share) const;
  /// A piece under another name; null: it keeps the whole's.
  virtual std::shared_ptr<const Body> called(const std::string& /*name*/) const { return nullptr; }
  /// The shape that a piece's definition has, where the whole's has this.
  virtual OrganShape shape_of_piece(const OrganShape& whole) const { return whole; }
  /// Whether teeth sink into it; they rub on what is hard.
  virtual bool is_bitten() const { return true; }
  /// Whether a bed holds any of it; none: that is as its definition says.
  virtual std::optional<bool> bedded() const { return std::nullopt; }
  /// The body as the one kind that has a lumen and takes clips, or that details refine; null: it is of another kind.
  virtual const RodBody* as_tube() const { return nullptr; }
  virtual const ShellBody* as_shell() const { return nullptr; }
  virtual const SolidBody* as_solid() const { return nullptr; }
};

using BodyPointer = std::shared_ptr<const Body>;

}  // namespace calot
