#pragma once
// What the shell's energy is made of at four quadrature points at once: forms of the surface and their derivatives by
// du, dv, duu, duv, dvv, the five vectors that a point's stencil gives.

#include "fem/element_layout.h"
#include "fem/lanes.h"

namespace calot {

/// The surface at four points: derivatives d[0..4], first and second form and unit normal.
struct ShellPoint {
  Lanes3 d[5];
  Lanes metric[3], curvature[3];  ///< (11, 12, 22)
  Lanes3 normal;
  Lanes jacobian = {};

  void finish();
  /// Gradient by (d0, d1) of w . n, w constant.
  void normal_gradient(const Lanes3& w, Lanes3& by_u, Lanes3& by_v) const;
};

/// A symmetric 3 x 3 form over surface tensors: entries 11, 12, 13, 22, 23, 33.
struct LanesForm {
  Lanes at[6];
  Lanes times(const Lanes* v, int row) const;
};

/// First and second derivatives of the membrane's energy by the metric, and D (b - B) and D of bending, all a unit
/// parametric area.
struct ShellStress {
  Lanes membrane[3];
  LanesForm membrane_stiffness;
  Lanes moment[3] = {};
  LanesForm bending_stiffness = {};
};

/// Gradient by the five derivatives; without bending by the first two.
template <bool Bends>
void shell_gradient(const ShellPoint& at, const ShellStress& stress, Lanes3* by);

/// Second derivatives by component pairs (see component_pairs): at[pair][k][l] by component c of derivative k and
/// component d of derivative l.
struct ShellHessian {
  Lanes at[6][5][5];
};
template <bool Bends>
void shell_hessian(const ShellPoint& at, const ShellStress& stress, ShellHessian& out);

}  // namespace calot
