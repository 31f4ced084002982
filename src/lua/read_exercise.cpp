#include "lua/read_exercise.h"

#include <fmt/format.h>

#include <cmath>

#include "base/suggest.h"
#include "lua/table_reader.h"
#include "session/metrics.h"

namespace calot {
namespace {

constexpr double weight_slack = 1e-6;  // what a sum of weights written as decimals may be off

void check_id(FieldCheck& check, const std::string& id) {
  bool good = !id.empty();
  for (const char c : id) good = good && ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-');
  if (!good) check.problem("id", fmt::format("\"{}\" is no id", id), "use small letters, digits and hyphens");
}

/// What kind of score a table is: set by calot.score's functions.
std::string kind_of(const Value& value) {
  const Value* kind = value.field("kind");
  return kind != nullptr && kind->is(Value::Kind::text) ? kind->text : std::string();
}

class ScoreReader {
 public:
  ScoreReader(FieldCheck& check, const Value& value) : check_(check), value_(value) {}

  ScoreDefinition read() {
    ScoreDefinition score;
    if (kind_of(value_) != "weighted") {
      check_.problem("score", "this is no score",
                     "write score = calot.score.weighted { ... }, or a function that returns one");
      return score;
    }
    const TableReader reader(check_, &value_, "score", api_table("weighted"));
    reader.read(score);
    if (const Value* critical = reader.take("critical")) score.critical = read_critical(*critical);
    for (std::size_t i = 0; i < value_.items.size(); ++i) {
      ScorePart part;
      if (read_part(part, value_.items[i], indexed("score", i))) score.parts.push_back(part);
    }
    check_weights(score.parts);
    return score;
  }

 private:
  std::vector<EventKind> read_critical(const Value& list) {
    std::vector<EventKind> events;
    for (std::size_t i = 0; i < list.items.size(); ++i) {
      const std::string path = indexed("score.critical", i);
      if (!list.items[i].is(Value::Kind::text)) {
        check_.problem(path, "this must be an event's name", suggestion("", event_names()));
      } else if (check_.known(path, list.items[i].text, event_names(), "event")) {
        events.push_back(*event_called(list.items[i].text));
      }
    }
    return events;
  }

  bool read_part(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("part"));
    if (!value.is(Value::Kind::table)) return false;
    all_weighted_ = all_weighted_ && reader.has("weight");
    part.place.path = path;
    const std::string kind = value.items.size() == 1 ? kind_of(value.items[0]) : std::string();
    if (kind == "benchmark") {
      read_benchmark(part, value.items[0], path + "[1]");
    } else if (kind == "penalty") {
      read_penalty(part, value.items[0], path + "[1]");
    } else {
      check_.problem(path,
                     "a part of the score is one calot.score.benchmark or calot.score.penalty with a weight",
                     "write { calot.score.benchmark { ... }, weight = 0.5 }");
      all_weighted_ = false;
      return false;
    }
    reader.read(part);
    if (reader.has("name") && part.name.empty())
      check_.problem(path + ".name", "the part's name is empty", "give it one, or leave it out");
    return true;
  }

  void read_benchmark(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("benchmark"));
    part.kind = ScorePartKind::benchmark;
    reader.read(part);
    part.name = part.metric;
    if (reader.has("metric") && part.metric.empty())
      check_.problem(path + ".metric", "the metric has no name", "such as metric = \"left.path_length_mm\"");
    if (reader.has("novice") && reader.has("expert") && part.novice == part.expert) {
      check_.problem(path + ".expert", fmt::format("novice and expert are both {:g}", part.novice),
                     "the score runs from one to the other: they must differ");
    }
  }

  void read_penalty(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("penalty"));
    part.kind = ScorePartKind::penalty;
    reader.read(part);
    part.name = to_text(part.event);
  }

  void check_weights(const std::vector<ScorePart>& parts) {
    if (value_.items.empty()) {
      return check_.problem("score", "the score has no parts",
                            "add { calot.score.benchmark { ... }, weight = 1 }");
    }
    if (!all_weighted_) return;  // said already
    double sum = 0;
    for (const ScorePart& part : parts) sum += part.weight;
    if (std::abs(sum - 1) > weight_slack) {
      check_.problem("score", fmt::format("the weights sum to {:g}, not to 1", sum),
                     "change them so that they sum to 1");
    }
  }

  FieldCheck& check_;
  const Value& value_;
  bool all_weighted_ = true;
};

GoldenDefinition read_golden(FieldCheck& check, const Value* value, double time_limit) {
  GoldenDefinition golden;
  const TableReader reader(check, value, "golden", api_table("golden"));
  const Value* at = reader.take("at");
  if (at == nullptr) return golden;
  if (at->items.size() > GoldenDefinition::most_times)
    check.problem("golden.at",
                  fmt::format("{} times, more than {}", at->items.size(), GoldenDefinition::most_times),
                  "keep those that show something");
  for (std::size_t i = 0; i < at->items.size(); ++i) {
    const Value& time = at->items[i];
    const std::string path = indexed("golden.at", i);
    if (!time.is(Value::Kind::number)) {
      check.problem(path, "this must be a time in s, got " + name_of(time.kind), "such as 10 * s");
    } else if (check.in_range(path, time.number, quantity::time, 0, time_limit, "within the time limit")) {
      golden.at.push_back(time.number);
    }
  }
  return golden;
}

/// All names, or those of the same owner ("left.") when the name starts with one that exists.
std::vector<std::string> likely(const std::string& name, const std::vector<std::string>& names) {
  const std::string owner = name.substr(0, name.find('.') + 1);
  std::vector<std::string> same;
  for (const std::string& candidate : names)
    if (!owner.empty() && candidate.starts_with(owner)) same.push_back(candidate);
  return same.empty() ? names : same;
}

}  // namespace

ExerciseTable read_exercise(FieldCheck& check, const Value& exercise,
                            const std::map<std::string, std::string>& chosen) {
  ExerciseTable result;
  ExerciseDefinition& definition = result.definition;
  const TableReader reader(check, &exercise, "", api_table("exercise"));
  reader.read(definition);
  if (reader.has("id")) check_id(check, definition.id);
  ReadParameters parameters = read_parameters(check, reader.take("params"), chosen);
  result.parameters = std::move(parameters.values);
  result.usage = std::move(parameters.usage);
  definition.parameters = std::move(parameters.definitions);
  for (const ParameterDefinition& parameter : definition.parameters)
    definition.params[parameter.name] = parameter.value;
  const Value* score = reader.take("score");
  if (score != nullptr && score->function == 0) definition.score = read_score(check, *score);
  definition.golden = read_golden(check, reader.take("golden"), definition.time_limit);
  const auto reference = [&](const char* key) {
    const Value* value = reader.take(key);
    return value != nullptr ? value->function : 0;
  };
  result.scene = reference("scene");
  result.steps = reference("steps");
  result.demo = reference("demo");
  result.score = reference("score");
  return result;
}

ScoreDefinition read_score(FieldCheck& check, const Value& score) { return ScoreReader(check, score).read(); }

void check_metrics(FieldCheck& check, const ExerciseDefinition& exercise) {
  const std::vector<std::string> names = metric_names(exercise);
  for (const ScorePart& part : exercise.score.parts) {
    if (part.kind != ScorePartKind::benchmark || part.metric.empty()) continue;
    if (std::find(names.begin(), names.end(), part.metric) != names.end()) continue;
    std::string hint = suggestion(part.metric, names);
    if (hint.starts_with("known")) hint = suggestion(part.metric, likely(part.metric, names));
    check.problem(part.place.path + "[1].metric", fmt::format("unknown metric \"{}\"", part.metric), hint);
  }
}

}  // namespace calot
