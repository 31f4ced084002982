#pragma once
// Motion, force and organ metrics of a session, and their names. A name carries its unit.
//
// In the formulas p is the tip, u the unit shaft axis, d the insertion, psi the roll; all from processed motion, see
// trace.h.

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "session/exercise.h"
#include "session/progress.h"
#include "session/trace.h"

namespace calot {

/// Raised with every change of what a metric or an event means, so that figures of two meanings never stand under one name.
/// 1: overforce judged the sum of all forces on an instrument. 2: it judges those on its jaws.
/// 3: ground is among what an instrument touches, is pressed by and hurts; a perforation is counted for each wall.
/// 4: forces, pressures and stretches of steps that did not end in balance are left out, as overforce always left them.
/// 5: current hurts walls by its distance to them; a place of a wall keeps what it took, and opens once.
/// 6: what turns in the jaws that hold it on is the event turn, and no slip.
inline constexpr int measures_version = 6;

enum class MetricOwner {
  instrument,
  moved,  ///< an instrument or the laparoscope
  laparoscope,
  organ,
  hollow,       ///< organ
  has_capsule,  ///< organ
  holds_bile,
  holds_blood,
  tissue,
  compared_organ,
  step,
  hold,
  note,
  total
};

struct MetricRow {
  const char* name;  ///< without its owner's: "path_length_mm" of "left.path_length_mm"
  MetricOwner owner;
  const char* doc;
  std::optional<EventKind> event{};  ///< the events that count in it, or mark when it grew too large
  bool counts = false;               ///< it is their number
};

const std::vector<MetricRow>& metric_rows();
/// How an author writes it: "<instrument>.path_length_mm", "<step>.<hold>.time_in_s", "total.time_s".
std::string pattern(const MetricRow& row);

/// Every metric a session of this exercise can measure.
std::vector<std::string> metric_names(const ExerciseDefinition& exercise);
/// What an event may have happened to: organs and tissues that there are or come later, and ground.
std::vector<std::string> place_names(const AnatomyDefinition& anatomy,
                                     std::span<const OrganDefinition> later_organs,
                                     std::span<const TissueDefinition> later_tissues);
/// Whether that is one of these, or a piece of one.
bool is_place(const std::string& name, const std::vector<std::string>& places);

/// A metric in words, its unit last: "left: path length, mm" of left.path_length_mm.
std::string metric_title(const std::string& metric);

/// The events behind a metric, called without its owner.
std::optional<EventKind> event_behind(const std::string& metric);

/// Metrics by name. What could not be measured (the economy of an instrument that never moved, the time of a
/// step that was never reached) is absent.
std::map<std::string, double> measure(const SceneDefinition& scene, const Traces& traces,
                                      const Progress& progress);

}  // namespace calot
