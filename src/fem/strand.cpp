#include "fem/strand.h"

#include <fmt/format.h>

#include <cmath>

namespace calot {
namespace {

/// Strain over which a strand becomes taut: at a sharp switch line searches fail now and then.
constexpr double switch_width = 0.03;
/// Of the strand's stiffness over its length: weaker, solves take more iterations; ten times as strong adds 6 % of force.
constexpr double centring_share = 1e-2;
constexpr double rounding_share = 1e-3;

StrandVector stacked(const Vec3& a, const Vec3& m, const Vec3& b) {
  StrandVector out;
  out.head<3>() = a;
  out.segment<3>(3) = m;
  out.tail<3>() = b;
  return out;
}

/// A way's half: its vector, and its rounded length, m.
struct Half {
  Vec3 arm;
  double length;
  Vec3 slope() const { return arm / length; }
  Mat3 bend() const { return (Mat3::Identity() - slope() * slope().transpose()) / length; }
};

struct Halves {
  Half a, b;  ///< from m to a and to b
  Halves(const StrandVector& places, double rounding)
      : a(half(places.head<3>() - places.segment<3>(3), rounding)),
        b(half(places.tail<3>() - places.segment<3>(3), rounding)) {}
  static Half half(const Vec3& arm, double rounding) {
    return {arm, std::sqrt(arm.squaredNorm() + rounding * rounding)};
  }
  double way() const { return a.length + b.length; }
  StrandVector slope() const { return stacked(a.slope(), -a.slope() - b.slope(), b.slope()); }
};

/// What a node is centred about: weights of a and b.
std::array<double, 2> centre_weights(bool torn) { return torn ? std::array{1.0, 0.0} : std::array{0.5, 0.5}; }

Vec3 off_centre(const StrandVector& places, bool torn) {
  const auto [a, b] = centre_weights(torn);
  return places.segment<3>(3) - a * places.head<3>() - b * places.tail<3>();
}

}  // namespace

StrandLaw::Sample StrandLaw::elastic(const Setup& setup, double strain) {
  const double by_width = strain / switch_width;
  // A slack strand's is no more than rounding, and exp() would overflow for a taut one's.
  const double on = 1 / (1 + std::exp(-by_width));
  const double taut = by_width > 30 ? strain : switch_width * std::log1p(std::exp(by_width));
  const double k = setup.stiffness, b = setup.stiffening, grown = std::expm1(b * taut);
  Sample out;
  const double pull = b > 0 ? k * grown / b : k * taut;
  out.energy = b > 0 ? k * (grown / b - taut) / b : 0.5 * k * taut * taut;
  if (b > 0 && b * taut < 1e-4)
    out.energy = k * taut * taut * (0.5 + b * taut / 6);  // the difference cancels
  out.tension = pull * on;
  out.stiffness = k * (1 + grown) * on * on + pull * on * (1 - on) / switch_width;
  return out;
}

double StrandLaw::strain_at_strength(const Setup& setup) {
  double strain = setup.stiffening > 0
                      ? std::log1p(setup.stiffening * setup.strength / setup.stiffness) / setup.stiffening
                      : setup.strength / setup.stiffness;
  for (int i = 0; i < 50; ++i) {
    const Sample at = elastic(setup, strain);
    const double step = (setup.strength - at.tension) / at.stiffness;
    strain += step;
    if (std::abs(step) < 1e-14) break;
  }
  return strain;
}

double StrandLaw::least_break_energy(const Setup& setup) {
  return setup.length *
         (elastic(setup, strain_at_strength(setup)).energy + 0.5 * setup.strength * least_tail);
}

Result<StrandLaw> StrandLaw::create(const Setup& setup) {
  StrandLaw law;
  law.setup_ = setup;
  law.peak_ = strain_at_strength(setup);
  const double stored = elastic(setup, law.peak_).energy;
  law.tail_ = 2 * (setup.break_energy / setup.length - stored) / setup.strength;
  if (law.tail_ >= least_tail * (1 - 1e-12)) return law;
  return fail(
      FailureKind::scenario,
      fmt::format("a strand {:.3g} mm long of a strength of {:.3g} N takes at least {:.3g} mJ to tear, "
                  "not {:.3g} mJ",
                  1e3 * setup.length, setup.strength, 1e3 * least_break_energy(setup),
                  1e3 * setup.break_energy),
      "raise the break energy, or lower the strength");
}

void visit_members(MemberReader& read, StrandLaw& law) {
  StrandLaw::Setup setup;
  read(setup);
  if (read.lacks()) return;
  Result<StrandLaw> made = StrandLaw::create(setup);
  if (!made) return read.refuse();
  law = std::move(made).value();
}

double StrandLaw::intact(double opened) const {
  if (opened <= peak_) return 1;
  if (torn(opened)) return 0;
  return setup_.strength * (1 - (opened - peak_) / tail_) / elastic(setup_, opened).tension;
}

StrandLaw::Sample StrandLaw::sample(double way, const StrandPast& past) const {
  if (torn(past.opened)) return {};
  const double at = strain(way), from = std::max(past.opened, peak_);
  Sample out = elastic(setup_, std::min(at, from));
  const double whole = intact(past.opened);
  out.energy *= whole * setup_.length;
  out.tension *= whole;
  out.stiffness *= whole / setup_.length;
  if (at <= from) return out;
  // Tension strength * (left - y / tail) * (1 + delay y / tail) of the strain y beyond: nothing when torn.
  const double left = 1 - (from - peak_) / tail_, y = std::min(at - from, left * tail_), share = y / tail_;
  const double slower = past.delay * left - 1;
  out.energy +=
      setup_.length * setup_.strength * y * (left + 0.5 * slower * share - past.delay * share * share / 3);
  const bool parted = at - from >= left * tail_;
  out.tension = parted ? 0 : setup_.strength * (left - share) * (1 + past.delay * share);
  out.stiffness = parted ? 0 : setup_.strength / (tail_ * setup_.length) * (slower - 2 * past.delay * share);
  return out;
}

double Strand::centring() const { return centring_share * law.setup().stiffness / law.setup().length; }

double Strand::way(const StrandVector& places) const {
  return Halves(places, rounding_share * law.setup().length).way();
}

StrandVector Strand::slope(const StrandVector& places) const {
  return Halves(places, rounding_share * law.setup().length).slope();
}

double Strand::value(const StrandVector& places, const StrandPast& past) const {
  return law.sample(way(places), past).energy +
         0.5 * centring() * off_centre(places, law.torn(past.opened)).squaredNorm();
}

StrandVector Strand::gradient(const StrandVector& places, const StrandPast& past) const {
  const bool torn = law.torn(past.opened);
  const Vec3 pull = centring() * off_centre(places, torn);
  const auto [a, b] = centre_weights(torn);
  const StrandVector centred = stacked(-a * pull, pull, -b * pull);
  if (torn) return centred;
  const Halves halves(places, rounding_share * law.setup().length);
  return centred + law.sample(halves.way(), past).tension * halves.slope();
}

StrandMatrix Strand::hessian(const StrandVector& places, const StrandPast& past) const {
  const bool torn = law.torn(past.opened);
  const auto [a, b] = centre_weights(torn);
  const std::array<double, 3> centred{-a, 1, -b};
  StrandMatrix out;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      out.block<3, 3>(3 * i, 3 * j) = centring() * centred[i] * centred[j] * Mat3::Identity();
  if (torn) return out;
  const Halves halves(places, rounding_share * law.setup().length);
  const StrandLaw::Sample at = law.sample(halves.way(), past);
  const StrandVector slope = halves.slope();
  out += at.stiffness * slope * slope.transpose();
  const Mat3 of_a = at.tension * halves.a.bend(), of_b = at.tension * halves.b.bend();
  out.block<3, 3>(0, 0) += of_a;
  out.block<3, 3>(3, 3) += of_a + of_b;
  out.block<3, 3>(6, 6) += of_b;
  for (const auto& [end, bend] : {std::pair{0, &of_a}, {6, &of_b}}) {
    out.block<3, 3>(end, 3) -= *bend;
    out.block<3, 3>(3, end) -= *bend;
  }
  return out;
}

}  // namespace calot
