#include "lua/load_exercise.h"

#include <fmt/format.h>

#include <algorithm>

#include "anatomy/instruments.h"
#include "base/suggest.h"
#include "field/divide_body.h"
#include "lua/calot_module.h"
#include "lua/demo_script.h"
#include "lua/handles.h"
#include "lua/read_exercise.h"
#include "lua/read_scene.h"
#include "lua/score_rules.h"
#include "lua/steps_script.h"
#include "lua/table_file.h"
#include "organs/body_kinds.h"
#include "script/lua_headers.h"
#include "script/source_map.h"
#include "session/metrics.h"

namespace calot {
namespace {

/// What blades may leave of a scene's tubes.
std::vector<OrganDefinition> pieces_of_tubes(const SceneDefinition& scene) {
  std::vector<OrganDefinition> out;
  const bool blades = std::any_of(scene.instruments.begin(), scene.instruments.end(), [](const auto& tool) {
    return instrument_row(tool.type).jaws == JawUse::cut;
  });
  for (const OrganDefinition& organ : scene.anatomy.organs) {
    if (!blades || !std::holds_alternative<TubeShape>(organ.shape)) continue;
    for (const std::string& name : piece_names(organ.name)) {
      out.push_back(organ);
      out.back().name = name;
    }
  }
  return out;
}

namespace fs = std::filesystem;

/// The exercise's functions in one Lua state, and what it declares.
struct Script {
  std::unique_ptr<Sandbox> sandbox;
  ExerciseTable table;
  Value scene;
};

class Loader {
 public:
  Loader(const fs::path& path, const LoadOptions& options, ScriptTexts texts = {})
      : path_(path), options_(options), texts_(std::move(texts)) {}

  /// Twice the same: once to check it, running steps and demo dry; and once, in a fresh state that no dry run
  /// has touched, to play it.
  Result<std::unique_ptr<ExerciseScript>> load();
  /// Whether the file runs and returns something that is no exercise.
  bool is_module();
  /// Asks the rules of the score in a fresh state: nothing that was played or asked before has touched it.
  Result<RuleAnswers> judge(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
                            const Progress& progress);

 private:
  Result<Value> run_chunk(Sandbox& sandbox);
  Result<std::unique_ptr<Sandbox>> make_sandbox() const;
  Result<Script> open(bool quiet, FieldCheck& check);
  /// Runs and checks; what it declares, or nothing where problems were found.
  Result<std::optional<ExerciseDefinition>> check_all();
  std::optional<Failure> call_scene(Script& script);
  /// A score that is a function of the parameters; a plain table has been read with the exercise.
  std::optional<Failure> call_score(Script& script, FieldCheck& check);
  ExerciseDefinition define(Script& script, FieldCheck& check);
  /// The rules of the score, asked of a session in which nothing happened: names that do not exist are found so.
  std::optional<Failure> try_rules(const Script& script, const ExerciseDefinition& definition);
  /// A failure is of resources; the scripts' own become problems.
  std::optional<Failure> run_dry(Script& script, ExerciseDefinition& definition, FieldCheck& check);
  void collect(const std::vector<Problem>& problems);
  void collect_validation(const std::vector<Problem>& problems);
  void collect(const Failure& failure);
  Failure all_problems();

  fs::path path_;
  LoadOptions options_;
  ScriptTexts texts_;  ///< as read when the exercise was checked; empty until then
  std::string text_;
  SourceMap map_;
  std::vector<Problem> problems_;
};

/// Where brackets are nested deepest: Lua does not say where it gave up.
int deepest_line(const std::string& text) {
  int line = 1, depth = 0, deepest = 0, found = 1;
  for (const char c : text) {
    line += c == '\n' ? 1 : 0;
    if (std::string_view("({[").find(c) != std::string_view::npos) ++depth;
    if (std::string_view(")}]").find(c) != std::string_view::npos) --depth;
    if (depth <= deepest) continue;
    deepest = depth;
    found = line;
  }
  return found;
}

bool is_exercise(const Value& root) {
  const Value* kind = root.field("kind");
  return kind != nullptr && kind->text == "exercise";
}

/// The rules as they were read: whoever writes on while an exercise is played changes nothing of its score.
class LuaRules final : public ScoreRules {
 public:
  LuaRules(fs::path path, LoadOptions options, ScriptTexts texts)
      : path_(std::move(path)), options_(std::move(options)), texts_(std::move(texts)) {}
  Result<RuleAnswers> judge(const ExerciseDefinition& exercise, const std::map<std::string, double>& metrics,
                            const Progress& progress) const override {
    return Loader(path_, options_, texts_).judge(exercise, metrics, progress);
  }

 private:
  fs::path path_;
  LoadOptions options_;
  ScriptTexts texts_;
};

class LuaExercise final : public ExerciseScript {
 public:
  LuaExercise(Script script, ExerciseDefinition definition, SourceMap map)
      : map_(std::move(map)),
        script_(std::move(script)),
        definition_(std::move(definition)),
        steps_(*script_.sandbox, definition_, script_.table.steps, script_.table.parameters),
        demo_(*script_.sandbox, definition_, script_.table.demo, script_.table.parameters) {}

  const ExerciseDefinition& definition() const override { return definition_; }
  InputSource& demo() override { return demo_; }
  Result<bool> advance(World& world, Progress& progress, double dt) override {
    return steps_.advance(world, progress, dt);
  }
  void set_emergency_flush(const std::function<void()>& flush) override {
    script_.sandbox->watchdog().set_flush(flush);
  }
  Failure located(Failure failure) const override {
    for (Problem& problem : failure.problems) locate(problem, map_, definition_.file);
    return failure;
  }
  std::vector<Problem> rehearse(const World& world) override {
    rehearsal_.emplace(*script_.sandbox, definition_, script_.table.demo, script_.table.parameters,
                       &rehearsal_problems_);
    const std::optional<Failure> failure = rehearsal_->run_dry(&world);
    if (failure && !rehearsal_->is_no_mistake(*failure))
      rehearsal_problems_.insert(rehearsal_problems_.end(), failure->problems.begin(),
                                 failure->problems.end());
    return rehearsal_problems_;
  }

 private:
  SourceMap map_;
  Script script_;
  ExerciseDefinition definition_;
  StepsScript steps_;
  DemoScript demo_;
  std::vector<Problem> rehearsal_problems_;
  std::optional<DemoScript> rehearsal_;
};

/// Whether one field contains the other, or is it.
bool related(const std::string& a, const std::string& b) {
  const std::string& shorter = a.size() < b.size() ? a : b;
  const std::string& longer = a.size() < b.size() ? b : a;
  return longer.starts_with(shorter) &&
         (longer.size() == shorter.size() || longer[shorter.size()] == '.' || longer[shorter.size()] == '[');
}

Result<std::unique_ptr<Sandbox>> Loader::make_sandbox() const {
  SandboxOptions options;
  options.script = path_;
  options.modules = options_.modules;
  options.seed = options_.seed;
  options.limits = options_.limits;
  options.texts = texts_;
  return Sandbox::create(options);
}

/// What the file returns. Lines are sought only in a text that Lua has found sound.
Result<Value> Loader::run_chunk(Sandbox& sandbox) {
  Result<Value> root = Value{};
  std::optional<Failure> failure = sandbox.protect([&](lua_State* L) {
    open_calot_module(L);
    open_handles(L);
    sandbox.push_chunk(L, path_, text_);
    map_ = SourceMap(text_);
    lua_call(L, 0, 1);
    root = read_value(L, -1);
  });
  if (failure) return *failure;
  return root;
}

Result<Script> Loader::open(bool quiet, FieldCheck& check) {
  Result<std::unique_ptr<Sandbox>> sandbox = make_sandbox();
  if (!sandbox) return sandbox.failure();
  Script script;
  script.sandbox = std::move(sandbox).value();
  script.sandbox->set_quiet(quiet);
  const Result<Value> root = run_chunk(*script.sandbox);
  if (!root) return root.failure();
  if (!is_exercise(root.value()))
    return fail(FailureKind::scenario, "the scenario returns no exercise",
                "end it with: return calot.exercise { ... }");
  script.table = read_exercise(check, root.value(), options_.params);
  keep_first(script.table.usage);
  if (!script.table.usage.empty()) return Failure{FailureKind::usage, script.table.usage};
  return script;
}

/// What one of the exercise's functions gives for the parameters; `name` is its field.
std::optional<Failure> call(Script& script, int function, const std::string& name, Value& value) {
  Result<Value> result = Value{};
  std::optional<Failure> failure = script.sandbox->protect([&](lua_State* L) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, function);
    push_parameters(L, script.table.parameters);
    lua_call(L, 1, 1);
    result = read_value(L, -1, name);
  });
  if (failure) return failure;
  if (!result) return result.failure();
  value = std::move(result).value();
  return std::nullopt;
}

std::optional<Failure> Loader::call_scene(Script& script) {
  return call(script, script.table.scene, "scene", script.scene);
}

std::optional<Failure> Loader::call_score(Script& script, FieldCheck& check) {
  if (script.table.score == 0) return std::nullopt;
  Value score;
  std::optional<Failure> failure = call(script, script.table.score, "score", score);
  if (!failure) script.table.definition.score = read_score(check, score, script.table.definition.api);
  return failure;
}

ExerciseDefinition Loader::define(Script& script, FieldCheck& check) {
  ExerciseDefinition definition = script.table.definition;
  definition.file = path_.string();
  definition.seed = options_.seed;
  definition.scene = read_scene(
      check, script.scene, {path_.has_parent_path() ? path_.parent_path() : fs::path("."), options_.assets});
  definition.later_organs = pieces_of_tubes(definition.scene);
  return definition;
}

std::optional<Failure> Loader::run_dry(Script& script, ExerciseDefinition& definition, FieldCheck& check) {
  // Both outlive both runs: a handle that one leaves behind may be met in the other.
  StepsScript steps(*script.sandbox, definition, script.table.steps, script.table.parameters, &problems_);
  DemoScript demo(*script.sandbox, definition, script.table.demo, script.table.parameters, &problems_);
  if (script.table.steps != 0) {
    Result<StepsScript::Declared> declared = steps.run_dry();
    if (!declared && steps.is_no_mistake(declared.failure())) {
      // Nothing to say; what the steps declare is not known.
    } else if (declared) {
      definition.step_names = declared->steps;
      definition.hold_names = declared->holds;
      definition.note_names = declared->notes;
      definition.waited_steps = declared->waited;
      definition.later_organs = declared->later;
      definition.later_tissues = declared->later_tissues;
      // Steps that were not reached have metrics nobody knows of: say nothing about them.
      if (declared->complete) check_names(check, definition);
      if (std::optional<Failure> failure = try_rules(script, definition)) return failure;
    } else if (declared.failure().kind == FailureKind::resource) {
      return declared.failure();
    } else {
      collect(declared.failure());
    }
  }
  std::optional<Failure> failure = demo.run_dry();
  if (failure && failure->kind == FailureKind::resource) return failure;
  if (failure && !demo.is_no_mistake(*failure)) collect(*failure);
  return std::nullopt;
}

std::optional<Failure> Loader::try_rules(const Script& script, const ExerciseDefinition& definition) {
  const std::vector<std::string> names = metric_names(definition);
  const RuleRun nothing{definition, {}, Progress(), script.table.parameters, &names};
  std::vector<std::pair<int, bool>> rules;  // and whether it answers true or false
  for (const ScorePart& part : definition.score.parts)
    if (part.kind == ScorePartKind::rule) rules.emplace_back(part.rule, false);
  rules.emplace_back(definition.score.bail_out, true);
  for (const auto& [rule, yes_no] : rules) {
    if (rule == 0) continue;
    const std::optional<Failure> failure = try_rule(*script.sandbox, rule, nothing, yes_no);
    if (failure && failure->kind != FailureKind::scenario) return failure;
    if (failure) collect(*failure);
  }
  return std::nullopt;
}

void Loader::collect(const std::vector<Problem>& problems) {
  for (Problem problem : problems) {
    locate(problem, map_, path_.string());
    problems_.push_back(std::move(problem));
  }
}

/// What the reader has reported is not worth reporting again, nor what follows from it.
void Loader::collect_validation(const std::vector<Problem>& problems) {
  std::vector<Problem> fresh;
  for (const Problem& problem : problems) {
    const auto known = [&](const Problem& other) {
      return !other.place.path.empty() && related(other.place.path, problem.place.path);
    };
    if (std::none_of(problems_.begin(), problems_.end(), known)) fresh.push_back(problem);
  }
  collect(fresh);
}

void Loader::collect(const Failure& failure) { collect(failure.problems); }

Failure Loader::all_problems() {
  std::stable_sort(problems_.begin(), problems_.end(), [](const Problem& a, const Problem& b) {
    const auto key = [](const Problem& p) { return p.place.line > 0 ? p.place.line : 1 << 30; };
    return key(a) < key(b);
  });
  keep_first(problems_);
  return {FailureKind::scenario, std::move(problems_)};
}

/// In a state of its own, which is gone before the exercise is opened to be played.
Result<std::optional<ExerciseDefinition>> Loader::check_all() {
  FieldCheck check;
  Result<Script> checked = open(false, check);
  if (!checked) return checked.failure();
  collect(check.take());
  if (checked->table.scene == 0) return {std::nullopt};
  if (std::optional<Failure> failure = call_scene(checked.value())) {
    if (failure->kind != FailureKind::scenario) return *failure;
    collect(*failure);
    return {std::nullopt};
  }
  if (std::optional<Failure> failure = call_score(checked.value(), check)) {
    if (failure->kind != FailureKind::scenario) return *failure;
    collect(*failure);
  }
  ExerciseDefinition definition = define(checked.value(), check);
  collect(check.take());
  collect_validation(validate(definition.scene));
  collect_validation(mesh_problems(definition.scene));
  checked->sandbox->set_quiet(true);  // steps and demo print when they are played
  if (std::optional<Failure> failure = run_dry(checked.value(), definition, check)) return *failure;
  collect(check.take());
  if (!problems_.empty()) return {std::nullopt};
  texts_ = checked->sandbox->texts();
  return {std::move(definition)};
}

Result<std::unique_ptr<ExerciseScript>> Loader::load() {
  Result<std::string> text = Sandbox::read_text(path_);
  if (!text) return text.failure();
  text_ = std::move(text).value();
  Result<std::optional<ExerciseDefinition>> checked = check_all();
  if (!checked && checked.failure().kind != FailureKind::scenario) {
    Failure failure = checked.failure();
    for (Problem& problem : failure.problems)
      if (problem.place.line == 0 && problem.place.file == path_) problem.place.line = deepest_line(text_);
    return failure;
  }
  if (!checked) collect(checked.failure());
  if (!problems_.empty() || !checked->has_value()) return all_problems();
  ExerciseDefinition definition = *std::move(checked).value();

  FieldCheck again;
  Result<Script> script = open(true, again);
  if (!script) return script.failure();
  if (std::optional<Failure> failure = call_scene(script.value())) return *failure;
  if (std::optional<Failure> failure = call_score(script.value(), again)) return *failure;
  script->sandbox->set_quiet(false);
  definition.source_hash = script->sandbox->source_hash();
  for (ScorePart& part : definition.score.parts) {
    part.place.file = path_.string();
    part.place.line = map_.line_of(part.place.path);
  }
  const ScoreDefinition& score = definition.score;
  if (score.bail_out != 0 || std::any_of(score.parts.begin(), score.parts.end(), [](const ScorePart& part) {
        return part.kind == ScorePartKind::rule;
      }))
    definition.score.rules = std::make_shared<LuaRules>(path_, options_, texts_);
  return std::unique_ptr<ExerciseScript>(
      std::make_unique<LuaExercise>(std::move(script).value(), std::move(definition), std::move(map_)));
}

Result<RuleAnswers> Loader::judge(const ExerciseDefinition& exercise,
                                  const std::map<std::string, double>& metrics, const Progress& progress) {
  text_ = texts_.at(path_);
  FieldCheck check;
  Result<Script> script = open(true, check);
  if (!script) return script.failure();
  if (std::optional<Failure> failure = call_scene(script.value())) return *failure;
  if (std::optional<Failure> failure = call_score(script.value(), check)) return *failure;
  const RuleRun run{exercise, metrics, progress, script->table.parameters, nullptr};
  RuleAnswers answers;
  for (const ScorePart& part : script->table.definition.score.parts) {
    if (part.kind != ScorePartKind::rule) continue;
    Result<RuleAnswer> answer = ask_rule(*script->sandbox, part.rule, run);
    if (!answer) return answer.failure();
    answers.parts.push_back(std::move(answer).value());
  }
  if (const int rule = script->table.definition.score.bail_out; rule != 0 && progress.bailed_out()) {
    Result<RuleAnswer> answer = ask_rule(*script->sandbox, rule, run, true);
    if (!answer) return answer.failure();
    answers.bail_out = std::move(answer).value();
  }
  return answers;
}

bool Loader::is_module() {
  Result<std::string> text = Sandbox::read_text(path_);
  Result<std::unique_ptr<Sandbox>> sandbox = make_sandbox();
  if (!text || !sandbox) return false;
  text_ = std::move(text).value();
  sandbox.value()->set_quiet(true);
  const Result<Value> root = run_chunk(*sandbox.value());
  return root && !is_exercise(root.value());
}

/// The scenarios beside a path that does not exist, for a suggestion.
std::vector<std::string> neighbours(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".lua")
      names.push_back((path.parent_path() / entry.path().filename()).string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

Result<std::unique_ptr<ExerciseScript>> load_exercise(const fs::path& path, const LoadOptions& options) {
  if (!fs::is_regular_file(path))
    return fail(FailureKind::usage, fmt::format("there is no scenario {}", path.string()),
                suggestion(path.string(), neighbours(path)));
  return Loader(path, options).load();
}

bool is_module(const fs::path& path, const LoadOptions& options) { return Loader(path, options).is_module(); }

}  // namespace calot
