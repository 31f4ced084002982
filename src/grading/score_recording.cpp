#include "grading/score_recording.h"

#include <fmt/format.h>

#include <array>
#include <fstream>

#include "base/hash.h"
#include "play/play.h"
#include "play/replay_checks.h"
#include "process/exit_code.h"
#include "session/metrics.h"
#include "session/progress_json.h"

namespace calot {
namespace {

constexpr const char* entry_version = "calot.scores/3";

/// Adds a file's bytes; false where it cannot be read.
bool add_file(Hash& hash, const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1 << 16> part;
  while (in.good()) {
    in.read(part.data(), part.size());
    hash.add_bytes(part.data(), static_cast<std::size_t>(in.gcount()));
  }
  return in.eof() && !in.bad();
}

/// How the recorded session ended, as far as its replay shows it.
std::string end_of(const Recording& recording, const SessionResult& session) {
  if (session.end != SessionEnd::source_ended) return to_text(session.end);
  if (recording.end.empty()) return cut_end;
  return came_to_its_end(recording.end) ? to_text(session.end) : recording.end;
}

/// Who, when, by what, and by which rules it was recorded.
void add_attempt(const Recording& recording, OrderedJson& entry) {
  const RecordingHeader& header = recording.header;
  for (const std::string& key : attempt_keys()) entry[key] = nullptr;
  write_attempt(header.attempt, entry);
  entry["session"] = session_of(recording);
  entry["recorded"] = {
      {"schema", header.version}, {"measures", header.measures}, {"scoring", header.scoring}};
  entry["measures"] = measures_version;
}

std::optional<Failure> add_measured(const ExerciseDefinition& exercise,
                                    const std::map<std::string, double>& metrics, const Progress& progress,
                                    const std::vector<std::string>& notes, OrderedJson& entry) {
  Result<Score> scored = score(exercise, metrics, progress);
  if (!scored) return scored.failure();
  Score total = std::move(scored).value();
  if (!entry["whole"].get<bool>()) cut_short(total, entry["end"] == to_text(SessionEnd::failed));
  entry["params"] = exercise.params;
  entry["score"] = score_json(exercise, total, total.outcome != AttemptOutcome::not_judged);
  entry["metrics"] = metrics;
  entry["steps"] = steps_json(progress);
  entry["notes"] = notes;
  return std::nullopt;
}

void verify(const Recording& recording, std::uint64_t exercise, const SessionResult& session,
            OrderedJson& entry) {
  const StateComparison states = compare_states(recording, session);
  std::vector<std::string> found;
  if (!states.message.empty()) found.push_back(states.message);
  const bool same_bits = states.differs || states.message.empty();
  if (same_bits)
    for (std::string& difference : measured_otherwise(recording, exercise, session))
      found.push_back(std::move(difference));
  if (same_bits && (recording.header.state_hash || recording.measured)) entry["verified"] = found.empty();
  entry["differences"] = found;
}

}  // namespace

std::vector<std::string> measured_otherwise(const Recording& recording, std::uint64_t exercise,
                                            const SessionResult& session) {
  std::vector<std::string> found;
  const bool same_rules =
      recording.header.measures == measures_version && recording.header.exercise_hash == exercise;
  if (!recording.measured || !same_rules) return found;
  const Measured& held = *recording.measured;
  for (const auto& [name, value] : held.metrics) {
    const auto simulated = session.metrics.find(name);
    if (simulated == session.metrics.end())
      found.push_back(fmt::format("{} is {} in the recording, and was not measured now", name, value));
    else if (simulated->second != value)
      found.push_back(fmt::format("{} is {} in the recording, {} simulated", name, value, simulated->second));
  }
  for (const auto& [name, value] : session.metrics)
    if (!held.metrics.contains(name))
      found.push_back(fmt::format("{} = {} is not in the recording", name, value));
  if (steps_json(held.progress) != steps_json(session.progress)) found.emplace_back("the steps differ");
  if (events_json(held.progress) != events_json(session.progress)) found.emplace_back("the events differ");
  if (notes_json(held.progress) != notes_json(session.progress)) found.emplace_back("what was noted differs");
  return found;
}

OrderedJson failed_entry(const std::string& file, const Failure& failure) {
  return {{"file", file},
          {"failure", problems_json(failure)},
          {"exit_code", static_cast<int>(exit_code(failure.kind))}};
}

Result<RecordingScorer> RecordingScorer::create(ScoreRequest request) {
  RecordingScorer scorer(std::move(request));
  Result<Exercise> standard = scorer.load({}, PlayRequest().seed);
  if (!standard) return standard.failure();
  scorer.standard_ = std::move(standard).value();
  if (scorer.standard_.definition.score.parts.empty())
    return fail(FailureKind::usage, "this exercise has no score: it trains nothing",
                "name another one, or give it a score", {scorer.request_.exercise.string(), 0, {}});
  if (!scorer.request_.keyed) return scorer;
  Hash hash;
  hash.add(std::string_view(entry_version));
  hash.add(scorer.request_.benchmarks ? scorer.request_.benchmarks->source_hash : 0);
  hash.add(scorer.request_.verify);
  hash.add(std::string_view(to_text(this_make())));
  add_file(hash, "/proc/self/exe");
  scorer.key_base_ = hash.value();
  return scorer;
}

std::string RecordingScorer::key(const std::string& file) {
  const Result<Recording> recording = read_recording(file);
  if (!recording) return {};
  const Result<const Exercise*> exercise = exercise_of(recording->header);
  Hash hash;
  hash.add(key_base_);
  if (!exercise || !add_file(hash, file)) return {};
  hash.add(exercise.value()->hash);
  return hex(hash.value());
}

OrderedJson RecordingScorer::score(const std::string& file) {
  OrderedJson entry = {{"file", file}};
  const Result<Recording> recording = read_recording(file);
  std::optional<Failure> failure =
      recording ? add_score(recording.value(), entry) : std::optional(recording.failure());
  if (failure) {
    for (Problem& problem : failure->problems)
      if (problem.place.file.empty()) problem.place.file = file;
    entry = failed_entry(file, *failure);
  }
  return entry;
}

Result<RecordingScorer::Exercise> RecordingScorer::load(const std::map<std::string, std::string>& params,
                                                        std::uint64_t seed) const {
  PlayRequest request;
  request.scenario = request_.exercise;
  request.params = params;
  request.seed = seed;
  Result<std::unique_ptr<ExerciseScript>> script = load_scenario(request);
  if (!script) return script.failure();
  Exercise exercise{script.value()->definition(), exercise_hash(script.value()->definition())};
  if (!request_.benchmarks) return exercise;
  std::vector<Problem> problems = apply(*request_.benchmarks, exercise.definition);
  if (!problems.empty()) return Failure{FailureKind::scenario, std::move(problems)};
  return exercise;
}

Result<const RecordingScorer::Exercise*> RecordingScorer::exercise_of(const RecordingHeader& header) {
  const ExerciseDefinition& standard = standard_.definition;
  if (header.seed == standard.seed && (header.params.empty() || header.params == standard.params))
    return &standard_;
  std::string name = std::to_string(header.seed);
  for (const auto& [key, value] : header.params) name += '\n' + key + '=' + value;
  const auto known = known_.find(name);
  if (known != known_.end()) return &known->second;
  Result<Exercise> loaded = load(header.params, header.seed);
  if (!loaded) return loaded.failure();
  return &known_.emplace(name, std::move(loaded).value()).first->second;
}

std::optional<Failure> RecordingScorer::add_score(const Recording& recording, OrderedJson& entry) {
  constexpr const char* hint = "name the exercise that it was made with";
  if (recording.steps.empty())
    return fail(FailureKind::usage, "this recording has no step: its session ended before it began",
                "leave it out, or record the session anew");
  // Another exercise may not know its parameters.
  if (recording.header.scenario != standard_.definition.id)
    return check_replay(recording, standard_.definition, hint);
  const Result<const Exercise*> found = exercise_of(recording.header);
  if (!found) return found.failure();
  const Exercise& exercise = *found.value();
  if (std::optional<Failure> wrong = check_replay(recording, exercise.definition, hint)) return wrong;
  add_attempt(recording, entry);
  const std::optional<std::string> why = why_simulate(recording, exercise);
  entry["from"] = why ? "simulation" : "recording";
  entry["why"] = why ? OrderedJson(*why) : OrderedJson();
  entry["verified"] = nullptr;
  entry["differences"] = OrderedJson::array();
  if (why) return simulate(recording, exercise, entry);
  entry["end"] = recording.end;
  entry["whole"] = came_to_its_end(recording.end);
  entry["stopped_at_s"] = recording.steps.empty() ? 0.0 : recording.steps.back().time;
  const Measured& held = *recording.measured;
  std::vector<std::string> notes = held.notes;
  if (const std::optional<std::string> cut = cut_note(recording)) notes.push_back(*cut);
  if (std::optional<Failure> wrong =
          add_measured(exercise.definition, held.metrics, held.progress, notes, entry))
    return wrong;
  if (!request_.watcher) return std::nullopt;
  if (request_.watcher->held) {
    request_.watcher->held(recording, exercise.definition);
    return std::nullopt;
  }
  const Result<Played> watched = replay(recording, exercise);
  return watched ? std::nullopt : std::optional(watched.failure());
}

std::optional<std::string> RecordingScorer::why_simulate(const Recording& recording,
                                                         const Exercise& exercise) const {
  if (request_.verify) return "--replay";
  if (recording.end.empty()) return "the recording was cut";
  if (!recording.measured) return "the recording does not hold what was measured";
  if (recording.header.exercise_hash != exercise.hash)
    return "the exercise has changed since it was recorded";
  if (recording.header.measures != measures_version)
    return fmt::format("measured by version {}, and this program measures by version {}",
                       recording.header.measures, measures_version);
  return std::nullopt;
}

Result<Played> RecordingScorer::replay(const Recording& recording, const Exercise& exercise) const {
  PlayRequest request;
  request.scenario = request_.exercise;
  request.params = recording.header.params;
  request.seed = recording.header.seed;
  request.replay = &recording;
  request.render = false;
  request.show_progress = false;
  if (request_.watcher) request_.watcher->begin(exercise.definition, request);
  Result<Played> played = play(request);
  if (!played) return played;
  if (played->session.end == SessionEnd::interrupted) return fail(FailureKind::interrupted, "interrupted");
  if (request_.watcher) request_.watcher->end(recording, played.value());
  return played;
}

std::optional<Failure> RecordingScorer::simulate(const Recording& recording, const Exercise& exercise,
                                                 OrderedJson& entry) const {
  const Result<Played> played = replay(recording, exercise);
  if (!played) return played.failure();
  const SessionResult& session = played->session;
  if (request_.verify) verify(recording, exercise.hash, session, entry);
  entry["end"] = end_of(recording, session);
  entry["whole"] = !played->report.aborted;
  entry["stopped_at_s"] = session.traces.time.back();
  std::vector<std::string> notes = session.notes;
  if (session.end == SessionEnd::failed) notes.push_back(to_text(session.failure));
  return add_measured(exercise.definition, session.metrics, session.progress, notes, entry);
}

}  // namespace calot
