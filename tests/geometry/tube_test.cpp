// Swept tubes: closed, of the right size, and turning with their line only.

#include "geometry/tube.h"

#include <gtest/gtest.h>

#include <numbers>

#include "geometry/tri_mesh.h"
#include "support/random.h"

namespace calot {
namespace {

using std::numbers::pi;
using Line = std::vector<Vec3>;

template <class Place>
Line sampled(int spans, const Place& place) {
  Line out;
  for (int k = 0; k <= spans; ++k) out.push_back(place(static_cast<double>(k) / spans));
  return out;
}

Line straight(int spans, double length) {
  return sampled(spans, [&](double s) { return Vec3(length * s, 0, 0); });
}

/// Of 5 mm about z, one and a half turns, 4 mm up each.
Vec3 helix(double s) {
  const double angle = 3 * pi * s;
  return {5e-3 * std::cos(angle), 5e-3 * std::sin(angle), 6e-3 * s};
}

TubeMesh::Surface placed(const TubeMesh& tube, const Line& line, const std::vector<TubeSection>& sections) {
  TubeMesh::Surface out;
  tube.place(line, sections, out);
  return out;
}

std::vector<TubeSection> round(const Line& line, double radius) {
  return std::vector<TubeSection>(line.size(), TubeSection{radius, radius, Vec3::Zero()});
}

TEST(TubeMesh, IsClosedAndFacesOutwardOnABentTaperedFlattenedLine) {
  const Line line = sampled(24, helix);
  std::vector<TubeSection> sections;
  for (std::size_t k = 0; k < line.size(); ++k)
    sections.push_back({1.2e-3 - 2e-5 * static_cast<double>(k), 0.4e-3, Vec3(1, 2, 3)});
  for (int sectors : {3, 4, 7, 16}) {
    const TubeMesh tube = TubeMesh::create(line, sectors).value();
    const TriMesh mesh{placed(tube, line, sections).positions, tube.triangles()};
    EXPECT_EQ(static_cast<int>(mesh.points.size()), tube.vertices());
    for (const Problem& problem : check(mesh)) ADD_FAILURE() << sectors << ": " << to_text(problem);
  }
}

TEST(TubeMesh, ACutEndIsClosedFacesOutwardAndShowsItsLumen) {
  const Line line = straight(12, 12e-3);
  for (int sectors : {7, 16, 20})
    for (double lumen : {0.0, 0.5}) {
      const TubeMesh tube = TubeMesh::create(line, sectors).value();
      TubeMesh::Surface out;
      tube.place(line, round(line, 2e-3), out, {TubeEnd{}, TubeEnd{true, lumen}});
      const TriMesh mesh{out.positions, tube.triangles()};
      for (const Problem& problem : check(mesh)) ADD_FAILURE() << sectors << ": " << to_text(problem);
      const TubeMesh::Surface whole = placed(tube, line, round(line, 2e-3));
      const std::size_t sections = line.size() * static_cast<std::size_t>(sectors);
      double rolled = 0;
      for (std::size_t i = 0; i < out.positions.size(); ++i) {
        if (i < sections) {
          EXPECT_EQ(out.positions[i], whole.positions[i]);
        }
        if (out.positions[i].x() > 12e-3) rolled = std::max(rolled, out.positions[i].tail<2>().norm());
      }
      if (sectors > 7) {  // of these the cap has too few rings to show it
        EXPECT_GT(rolled, 1.1 * 2e-3) << "its edge has curled outward";
      }
      if (lumen > 0) {
        EXPECT_LT(out.positions.back().x(), 12e-3 - 1e-3) << "it is hollow";
      }
    }
}

TEST(TubeMesh, TendsToTheCapsuleWithTheSquareOfTheSectors) {
  const double radius = 1e-3, length = 6e-3;
  const double exact = pi * radius * radius * (length + 4.0 / 3 * radius);
  const Line line = straight(6, length);
  std::vector<double> errors;
  for (int sectors : {8, 16, 32}) {
    const TubeMesh tube = TubeMesh::create(line, sectors).value();
    errors.push_back(
        1 - enclosed_volume({placed(tube, line, round(line, radius)).positions, tube.triangles()}) / exact);
  }
  EXPECT_LT(errors[2], 0.01);
  for (int k : {0, 1}) EXPECT_NEAR(errors[k] / errors[k + 1], 4, 0.3);
}

TEST(TubeMesh, EveryVertexIsARadiusFromTheLineAndItsNormalPointsAway) {
  const double radius = 1e-3, length = 6e-3;
  const Line line = straight(6, length);
  const TubeMesh tube = TubeMesh::create(line, 12).value();
  const TubeMesh::Surface at = placed(tube, line, round(line, radius));
  for (int k = 0; k < tube.vertices(); ++k) {
    const Vec3& p = at.positions[k];
    const Vec3 away = p - Vec3(std::clamp(p.x(), 0.0, length), 0, 0);
    EXPECT_NEAR(away.norm(), radius, 1e-15);
    EXPECT_LT((at.normals[k] - away / radius).norm(), 1e-12);
  }
}

TEST(TubeMesh, NormalsAreThoseOfTheSurfaceWhereItIsBentTaperedAndFlattened) {
  // Against the triangles' own about each vertex, which tend to them with the spacing.
  const Line line = sampled(120, helix);
  std::vector<TubeSection> sections;
  for (std::size_t k = 0; k < line.size(); ++k)
    sections.push_back({1.2e-3 - 6e-6 * static_cast<double>(k), 0.6e-3, Vec3::UnitZ()});
  const TubeMesh tube = TubeMesh::create(line, 60).value();
  const TubeMesh::Surface at = placed(tube, line, sections);
  std::vector<Vec3> sums(at.positions.size(), Vec3::Zero());
  for (const Triangle& t : tube.triangles()) {
    const Vec3 n = (at.positions[t[1]] - at.positions[t[0]]).cross(at.positions[t[2]] - at.positions[t[0]]);
    for (int corner : t) sums[corner] += n;
  }
  for (int k = 0; k < tube.vertices(); ++k) {
    EXPECT_NEAR(at.normals[k].norm(), 1, 1e-14);
    EXPECT_GT(at.normals[k].dot(sums[k].normalized()), 0.97) << k;
  }
}

TEST(TubeMesh, APressedSectionIsAnEllipseAlongItsPress) {
  const Line line = straight(4, 4e-3);
  const TubeMesh tube = TubeMesh::create(line, 64).value();
  const Vec3 press(5, 0.6, 0.8);  // part of it along the line
  const TubeMesh::Surface at =
      placed(tube, line, std::vector<TubeSection>(line.size(), {2e-3, 0.5e-3, -3 * press}));
  const Vec3 thin(0, 0.6, 0.8), wide(0, -0.8, 0.6);
  for (int k = 0; k < 64; ++k) {
    const Vec3 p = at.positions[tube.vertex(2, k)] - line[2];
    EXPECT_NEAR(std::hypot(p.dot(thin) / 0.5e-3, p.dot(wide) / 2e-3), 1, 1e-12);
  }
}

TEST(ParallelFrames, APlanarLineKeepsItsPlanesNormalThroughEveryBend) {
  // With an inflection, straight parts and points that coincide.
  Line line = sampled(30, [](double s) { return Vec3(s, 0.1 * std::sin(7 * s), 0); });
  line.insert(line.begin() + 10, line[10]);
  for (int k = 1; k < 5; ++k) line.push_back(line.back() + Vec3(0.02, 0, 0));
  for (const LineFrame& f : parallel_frames(line, Vec3(0, 0, 1)))
    EXPECT_LT((f.side - Vec3::UnitZ()).norm(), 1e-13);
}

TEST(ParallelFrames, OnAHelixTheyTurnAgainstTheFrenetFrameByItsTorsion) {
  // Angle about the tangent between a frame that does not twist and the principal normal: the integral of the torsion.
  const double radius = 5e-3, rise = 6e-3 / (3 * pi), squared = radius * radius + rise * rise;
  const double total = rise / squared * 3 * pi * std::sqrt(squared);
  std::vector<double> errors;
  for (int spans : {30, 60, 120}) {
    const Line line = sampled(spans, helix);
    const std::vector<LineFrame> frames = parallel_frames(line, Vec3(-1, 0, 0));
    const LineFrame& last = frames.back();
    const Vec3 inward = -Vec3(line.back().x(), line.back().y(), 0).normalized();
    const double angle = std::atan2(last.side.dot(last.tangent.cross(inward)), last.side.dot(inward));
    errors.push_back(std::abs(std::remainder(angle + total, 2 * pi)));
    for (std::size_t k = 1; k < frames.size(); ++k) {
      // As far as the tangent turns, and no further.
      const double turn = (frames[k].tangent - frames[k - 1].tangent).norm();
      EXPECT_LT((frames[k].side - frames[k - 1].side).norm(), 1.001 * turn);
      EXPECT_NEAR(frames[k].side.dot(frames[k].tangent), 0, 1e-15);
      EXPECT_NEAR(frames[k].side.norm(), 1, 1e-15);
    }
  }
  EXPECT_LT(errors[2], 1e-3);
  EXPECT_GT(errors[0] / errors[2], 14) << "of the second order of the tangents";
}

TEST(ParallelFrames, AStraightPartBetweenBendsTurnsNothing) {
  Line line = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(4, 0, 0), Vec3(4, 1, 1)};
  const std::vector<LineFrame> frames = parallel_frames(line, Vec3(0.3, 0.6, 0.8));
  for (int k = 0; k < 4; ++k) EXPECT_LT((frames[k].side - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
}

TEST(ParallelFrames, ALineThatMovesALittleTurnsItsFramesALittleWhereverItPoints) {
  Rng rng(1);
  const Line rest = straight(5, 1.0);
  const LineFrame first = parallel_frames(rest, Vec3::UnitY()).front();
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3 tangent = test::random_vector(rng, 1.0).normalized();
    if (tangent.x() < -0.9) continue;  // pointing back is where there is no least turn
    const auto side = [&](const Vec3& t) {
      Line line;
      for (int k = 0; k < 6; ++k) line.push_back(k * t);
      return parallel_frames(line, first).back().side;
    };
    const Vec3 nudged = (tangent + 1e-6 * test::random_vector(rng, 1.0)).normalized();
    // The frame turns about the tangent by at most tan(angle / 2) of the way.
    EXPECT_LT((side(nudged) - side(tangent)).norm(), 6 * (nudged - tangent).norm() + 1e-14);
  }
}

TEST(TubeMesh, TheSamePlacesGiveTheSameBits) {
  const Line line = sampled(12, helix);
  const TubeMesh tube = TubeMesh::create(line, 9).value(), again = TubeMesh::create(line, 9).value();
  const TubeMesh::Surface at = placed(tube, line, round(line, 1e-3));
  TubeMesh::Surface other = placed(again, straight(12, 1.0), round(line, 2e-3));  // whatever was there before
  again.place(line, round(line, 1e-3), other);
  EXPECT_EQ(at.positions, other.positions);
  EXPECT_EQ(at.normals, other.normals);
  EXPECT_EQ(tube.triangles(), again.triangles());
}

TEST(TubeMesh, NoLineOrTooFewSectorsAreRefused) {
  const Line point = {Vec3::Zero()}, stuck = {Vec3::Zero(), Vec3::Zero(), Vec3::UnitX()};
  for (const Line& line : {Line(), point, stuck})
    EXPECT_EQ(TubeMesh::create(line, 8).failure().kind, FailureKind::scenario);
  EXPECT_EQ(TubeMesh::create(straight(2, 1.0), 2).failure().kind, FailureKind::scenario);
}

}  // namespace
}  // namespace calot
