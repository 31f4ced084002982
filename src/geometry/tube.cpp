#include "geometry/tube.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace calot {
namespace {

Vec3 any_perpendicular(const Vec3& axis) {
  int smallest = 0;
  axis.cwiseAbs().minCoeff(&smallest);
  return axis.cross(Vec3::Unit(smallest)).normalized();
}

/// Unit part of a vector across a unit tangent.
Vec3 across(const Vec3& tangent, const Vec3& v) { return (v - tangent.dot(v) * tangent).normalized(); }

std::vector<Vec3> tangents(std::span<const Vec3> line) {
  const int last = static_cast<int>(line.size()) - 1;
  std::vector<Vec3> out(line.size());
  const auto chord = [&](int k) { return Vec3(line[k + 1] - line[k]); };
  Vec3 known = Vec3::UnitX();
  for (int k = last - 1; k >= 0; --k)
    if (chord(k).squaredNorm() > 0) known = chord(k).normalized();
  for (int k = 0; k <= last; ++k) {
    Vec3 slope = Vec3::Zero();
    if (last > 0) {
      // Slopes of the chords on both sides, by the other's length; at an end the parabola goes on.
      const int middle = std::clamp(k, 1, std::max(1, last - 1));
      const Vec3 before = chord(middle - 1), after = last > 1 ? chord(middle) : before;
      const double a = before.norm(), b = after.norm();
      if (a > 0 && b > 0) {
        const Vec3 in = before / a, out_slope = after / b, bend = (out_slope - in) / (a + b);
        slope = k < middle   ? Vec3(in - a * bend)
                : k > middle ? Vec3(out_slope + b * bend)
                             : Vec3(in + a * bend);
      } else {
        slope = before + after;
      }
    }
    if (slope.squaredNorm() > 0) known = slope.normalized();
    out[k] = known;
  }
  return out;
}

Vec3 reflected(const Vec3& v, const Vec3& mirror) {
  const double squared = mirror.squaredNorm();
  return squared > 0 ? Vec3(v - 2 / squared * mirror.dot(v) * mirror) : v;
}

/// `v`, across `from`, turned as the least turn takes that unit vector to another; as it is where they are opposite.
Vec3 least_turn(const Vec3& v, const Vec3& from, const Vec3& to) {
  return reflected(reflected(v, from), from + to);
}

/// Stretches vectors across the line so that the unit circle becomes the section.
Mat3 stretch(const LineFrame& frame, const TubeSection& section) {
  const Vec3 part = section.pressed - frame.tangent.dot(section.pressed) * frame.tangent;
  Mat3 out = section.radius * Mat3::Identity();
  if (part.squaredNorm() > 0)
    out += (section.flattened - section.radius) / part.squaredNorm() * part * part.transpose();
  return out;
}

/// Where a ring of a tube's end stands, as shares of the section's half-axes: across the line, and along it outward.
struct EndRing {
  double wide = 1, out = 0;
};

/// A quarter of a circle, `ring` of `rings` on the way from the last section, 0, to the tip.
EndRing round_end(double ring, int rings) {
  const double angle = 0.5 * std::numbers::pi * ring / rings;
  return {std::cos(angle), std::sin(angle)};
}

/// The edge lies rolled outward by about its own thickness; then it goes in, to the lumen's end. Drawn by eye.
EndRing cut_end(double share, double lumen) {
  const double wall = 1 - lumen, curl = 0.12 + 0.2 * wall;
  const std::array<EndRing, 6> rings = {{{1, 0},
                                         {1 + curl, 0.6 * curl},
                                         {1 + 0.5 * curl, 1.5 * curl},
                                         {1 - 0.6 * wall, 1.1 * curl},
                                         {std::max(0.25, lumen), -0.2},
                                         {0, lumen > 0 ? -1.2 : -0.25}}};
  const double at = share * (rings.size() - 1);
  const std::size_t before = std::min(static_cast<std::size_t>(at), rings.size() - 2);
  const double part = at - static_cast<double>(before);
  return {(1 - part) * rings[before].wide + part * rings[before + 1].wide,
          (1 - part) * rings[before].out + part * rings[before + 1].out};
}

EndRing end_ring(const TubeEnd& kind, double ring, int rings) {
  return kind.cut ? cut_end(ring / rings, kind.lumen) : round_end(ring, rings);
}

}  // namespace

std::vector<LineFrame> parallel_frames(std::span<const Vec3> line, const Vec3& first) {
  const std::vector<Vec3> along = tangents(line);
  std::vector<LineFrame> out(line.size());
  for (std::size_t k = 0; k < line.size(); ++k) {
    Vec3 side = first;
    if (k > 0) {
      const Vec3 way = line[k] - line[k - 1];
      // Without a way the first mirror is the tangent's own: then both make the least turn.
      const Vec3 mirror = way.squaredNorm() > 0 ? way : along[k - 1];
      side = reflected(reflected(out[k - 1].side, mirror), along[k] - reflected(along[k - 1], mirror));
    }
    out[k] = {along[k], across(along[k], side)};
  }
  return out;
}

std::vector<LineFrame> parallel_frames(std::span<const Vec3> line, const LineFrame& rest) {
  if (line.empty()) return {};
  const Vec3 tangent = tangents(line).front();
  return parallel_frames(line, least_turn(rest.side, rest.tangent, tangent));
}

Result<TubeMesh> TubeMesh::create(std::span<const Vec3> rest, int sectors) {
  if (sectors < 3)
    return fail(FailureKind::scenario, fmt::format("a tube of {} sectors", sectors), "give it 3 or more");
  if (rest.size() < 2 || !((rest[1] - rest[0]).squaredNorm() > 0))
    return fail(FailureKind::scenario, "a tube's line has no direction at its beginning",
                "give it two points or more, and keep them apart");
  TubeMesh mesh;
  mesh.points_ = static_cast<int>(rest.size());
  mesh.sectors_ = sectors;
  mesh.cap_rings_ = std::max(1, (sectors + 2) / 4 - 1);  // as high as wide
  const Vec3 tangent = tangents(rest).front();
  mesh.rest_ = {tangent, any_perpendicular(tangent)};
  for (int k = 0; k < sectors; ++k) {
    const double angle = 2 * std::numbers::pi * k / sectors;
    mesh.cosine_.push_back(std::cos(angle));
    mesh.sine_.push_back(std::sin(angle));
  }
  // Rings in the order of the line: the caps' own are kept behind the sections', the first cap's from its end on.
  const int tube = mesh.points_ * sectors, cap = mesh.cap_rings_ * sectors + 1;
  std::vector<int> rings;
  for (int r = mesh.cap_rings_ - 1; r >= 0; --r) rings.push_back(tube + r * sectors);
  for (int p = 0; p < mesh.points_; ++p) rings.push_back(p * sectors);
  for (int r = 0; r < mesh.cap_rings_; ++r) rings.push_back(tube + cap + r * sectors);
  const int bottom = tube + cap - 1, top = tube + 2 * cap - 1;
  for (std::size_t r = 1; r < rings.size(); ++r) mesh.join_rings(rings[r - 1], rings[r]);
  for (int k = 0; k < sectors; ++k) {
    const int next = (k + 1) % sectors;
    mesh.triangles_.push_back({bottom, rings.front() + next, rings.front() + k});
    mesh.triangles_.push_back({top, rings.back() + k, rings.back() + next});
  }
  return mesh;
}

void TubeMesh::join_rings(int before, int after) {
  for (int k = 0; k < sectors_; ++k) {
    const int next = (k + 1) % sectors_;
    triangles_.push_back({before + k, before + next, after + next});
    triangles_.push_back({before + k, after + next, after + k});
  }
}

void TubeMesh::place(std::span<const Vec3> line, std::span<const TubeSection> sections, Surface& out,
                     const std::array<TubeEnd, 2>& ends) const {
  out.positions.resize(vertices());
  out.normals.resize(vertices());
  const std::vector<LineFrame> frames = parallel_frames(line, rest_);
  std::vector<Mat3> stretches(points_);
  for (int p = 0; p < points_; ++p) {
    stretches[p] = stretch(frames[p], sections[p]);
    for (int k = 0; k < sectors_; ++k)
      out.positions[vertex(p, k)] = line[p] + stretches[p] * around(frames[p], k);
  }
  for (int p = 0; p < points_; ++p) {
    const int before = std::max(0, p - 1), after = std::min(points_ - 1, p + 1);
    for (int k = 0; k < sectors_; ++k) {
      const Vec3 round = stretches[p] * (cosine_[k] * frames[p].up() - sine_[k] * frames[p].side);
      const Vec3 out_of_line = out.positions[vertex(p, k)] - line[p];
      Vec3 along = out.positions[vertex(after, k)] - out.positions[vertex(before, k)];
      // A cap goes on as an ellipsoid; inside of a bend tighter than the tube the surface folds back.
      if (p == 0 || p == points_ - 1 || along.dot(frames[p].tangent) <= 0) along = frames[p].tangent;
      const Vec3 normal = round.cross(along);
      out.normals[vertex(p, k)] =
          normal.squaredNorm() > 0 ? normal.normalized() : Vec3(out_of_line.normalized());
    }
  }
  const int tube = points_ * sectors_, cap = cap_rings_ * sectors_ + 1;
  place_cap(frames.front(), line.front(), sections.front(), -1, ends[0], tube, out);
  place_cap(frames.back(), line.back(), sections.back(), 1, ends[1], tube + cap, out);
}

void TubeMesh::place_cap(const LineFrame& frame, const Vec3& end, const TubeSection& section, double outward,
                         const TubeEnd& kind, int first, Surface& out) const {
  constexpr double step = 1e-3;  // of a ring, on which its direction is taken
  const Mat3 wide = stretch(frame, section);
  const Vec3 tip = outward * frame.tangent;
  const bool pressed =
      (section.pressed - frame.tangent.dot(section.pressed) * frame.tangent).squaredNorm() > 0;
  const double height = pressed ? std::min(section.radius, section.flattened) : section.radius;
  for (int r = 0; r < cap_rings_; ++r) {
    const int rings = cap_rings_ + 1;
    const EndRing at = end_ring(kind, r + 1, rings), before = end_ring(kind, r + 1 - step, rings),
                  after = end_ring(kind, r + 1 + step, rings);
    for (int k = 0; k < sectors_; ++k) {
      const Vec3 side = wide * around(frame, k);
      const Vec3 round = wide * (cosine_[k] * frame.up() - sine_[k] * frame.side);
      const Vec3 on = height * (after.out - before.out) * tip + (after.wide - before.wide) * side;
      const Vec3 normal = outward * round.cross(on);
      out.positions[first + r * sectors_ + k] = end + at.wide * side + height * at.out * tip;
      out.normals[first + r * sectors_ + k] = normal.squaredNorm() > 0 ? Vec3(normal.normalized()) : tip;
    }
  }
  out.positions[first + cap_rings_ * sectors_] =
      end + height * end_ring(kind, cap_rings_ + 1, cap_rings_ + 1).out * tip;
  out.normals[first + cap_rings_ * sectors_] = tip;
}

}  // namespace calot
