#include "session/measured.h"

#include <fstream>
#include <iterator>

#include "base/hash.h"
#include "session/json_fields.h"
#include "session/progress_json.h"
#include "session/trace.h"

namespace calot {
namespace {

/// Length and text, so that no two lists of texts run into the same bytes.
void add_text(Hash& hash, const std::string& text) {
  hash.add(text.size());
  hash.add(std::string_view(text));
}

void add_meshes(Hash& hash, const std::vector<OrganDefinition>& organs) {
  for (const OrganDefinition& organ : organs) {
    const std::string* path = mesh_path(organ.shape);
    if (path == nullptr) continue;
    std::ifstream in(*path, std::ios::binary);
    add_text(hash, {std::istreambuf_iterator<char>(in), {}});
  }
}

std::map<std::string, double> read_metrics(const Json& json, std::vector<std::string>& problems) {
  std::map<std::string, double> metrics;
  if (!json.is_object()) {
    problems.emplace_back("metrics must be an object of numbers");
    return metrics;
  }
  for (const auto& [name, value] : json.items()) {
    if (value.is_number())
      metrics[name] = value.get<double>();
    else
      problems.push_back("metrics: " + name + " must be a number");
  }
  return metrics;
}

}  // namespace

std::uint64_t exercise_hash(const ExerciseDefinition& exercise) {
  Hash hash;
  hash.add(exercise.source_hash);
  hash.add(exercise.seed);
  for (const auto& [name, value] : exercise.params) {
    add_text(hash, name);
    add_text(hash, value);
  }
  add_meshes(hash, exercise.scene.anatomy.organs);
  add_meshes(hash, exercise.later_organs);
  hash.add(MotionProcessing::version);
  return hash.value();
}

OrderedJson measured_json(const Measured& measured) {
  return {{"metrics", measured.metrics},
          {"steps", steps_json(measured.progress)},
          {"events", events_json(measured.progress)},
          {"noted", notes_json(measured.progress)},
          {"notes", measured.notes}};
}

Measured read_measured(JsonFields& fields, std::vector<std::string>& problems) {
  Measured measured;
  measured.metrics = read_metrics(fields.any("metrics"), problems);
  measured.progress = read_progress(fields.any("steps"), fields.any("events"), fields.any("noted"), problems);
  measured.notes = fields.texts("notes");
  fields.expect_no_others();
  return measured;
}

}  // namespace calot
