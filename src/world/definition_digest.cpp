#include "world/definition_digest.h"

#include "base/digest.h"

namespace calot {
namespace {

/// Every struct is taken apart by all of its members: one that gets another member is an error here until that is named.
class DefinitionDigest {
 public:
  std::string hex() const { return digest_.hex(); }

  template <class... Each>
  void put_all(const Each&... each) {
    (put(each), ...);
  }

  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void put(T value) { digest_.add(value); }
  void put(const std::string& text) { digest_.add(std::string_view(text)); }
  void put(const Vec3& p) { digest_.add(std::span<const double>(p.data(), 3)); }
  void put(const VecX& x) {
    digest_.add(std::span<const double>(x.data(), static_cast<std::size_t>(x.size())));
  }
  void put(const Triangle& t) { digest_.add(std::span<const int>(t.data(), 3)); }
  template <class T>
  void put(const std::vector<T>& list) {
    put(list.size());
    for (const T& each : list) put(each);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    put(value.index());
    std::visit([&](const auto& held) { put(held); }, value);
  }

  void put(const SphereShape& d) {
    const auto& [radius] = d;
    put(radius);
  }
  void put(const PearShape& d) {
    const auto& [length, width, refine, refine_radius] = d;
    put_all(length, width, refine, refine_radius);
  }
  void put(const SweptStation& d) {
    const auto& [at, radius, refine] = d;
    put_all(at, radius, refine);
  }
  void put(const SweptShape& d) {
    const auto& [along] = d;
    put(along);
  }
  void put(const MeshFile& d) {
    const auto& [path, scale] = d;
    put_all(path, scale);
  }
  void put(const TubeShape& d) {
    const auto& [points, radius, end_radius, nodes, pressure, patient_end, carries, feed_pressure,
                 feed_resistance, radii] = d;
    put_all(points, radius, end_radius, nodes, pressure, patient_end, carries, feed_pressure, feed_resistance,
            radii);
  }
  void put(const RigidShape& d) {
    const auto& [size, rounding, centre, density, stiffness] = d;
    put_all(size, rounding, centre, density, stiffness);
  }
  void put(const LobeShape& d) {
    const auto& [width, depth, thickness, edge, edge_angle, overhang, bed_length, bed_width, bed_depth, young,
                 poisson, density, sags, hold] = d;
    put_all(width, depth, thickness, edge, edge_angle, overhang, bed_length, bed_width, bed_depth, young,
            poisson, density, sags, hold);
  }
  void put(const FibreDefinition& d) {
    const auto& [stiffness, stiffening, angle] = d;
    put_all(stiffness, stiffening, angle);
  }
  void put(const WallDefinition& d) {
    const auto& [thickness, shear_modulus, stiffening, fibres, overstretch, perforation_stretch, pinch_limit,
                 burn_energy, density, retardation] = d;
    put_all(thickness, shear_modulus, stiffening, fibres, overstretch, perforation_stretch, pinch_limit,
            burn_energy, density, retardation);
  }
  void put(const BileDefinition& d) {
    const auto& [density, fill_volume, fill_pressure] = d;
    put_all(density, fill_volume, fill_pressure);
  }
  void put(const HeldRegion& d) {
    const auto& [name, landmark, radius, stiffness, while_filled] = d;
    put_all(name, landmark, radius, stiffness, while_filled);
  }
  void put(const InjuryDefinition& d) {
    const auto& [cut, closed, partly, unclipped, near_start, together] = d;
    put_all(cut, closed, partly, unclipped, near_start, together);
  }
  void put(const InjuryNearStart& d) {
    const auto& [within, called] = d;
    put_all(within, called);
  }
  void put(const InjuryTogether& d) {
    const auto& [with, called] = d;
    put_all(with, called);
  }
  void put(const OrganDefinition& d) {
    const auto& [name, shape, nodes, neck, fundus, liver_side, wall, bile, held, looks, extensions,
                 compared_with, injury, keep_clear, vessels] = d;
    put_all(name, shape, nodes, neck, fundus, liver_side, wall, bile, held, looks, extensions, compared_with,
            injury, keep_clear, vessels);
  }
  void put(const WallVessel& d) {
    const auto& [points, radius] = d;
    put_all(points, radius);
  }
  void put(const JointDefinition& d) {
    const auto& [from, to, radius, stiffness] = d;
    put_all(from, to, radius, stiffness);
  }
  void put(const TissueDefinition& d) {
    const auto& [name, from, to, within, start, stop, strands, slack, stiffness, stiffening, strength,
                 break_energy, density, radius, divide_energy, covered] = d;
    put_all(name, from, to, within, start, stop, strands, slack, stiffness, stiffening, strength,
            break_energy, density, radius, divide_energy, covered);
  }
  void put(const GroundDefinition& d) {
    const auto& [name, type, point, normal, to, size, radius, friction, looks] = d;
    put_all(name, type, point, normal, to, size, radius, friction, looks);
  }
  void put(const SupportDefinition& d) {
    const auto& [point, normal, friction] = d;
    put_all(point, normal, friction);
  }
  void put(const AnatomyDefinition& d) {
    const auto& [organs, joints, tissue, ground, support, friction, rest_within, heart_rate, table_head_up,
                 table_left_down] = d;
    put_all(organs, joints, tissue, ground, support, friction, rest_within, heart_rate, table_head_up,
            table_left_down);
  }
  void put(const SolverDefinition& d) {
    const auto& [rate, motion, tolerance, extension_levels, extension_scheme, extension_view, skip_still] = d;
    put_all(rate, motion, tolerance, extension_levels, extension_scheme, extension_view, skip_still);
  }

 private:
  Digest digest_;
};

}  // namespace

std::string rest_key(const SceneDefinition& scene, const Field& field) {
  DefinitionDigest digest;
  digest.put_all(std::string("rest state"), scene.anatomy, scene.solver);
  for (const Organ& organ : field.organs)
    digest.put_all(organ.body->rest(), organ.body->skin().triangles, organ.body->skin_rest(), organ.state.x,
                   organ.state.datum_pressure, organ.state.volume);
  for (const Tissue& tissue : field.tissues)
    digest.put_all(tissue.body->rest(), tissue.now.state.x, tissue.now.opened);
  return digest.hex();
}

}  // namespace calot
