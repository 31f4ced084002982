#include <fmt/format.h>

#include <set>

#include "app/commands.h"
#include "base/hash.h"
#include "base/log.h"
#include "grading/score_recording.h"
#include "grading/score_tables.h"
#include "grading/score_verdicts.h"
#include "lua/read_benchmarks.h"
#include "play/play.h"
#include "process/interrupt.h"
#include "process/output_folder.h"
#include "process/process_pool.h"
#include "process/project.h"
#include "process/terminal.h"
#include "session/json_fields.h"

namespace calot {
namespace {

namespace fs = std::filesystem;

/// What was scored before, one file an entry: "hash of the second line" and the entry without its file's name.
class Results {
 public:
  explicit Results(fs::path folder) : folder_(std::move(folder)) {}

  /// Null where there is none, or where it is not what was written.
  OrderedJson find(const std::string& key) const {
    std::error_code error;
    if (folder_.empty() || !fs::is_regular_file(path(key), error)) return {};
    const Result<std::string> text = read_text(path(key));
    const std::size_t end = text ? text->find('\n') : std::string::npos;
    if (end == std::string::npos || text->substr(0, end) != checksum(text->substr(end + 1))) return {};
    return OrderedJson::parse(text->substr(end + 1), nullptr, false);
  }

  Result<std::string> keep(const std::string& key, OrderedJson entry) const {
    entry.erase("file");
    const std::string text = entry.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
    return write_text(path(key), checksum(text) + '\n' + text);
  }

 private:
  fs::path path(const std::string& key) const { return folder_ / (key + ".json"); }
  static std::string checksum(const std::string& text) {
    Hash hash;
    hash.add(std::string_view(text));
    return '"' + hex(hash.value()) + '"';
  }

  fs::path folder_;
};

/// One run of the command.
class ClassScorer {
 public:
  ClassScorer(const ScoreCommand& command, RecordingScorer scorer, std::vector<std::string> files)
      : command_(command),
        scorer_(std::move(scorer)),
        files_(std::move(files)),
        results_(command.output),
        entries_(files_.size()) {}

  std::optional<Failure> run() {
    line_.emplace();
    const PoolOptions options{command_.jobs, &interrupt_flag()};
    const Result<int> done = work_in_processes(
        static_cast<int>(files_.size()), options, [this](int k) { return answer(k); },
        [this](int k, Result<std::string> text) { take(k, std::move(text)); });
    line_.reset();
    if (!done) return done.failure();
    if (interrupt_flag())
      return fail(FailureKind::interrupted,
                  fmt::format("interrupted when {} of {} recordings were done", done.value(), files_.size()));
    mark_copies(entries_);
    return unwritten_;
  }

  /// Copies are marked once all were scored.
  const std::vector<OrderedJson>& entries() const { return entries_; }
  int taken() const { return taken_; }

 private:
  const std::string& file(int k) const { return files_[static_cast<std::size_t>(k)]; }

  /// In a process of its own.
  std::string answer(int k) {
    const std::string key = command_.output.empty() ? "" : scorer_.key(file(k));
    OrderedJson json = {{"key", key}};
    OrderedJson kept = !key.empty() && !command_.again ? results_.find(key) : OrderedJson();
    if (kept.is_object())
      json["kept"] = std::move(kept);
    else
      json["entry"] = scorer_.score(file(k));
    return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
  }

  void take(int k, Result<std::string> text) {
    OrderedJson& entry = entries_[static_cast<std::size_t>(k)];
    entry = {{"file", file(k)}};
    if (!text) {
      Failure failure = text.failure();
      for (Problem& problem : failure.problems) problem.place.file = file(k);
      entry = failed_entry(file(k), failure);
    } else {
      add(OrderedJson::parse(text.value()), entry);
    }
    if (++done_; line_->due()) line_->show(fmt::format("{} of {} recordings", done_, files_.size()));
  }

  void add(const OrderedJson& answer, OrderedJson& entry) {
    const bool kept = answer.contains("kept");
    entry.update(kept ? answer["kept"] : answer["entry"]);
    const auto key = answer["key"].get<std::string>();
    if (kept && !fresh_.contains(key)) ++taken_;  // a copy's may have been written a moment ago
    if (kept || key.empty() || entry.contains("failure")) return;
    fresh_.insert(key);
    const Result<std::string> written = results_.keep(key, entry);
    if (!written && !unwritten_) unwritten_ = written.failure();
  }

  const ScoreCommand& command_;
  RecordingScorer scorer_;
  std::vector<std::string> files_;
  Results results_;
  std::vector<OrderedJson> entries_;
  int done_ = 0, taken_ = 0;
  std::set<std::string> fresh_;  ///< keys of what this run scored
  std::optional<Failure> unwritten_;
  std::optional<ProgressLine> line_;  ///< while it runs
};

Result<ScoreRequest> read_request(const ScoreCommand& command) {
  ScoreRequest request;
  request.exercise = command.exercise;
  request.verify = command.replay;
  request.keyed = !command.output.empty();
  if (command.benchmarks.empty()) return request;
  Result<BenchmarkTable> table = read_benchmarks(command.benchmarks, project_part("scripts/lua"));
  if (!table) return table.failure();
  request.benchmarks = std::move(table).value();
  return request;
}

/// Without names: what is kept has none.
std::optional<Failure> write_scores(const fs::path& folder, ClassScores scores) {
  if (folder.empty()) return std::nullopt;
  scores.names.clear();
  for (const auto& [name, text] :
       {std::pair{"scores.json", scores_json(scores)}, {"scores.csv", scores_csv(scores)}}) {
    const Result<std::string> written = write_text(folder / name, text);
    if (!written) return written.failure();
  }
  return std::nullopt;
}

void print_scores(const ClassScores& scores, const ScoreCommand& command) {
  const std::string text = command.json  ? scores_json(scores)
                           : command.csv ? scores_csv(scores)
                                         : scores_text(scores);
  std::fputs(text.c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

ExitCode score_command(const ScoreCommand& command) {
  interrupt_flag();  // before a process is started: from here on an interruption ends in order
  const std::string again = "calot score " + shell_word(command.exercise) + " ...";
  std::vector<std::string> files = recordings_of(command.recordings);
  if (files.empty()) {
    print_failure(no_recordings(command.recordings), "calot run " + shell_word(command.exercise),
                  command.json);
    return ExitCode::nothing_selected;
  }
  Result<ScoreRequest> request = read_request(command);
  if (!request) return print_failure(request.failure(), "calot score --help", command.json);
  const Result<NameRegister> names = read_names(command.names);
  if (!names) return print_failure(names.failure(), "calot score --help", command.json);
  const std::optional<BenchmarkTable> benchmarks = request->benchmarks;
  Result<RecordingScorer> scorer = RecordingScorer::create(std::move(request).value());
  if (!scorer) {
    const bool usage = scorer.failure().kind == FailureKind::usage;
    return print_failure(scorer.failure(),
                         usage ? "calot score --help" : "calot check " + shell_word(command.exercise),
                         command.json);
  }
  if (command.dry_run) {
    const std::optional<Failure> wrong = first_unreadable(files);
    return wrong ? print_failure(*wrong, "calot score --help", command.json) : ExitCode::ok;
  }
  const ExerciseDefinition exercise = scorer->exercise();
  std::optional<OutputFolder> folder;
  if (!command.output.empty()) {
    Result<OutputFolder> claimed = OutputFolder::claim(command.output);
    if (!claimed) return print_failure(claimed.failure(), "calot score --help", command.json);
    folder.emplace(std::move(claimed).value());
  }
  ClassScorer run(command, std::move(scorer).value(), std::move(files));
  std::optional<Failure> failure = run.run();
  const ClassScores scores{exercise, benchmarks, run.entries(), names.value()};
  if (!failure) failure = write_scores(command.output, scores);
  if (failure) return print_failure(*failure, again, command.json);
  if (run.taken() > 0)
    log_info(fmt::format("{} of {} taken from {}; --again scores them anew.", run.taken(),
                         scores.entries.size(), command.output));
  tell_why(scores.entries);
  print_scores(scores, command);
  return judge(scores.entries, command.exercise, command.fail_below);
}

}  // namespace calot
