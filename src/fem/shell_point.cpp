#include "fem/shell_point.h"

#include <cmath>

namespace calot {

void ShellPoint::finish() {
  metric[0] = dot(d[0], d[0]), metric[1] = dot(d[0], d[1]), metric[2] = dot(d[1], d[1]);
  const Lanes3 m = cross(d[0], d[1]);
  const Lanes squared = dot(m, m);
  for (int lane = 0; lane < lane_count; ++lane) jacobian[lane] = std::sqrt(squared[lane]);
  normal = (1.0 / jacobian) * m;
  for (int k = 0; k < 3; ++k) curvature[k] = dot(d[2 + k], normal);
}

void ShellPoint::normal_gradient(const Lanes3& w, Lanes3& by_u, Lanes3& by_v) const {
  const Lanes3 g = (1.0 / jacobian) * (w - dot(w, normal) * normal);
  by_u = cross(d[1], g);
  by_v = cross(g, d[0]);
}

Lanes LanesForm::times(const Lanes* v, int row) const {
  constexpr int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  return at[place[row][0]] * v[0] + at[place[row][1]] * v[1] + at[place[row][2]] * v[2];
}

namespace {

/// Sum of moment_k d_(2 + k), whose product with the normal is varied.
Lanes3 bent(const ShellPoint& at, const Lanes* moment) {
  return moment[0] * at.d[2] + moment[1] * at.d[3] + moment[2] * at.d[4];
}

/// A coupling of two derivatives: [c][d].
struct Block {
  Lanes at[3][3] = {};

  void add(const Lanes3& a, const Lanes3& b) {
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d) at[c][d] = fused(a[c], b[d], at[c][d]);
  }
  void add_diagonal(const Lanes& value) {
    for (int c = 0; c < 3; ++c) at[c][c] += value;
  }
  /// Adds [v], the matrix with [v] w = v x w.
  void add_cross(const Lanes3& v) {
    at[0][1] -= v[2], at[0][2] += v[1];
    at[1][0] += v[2], at[1][2] -= v[0];
    at[2][0] -= v[1], at[2][1] += v[0];
  }
  /// As the couplings of derivative k with l and of l with k.
  void put(int k, int l, ShellHessian& out) const {
    for (int pair = 0; pair < 6; ++pair) {
      const int c = component_pairs[pair][0], d = component_pairs[pair][1];
      out.at[pair][k][l] = at[c][d];
      out.at[pair][l][k] = at[d][c];
    }
  }
};

/// Couplings of du and dv.
struct FirstBlocks {
  Block uu, uv, vv;
};

void add_membrane(const ShellPoint& at, const ShellStress& stress, FirstBlocks& h) {
  const Lanes3 &u = at.d[0], &v = at.d[1];
  const Lanes* s = stress.membrane_stiffness.at;
  // The metric's rows are 2 u by du; v by du and u by dv; 2 v by dv.
  h.uu.add(u, 4.0 * s[0] * u + 2.0 * s[1] * v);
  h.uu.add(v, 2.0 * s[1] * u + s[3] * v);
  h.uv.add(u, 2.0 * s[1] * u + 4.0 * s[2] * v);
  h.uv.add(v, s[3] * u + 2.0 * s[4] * v);
  h.vv.add(u, s[3] * u + 2.0 * s[4] * v);
  h.vv.add(v, 2.0 * s[4] * u + 4.0 * s[5] * v);
  h.uu.add_diagonal(2.0 * stress.membrane[0]);
  h.uv.add_diagonal(stress.membrane[1]);
  h.vv.add_diagonal(2.0 * stress.membrane[2]);
}

/// Second derivatives of w . n by du, dv, w constant. f(m) = w . m / |m|, m = u x v: with P = 1 - n n',
/// Hess f = -(Pw n' + n (Pw)' + f P) / |m|^2, grad f = Pw / |m|, and dm = -[v] du + [u] dv.
void add_normal_hessian(const ShellPoint& at, const Lanes3& w, FirstBlocks& h) {
  const Lanes3 &u = at.d[0], &v = at.d[1], &n = at.normal;
  const Lanes f = dot(w, n);
  const Lanes3 pw = w - f * n;
  const Lanes scale = -1.0 / (at.jacobian * at.jacobian), fs = f * scale;
  // -[v]' and [u]' times n and Pw.
  const Lanes3 n_u = cross(v, n), n_v = cross(n, u), w_u = cross(v, pw), w_v = cross(pw, u);
  h.uu.add(scale * w_u - fs * n_u, n_u);
  h.uu.add(scale * n_u, w_u);
  h.uu.add(-fs * v, v);
  h.uu.add_diagonal(fs * at.metric[2]);
  h.vv.add(scale * w_v - fs * n_v, n_v);
  h.vv.add(scale * n_v, w_v);
  h.vv.add(-fs * u, u);
  h.vv.add_diagonal(fs * at.metric[0]);
  h.uv.add(scale * w_u - fs * n_u, n_v);
  h.uv.add(scale * n_u, w_v);
  h.uv.add(fs * u, v);
  h.uv.add_diagonal(-fs * at.metric[1]);
  // d2m(du, dv) = du x dv, so grad . (du x dv) = -du' [grad] dv.
  h.uv.add_cross((-1.0 / at.jacobian) * pw);
}

void add_bending(const ShellPoint& at, const ShellStress& stress, FirstBlocks& h, ShellHessian& out) {
  const Lanes3& n = at.normal;
  const Lanes* stiffness = stress.bending_stiffness.at;
  constexpr int place[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  Lanes3 by_u[3], by_v[3];  // of the curvatures
  for (int k = 0; k < 3; ++k) at.normal_gradient(at.d[2 + k], by_u[k], by_v[k]);
  const Lanes inverse = 1.0 / at.jacobian;
  const Lanes3 n_u = cross(at.d[1], n), n_v = cross(n, at.d[0]);
  for (int k = 0; k < 3; ++k) {
    Lanes3 t_u, t_v;
    for (int l = 0; l < 3; ++l) {
      t_u = t_u + stiffness[place[k][l]] * by_u[l];
      t_v = t_v + stiffness[place[k][l]] * by_v[l];
    }
    h.uu.add(by_u[k], t_u);
    h.uv.add(by_u[k], t_v);
    h.vv.add(by_v[k], t_v);
    // By d_(2 + k) and du: moment_k P / |m| times -[v]; by dv: times [u].
    const Lanes share = stress.moment[k] * inverse;
    Block with_u, with_v;
    with_u.add(n, t_u - share * n_u);
    with_u.add_cross(-share * at.d[1]);
    with_v.add(n, t_v - share * n_v);
    with_v.add_cross(share * at.d[0]);
    with_u.put(2 + k, 0, out);
    with_v.put(2 + k, 1, out);
    for (int l = k; l < 3; ++l) {
      Block both;
      both.add(stiffness[place[k][l]] * n, n);
      both.put(2 + k, 2 + l, out);
    }
  }
}

}  // namespace

template <bool Bends>
void shell_gradient(const ShellPoint& at, const ShellStress& stress, Lanes3* by) {
  by[0] = 2.0 * stress.membrane[0] * at.d[0] + stress.membrane[1] * at.d[1];
  by[1] = 2.0 * stress.membrane[2] * at.d[1] + stress.membrane[1] * at.d[0];
  if constexpr (Bends) {
    Lanes3 by_u, by_v;
    at.normal_gradient(bent(at, stress.moment), by_u, by_v);
    by[0] = by[0] + by_u;
    by[1] = by[1] + by_v;
    for (int k = 0; k < 3; ++k) by[2 + k] = stress.moment[k] * at.normal;
  }
}

template <bool Bends>
void shell_hessian(const ShellPoint& at, const ShellStress& stress, ShellHessian& out) {
  FirstBlocks h;
  add_membrane(at, stress, h);
  if constexpr (Bends) {
    add_normal_hessian(at, bent(at, stress.moment), h);
    add_bending(at, stress, h, out);
  }
  h.uu.put(0, 0, out);
  h.uv.put(0, 1, out);
  h.vv.put(1, 1, out);
}

template void shell_gradient<true>(const ShellPoint&, const ShellStress&, Lanes3*);
template void shell_gradient<false>(const ShellPoint&, const ShellStress&, Lanes3*);
template void shell_hessian<true>(const ShellPoint&, const ShellStress&, ShellHessian&);
template void shell_hessian<false>(const ShellPoint&, const ShellStress&, ShellHessian&);

}  // namespace calot
