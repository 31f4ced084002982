#include "view/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "anatomy/organ_frame.h"
#include "view/surfaces.h"

namespace calot {
namespace {

constexpr double mm = 1e-3;
using std::numbers::pi;

double bump(double x, double width) { return std::exp(-x * x / (width * width)); }

/// A sum of waves of no common period, in [-1, 1]: broad lobes of an organ.
double lobes(double x, double y) {
  return (std::sin(x + 1.3 * std::sin(0.7 * y)) + std::sin(1.31 * y + 0.9 * std::sin(0.83 * x) + 2.1) +
          std::sin(0.71 * (x + y) + 4.0)) /
         3;
}

/// The liver's section across its margin, in (x, z) of the organ's frame, by arc length (m) from the margin's
/// foremost point; negative runs along the visceral surface, positive along the front.
class LiverSection {
 public:
  LiverSection() {
    // Curvature (1/m) by arc length, integrated both ways from the foremost point, where the surface faces
    // +z.
    for (int i = 0; i <= steps; ++i) {
      front_.push_back(advance(front_, i * step, +1));
      visceral_.push_back(advance(visceral_, i * step, -1));
    }
  }
  Vec2 at(double s) const {
    const auto& side = s < 0 ? visceral_ : front_;
    const double place = std::abs(s) / step;
    const int i = std::min(static_cast<int>(place), steps - 1);
    const double f = place - i;
    return side[i].place * (1 - f) + side[i + 1].place * f;
  }
  static constexpr int steps = 360;
  static constexpr double step = 0.5 * mm, length = steps * step;

 private:
  struct Sample {
    Vec2 place{0, 0};
    double angle = 0;  // of the normal from +z: towards +x on the front, towards -x on the visceral side
  };
  static double curvature(double s, double side) {
    if (side < 0) return s < 17 * mm ? 1 / (11 * mm) : 0.0;
    return s < 7 * mm ? 1 / (16 * mm) : s < 150 * mm ? 1 / (150 * mm) : 0.0;
  }
  static Sample advance(const std::vector<Sample>& done, double s, double side) {
    if (done.empty()) return {};
    Sample next = done.back();
    next.angle += curvature(s, side) * step;
    next.place += step * Vec2(side * std::cos(next.angle), -std::sin(next.angle));
    return next;
  }
  std::vector<Sample> front_, visceral_;
};

}  // namespace

SceneMesh cavity_wall(const Vec3& centre, Material material) {
  const Vec3 half(210 * mm, 230 * mm, 135 * mm);
  SceneMesh wall = sheet(material, 28, 20, [&](double u, double v) {
    const double a = 2 * pi * u, b = pi * v;  // runs so that its normals point inward, whence it is seen
    const Vec3 d(std::sin(b) * std::cos(a), std::sin(b) * std::sin(a), std::cos(b));
    const double fold = 1 + 0.04 * lobes(9 * d.x() + 3 * d.z(), 8 * d.y());
    return Vec3(centre + fold * d.cwiseProduct(half));
  });
  return wall;
}

SceneMesh liver_mesh(const OrganDefinition& organ) {
  const OrganExtent extent = organ_extent(organ);
  const LiverSection section;
  const double bed = 0.62 * extent.radius;       // x of the visceral surface at the fossa
  const double margin = 0.80 * extent.length;    // z of the margin at the fossa
  const double foot = section.at(-20 * mm).x();  // x of the visceral plane in the section
  SceneMesh mesh = sheet(Material::liver, 40, 44, [&](double u, double v) {
    const double across = (160 - 260 * u) * mm;  // towards the patient's right
    // Rows are denser at the margin.
    const double t = 2 * v - 1, s = (0.2 * t + 0.8 * t * t * t) * LiverSection::length;
    const Vec2 p = section.at(s);
    const double visceral = 0.5 - 0.5 * std::tanh(p.x() / (10 * mm));
    const double fossa = bump(across, 1.25 * extent.radius);
    double x = bed + (p.x() - foot) - (1 - fossa) * visceral * 0.55 * extent.radius;
    double z = margin + p.y() + 6 * mm * lobes(across / (22 * mm), 1.0) - 6 * mm * fossa +
               7 * mm * (1 - bump(across, 60 * mm));
    const double right = std::max(across, 0.0), left = std::min(across, 0.0);
    x += left * left / 0.9 - right * right / 1.2;  // the margin rises to the patient's left
    z += 0.45 * across;                            // and comes down along the costal margin to the right
    const double swell = 1.5 * mm * lobes(across / (15 * mm), s / (13 * mm));
    return Vec3(x + swell * (1 - fossa), across, z + 0.4 * swell);
  });
  move(mesh, organ_frame(organ));
  return mesh;
}

std::vector<SceneMesh> abdomen_meshes(const OrganDefinition& organ) {
  const Pose frame = organ_frame(organ);
  const OrganExtent extent = organ_extent(organ);
  const Vec3 neck = organ.neck, middle = frame * Vec3(0, 0, 0.5 * extent.length);
  SceneMesh omentum = sheet(Material::fat, 36, 36, [&](double u, double v) {
    const auto spread = [](double t) {
      return (0.45 * t + 0.55 * t * t * t) * 190 * mm;
    };  // denser in the middle
    const double x = spread(2 * u - 1), y = spread(2 * v - 1);
    double z = neck.z() - 16 * mm - middle.z();
    z += 7 * mm * lobes(x / (19 * mm), y / (17 * mm)) + 2.6 * mm * lobes(x / (4.5 * mm) + 3, y / (5 * mm));
    z += 29 * mm * bump((middle + Vec3(x, y, 0) - neck).head<2>().norm(), 24 * mm);  // fat around the neck
    z += 16 * mm * bump(y + 75 * mm, 45 * mm);  // transverse colon under the omentum
    z += 0.35 * std::max(0.0, std::hypot(x, y) - 120 * mm);
    return Vec3(middle + Vec3(x, y, z));
  });
  // The duodenum crosses below the neck, medially.
  SceneMesh duodenum = sheet(Material::peritoneum, 24, 16, [&](double u, double v) {
    const double a = 2 * pi * v, t = 2 * u - 1;
    const double radius = (15 + 1.6 * std::sin(9 * t) + 0.9 * std::sin(23 * t + 1)) * mm;
    const Vec3 line = neck + Vec3((28 + 70 * t) * mm, (-16 + 14 * t * t) * mm, (-19 - 6 * t * t) * mm);
    return Vec3(line + radius * Vec3(0.1 * std::cos(a), std::cos(a), std::sin(a)));
  });
  return {duodenum, omentum, cavity_wall(middle + Vec3(40 * mm, -20 * mm, -30 * mm), Material::peritoneum)};
}

SceneMesh plane_mesh(const Vec3& point, const Vec3& normal, const Vec3& about, Material material) {
  const Vec3 n = normal.normalized(), a = n.unitOrthogonal(), b = n.cross(a);
  const Vec3 foot = about - n * n.dot(about - point);
  return sheet(material, 36, 36, [&](double u, double v) {
    const double x = (2 * u - 1) * 200 * mm, y = (2 * v - 1) * 200 * mm;
    // Flat where the organ lies, for contact must look like contact; wavy further out.
    const double wave =
        material == Material::board ? 0 : 4 * mm * lobes(x / (23 * mm), y / (20 * mm)) - 4 * mm;
    return Vec3(foot + x * a + y * b + n * wave * (1 - bump(std::hypot(x, y), 70 * mm)));
  });
}

SceneMesh bowel_mesh(const GroundDefinition& capsule) {
  const Vec3 way = capsule.to - capsule.point;
  const double radius = capsule.radius, length = way.norm(), whole = length + pi * radius;
  const Vec3 axis = length > 0 ? way.normalized() : Vec3::UnitZ(), a = axis.unitOrthogonal(),
             b = axis.cross(a);
  SceneMesh mesh = sheet(Material::bowel, 40, 80, [&](double u, double v) {
    // By the way along it, so that the folds are met by enough rows.
    const double lon = 2 * pi * u, s = v * whole, cap = 0.5 * pi * radius;
    const double at = std::clamp(s - cap, 0.0, length);
    const double angle = s < cap ? s / radius : s > cap + length ? (s - length) / radius : 0.5 * pi;
    const double phase =
        s / (1.5 * radius) + 0.35 * std::sin(s / (2.7 * radius)) + 0.25 * std::sin(2 * lon + 1.0);
    const double fold = 1 - 0.11 * std::pow(std::cos(pi * phase), 8) * std::sin(angle);
    const Vec3 out = std::sin(angle) * (std::cos(lon) * a + std::sin(lon) * b);
    return Vec3(capsule.point + at * axis + radius * (fold * out - std::cos(angle) * axis));
  });
  for (Vec3& p : mesh.rest_positions) {
    const Vec3 from = p - capsule.point;
    p = Vec3(from.dot(a), from.dot(b), from.dot(axis));
  }
  return mesh;
}

SceneMesh ground_mesh(const GroundDefinition& ground, const Vec3& about, Material material) {
  if (ground.type == GroundType::plane) return plane_mesh(ground.point, ground.normal, about, material);
  if (material == Material::bowel) return bowel_mesh(ground);
  // A capsule is swept, a box grown along the same directions: of a sheet over the sphere around both.
  const bool box = ground.type == GroundType::box;
  const Vec3 along = ground.to - ground.point, axis = along.norm() > 0 ? along.normalized() : Vec3::UnitZ();
  const Vec3 a = box ? Vec3::UnitX() : axis.unitOrthogonal(), b = box ? Vec3::UnitY() : axis.cross(a);
  const Vec3 c = box ? Vec3::UnitZ() : axis;
  return sheet(material, 64, 48, [&](double u, double v) {
    const double lon = 2 * pi * u, lat = pi * v;  // runs so that its normals point outward
    const Vec3 d(std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat));
    const Vec3 out = ground.radius * (d.x() * a + d.y() * b + d.z() * c);
    if (!box) return Vec3((d.z() > 0 ? ground.to : ground.point) + out);
    const Vec3 corner = 0.5 * ground.size.cwiseProduct(d.cwiseSign());
    return Vec3(ground.point + corner + out);
  });
}

}  // namespace calot
