#pragma once
// Two bodies with strands between them, moved by their masses.

#include "body/inertia.h"
#include "body/rigid_body.h"
#include "body/tissue_body.h"
#include "geometry/solid_surface.h"
#include "group_rig.h"
#include "joins/skin_place.h"
#include "joins/strand_join.h"

namespace calot::test {

/// What a tissue of a kind is, by area.
struct TestTissue {
  double length = 1e-3;       ///< m
  double stiffness = 50e3;    ///< Pa
  double strength = 100e3;    ///< Pa
  double break_energy = 100;  ///< J/m^2
};

struct StrandRig : GroupRig {
  std::shared_ptr<StrandJoin> strands;
  std::vector<double> opened;

  /// From body 0 to body 1 at `places`, m, each for `area`, m^2: taut as they are. Instruments feel them by `radius`, m.
  StrandRig(const std::vector<BodyPointer>& of, const TestTissue& tissue, const std::vector<Vec3>& at,
            double area, double radius = 0)
      : StrandRig(made(of, tissue, at, area, radius)) {}

  /// A step of implicit Euler of `h` s; 0: a rest.
  NewtonResult step(double h, double tolerance = 1e-6) {
    strands->set_past(opened, h);
    for (One& one : bodies) {
      if (h == 0) continue;
      one.state.motion = motion_part(*one.body, present_motion(*one.body, one.state), h).value();
      one.state.motion.duration = h;
      one.loads.inertia = std::make_shared<const Inertia>(*one.body, one.state, 5e-3);
      one.state.x += h * one.state.motion.begin.velocity;
    }
    const NewtonResult result = settle(tolerance);
    const std::vector<double> strains = strands->strains(x());
    for (std::size_t i = 0; i < opened.size(); ++i) opened[i] = std::max(opened[i], strains[i]);
    return result;
  }
  std::size_t torn() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < opened.size(); ++i)
      count += strands->strands()[i].strand.law.torn(opened[i]) ? 1 : 0;
    return count;
  }

 private:
  struct Made {
    std::vector<BodyPointer> bodies;
    std::shared_ptr<StrandJoin> join;
  };
  static Made made(const std::vector<BodyPointer>& of, const TestTissue& tissue,
                   const std::vector<Vec3>& places_of, double area, double radius) {
    std::vector<PlacedStrand> strands;
    TissueBody::Setup middle;
    middle.strength = tissue.strength * area;
    const SkinFinder first(*of[0], of[0]->skin_rest()), second(*of[1], of[1]->skin_rest());
    for (const Vec3& at : places_of) {
      const NearestSkin one = first.nearest(at), other = second.nearest(at);
      StrandLaw::Setup setup;
      setup.taut = one.distance + other.distance;
      setup.length = tissue.length;
      setup.stiffness = tissue.stiffness * area;
      setup.strength = tissue.strength * area;
      setup.break_energy = tissue.break_energy * area;
      const StrandLaw law = StrandLaw::create(setup).value();
      strands.push_back({{law}, one.place, other.place, strand_thread(law, radius), area});
      middle.nodes.push_back(at);
      middle.masses.push_back(1000 * area * tissue.length);
    }
    Made out{of, std::make_shared<StrandJoin>(std::array{0, 1}, std::move(strands))};
    out.join->set_nodes(2);
    out.bodies.push_back(std::make_shared<const TissueBody>(middle));
    return out;
  }
  explicit StrandRig(const Made& from)
      : GroupRig(from.bodies), strands(from.join), opened(from.join->strands().size(), 0.0) {
    joins.push_back(from.join);
  }
};

inline BodyPointer plate(const Vec3& size, const Vec3& centre) {
  RigidBody::Setup setup;
  setup.surface = rounded_box(size, 2e-3, centre, 6e-3);
  setup.density = 1000;
  return std::make_shared<const RigidBody>(RigidBody::create(setup).value());
}

/// Springs from all skin points of a body to where they are at rest, moved by `way`, m; together as stiff as
/// `stiffness`, N/m.
inline void carry(GroupRig& rig, int body, const Vec3& way, double stiffness) {
  auto& one = rig.bodies[body];
  one.loads.grip = {};
  const std::vector<Vec3>& skin = one.body->skin_rest();
  for (std::size_t row = 0; row < skin.size(); ++row)
    rig.hold(body, static_cast<int>(row), skin[row] + way, stiffness / static_cast<double>(skin.size()));
}

}  // namespace calot::test
