#include "geometry/swept.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace calot {
namespace {

constexpr int steps_each = 24;  // of the axis, between two stations

/// Hermite's cubic over a span of `width`.
template <class T>
T hermite(const T& a, const T& slope_a, const T& b, const T& slope_b, double width, double t) {
  const double s = 1 - t;
  return T(s * s * (1 + 2 * t) * a + t * t * (1 + 2 * s) * b + width * s * t * (s * slope_a - t * slope_b));
}

/// Slopes of the natural cubic spline over the chords' lengths: its curvature is continuous.
std::vector<Vec3> axis_slopes(const std::vector<SweptStation>& stations, const std::vector<double>& chords) {
  const auto last = static_cast<Eigen::Index>(chords.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(last + 1, last + 1);
  Eigen::MatrixX3d wanted = Eigen::MatrixX3d::Zero(last + 1, 3);
  for (Eigen::Index k = 0; k < last; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const double share = 1 / chords[at];
    matrix.block<2, 2>(k, k) += share * Eigen::Matrix2d{{2, 1}, {1, 2}};
    wanted.middleRows<2>(k).rowwise() +=
        3 * share * share * (stations[at + 1].at - stations[at].at).transpose();
  }
  const Eigen::MatrixX3d slopes = matrix.partialPivLu().solve(wanted);
  std::vector<Vec3> out;
  for (Eigen::Index k = 0; k <= last; ++k) out.push_back(slopes.row(k).transpose());
  return out;
}

/// Slopes that keep a curve between its neighbouring values (Fritsch and Butland 1984: harmonic means).
std::vector<double> kept_slopes(const std::vector<SweptStation>& stations, const std::vector<double>& way) {
  std::vector<double> out(stations.size(), 0.0);
  for (std::size_t k = 1; k + 1 < stations.size(); ++k) {
    const double before = (stations[k].radius - stations[k - 1].radius) / (way[k] - way[k - 1]);
    const double after = (stations[k + 1].radius - stations[k].radius) / (way[k + 1] - way[k]);
    if (before * after > 0) out[k] = 2 * before * after / (before + after);
  }
  return out;
}

/// The span of an increasing table that `x` lies in, and the share of it.
std::pair<std::size_t, double> span_of(const std::vector<double>& table, double x) {
  const auto above = std::upper_bound(table.begin() + 1, table.end() - 1, x) - table.begin();
  const auto k = static_cast<std::size_t>(above) - 1;
  return {k, std::clamp((x - table[k]) / (table[k + 1] - table[k]), 0.0, 1.0)};
}

}  // namespace

SweptForm::SweptForm(std::vector<SweptStation> stations, const Vec3& side) : stations_(std::move(stations)) {
  std::vector<double> chords;
  for (std::size_t k = 1; k < stations_.size(); ++k)
    chords.push_back((stations_[k].at - stations_[k - 1].at).norm());
  const std::vector<Vec3> slopes = axis_slopes(stations_, chords);
  line_.push_back(stations_[0].at);
  way_.push_back(0);
  station_way_.push_back(0);
  for (std::size_t k = 0; k < chords.size(); ++k) {
    for (int i = 1; i <= steps_each; ++i) {
      line_.push_back(hermite(stations_[k].at, slopes[k], stations_[k + 1].at, slopes[k + 1], chords[k],
                              static_cast<double>(i) / steps_each));
      way_.push_back(way_.back() + (line_.back() - line_[line_.size() - 2]).norm());
    }
    station_way_.push_back(way_.back());
  }
  slope_ = kept_slopes(stations_, station_way_);
  frames_ = parallel_frames(line_, side);
}

double SweptForm::radius(double z) const {
  const auto [k, t] = span_of(station_way_, z);
  return hermite(stations_[k].radius, slope_[k], stations_[k + 1].radius, slope_[k + 1],
                 station_way_[k + 1] - station_way_[k], t);
}

Profile SweptForm::profile() const {
  // A copy: the profile outlives the form.
  return {[form = *this, length = length()](double s) {
    const double z = length * 0.5 * (1 - std::cos(std::numbers::pi * s));
    const auto rounded = [](double depth, double cap) {
      const double up = 1 - std::min(1.0, depth / cap);
      return std::sqrt(std::max(0.0, 1 - up * up));
    };
    const double cap =
        rounded(z, form.stations_.front().radius) * rounded(length - z, form.stations_.back().radius);
    return Vec2(s > 0 && s < 1 ? form.radius(z) * cap : 0.0, z);
  }};
}

double SweptForm::spacing(const Vec3& straight) const {
  double widest = 0;
  for (const SweptStation& station : stations_) widest = std::max(widest, station.radius);
  const auto [k, t] = span_of(station_way_, straight.z());
  const double refine = stations_[k].refine + t * (stations_[k + 1].refine - stations_[k].refine);
  const double thin = radius(straight.z()) / widest;
  return (0.45 + 0.55 * thin * thin * (3 - 2 * thin)) / refine;
}

Vec3 SweptForm::bent(const Vec3& straight) const {
  const auto [k, t] = span_of(way_, straight.z());
  const auto mixed = [t = t](const Vec3& a, const Vec3& b) { return Vec3(a + t * (b - a)); };
  const LineFrame &a = frames_[k], &b = frames_[k + 1];
  return mixed(line_[k], line_[k + 1]) + straight.x() * mixed(a.side, b.side) +
         straight.y() * mixed(a.up(), b.up());
}

SweptForm::Bend SweptForm::sharpest() const {
  Bend out;
  for (std::size_t i = 0; i + 1 < line_.size(); ++i) {
    const double turned = (frames_[i + 1].tangent - frames_[i].tangent).norm();
    const double found = radius(way_[i]) * turned / (way_[i + 1] - way_[i]);
    if (found > out.radius_by_curvature) out = {way_[i], found};
  }
  return out;
}

}  // namespace calot
