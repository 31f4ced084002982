#pragma once
// The simulated operating field: const definition in, mutable state inside, one step at a time.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/definitions.h"
#include "body/body_handle.h"
#include "geometry/stencil.h"
#include "tools/step_report.h"
#include "tools/tool_index.h"
#include "world/critical_view.h"

namespace calot {

struct DrawnSurface;
struct Field;
struct FieldState;
class KeptResults;

/// The point of an organ's skin that came to rest furthest from where it is drawn.
struct RestShift {
  double distance = 0;   ///< m
  std::string landmark;  ///< of the organ, the nearest where it is drawn
};

class World {
 public:
  /// Validates, builds and brings the scene to its rest equilibrium at time 0. Failures: scenario
  /// (validation), simulation (the rest state could not be found), resource (it would take too long) or interrupted
  /// (`stop`, which must outlive the world, became true). Of `threads`, at most as many share the work of a step for the world's life: its bits are the
  /// same whatever their number. What takes long is looked for among `kept` first, and kept there when it had to be found:
  /// no bit depends on whether it was there; null: nothing is.
  static Result<World> create(const SceneDefinition& scene, const std::atomic<bool>* stop = nullptr,
                              int threads = 1, KeptResults* kept = nullptr);
  /// A scene that create() refuses, to be looked at: its organs as they are drawn, empty, neither tied nor at rest, its
  /// instruments in their ports, and the laparoscope. No step can be made of it. `overlaps` receives where organs are deepest in
  /// each other or in ground, m. Fails (scenario) where not even that can be built.
  static Result<World> as_drawn(const SceneDefinition& scene, std::vector<Vec3>& overlaps,
                                KeptResults* kept = nullptr);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Advances by 1 / rate. On failure (FailureKind::simulation) the message says where, when and what to
  /// change; the state is that of before the step and further steps fail alike. Once `stop` is true a step fails
  /// (interrupted) within some Newton iterations, the state that of before it. A step that is known to change nothing,
  /// as the last one with the same input did not, costs a hash (solver.skip_still).
  Result<StepReport> step(const StepInput& input);

  const SceneDefinition& scene() const;
  /// The report of the last step (of the rest state before the first).
  const StepReport& report() const;
  /// Of the present state, computed anew.
  std::uint64_t state_hash() const;

  /// All that moves and who is there, to be copied and given back to this world: what follows has the same bits. Fails
  /// (internal) where it is another world's.
  FieldState state() const;
  Result<bool> restore(const FieldState& state);

  /// All of it but its scene, as bytes of which another process makes the same world: each step from there has the same hash.
  std::string to_bytes() const;
  /// The other arguments as of create(). Fails, too, (usage) where the bytes are no world's, cut off, longer, damaged or
  /// of another version, and (scenario) where they are of another scene.
  static Result<World> from_bytes(const SceneDefinition& scene, std::string_view bytes,
                                  const std::atomic<bool>* stop = nullptr, int threads = 1,
                                  KeptResults* kept = nullptr);

  // Organs come, go and are divided between steps (field/change_bodies.h); the report then is of those that are there. Where
  // masses do not count all come to rest at once. Each fails (scenario; simulation where no rest was found) with the world
  // as it was; what is asked for by a name or handle that is gone is told when it went and why.

  Result<OrganIndex> organ(const std::string& name) const;
  Result<OrganIndex> organ(const BodyHandle& handle) const;
  BodyHandle handle(OrganIndex organ) const;
  /// At about this share of a tube's length, from its start.
  Result<Division> divide(const std::string& organ, double share);
  /// Sets a clip that shuts a tube, at this share of its length, 0 to 1.
  Result<bool> clip(const std::string& organ, double share, ClipSize size);
  Result<bool> remove(const std::string& organ, const std::string& why);
  /// It stands behind all others; problems have paths as of validate(organ).
  Result<OrganIndex> add(const OrganDefinition& definition);
  /// Lets an organ go where a held region of this name holds it.
  Result<bool> release(const std::string& organ, const std::string& held);
  /// Lays strands between two organs where they are now; problems have paths as of validate(tissue).
  Result<bool> add_tissue(const TissueDefinition& definition);
  Result<bool> remove_tissue(const std::string& name);
  /// Makes a hole of a width (m, > 0) in a tube's wall, at about this share of its length, 0 to 1. Returns at which.
  Result<double> open_tube(const std::string& tube, double share, double width);
  /// Where they are now.
  Result<bool> tie(const JointDefinition& joint);
  /// Undoes all joints of two organs.
  Result<bool> untie(const std::string& one, const std::string& other);
  /// Place of "organ.landmark", m, of an organ that is there.
  Result<Vec3> place(const std::string& organ_and_landmark) const;
  std::vector<std::string> landmarks() const;  ///< of these

  /// Upward direction (unit): minus gravity, turned by the table's tilt.
  Vec3 up() const;
  /// m. This and the next two throw std::logic_error for a name that the scene does not have and no organ had.
  Vec3 port_position(const std::string& port) const;
  /// Present place of "organ.landmark" on the skin, m; of an organ that went, where it was last.
  Vec3 landmark(const std::string& organ_and_landmark) const;
  /// How far a tool's jaws, or what its rod ends in, are from an organ's skin, m; 0 where they touch (acts/current.h).
  double clearance(ToolIndex instrument, OrganIndex organ) const;
  /// Of a triangle's area what the laparoscope sees, m^2, across its line of sight (world/sight.h), from where
  /// it is now.
  double seen_area(const std::array<Vec3, 3>& corners) const;
  /// Whether it sees a place, m: in its round field, with no organ, instrument or ground on the way but for its last 2 mm.
  /// `through`: an organ that does not hide it; empty: none.
  bool sees(const Vec3& place, const std::string& through = {}) const;
  /// A landmark; a rigid thing does not hide its centre.
  bool sees(const std::string& landmark) const;
  const Laparoscope& laparoscope() const;
  /// The critical view of safety from where the laparoscope is now (world/critical_view.h). Throws as landmark() does.
  CriticalView critical_view(const CriticalViewQuestion& question) const;
  /// How organs had come to rest at the start, one an organ of the scene.
  const std::vector<RestShift>& rest_shifts() const;
  /// Outward unit normal of the skin there; upwards at a rigid thing's places, which lie inside of it.
  Vec3 landmark_normal(const std::string& organ_and_landmark) const;

  /// Organs and tools as they are now (field/field.h), for who looks closer than the report does.
  const Field& field() const;
  /// The skin that is touched, and drawn but for the mould of jaws (view/jaw_mould.h): triangles fixed, positions present; rest
  /// positions for texture.
  const Tessellation& skin(OrganIndex organ) const;
  std::vector<Vec3> skin_positions(OrganIndex organ) const;  ///< m, one a skin point
  std::vector<Vec3> skin_normals(OrganIndex organ) const;    ///< unit, outward
  /// What is drawn of an organ: triangles fixed, places now, and at rest for texture.
  const std::vector<Triangle>& drawn_triangles(OrganIndex organ) const;
  const std::vector<Vec3>& drawn_rest(OrganIndex organ) const;
  DrawnSurface drawn(OrganIndex organ) const;
  /// Lowest natural frequency, Hz, of an organ at its present equilibrium, its bile's mass included: what shakes
  /// it below a third of that may be treated as static (the paper, section 4). Fails (simulation) where the
  /// equilibrium is not stable, its volume kept.
  Result<double> lowest_frequency(OrganIndex organ) const;
  /// Deepest penetration of any instrument part into the skin (m, 0 when none), tested on a finer
  /// tessellation than contact uses: for tests and reports.
  double deepest_penetration() const;

 private:
  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace calot
