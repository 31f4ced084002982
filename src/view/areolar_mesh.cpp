#include "view/areolar_mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "view/scatter.h"

namespace calot {
namespace {

// All (d), by eye.
constexpr double thin_fibre = 0.09e-3, thick_fibre = 0.20e-3;  // m, radii of fibres
constexpr double rooted = 0.3e-3;                              // m, of a fibre that is inside the wall
constexpr double longest_stump = 3.2e-3;                       // m
constexpr int fibre_sides = 3;

struct FibreDetail {
  int fibres, pieces;  ///< of a strand; of a fibre
  bool full;           ///< with links between strands, and drops
  double thicker;      ///< share, so that no pixel of a picture of that detail misses a fibre
};
FibreDetail fibre_detail(SceneDetail detail) {
  return detail == SceneDetail::coarse ? FibreDetail{3, 4, false, 1.8} : FibreDetail{6, 8, true, 1};
}

/// What a fibre's surface shows beside its form.
struct FibreLook {
  double taut = 0;                        ///< 0: slack, 1: as it is about to tear
  double burnt_ends = 0, burnt_amid = 0;  ///< shares
  double radius = thin_fibre;             ///< m
  std::size_t strand = 0;                 ///< where in the pattern it is
  bool tapers = false;                    ///< its last end hangs free
};

/// Chance of one fibre.
struct Chance {
  std::size_t strand;
  int fibre;
  double operator()(int which) const { return share_of(strand, fibre, which); }
  double both_ways(int which) const { return 2 * (*this)(which)-1; }
};

Vec3 across(const Vec3& along, double turn) {
  const Vec3 side = along.unitOrthogonal();
  return std::cos(turn) * side + std::sin(turn) * along.cross(side);
}

/// A prism with rounded normals along a path; thicker where it takes root.
void add_fibre(std::span<const Vec3> path, const FibreLook& look, SceneMesh& out) {
  const auto last = static_cast<int>(path.size()) - 1;
  Vec3 side = (path[1] - path[0]).unitOrthogonal();
  const int first = static_cast<int>(out.positions.size());
  const double pattern = 3.7e-3 * static_cast<double>(look.strand % 23);
  for (int k = 0; k <= last; ++k) {
    const double t = static_cast<double>(k) / last, ends = std::abs(2 * t - 1);
    const Vec3 way = path[std::min(k + 1, last)] - path[std::max(k - 1, 0)];
    const Vec3 along = way.norm() > 0 ? Vec3(way.normalized()) : side.unitOrthogonal();
    side = (side - along * along.dot(side)).normalized();
    const bool free_end = look.tapers && t > 0.5;
    const double wide = look.radius * (free_end ? 1.4 - 0.8 * t : 1 + 1.2 * ends * ends * ends * ends);
    const double amid = look.tapers ? t : 1 - ends;
    for (int s = 0; s < fibre_sides; ++s) {
      const double turn = 2 * std::numbers::pi * s / fibre_sides;
      const Vec3 normal = std::cos(turn) * side + std::sin(turn) * along.cross(side);
      out.positions.emplace_back(path[static_cast<std::size_t>(k)] + wide * normal);
      out.normals.push_back(normal);
      out.rest_positions.emplace_back(pattern + 4e-3 * t, pattern * 0.6 + 0.3e-3 * s, 1e-3 * look.taut);
      out.burnt.push_back(look.burnt_ends + amid * (look.burnt_amid - look.burnt_ends));
      if (k == last) continue;
      const int a = first + k * fibre_sides + s, b = first + k * fibre_sides + (s + 1) % fibre_sides;
      out.triangles.push_back({a, b, a + fibre_sides});
      out.triangles.push_back({b, b + fibre_sides, a + fibre_sides});
    }
  }
}

/// A film between two fibres of as many points (an odd number: every other one is enough), both of its sides.
void add_film(std::span<const Vec3> one, std::span<const Vec3> other, const FibreLook& look, SceneMesh& out) {
  const double pattern = 5.3e-3 * static_cast<double>(look.strand % 19);
  const int last = (static_cast<int>(one.size()) - 1) / 2;
  for (const int sign : {1, -1}) {
    const int first = static_cast<int>(out.positions.size());
    for (int k = 0; k <= last; ++k) {
      const auto at = 2 * static_cast<std::size_t>(k);
      const Vec3 along = k < last ? Vec3(one[at + 2] - one[at]) : Vec3(one[at] - one[at - 2]),
                 over = other[at] - one[at];
      const Vec3 normal = along.cross(over);
      const double t = static_cast<double>(k) / last;
      for (const double side : {0.0, 1.0}) {
        out.positions.emplace_back(one[at] + side * over);
        out.normals.emplace_back(sign * (normal.norm() > 0 ? Vec3(normal.normalized()) : Vec3::UnitZ()));
        out.rest_positions.emplace_back(pattern + 4e-3 * t, 1.5e-3 * side, 1e-3 * look.taut);
        out.burnt.push_back(look.burnt_ends +
                            (1 - std::abs(2 * t - 1)) * (look.burnt_amid - look.burnt_ends));
      }
      if (k == last) continue;
      const int a = first + 2 * k, b = a + 1;  // `along` from a to a + 2, `over` from a to b
      for (const Triangle& t3 : {Triangle{a, a + 2, b}, Triangle{b, a + 2, b + 2}})
        out.triangles.push_back(sign > 0 ? t3 : Triangle{t3[0], t3[2], t3[1]});
    }
  }
}

/// What lies on a fibre of that look, m thick: a drop of fluid, or a lobule of fat.
void add_bead(const Vec3& at, const FibreLook& look, bool fat, SceneMesh& out) {
  constexpr int around = 6, rows = 4;
  const double pattern = 3.7e-3 * static_cast<double>(look.strand % 23);
  const int first = static_cast<int>(out.positions.size());
  for (int r = 0; r <= rows; ++r)
    for (int k = 0; k < around; ++k) {
      const double up = std::numbers::pi * r / rows, turn = 2 * std::numbers::pi * k / around;
      const Vec3 normal(std::sin(up) * std::cos(turn), std::sin(up) * std::sin(turn), std::cos(up));
      out.positions.emplace_back(at + look.radius * normal);
      out.normals.push_back(normal);
      out.rest_positions.emplace_back(pattern + look.radius * normal.x(), look.radius * normal.y(),
                                      fat ? -1e-3 : 0.5e-3);
      out.burnt.push_back(look.burnt_amid);
    }
  for (int r = 0; r < rows; ++r)
    for (int k = 0; k < around; ++k) {
      const int a = first + r * around + k, b = first + r * around + (k + 1) % around;
      out.triangles.push_back({a, a + around, b});
      out.triangles.push_back({b, a + around, b + around});
    }
}

/// The strands that begin nearest to each at rest: its fibres spread towards these, and so stay on the walls.
constexpr std::size_t neighbours_each = 4;
using Neighbours = std::vector<std::array<std::size_t, neighbours_each>>;

Neighbours neighbours_of(const Tissue& tissue, const std::vector<Organ>& organs) {
  const std::vector<PlacedStrand>& strands = tissue.strands->strands();
  const std::vector<Vec3>& skin =
      organs[static_cast<std::size_t>(tissue.strands->bodies()[0])].body->skin_rest();
  std::vector<Vec3> begins;
  for (const PlacedStrand& strand : strands) begins.push_back(carried_to(strand.one, skin));
  Neighbours out(strands.size());
  std::vector<std::pair<double, std::size_t>> by_distance(strands.size());
  for (std::size_t k = 0; k < strands.size(); ++k) {
    for (std::size_t i = 0; i < strands.size(); ++i)
      by_distance[i] = {(begins[i] - begins[k]).squaredNorm(), i};
    const std::size_t count = std::min(neighbours_each + 1, strands.size());
    std::partial_sort(by_distance.begin(), by_distance.begin() + static_cast<long>(count), by_distance.end());
    for (std::size_t n = 0; n < neighbours_each; ++n)
      out[k][n] = by_distance[std::min(n + 1, count - 1)].second;
  }
  return out;
}

/// The fibres of one tissue.
class AreolarFibres {
 public:
  AreolarFibres(const Tissue& tissue, const std::vector<Organ>& organs, std::size_t first_strand,
                SceneDetail detail, AreolarMeshes& out)
      : tissue_(tissue),
        lines_(strand_lines(tissue, organs)),
        neighbours_(neighbours_of(tissue, organs)),
        first_(first_strand),
        detail_(fibre_detail(detail)),
        out_(out) {}

  void add() {
    for (std::size_t k = 0; k < lines_.size(); ++k)
      if (tissue_.torn(k))
        add_stumps(k);
      else
        add_whole(k);
    for (std::size_t k = 0; detail_.full && k < lines_.size(); ++k) add_link(k);
  }

 private:
  const PlacedStrand& strand(std::size_t k) const { return tissue_.strands->strands()[k]; }
  const StrandLaw& law(std::size_t k) const { return strand(k).strand.law; }
  double spacing(std::size_t k) const { return std::sqrt(strand(k).area); }
  double heat(std::size_t k) const { return tissue_.heated_share(k); }
  double way(std::size_t k) const {
    const StrandLine& line = lines_[k];
    return (line.by - line.from).norm() + (line.to - line.by).norm();
  }
  /// 0: slack; 1: it begins to tear.
  double tautness(std::size_t k) const { return std::clamp(law(k).strain(way(k)) / law(k).peak(), 0.0, 1.0); }
  /// Where a fibre takes root: on the wall between its strand's end and a neighbour's.
  Vec3 root(std::size_t k, const Chance& chance, bool first) const {
    const auto n = static_cast<std::size_t>(chance(first ? 0 : 1) * neighbours_each);
    const StrandLine &own = lines_[k], &other = lines_[neighbours_[k][n]];
    const Vec3 &at = first ? own.from : own.to, to = (first ? other.from : other.to) - at;
    // No farther than its own area goes, though the wall has been stretched.
    return at + chance(first ? 2 : 3) * std::min(0.8, spacing(k) / std::max(to.norm(), 1e-6)) * to;
  }

  void add_whole(std::size_t k) {
    const double taut = tautness(k), hot = heat(k);
    std::vector<std::vector<Vec3>> paths;
    for (int fibre = 0; fibre < detail_.fibres; ++fibre) {
      const Chance chance{first_ + k, fibre};
      const std::vector<Vec3>& path = paths.emplace_back(whole_path(k, chance));
      add_fibre(path, {taut, 0.4 * hot, hot, radius(chance) * (1 - 0.35 * taut), first_ + k}, out_.fibres);
      const double bead = chance(11);
      if (!detail_.full || bead > 0.16) continue;
      const bool fat = bead < 0.06;
      const double thick = (fat ? 0.55e-3 : 0.28e-3) * (0.7 + 0.6 * chance(12));
      add_bead(path[path.size() / 2], {taut, hot, hot, thick, first_ + k}, fat, out_.fibres);
    }
    for (std::size_t i = 1; i < paths.size(); ++i)
      add_film(paths[i - 1], paths[i], {taut, 0.4 * hot, hot, 0, first_ + k + 7 * i}, out_.films);
  }

  std::vector<Vec3> whole_path(std::size_t k, const Chance& chance) const {
    const StrandLine& line = lines_[k];
    Vec3 a = root(k, chance, true), b = root(k, chance, false);
    const Vec3 along = (b - a).norm() > 0 ? Vec3((b - a).normalized()) : Vec3::UnitZ();
    a -= rooted * along;
    b += rooted * along;
    const double taut = tautness(k),
                 slack = std::max(
                     0.0, law(k).setup().taut * (1.05 + 0.5 * chance(4)) / std::max(way(k), 1e-6) - 1);
    const Vec3 amid = line.by + (0.15 + 0.45 * (1 - taut)) * spacing(k) * chance.both_ways(5) *
                                    across(along, 6 * chance(6));
    const Vec3 pull = 2 * amid - 0.5 * (a + b);
    // The height of waves that make a way longer by this share.
    const double waves = 1 + 1.5 * chance(7), long_way = (b - a).norm();
    const double high = std::min(0.25 * long_way, long_way / (std::numbers::pi * waves) * std::sqrt(slack));
    const Vec3 aside = high * across(along, 6 * chance(8));
    std::vector<Vec3> path;
    for (int p = 0; p <= detail_.pieces; ++p) {
      const double t = static_cast<double>(p) / detail_.pieces, s = 1 - t;
      const double wave =
          std::sin(2 * std::numbers::pi * (waves * t + chance(9))) * std::sin(std::numbers::pi * t);
      path.emplace_back(s * s * a + 2 * s * t * pull + t * t * b + wave * aside);
    }
    return path;
  }

  void add_stumps(std::size_t k) {
    for (int fibre = 0; fibre < detail_.fibres; ++fibre)
      for (const bool first : {true, false}) add_stump(k, {first_ + k, fibre}, first);
  }
  /// What is left on a wall: it has drawn back and curls.
  void add_stump(std::size_t k, const Chance& chance, bool first) {
    const StrandLine& line = lines_[k];
    const Vec3 out = (first ? 1 : -1) * (line.to - line.from);
    const Vec3 along = out.norm() > 0 ? Vec3(out.normalized()) : Vec3::UnitZ();
    const Vec3 begin = root(k, chance, first) - rooted * along;
    const double much = chance(first ? 13 : 14);
    const double long_way =
        rooted + std::min(law(k).setup().taut * (0.25 + 0.5 * much), longest_stump * (0.4 + 0.6 * much));
    const double curls = 0.6 + 1.8 * chance(first ? 15 : 16);
    const Vec3 aside = across(along, 6 * chance(first ? 17 : 18));
    std::vector<Vec3> path;
    for (int p = 0; p <= detail_.pieces / 2; ++p) {
      const double turned = curls * 2 * p / detail_.pieces;
      path.emplace_back(begin +
                        long_way / curls * (std::sin(turned) * along + (1 - std::cos(turned)) * aside));
    }
    const double hot = heat(k);
    add_fibre(path, {0.3, 0.3 * hot, hot, 1.2 * radius(chance), first_ + k, true}, out_.fibres);
  }

  /// From the middle of a strand to that of a neighbour, while neither is torn nor far off.
  void add_link(std::size_t k) {
    const Chance chance{first_ + k, detail_.fibres};
    const std::size_t other = neighbours_[k][static_cast<std::size_t>(chance(0) * neighbours_each)];
    const Vec3 a = lines_[k].at(0.25 + 0.5 * chance(1)), b = lines_[other].at(0.25 + 0.5 * chance(2));
    if (tissue_.torn(k) || tissue_.torn(other) || (b - a).norm() > 2.5 * spacing(k) || a == b) return;
    const Vec3 sag = 0.15 * (b - a).norm() * across((b - a).normalized(), 6 * chance(3));
    std::vector<Vec3> path;
    for (int p = 0; p <= detail_.pieces / 2; ++p) {
      const double t = 2.0 * p / detail_.pieces;
      path.emplace_back(a + t * (b - a) + 4 * t * (1 - t) * sag);
    }
    add_fibre(path, {std::max(tautness(k), tautness(other)), heat(k), heat(other), thin_fibre, first_ + k},
              out_.fibres);
  }

  double radius(const Chance& chance) const {
    return detail_.thicker * (thin_fibre + (thick_fibre - thin_fibre) * chance(10) * chance(10));
  }

  const Tissue& tissue_;
  std::vector<StrandLine> lines_;
  Neighbours neighbours_;
  std::size_t first_;
  FibreDetail detail_;
  AreolarMeshes& out_;
};

}  // namespace

void add_areolar(const Tissue& tissue, const std::vector<Organ>& organs, std::size_t first_strand,
                 SceneDetail detail, AreolarMeshes& out) {
  AreolarFibres(tissue, organs, first_strand, detail, out).add();
}

}  // namespace calot
