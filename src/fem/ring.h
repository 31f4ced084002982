#pragma once
// How a thin tube gives way between two lines that press on it from opposite sides: its section flattens.
//
// The closing d is by how much the section has become lower, from 0 to the lumen's diameter D; F the force a unit of
// length. R is the radius of the wall's middle, EI = E t^3 / 12.
// - At first the section is a ring with F R^3 / (EI d) = 1 / (pi/4 - 2/pi) = 1 / 0.149 (Timoshenko, Strength of
//   Materials, part I, section 80).
// - From d = 0.56 R on the loads lie on flats, and the sides are two equal loops of the elastica, of height
//   h = 2 R - d, whatever the ring was before: F = b^2 EI / h^2, where b is the integral of sqrt(sin) from 0 to pi.
// Both at once, and smooth:
//     F = k D / m ((1 - y)^-2 - (1 - y)^(m - 2)),  y = d / D,  k = EI / (0.149 R^3),  m = 8 / (0.149 b^2) = 9.36
// For a thin wall this is within 7.2 % of the elastica's everywhere, and right at both ends. A wall that is not thin
// closes earlier, at D = 2 R - t.
// - A pressure p inside resists by p times the area that the lumen loses. A stadium of the same outline has lost
//   pi d^2 / 4, at d = D all of it: so the pressure adds p pi d / 2 to F, which is p times the width of the flats.

#include <algorithm>
#include <cmath>
#include <limits>

namespace calot {

/// An energy a unit of length of a tube, by a length.
struct SectionSample {
  double energy = 0;  ///< J/m
  double slope = 0;   ///< N/m
  double bend = 0;    ///< Pa
};

struct FlatRing {
  double stiffness = 0;  ///< k, Pa
  double lumen = 0;      ///< D, m
  double outer = 0;      ///< outer radius at rest, m

  /// `young` in Pa (of the plane strain of a long tube: E / (1 - nu^2)), the radius of the wall's middle and the wall's
  /// thickness in m, thinner than twice that radius.
  static FlatRing of_tube(double young, double radius, double wall);

  /// By the closing, m, at a gauge pressure in Pa; infinite from the lumen's diameter on. Widening (below 0) goes on
  /// smoothly.
  SectionSample sample(double closing, double pressure) const;
  /// Whether the section resists every closing at this pressure: one that is sucked on harder than 0.38 k falls in by
  /// itself (a ring buckles at 0.45 k).
  bool stands(double pressure) const;

  /// How near to the centreline a shape may come that presses from both sides: the wall, folded flat. m.
  double folded() const { return outer - 0.5 * lumen; }
  /// Of the closed-down lumen, m^2.
  double lumen_area(double closing) const;
  /// Half the outer height and width of the section as a stadium of the same outline, m.
  double half_height(double closing) const { return outer - 0.5 * closing; }
  double half_width(double closing) const;
};

/// What a tube's centreline costs near a shape that presses on its outside: the flattening section in series with a
/// contact potential of the gap left between them. As the shape comes nearer, the gap closes, the section flattens
/// softly, and when it is flat nothing gives any more. Each side of the section closes by half, so a shape is answered by
/// half the ring's energy, and two opposite ones by all of it.
///
/// `Gap` is a convex potential of the gap (J/m^2), as collision/barrier.h: `range`, beyond which it is 0, and
/// sample(gap) with energy, derivative and second derivative.
template <class Gap>
struct RodContactLaw {
  FlatRing ring;  ///< of lumen 0: a solid thread, which does not flatten
  Gap gap;
  double width = 0;  ///< m of the tube's outline that press on the shape

  struct Sample {
    SectionSample section;  ///< by the distance
    double closing = 0;     ///< of the whole section, m
    double gap = 0;         ///< m
  };
  /// By the distance (m) of the shape's surface from the centreline. C2, convex and decreasing; 0 from outer + range on,
  /// infinite up to ring.folded(), and where the section does not stand.
  Sample sample(double distance, double pressure) const;

 private:
  SectionSample side(double closing, double pressure) const;
  double balanced_gap(double overlap, double pressure) const;
};

/// Of one side of the section by its own closing, half the whole: its height above the centreline is less by that.
template <class Gap>
SectionSample RodContactLaw<Gap>::side(double closing, double pressure) const {
  const SectionSample whole = ring.sample(2 * closing, pressure);
  return {0.5 * whole.energy, whole.slope, 2 * whole.bend};
}

/// Where the section pushes back as hard as the gap presses: Newton's steps on a force that grows with the gap, between
/// ends that close in. `overlap`: by how much the shape has come nearer than the outer radius.
template <class Gap>
double RodContactLaw<Gap>::balanced_gap(double overlap, double pressure) const {
  constexpr int most_steps = 200;
  double low = std::max(-overlap, 0.0), high = std::min(gap.range, 0.5 * ring.lumen - overlap);
  if constexpr (requires { gap.soft_share; })
    if (gap.soft_share > 0) low = -overlap;
  double at = 0.5 * (low + high);
  for (int step = 0; step < most_steps; ++step) {
    const auto b = gap.sample(at);
    const SectionSample s = side(overlap + at, pressure);
    const double excess = s.slope + width * b.derivative, slope = s.bend + width * b.second;
    (excess > 0 ? high : low) = at;
    double next = at - excess / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == at || next <= low || next >= high) break;
    // To the last bits: the force is then right to those as well.
    if (std::abs(next - at) <= 4 * std::numeric_limits<double>::epsilon() * (std::abs(overlap) + gap.range))
      return next;
    at = next;
  }
  return at;
}

template <class Gap>
typename RodContactLaw<Gap>::Sample RodContactLaw<Gap>::sample(double distance, double pressure) const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double overlap = ring.outer - distance;
  if (distance >= ring.outer + gap.range) return {{}, 0, -overlap};
  if (ring.lumen == 0) {
    const auto b = gap.sample(-overlap);
    return {{width * b.energy, width * b.derivative, width * b.second}, 0, -overlap};
  }
  if (!(distance > ring.folded()) || !ring.stands(pressure))
    return {{infinity, -infinity, infinity}, ring.lumen, 0};
  const double open = balanced_gap(overlap, pressure);
  const auto b = gap.sample(open);
  const SectionSample s = side(overlap + open, pressure);
  const double press = width * b.second;
  return {
      {s.energy + width * b.energy, -s.slope, s.bend * press / (s.bend + press)}, 2 * (overlap + open), open};
}

}  // namespace calot
