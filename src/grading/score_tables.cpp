#include "grading/score_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "process/terminal.h"
#include "session/attempt.h"
#include "session/csv.h"
#include "session/scoring.h"

namespace calot {
namespace {

bool is_whole(const OrderedJson& entry) { return is_scored(entry) && entry["whole"].get<bool>(); }
bool has_passed(const OrderedJson& entry) { return is_scored(entry) && entry["score"]["passed"].get<bool>(); }
double total_of(const OrderedJson& entry) { return entry["score"]["total"].get<double>(); }
std::string text_of(const OrderedJson& value) { return value.is_string() ? value.get<std::string>() : ""; }

using Entries = std::vector<OrderedJson>;

std::size_t count(const Entries& entries, const ScoreGroup& group, bool (*is)(const OrderedJson&)) {
  return static_cast<std::size_t>(std::count_if(group.members.begin(), group.members.end(),
                                                [&](std::size_t i) { return is(entries[i]); }));
}

/// The totals of those that were finished, ascending.
std::vector<double> finished_totals(const Entries& entries, const ScoreGroup& group) {
  std::vector<double> totals;
  for (const std::size_t i : group.members)
    if (is_finished(entries[i])) totals.push_back(total_of(entries[i]));
  std::sort(totals.begin(), totals.end());
  return totals;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of the group's parts, over its finished attempts; nan where there is none.
std::vector<double> mean_points(const Entries& entries, const ScoreGroup& group) {
  std::vector<double> means;
  for (std::size_t part = 0; part < group.parts.size(); ++part) {
    std::vector<double> points;
    for (const std::size_t i : group.members)
      if (is_finished(entries[i]))
        points.push_back(entries[i]["score"]["parts"][part]["points"].get<double>());
    means.push_back(points.empty() ? std::numeric_limits<double>::quiet_NaN() : mean_of(points));
  }
  return means;
}

OrderedJson totals_json(const std::vector<double>& totals) {
  OrderedJson json = {{"mean", nullptr},
                      {"median", nullptr},
                      {"standard_deviation", nullptr},
                      {"least", nullptr},
                      {"most", nullptr}};
  if (totals.empty()) return json;
  const std::size_t half = totals.size() / 2;
  const double mean = mean_of(totals);
  double squares = 0;
  for (const double total : totals) squares += (total - mean) * (total - mean);
  json["mean"] = mean;
  json["median"] = totals.size() % 2 == 1 ? totals[half] : (totals[half - 1] + totals[half]) / 2;
  if (totals.size() > 1)
    json["standard_deviation"] = std::sqrt(squares / static_cast<double>(totals.size() - 1));
  json["least"] = totals.front();
  json["most"] = totals.back();
  return json;
}

OrderedJson group_json(const Entries& entries, const ScoreGroup& group) {
  OrderedJson json = {{"mode", group.mode},
                      {"params", group.params},
                      {"digest", group.digest},
                      {"pass_mark", group.pass_mark},
                      {"files", OrderedJson::array()},
                      {"scored", group.members.size()},
                      {"whole", count(entries, group, is_whole)},
                      {"finished", count(entries, group, is_finished)},
                      {"passed", count(entries, group, has_passed)}};
  for (const std::size_t i : group.members) json["files"].push_back(entries[i]["file"]);
  for (const OutcomeRow& row : outcome_rows())
    json["outcomes"][row.name] =
        std::count_if(group.members.begin(), group.members.end(),
                      [&](std::size_t i) { return entries[i]["score"]["outcome"] == row.name; });
  json["total"] = totals_json(finished_totals(entries, group));
  json["parts"] = OrderedJson::array();
  const std::vector<double> means = mean_points(entries, group);
  for (std::size_t part = 0; part < means.size(); ++part) {
    OrderedJson entry;
    for (const char* key : {"name", "title", "weight"}) entry[key] = group.parts[part][key];
    entry["mean_points"] = std::isnan(means[part]) ? OrderedJson() : OrderedJson(means[part]);
    json["parts"].push_back(std::move(entry));
  }
  return json;
}

OrderedJson benchmarks_json(const std::optional<BenchmarkTable>& table) {
  if (!table) return {{"name", "the exercise's own"}, {"version", nullptr}, {"calibration", "uncalibrated"}};
  return {{"name", table->name}, {"version", table->version}, {"calibration", table->calibration}};
}

/// A text as it is, another value as JSON has it; nothing for null.
std::string csv_value(const OrderedJson& value) {
  if (value.is_null()) return {};
  return csv_field(value.is_string() ? value.get<std::string>() : value.dump());
}

/// Names of the groups' parts, each once, in the order in which they come.
std::vector<std::string> all_parts(const std::vector<ScoreGroup>& groups) {
  std::vector<std::string> names;
  for (const ScoreGroup& group : groups)
    for (const OrderedJson& part : group.parts)
      if (const std::string name = text_of(part["name"]);
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  return names;
}

std::set<std::string> all_metrics(const Entries& entries) {
  std::set<std::string> names;
  for (const OrderedJson& entry : entries)
    if (is_scored(entry))
      for (const auto& [name, value] : entry["metrics"].items()) names.insert(name);
  return names;
}

constexpr std::array session_keys = {"from", "end", "whole", "stopped_at_s", "measures"};
constexpr std::array score_keys = {"scoring", "digest", "pass_mark", "outcome",    "verdict",
                                   "total",   "passed", "completed", "steps_done", "steps"};
constexpr std::array part_keys = {"points", "weight", "measured", "explanation"};

/// The table of CSV: what each row has, column by column.
class CsvTable {
 public:
  explicit CsvTable(const ClassScores& scores)
      : scores_(scores),
        groups_(score_groups(scores.entries)),
        parts_(all_parts(groups_)),
        metrics_(all_metrics(scores.entries)) {}

  std::string text() const {
    std::string text = csv_row(head());
    for (const std::size_t i : by_outcome(scores_.entries)) text += csv_row(row(i));
    return text;
  }

 private:
  std::vector<std::string> head() const {
    std::vector<std::string> head{"file", "group"};
    head.insert(head.end(), attempt_keys().begin(), attempt_keys().end());
    if (!scores_.names.empty()) head.emplace_back("name");
    head.insert(head.end(), session_keys.begin(), session_keys.end());
    head.insert(head.end(), score_keys.begin(), score_keys.end());
    for (const char* key : {"critical", "gates"}) head.emplace_back(key);
    for (const std::string& name : parts_)
      for (const char* what : {"points", "weight", "measured", "reason"})
        head.push_back(csv_field(name + ' ' + what));
    for (const std::string& name : metrics_) head.push_back(csv_field(name));
    head.emplace_back("failure");
    return head;
  }

  std::vector<std::string> row(std::size_t index) const {
    const OrderedJson& entry = scores_.entries[index];
    std::vector<std::string> row{csv_value(entry["file"])};
    if (!is_scored(entry)) {
      row.emplace_back();
      for (const std::string& key : attempt_keys())
        row.push_back(entry.contains(key) ? csv_value(entry[key]) : "");
      row.resize(head().size());
      row.back() = csv_field(failure_text(entry));
      return row;
    }
    row.push_back(csv_field(group_of(index)));
    for (const std::string& key : attempt_keys()) row.push_back(csv_value(entry[key]));
    if (!scores_.names.empty()) row.push_back(csv_field(name_of(entry)));
    for (const char* key : session_keys) row.push_back(csv_value(entry[key]));
    const OrderedJson& score = entry["score"];
    for (const char* key : score_keys) row.push_back(csv_value(score[key]));
    add_gates(score, row);
    for (const std::string& name : parts_) add_part(score, name, row);
    for (const std::string& name : metrics_)
      row.push_back(entry["metrics"].contains(name) ? csv_value(entry["metrics"][name]) : "");
    row.emplace_back();
    return row;
  }

  std::string group_of(std::size_t index) const {
    for (const ScoreGroup& group : groups_)
      if (std::find(group.members.begin(), group.members.end(), index) != group.members.end())
        return group_title(group, groups_);
    return {};
  }

  std::string name_of(const OrderedJson& entry) const {
    const auto found = scores_.names.find(text_of(entry["trainee"]));
    return found == scores_.names.end() ? "" : found->second;
  }

  static void add_gates(const OrderedJson& score, std::vector<std::string>& row) {
    std::string critical, reasons;
    for (const OrderedJson& event : score["critical"])
      critical += (critical.empty() ? "" : " ") + text_of(event["event"]);
    for (const OrderedJson& gate : score["gates"])
      reasons += fmt::format("{}{} ({})", reasons.empty() ? "" : "; ", text_of(gate["reason"]),
                             text_of(gate["found"]));
    row.push_back(csv_field(critical));
    row.push_back(csv_field(reasons));
  }

  static void add_part(const OrderedJson& score, const std::string& name, std::vector<std::string>& row) {
    const OrderedJson& parts = score["parts"];
    const auto part =
        std::find_if(parts.begin(), parts.end(), [&](const OrderedJson& one) { return one["name"] == name; });
    for (const char* key : part_keys) row.push_back(part == parts.end() ? "" : csv_value((*part)[key]));
  }

  const ClassScores& scores_;
  std::vector<ScoreGroup> groups_;
  std::vector<std::string> parts_;
  std::set<std::string> metrics_;
};

std::string class_verdict(const OrderedJson& entry) {
  return has_passed(entry) ? green(verdict_text(entry)) : red(verdict_text(entry));
}

std::string one_decimal(double value) { return fmt::format("{:.1f}", value); }

/// One group's table; columns that nobody has are left out.
class GroupTable {
 public:
  GroupTable(const ClassScores& scores, const ScoreGroup& group) : scores_(scores), group_(group) {
    for (const std::size_t i : group.members) {
      has_trainees_ = has_trainees_ || scores.entries[i]["trainee"].is_string();
      has_times_ = has_times_ || scores.entries[i]["began"].is_string();
    }
  }

  std::string text() const {
    std::vector<std::vector<std::string>> rows{head()};
    for (const std::size_t i : group_.members) rows.push_back(row(scores_.entries[i]));
    if (finished_totals(scores_.entries, group_).size() > 1) rows.push_back(means());
    std::string alignment = 'l' + std::string(before_score() - 1, 'l') + "rr";
    alignment += std::string(group_.parts.size(), 'r') + 'l';
    return table(rows, alignment);
  }

 private:
  std::size_t before_score() const { return 1U + (has_trainees_ ? 1U : 0U) + (has_times_ ? 2U : 0U); }

  std::vector<std::string> head() const {
    std::vector<std::string> head{"recording"};
    if (has_trainees_) head.emplace_back("trainee");
    if (has_times_) head.insert(head.end(), {"began", "attempt"});
    head.insert(head.end(), {"score", "steps"});
    for (const OrderedJson& part : group_.parts)
      head.push_back(fmt::format("{} ({:.0f})", text_of(part["name"]), 100 * part["weight"].get<double>()));
    head.emplace_back("verdict");
    return head;
  }

  std::vector<std::string> row(const OrderedJson& entry) const {
    std::vector<std::string> row{text_of(entry["file"])};
    if (has_trainees_) row.push_back(with_name(text_of(entry["trainee"]), scores_.names));
    if (has_times_)
      row.insert(row.end(), {began_text(entry), entry["attempt"].is_null() ? "" : entry["attempt"].dump()});
    row.push_back(has_total(entry) ? one_decimal(total_of(entry)) : "");
    row.push_back(steps_text(entry));
    for (const OrderedJson& part : entry["score"]["parts"])
      row.push_back(one_decimal(part["points"].get<double>()));
    row.push_back(class_verdict(entry));  // last: colours have a width for the table, and none on the screen
    return row;
  }

  std::vector<std::string> means() const {
    const std::vector<double> totals = finished_totals(scores_.entries, group_);
    std::vector<std::string> row{
        fmt::format("mean of {} finished, of {} attempts", totals.size(), group_.members.size())};
    row.resize(before_score());
    row.insert(row.end(), {one_decimal(mean_of(totals)), ""});
    for (const double points : mean_points(scores_.entries, group_))
      row.push_back(std::isnan(points) ? "" : one_decimal(points));
    row.emplace_back();
    return row;
  }

  const ClassScores& scores_;
  const ScoreGroup& group_;
  bool has_trainees_ = false, has_times_ = false;
};

/// What the columns of parts are about, each once.
std::string legend(const std::vector<ScoreGroup>& groups) {
  std::vector<std::vector<std::string>> rows;
  for (const std::string& name : all_parts(groups))
    for (const ScoreGroup& group : groups) {
      const auto part = std::find_if(group.parts.begin(), group.parts.end(),
                                     [&](const OrderedJson& one) { return one["name"] == name; });
      if (part == group.parts.end()) continue;
      rows.push_back({name, text_of((*part)["title"])});
      break;
    }
  return rows.empty() ? "" : "Parts:\n" + table(rows, "ll") + '\n';
}

std::string group_text(const ClassScores& scores, const ScoreGroup& group,
                       const std::vector<ScoreGroup>& all) {
  return fmt::format("{}: {} of {} passed (pass mark {:g})\n{}\n", bold(group_title(group, all)),
                     count(scores.entries, group, has_passed), group.members.size(), group.pass_mark,
                     GroupTable(scores, group).text());
}

/// Copies, and recordings without a score, each with its reason.
std::string not_counted(const Entries& entries) {
  std::string text;
  for (const OrderedJson& entry : entries) {
    if (is_scored(entry)) continue;
    std::string why = failure_text(entry);
    for (std::size_t at = why.find('\n'); at != std::string::npos; at = why.find('\n', at))
      why.replace(at, 1, "; ");
    // A failure's text begins with its file.
    text += fmt::format("  {}{}\n", entry.contains("failure") ? "" : text_of(entry["file"]) + ": ", why);
  }
  return text.empty() ? "" : "Not counted:\n" + text + '\n';
}

std::string explained(const OrderedJson& entry) {
  std::vector<std::vector<std::string>> rows;
  std::string gates;
  for (const OrderedJson& gate : entry["score"]["gates"])
    gates += fmt::format("  {} ({}): the total is capped at {:g}\n", gate["reason"].get<std::string>(),
                         gate["found"].get<std::string>(), gate["cap"].get<double>());
  for (const OrderedJson& part : entry["score"]["parts"])
    rows.push_back({one_decimal(part["points"].get<double>()),
                    fmt::format("of {:.1f}", 100 * part["weight"].get<double>()),
                    fmt::format("{} ({})", part["title"].get<std::string>(), part["name"].get<std::string>()),
                    part["explanation"].get<std::string>()});
  return gates + table(rows, "rrll");
}

}  // namespace

bool has_total(const OrderedJson& entry) { return is_scored(entry) && !entry["score"]["total"].is_null(); }

std::string steps_text(const OrderedJson& entry) {
  return fmt::format("{}/{}", entry["score"]["steps_done"].get<std::size_t>(),
                     entry["score"]["steps"].get<std::size_t>());
}

bool is_finished(const OrderedJson& entry) {
  return has_total(entry) && entry["score"]["completed"].get<bool>();
}

std::string began_text(const OrderedJson& entry) {
  std::string text = text_of(entry["began"]);
  if (text.size() < 16) return text;
  text[10] = ' ';
  return text.substr(0, 16);
}

std::string verdict_text(const OrderedJson& entry) {
  if (!is_scored(entry)) return entry.contains("copy_of") ? "a copy" : "no score";
  std::string text = entry["score"]["verdict"].get<std::string>();
  if (!is_whole(entry))
    text += fmt::format(" ({} at {:.2f} s)", entry["end"].get<std::string>(),
                        entry["stopped_at_s"].get<double>());
  return text;
}

std::string scores_json(const ClassScores& scores) {
  OrderedJson json = {{"schema", "calot.scores/3"},
                      {"scenario", scores.exercise.id},
                      {"title", scores.exercise.title},
                      {"file", scores.exercise.file},
                      {"pass_mark", scores.exercise.score.pass},
                      {"benchmarks", benchmarks_json(scores.benchmarks)},
                      {"recordings", scores.entries},
                      {"groups", OrderedJson::array()}};
  for (OrderedJson& entry : json["recordings"])
    if (const auto name = scores.names.find(entry.contains("trainee") ? text_of(entry["trainee"]) : "");
        name != scores.names.end())
      entry["name"] = name->second;
  for (const ScoreGroup& group : score_groups(scores.entries))
    json["groups"].push_back(group_json(scores.entries, group));
  return json_text(json) + '\n';
}

std::string scores_csv(const ClassScores& scores) { return CsvTable(scores).text(); }

std::string scores_text(const ClassScores& scores) {
  std::string text = fmt::format("{} ({})\n\n", bold(scores.exercise.title), scores.exercise.id);
  const std::vector<ScoreGroup> groups = score_groups(scores.entries);
  for (const ScoreGroup& group : groups) text += group_text(scores, group, groups);
  text +=
      scores.entries.size() == 1 && !groups.empty() ? explained(scores.entries[0]) + '\n' : legend(groups);
  text += not_counted(scores.entries);
  if (groups.size() > 1) text += "What is of another mode, parameters or score is averaged apart.\n";
  if (scores.benchmarks)
    text += fmt::format("Benchmarks: {}, version {}, {}.\n", scores.benchmarks->name,
                        scores.benchmarks->version, scores.benchmarks->calibration);
  else
    text += "Benchmarks are design values, uncalibrated.\n";
  if (scores.exercise.api == 1) text += fmt::format("{}\n", api_1_remark);
  return text;
}

std::string failure_text(const OrderedJson& entry) {
  if (entry.contains("copy_of"))
    return fmt::format("the same session as {}: it counts once", text_of(entry["copy_of"]));
  std::string text;
  for (const OrderedJson& problem : entry["failure"]) {
    const Problem plain{{problem["file"].get<std::string>(), problem["line"].get<int>(), {}},
                        problem["message"].get<std::string>(),
                        problem["hint"].get<std::string>()};
    if (!text.empty()) text += '\n';
    text += to_text(plain);
  }
  return text;
}

}  // namespace calot
