#pragma once
// The kinds of bodies: a row and a file each. Keys and limits of their definitions stand in anatomy/scene_keys.cpp.
//
// A new kind is a class (body/body.h), a row with what makes it of its definition, and, to be named in scenarios, a
// shape of its own in OrganShape. What the definition's shape alone decides is asked of that: is_hollow(), what events
// call a cut (acts/jaw_acts.cpp), and how it is drawn (room view).

#include <atomic>
#include <cstdint>

#include "base/kept_results.h"
#include "organs/organ.h"

namespace calot {

/// What bringing all organs of a scene to rest may take, used up as they are.
struct FillingLimits {
  const std::atomic<bool>* stop = nullptr;  ///< where it is true the filling ends; may be null
  /// Newton iterations times nodes; the most that half a minute is sure to do.
  std::int64_t node_iterations = 200'000;
  bool sinks = false;  ///< what has no rest otherwise sinks until something holds it (equilibrium.h)
};

/// Where an organ comes to rest.
struct OrganSetting {
  const ContactLoads& loads;  ///< the ground
  Vec3 up = Vec3::UnitZ();
  double tolerance = 1e-6;
  int levels = 0;                   ///< of structural extensions that may refine it
  FillingLimits* limits = nullptr;  ///< may be null
  KeptResults* kept = nullptr;      ///< as of World::create
  /// Only to be looked at: where it is drawn, in ground or not, and empty.
  bool only_drawn = false;
};

struct BodyKind {
  const char* shape;  ///< its name in a scene, in the order of OrganShape
  /// Builds the organ, but for its landmarks (Body::landmarks), and brings it to rest where it can be in equilibrium
  /// alone. Failures: scenario (a definition that cannot be built), simulation (no rest state found), resource or
  /// interrupted (`limits`); see at_organ.
  Result<RestedOrgan> (*make)(const OrganDefinition& definition, const OrganSetting& setting);
  /// Its body held by what is `left` of the regions of its definition, all but the one at `released`. Null: it is not held.
  Result<BodyPointer> (*released)(const Organ& organ, const std::vector<HeldRegion>& left,
                                  std::size_t released) = nullptr;
};
const std::vector<BodyKind>& body_kinds();

Result<RestedOrgan> make_organ(const BodyKind& kind, const OrganDefinition& definition,
                               const OrganSetting& setting);
/// Of the kind that its shape names.
Result<RestedOrgan> make_organ(const OrganDefinition& definition, const ContactLoads& loads, const Vec3& up,
                               double tolerance, int levels = 0, FillingLimits* limits = nullptr,
                               KeptResults* kept = nullptr);

/// Fails (scenario) where an organ at rest is inside the ground.
std::optional<Failure> check_clear_of_ground(const Body& body, const ContactLoads& loads);
/// An organ of what is not solved for alone, where it was drawn. Its skin does not meet itself. Failures of the body
/// are of its shape.
template <class Kind>
Result<RestedOrgan> organ_as_drawn(const OrganDefinition& definition, Result<Kind> body,
                                   const OrganSetting& setting) {
  if (!body) {
    Failure failure = body.failure();
    for (Problem& problem : failure.problems) problem.place = {"", 0, ".shape"};
    return failure;
  }
  const auto drawn = std::make_shared<const Kind>(std::move(body).value());
  if (!setting.only_drawn)
    if (std::optional<Failure> failure = check_clear_of_ground(*drawn, setting.loads)) return *failure;
  RestedOrgan made{Organ(definition, drawn), NewtonWorkspace(drawn->pattern())};
  made.organ.search.own.active = false;
  return made;
}

/// Problems of a mesh know no organ: what is wrong in a file stays there, the rest is the shape's.
Failure of_organ(Failure failure, const OrganDefinition& definition);
/// The surface of a rigid thing where it begins, m. Fails (scenario) where its file holds none that can be touched.
Result<TriMesh> rigid_surface(const OrganDefinition& definition);
/// What is wrong with the scene's mesh files, each with organ and field; nothing is solved for.
std::vector<Problem> mesh_problems(const SceneDefinition& scene);

/// What an author should know of them, a line each: points that are left out, as no triangle uses them.
std::vector<std::string> mesh_remarks(const SceneDefinition& scene);

Result<RestedOrgan> make_hollow_organ(const OrganDefinition& definition, const OrganSetting& setting);
/// Takes away a region that an organ is held by, and leaves it where it is. Fails (scenario) where it has none of that name.
Result<bool> release_held(Organ& organ, const std::string& held);
Result<BodyPointer> released_hollow_organ(const Organ& organ, const std::vector<HeldRegion>& left,
                                          std::size_t released);
Result<BodyPointer> released_tube(const Organ& organ, const std::vector<HeldRegion>& left,
                                  std::size_t released);
Result<BodyPointer> released_lobe(const Organ& organ, const std::vector<HeldRegion>& left,
                                  std::size_t released);
/// Takes away what held an organ only while it was filled, and leaves it where it is; whether there was any.
Result<bool> release_filled(Organ& organ);
Result<RestedOrgan> make_tube(const OrganDefinition& definition, const OrganSetting& setting);
Result<RestedOrgan> make_rigid_organ(const OrganDefinition& definition, const OrganSetting& setting);
Result<RestedOrgan> make_lobe(const OrganDefinition& definition, const OrganSetting& setting);

}  // namespace calot
