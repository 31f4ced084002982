#pragma once
// The simulated operating field: const definition in, mutable state inside, one step at a time.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/definitions.h"
#include "geometry/stencil.h"
#include "sim/instrument.h"
#include "sim/skin_difference.h"
#include "sim/structure_drawing.h"

namespace calot {

/// Target poses at the end of the step, one an instrument in the definition's order: the only input there is,
/// whatever its source (demo, recording, live device).
struct StepInput {
  std::vector<InstrumentPose> instruments;
};

/// Kinds: contact, grasp, release, slip, overforce, overstretch.
struct WorldEvent {
  std::string kind;
  double time = 0;         ///< s
  std::string instrument;  ///< may be empty
  std::string organ;       ///< may be empty
  double value = 0;        ///< N for forces, stretch for overstretch, else 0
};

struct InstrumentState {
  InstrumentPose pose;
  Vec3 tip = Vec3::Zero();           ///< m
  Vec3 tip_force = Vec3::Zero();     ///< N, of the tissue on the instrument
  Vec3 handle_force = Vec3::Zero();  ///< N, felt at the handle, lever about the trocar
  bool touching = false;
  std::string holds;  ///< organ's name, empty when nothing is held
  int grip_points = 0;
};

struct OrganState {
  double pressure = 0;     ///< Pa, gauge, at the highest point
  double volume = 0;       ///< m^3 enclosed
  double energy = 0;       ///< J, wall
  double max_stretch = 1;  ///< largest principal stretch of the wall
  int extensions = 0;      ///< places where an instrument has structural extensions
  int details = 0;         ///< nodes that they add
};

struct SolveStatistics {
  int substeps = 0;
  int newton_iterations = 0;
  /// Changes of the active details, and those given up because the organ found no rest with them.
  int extensions_changed = 0, extensions_refused = 0;
  /// Wall time, not part of any hash: energies and their derivatives (those of contact too), factors, solves,
  /// and finding who meets whom and how far each may go; and changes of details, their solves included.
  double assembly_s = 0, factorisation_s = 0, solve_s = 0, contact_s = 0, extension_s = 0;
};

struct StepReport {
  double time = 0;  ///< s, at the end of the step
  std::vector<InstrumentState> instruments;
  std::vector<OrganState> organs;
  std::vector<WorldEvent> events;
  SolveStatistics statistics;
  std::uint64_t state_hash = 0;
};

class World {
 public:
  /// Validates, builds and brings the scene to its rest equilibrium at time 0. Failures: scenario
  /// (validation) or simulation (the rest state could not be found).
  static Result<World> create(const SceneDefinition& scene);
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  /// Advances by 1 / rate. On failure (FailureKind::simulation) the message says where, when and what to
  /// change; the state stays that of the last converged sub-step and further steps fail alike.
  Result<StepReport> step(const StepInput& input);

  const SceneDefinition& scene() const;
  /// The report of the last step (of the rest state before the first).
  const StepReport& report() const;
  std::uint64_t state_hash() const;

  /// Upward direction (unit): minus gravity, turned by the table's tilt.
  Vec3 up() const;
  Vec3 port_position(const std::string& port) const;
  /// Present place of "organ.landmark" on the skin, m.
  Vec3 landmark(const std::string& organ_and_landmark) const;
  /// Outward unit normal of the skin there.
  Vec3 landmark_normal(const std::string& organ_and_landmark) const;

  /// The skin that is touched, and drawn but for the mould of jaws: triangles fixed, positions present; rest
  /// positions for texture.
  const Tessellation& skin(int organ) const;
  std::vector<Vec3> skin_positions(int organ) const;  ///< m, one a skin point
  std::vector<Vec3> skin_normals(int organ) const;    ///< unit, outward
  const std::vector<Vec3>& skin_rest_positions(int organ) const;
  /// Elements and nodes of an organ's structure and of its extensions, where they lie on the present skin.
  StructureDrawing structure(int organ) const;
  /// The skin as it is drawn: what jaws hold takes their shape (sim/jaw_mould.h). Some milliseconds a holding tool.
  struct DrawnSkin {
    std::vector<Vec3> positions, normals;  ///< m; unit, outward
  };
  DrawnSkin drawn_skin(int organ) const;
  /// Lowest natural frequency, Hz, of an organ at its present equilibrium, its bile's mass included: what shakes
  /// it below a third of that may be treated as static (the paper, section 4). Fails (simulation) where the
  /// equilibrium is not stable, its volume kept.
  Result<double> lowest_frequency(int organ) const;
  /// How far the motion of an organ's skin since time 0 is from that of the organ it is compared with. None without
  /// one, or where that has not moved. Some 0.1 s.
  std::optional<SkinDifference> difference(int organ) const;
  /// Deepest penetration of any instrument part into the skin (m, 0 when none), tested on a finer
  /// tessellation than contact uses: for tests and reports.
  double deepest_penetration() const;

 private:
  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace calot
