#pragma once
// One organ: the shell on its subdivision surface, its bile, its bed, and the skin that is drawn and touched
// (the paper's virtual structure, section 5). Everything here is fixed once built; what moves is in
// BodyState.

#include <functional>
#include <optional>

#include "anatomy/definitions.h"
#include "fem/bile.h"
#include "fem/links.h"
#include "fem/shell.h"
#include "geometry/tri_mesh.h"
#include "numerics/newton.h"

namespace calot {

/// The skin (drawn and touched) is split so that its points stand this close at rest, m: a jaw's edge, 0.8 mm
/// round, then finds a point wherever it presses.
inline constexpr double skin_spacing = 1.0e-3;

struct BodyState {
  VecX x;                 ///< control nodes, 3 each, m
  double multiplier = 0;  ///< pressure at the datum's height, Pa
  double volume = 0;      ///< m^3, what the constraint keeps
};

class VirtualStructure {
 public:
  /// From a control mesh whose limit surface is the unstressed shape (m, world).
  struct Setup {
    std::string name = "organ";
    TriMesh control;
    ShellMaterial material;
    std::optional<BileDefinition> bile;  ///< closed surfaces only
    Vec3 up = Vec3::UnitZ();
    /// Elastic foundation at a quadrature point at rest position x, N/m per m^2 (0: none).
    std::function<double(const Vec3& x)> foundation;
    std::vector<QuadraturePoint> rule = three_point_rule();
  };
  static Result<VirtualStructure> create(const Setup& setup);

  const std::string& name() const { return name_; }
  int nodes() const { return static_cast<int>(rest_.size()) / 3; }
  const VecX& rest() const { return rest_; }
  const TriMesh& control() const { return control_; }
  const Shell& shell() const { return shell_; }
  const std::optional<Bile>& bile() const { return bile_; }
  const Tessellation& skin() const { return skin_; }
  /// Rest area that each skin point stands for, m^2.
  const std::vector<double>& skin_areas() const { return skin_areas_; }
  const std::vector<Vec3>& skin_rest() const { return skin_rest_; }
  /// Longest edge of the skin's triangles at rest, m.
  double widest_skin_gap() const;
  /// Shortest control edge at each node at rest, m: the scale of a safe step there.
  const std::vector<double>& edge_lengths() const { return edge_lengths_; }
  double size() const { return size_; }  ///< m, diagonal of the rest shape's box

  /// Skin points of one control face (each point belongs to one face) and the nodes they depend on. As the
  /// weights are not negative the points lie in the box of these nodes, whatever the state.
  struct SkinFace {
    std::vector<int> rows, nodes;
  };
  const std::vector<SkinFace>& skin_faces() const { return skin_faces_; }

  /// Empty matrix with this structure's pattern; and the constant part of its Hessian (the bed).
  BlockMatrix pattern() const;
  const std::vector<double>& constant_hessian() const { return constant_hessian_; }

  const Links& foundation() const { return foundation_; }
  const StencilTable& quadrature() const { return quadrature_; }

  std::vector<Vec3> skin_positions(const VecX& x) const;  ///< m
  Vec3 skin_point(int row, const VecX& x) const {
    return blend(skin_.stencils, skin_.stencils.value, row, x);
  }
  std::vector<Vec3> skin_normals(const VecX& x) const;  ///< unit, outward

 private:
  std::string name_;
  TriMesh control_;
  VecX rest_;
  Shell shell_;
  std::optional<Bile> bile_;
  Tessellation skin_;
  std::vector<Vec3> skin_rest_;
  std::vector<double> skin_areas_, edge_lengths_, constant_hessian_;
  StencilTable quadrature_;
  Links foundation_;
  std::vector<std::vector<int>> cliques_;
  std::vector<SkinFace> skin_faces_;
  double size_ = 0;
};

}  // namespace calot
