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
  ScoreReader(FieldCheck& check, const Value& value, int api) : check_(check), value_(value), api_(api) {}

  ScoreDefinition read() {
    ScoreDefinition score;
    if (kind_of(value_) != "weighted") {
      check_.problem("score", "this is no score",
                     "write score = calot.score.weighted { ... }, or a function that returns one");
      return score;
    }
    const TableReader reader(check_, &value_, "score", api_table("weighted"));
    reader.read(score);
    for (const auto& [key, points] : {std::pair{"pass", score.pass}, std::pair{"cap", score.cap}})
      if (points > 0 && points < 1)
        check_.problem(reader.path_of(key),
                       fmt::format("{} = {:g} is less than one point of 100", key, points),
                       fmt::format("did you mean {:g}?", 100 * points));
    score.critical = read_events(reader, "critical");
    if (const Value* judge = reader.take("bail_out")) score.bail_out = judge->function;
    expect_api("score.bail_out_completes", reader.has("bail_out_completes"), 1,
               "write bail_out = function(run) return true, \"why that was right\" end");
    expect_api("score.bail_out", reader.has("bail_out"), 2, "write api = 2, or bail_out_completes = true");
    if (const Value* gates = reader.take("gates"))
      for (std::size_t i = 0; i < gates->items.size(); ++i)
        score.gates.push_back(read_gate(gates->items[i], indexed("score.gates", i)));
    for (std::size_t i = 0; i < value_.items.size(); ++i) {
      ScorePart part;
      if (read_part(part, value_.items[i], indexed("score", i))) score.parts.push_back(part);
    }
    check_weights(score.parts);
    return score;
  }

 private:
  std::vector<EventKind> read_events(const TableReader& reader, const std::string& key) {
    std::vector<EventKind> events;
    const Value* list = reader.take(key);
    for (std::size_t i = 0; list != nullptr && i < list->items.size(); ++i) {
      const std::string path = indexed(reader.path_of(key), i);
      if (!list->items[i].is(Value::Kind::text)) {
        check_.problem(path, "this must be an event's name", suggestion("", event_names()));
      } else if (check_.known(path, list->items[i].text, event_names(), "event")) {
        events.push_back(*event_called(list->items[i].text));
      }
    }
    return events;
  }

  GateDefinition read_gate(const Value& value, const std::string& path) {
    GateDefinition gate;
    const TableReader reader(check_, &value, path, api_table("gate"));
    reader.read(gate);
    gate.place.path = path;
    const auto given = [&](const char* key) { return value.field(key) != nullptr; };  // fit or not
    const auto expect = [&](bool good, const char* what, const char* hint) {
      if (!good) check_.problem(path, what, hint);
    };
    if (reader.has("reason"))
      expect(!gate.reason.empty(), "the gate's reason is empty", "say in a sentence why it fails");
    expect(given("event") || given("metric"), "the gate has no condition",
           "give event = \"perforation\", or metric and below or above");
    expect(given("event") || !(given("only_after") || given("organ")),
           "only_after and organ say more of an event, and there is none", "give event too");
    expect(given("only_after") || !given("after_organ"),
           "after_organ says more of only_after, and there is none", "give only_after too");
    const bool bounded = given("below") != given("above");
    expect(given("metric") ? bounded : !given("below") && !given("above"),
           "a metric needs below or above, one of them, and they need a metric",
           "such as metric = \"note.critical_view_points\", below = 5");
    return gate;
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
    } else if (kind == "procedure") {
      read_procedure(part, value.items[0], path + "[1]");
    } else if (kind == "time") {
      read_time(part, value.items[0], path + "[1]");
    } else if (kind == "critical_view") {
      read_critical_view(part, value.items[0], path + "[1]");
    } else if (kind == "rule") {
      read_rule(part, value.items[0], path + "[1]");
      if (!reader.has("name"))
        check_.problem(path, "a rule needs a name",
                       "write { calot.score.rule(...), name = \"order\", weight = 0.5 }");
    } else {
      check_.problem(path, "a part of the score is one of calot.score's, such as a benchmark, with a weight",
                     "write { calot.score.benchmark { ... }, weight = 0.5 }");
      all_weighted_ = false;
      return false;
    }
    reader.read(part);
    if (kind != "procedure") part.steps = read_steps(reader);
    if (kind == "procedure" && reader.has("steps"))
      check_.problem(path + ".steps", "a procedure names its steps itself",
                     "write calot.score.procedure { steps = ... }");
    expect_api(path + ".steps", reader.has("steps"), 2,
               "write api = 2: parts then earn by the steps that were done");
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

  void read_procedure(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("procedure"));
    part.kind = ScorePartKind::procedure;
    reader.read(part);
    part.name = "procedure";
    part.minor = read_events(reader, "minor");
    part.major = read_events(reader, "major");
    part.steps = read_steps(reader);
  }

  std::vector<std::string> read_steps(const TableReader& reader) {
    std::vector<std::string> names;
    const Value* steps = reader.take("steps");
    for (std::size_t i = 0; steps != nullptr && i < steps->items.size(); ++i) {
      if (!steps->items[i].is(Value::Kind::text))
        check_.problem(indexed(reader.path_of("steps"), i), "this must be a step's name", "as t:step has it");
      names.push_back(steps->items[i].text);
    }
    return names;
  }

  /// A key that only one version knows.
  void expect_api(const std::string& path, bool given, int api, const char* hint) {
    if (given && api_ != api) check_.problem(path, fmt::format("this belongs to api = {}", api), hint);
  }

  void read_time(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("time_score"));
    part.kind = ScorePartKind::time;
    reader.read(part);
    part.name = "time";
    part.errors = read_events(reader, "errors");
    if (reader.has("reference") && reader.has("limit") && part.reference >= part.limit)
      check_.problem(
          path + ".limit",
          fmt::format("the limit, {:g} s, is not after the reference, {:g} s", part.limit, part.reference),
          "who takes as long as the limit earns nothing");
  }

  void read_critical_view(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("critical_view"));
    part.kind = ScorePartKind::critical_view;
    part.metric = "note.critical_view_points";
    reader.read(part);
    part.name = "critical_view";
  }

  void read_rule(ScorePart& part, const Value& value, const std::string& path) {
    const TableReader reader(check_, &value, path, api_table("rule"));
    part.kind = ScorePartKind::rule;
    if (const Value* judge = reader.take("judge")) part.rule = judge->function;
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
  int api_;
  bool all_weighted_ = true;
};

void read_times(FieldCheck& check, const Value& at, double time_limit, std::vector<double>& out) {
  for (std::size_t i = 0; i < at.items.size(); ++i) {
    const Value& time = at.items[i];
    const std::string path = indexed("golden.at", i);
    if (!time.is(Value::Kind::number)) {
      check.problem(path, "this must be a time in s, got " + name_of(time.kind), "such as 10 * s");
    } else if (check.in_range(path, time.number, quantity::time, 0, time_limit, "within the time limit")) {
      out.push_back(time.number);
    }
  }
}

/// `others`: the moments before it.
GoldenMoment read_moment(FieldCheck& check, const Value& value, const std::string& path,
                         const std::vector<GoldenMoment>& others) {
  GoldenMoment moment;
  const TableReader reader(check, &value, path, api_table("moment"));
  reader.read(moment);
  moment.place.path = path;
  if (!value.is(Value::Kind::table)) return moment;
  const auto given = [&](const char* key) { return value.field(key) != nullptr; };  // fit or not
  if (reader.has("name") && check.identifier(path + ".name", moment.name, "picture")) {
    const auto same = [&](const GoldenMoment& other) { return other.name == moment.name; };
    if (moment.name == "end" || std::any_of(others.begin(), others.end(), same))
      check.problem(path + ".name", fmt::format("another picture is called \"{}\"", moment.name),
                    "give each a name of its own");
  }
  if (!given("event") && !given("step"))
    check.problem(path, "the moment waits for nothing", "give event = \"grasp\", or step = \"expose\"");
  if (!given("event") && (given("organ") || given("count")))
    check.problem(path, "organ and count say more of an event, and there is none", "give event too");
  return moment;
}

GoldenDefinition read_golden(FieldCheck& check, const Value* value, double time_limit) {
  GoldenDefinition golden;
  const TableReader reader(check, value, "golden", api_table("golden"));
  const Value *at = reader.take("at"), *moments = reader.take("moments");
  const std::size_t times = at ? at->items.size() : 0, all = times + (moments ? moments->items.size() : 0);
  if (all > GoldenDefinition::most_pictures)
    check.problem("golden", fmt::format("{} pictures, more than {}", all, GoldenDefinition::most_pictures),
                  "keep those that show something");
  if (value != nullptr && value->field("at") == nullptr && value->field("moments") == nullptr)
    check.problem("golden", "no picture is asked for", "give at = { 0, 10 * s }");
  if (at) read_times(check, *at, time_limit, golden.at);
  for (std::size_t i = 0; moments != nullptr && i < moments->items.size(); ++i)
    golden.moments.push_back(
        read_moment(check, moments->items[i], indexed("golden.moments", i), golden.moments));
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
  if (score != nullptr && score->function == 0) definition.score = read_score(check, *score, definition.api);
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

ScoreDefinition read_score(FieldCheck& check, const Value& score, int api) {
  return ScoreReader(check, score, api).read();
}

void check_names(FieldCheck& check, const ExerciseDefinition& exercise) {
  const std::vector<std::string> names = metric_names(exercise),
                                 organs = place_names(exercise.scene.anatomy, exercise.later_organs,
                                                      exercise.later_tissues);
  const auto check_metric = [&](const std::string& path, const std::string& metric) {
    if (metric.empty() || std::find(names.begin(), names.end(), metric) != names.end()) return;
    std::string hint = suggestion(metric, names);
    if (hint.starts_with("known")) hint = suggestion(metric, likely(metric, names));
    check.problem(path, fmt::format("unknown metric \"{}\"", metric), hint);
  };
  for (const ScorePart& part : exercise.score.parts) {
    check_metric(part.place.path + "[1].metric", part.metric);
    const std::string own = part.kind == ScorePartKind::procedure ? "[1].steps" : ".steps";
    for (std::size_t i = 0; i < part.steps.size(); ++i)
      check.known(indexed(part.place.path + own, i), part.steps[i], exercise.step_names, "step");
  }
  for (const GateDefinition& gate : exercise.score.gates) {
    check_metric(gate.place.path + ".metric", gate.metric);
    if (!gate.organ.empty()) check.known(gate.place.path + ".organ", gate.organ, organs, "organ");
    if (!gate.after_organ.empty())
      check.known(gate.place.path + ".after_organ", gate.after_organ, organs, "organ");
  }
  for (const GoldenMoment& moment : exercise.golden.moments) {
    if (!moment.organ.empty()) check.known(moment.place.path + ".organ", moment.organ, organs, "organ");
    if (!moment.step.empty())
      check.known(moment.place.path + ".step", moment.step, exercise.step_names, "step");
  }
}

}  // namespace calot
