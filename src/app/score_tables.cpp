#include "app/score_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "app/terminal.h"
#include "session/csv.h"
#include "session/scoring.h"

namespace calot {
namespace {

bool is_scored(const OrderedJson& entry) { return !entry.contains("failure"); }
bool is_whole(const OrderedJson& entry) { return is_scored(entry) && entry["whole"].get<bool>(); }
bool has_passed(const OrderedJson& entry) { return is_scored(entry) && entry["score"]["passed"].get<bool>(); }
double total_of(const OrderedJson& entry) { return entry["score"]["total"].get<double>(); }

/// The place of an entry's outcome in tables: more than all others for one without a score.
std::size_t outcome_rank(const OrderedJson& entry) {
  const std::vector<OutcomeRow>& rows = outcome_rows();
  if (!is_scored(entry)) return rows.size();
  const auto is = [&](const OutcomeRow& row) { return entry["score"]["outcome"] == row.name; };
  return static_cast<std::size_t>(std::find_if(rows.begin(), rows.end(), is) - rows.begin());
}

/// The totals of those that were finished, ascending.
std::vector<double> finished_totals(const ClassScores& scores) {
  std::vector<double> totals;
  for (const OrderedJson& entry : scores.entries)
    if (is_finished(entry)) totals.push_back(total_of(entry));
  std::sort(totals.begin(), totals.end());
  return totals;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

/// Of all parts, in the score's order; nan of one that nobody has.
std::vector<double> mean_points(const ClassScores& scores) {
  std::vector<double> means;
  for (std::size_t i = 0; i < scores.exercise.score.parts.size(); ++i) {
    std::vector<double> points;
    for (const OrderedJson& entry : scores.entries) {
      const OrderedJson* parts = parts_of(scores, entry);
      if (parts != nullptr && is_finished(entry)) points.push_back((*parts)[i]["points"].get<double>());
    }
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

OrderedJson class_json(const ClassScores& scores) {
  const auto count = [&](bool (*is)(const OrderedJson&)) {
    return std::count_if(scores.entries.begin(), scores.entries.end(), is);
  };
  OrderedJson json = {{"recordings", scores.entries.size()},
                      {"scored", count(is_scored)},
                      {"whole", count(is_whole)},
                      {"finished", count(is_finished)},
                      {"passed", count(has_passed)}};
  for (std::size_t rank = 0; rank < outcome_rows().size(); ++rank)
    json["outcomes"][outcome_rows()[rank].name] =
        std::count_if(scores.entries.begin(), scores.entries.end(),
                      [&](const OrderedJson& entry) { return outcome_rank(entry) == rank; });
  json["total"] = totals_json(finished_totals(scores));
  json["parts"] = OrderedJson::array();
  const std::vector<double> means = mean_points(scores);
  for (std::size_t i = 0; i < means.size(); ++i) {
    const ScorePart& part = scores.exercise.score.parts[i];
    json["parts"].push_back({{"name", part.name},
                             {"weight", part.weight},
                             {"mean_points", std::isnan(means[i]) ? OrderedJson() : OrderedJson(means[i])}});
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

std::set<std::string> all_metrics(const ClassScores& scores) {
  std::set<std::string> names;
  for (const OrderedJson& entry : scores.entries)
    if (is_scored(entry))
      for (const auto& [name, value] : entry["metrics"].items()) names.insert(name);
  return names;
}

std::vector<std::string> csv_entry(const ClassScores& scores, const OrderedJson& entry,
                                   const std::set<std::string>& metrics) {
  const OrderedJson& score = entry["score"];
  std::string critical;
  for (const OrderedJson& event : score["critical"])
    critical += (critical.empty() ? "" : " ") + event["event"].get<std::string>();
  std::string reasons;
  for (const OrderedJson& gate : score["gates"])
    reasons += fmt::format("{}{} ({})", reasons.empty() ? "" : "; ", gate["reason"].get<std::string>(),
                           gate["found"].get<std::string>());
  std::vector<std::string> fields;
  for (const char* key : {"file", "from", "end", "whole", "stopped_at_s"})
    fields.push_back(csv_value(entry[key]));
  for (const char* key : {"outcome", "verdict", "total", "passed", "completed", "steps_done", "steps"})
    fields.push_back(csv_value(score[key]));
  fields.push_back(csv_field(critical));
  fields.push_back(csv_field(reasons));
  const OrderedJson* parts = parts_of(scores, entry);
  for (std::size_t i = 0; i < scores.exercise.score.parts.size(); ++i)
    for (const char* key : {"points", "measured", "explanation"})
      fields.push_back(parts != nullptr ? csv_value((*parts)[i][key]) : "");
  for (const std::string& name : metrics)
    fields.push_back(entry["metrics"].contains(name) ? csv_value(entry["metrics"][name]) : "");
  fields.emplace_back();
  return fields;
}

std::string class_verdict(const OrderedJson& entry) {
  return has_passed(entry) ? green(verdict_text(entry)) : red(verdict_text(entry));
}

std::string one_decimal(double value) { return fmt::format("{:.1f}", value); }

std::vector<std::string> class_row(const ClassScores& scores, const OrderedJson& entry) {
  std::vector<std::string> row{entry["file"].get<std::string>()};
  row.push_back(has_total(entry) ? one_decimal(total_of(entry)) : "");
  row.push_back(is_scored(entry) ? steps_text(entry) : "");
  const OrderedJson* parts = parts_of(scores, entry);
  for (std::size_t i = 0; i < scores.exercise.score.parts.size(); ++i)
    row.push_back(parts != nullptr ? one_decimal((*parts)[i]["points"].get<double>()) : "");
  row.push_back(class_verdict(entry));  // last: colours have a width for the table, and none on the screen
  return row;
}

std::string class_table(const ClassScores& scores) {
  std::vector<std::vector<std::string>> rows{{"recording", "score", "steps"}};
  for (const ScorePart& part : scores.exercise.score.parts)
    rows[0].push_back(fmt::format("{} ({:.0f})", part.name, 100 * part.weight));
  const std::string alignment = "lrr" + std::string(scores.exercise.score.parts.size(), 'r') + 'l';
  rows[0].emplace_back("verdict");
  for (const std::size_t i : by_outcome(scores.entries)) rows.push_back(class_row(scores, scores.entries[i]));
  const std::vector<double> totals = finished_totals(scores);
  if (totals.size() > 1) {
    rows.push_back({fmt::format("mean of {} finished, of {} attempts", totals.size(),
                                std::count_if(scores.entries.begin(), scores.entries.end(), is_scored)),
                    one_decimal(mean_of(totals)), ""});
    for (const double points : mean_points(scores))
      rows.back().push_back(std::isnan(points) ? "" : one_decimal(points));
    rows.back().emplace_back();
  }
  return table(rows, alignment);
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
                    part["name"].get<std::string>(), part["explanation"].get<std::string>()});
  return gates + table(rows, "rrll");
}

std::string counts_text(const ClassScores& scores) {
  const OrderedJson counted = class_json(scores);
  const auto number = [&](const char* key) { return counted[key].get<std::size_t>(); };
  std::string text = fmt::format("{} of {} passed (pass mark {:.0f})", number("passed"), number("recordings"),
                                 scores.exercise.score.pass);
  if (number("scored") > number("whole"))
    text += fmt::format("; {} scored up to where they stop", number("scored") - number("whole"));
  if (number("recordings") > number("scored"))
    text += fmt::format("; {} without a score", number("recordings") - number("scored"));
  return text + '\n';
}

}  // namespace

const OrderedJson* parts_of(const ClassScores& scores, const OrderedJson& entry) {
  if (!is_scored(entry)) return nullptr;
  const OrderedJson& parts = entry["score"]["parts"];
  const std::vector<ScorePart>& expected = scores.exercise.score.parts;
  const bool same =
      std::equal(expected.begin(), expected.end(), parts.begin(), parts.end(),
                 [](const ScorePart& part, const OrderedJson& json) { return json["name"] == part.name; });
  return same ? &parts : nullptr;
}

bool has_total(const OrderedJson& entry) { return is_scored(entry) && !entry["score"]["total"].is_null(); }

std::string steps_text(const OrderedJson& entry) {
  return fmt::format("{}/{}", entry["score"]["steps_done"].get<std::size_t>(),
                     entry["score"]["steps"].get<std::size_t>());
}

bool is_finished(const OrderedJson& entry) {
  return has_total(entry) && entry["score"]["completed"].get<bool>();
}

std::vector<std::size_t> by_outcome(const std::vector<OrderedJson>& entries) {
  std::vector<std::size_t> order(entries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return outcome_rank(entries[a]) < outcome_rank(entries[b]);
  });
  return order;
}

std::string verdict_text(const OrderedJson& entry) {
  if (!is_scored(entry)) return "no score";
  std::string text = entry["score"]["verdict"].get<std::string>();
  if (!is_whole(entry))
    text += fmt::format(" ({} at {:.2f} s)", entry["end"].get<std::string>(),
                        entry["stopped_at_s"].get<double>());
  return text;
}

std::string scores_json(const ClassScores& scores) {
  OrderedJson json = {{"schema", "calot.scores/2"},
                      {"scenario", scores.exercise.id},
                      {"title", scores.exercise.title},
                      {"file", scores.exercise.file},
                      {"pass_mark", scores.exercise.score.pass},
                      {"benchmarks", benchmarks_json(scores.benchmarks)},
                      {"recordings", scores.entries}};
  json["class"] = class_json(scores);
  return json_text(json) + '\n';
}

std::string scores_csv(const ClassScores& scores) {
  std::vector<std::string> head{"file",       "from",    "end",      "whole",  "stopped_at_s",
                                "outcome",    "verdict", "total",    "passed", "completed",
                                "steps_done", "steps",   "critical", "gates"};
  for (const ScorePart& part : scores.exercise.score.parts) {
    head.push_back(csv_field(part.name + " points"));
    head.push_back(csv_field(part.name + " measured"));
    head.push_back(csv_field(part.name + " reason"));
  }
  const std::set<std::string> metrics = all_metrics(scores);
  for (const std::string& name : metrics) head.push_back(csv_field(name));
  head.emplace_back("failure");
  std::string text = csv_row(head);
  for (const std::size_t i : by_outcome(scores.entries)) {
    const OrderedJson& entry = scores.entries[i];
    std::vector<std::string> fields(head.size());
    if (is_scored(entry)) {
      fields = csv_entry(scores, entry, metrics);
    } else {
      fields.front() = csv_value(entry["file"]);
      fields.back() = csv_field(failure_text(entry));
    }
    text += csv_row(fields);
  }
  return text;
}

std::string scores_text(const ClassScores& scores) {
  std::string text =
      fmt::format("{} ({})\n\n{}", bold(scores.exercise.title), scores.exercise.id, class_table(scores));
  if (scores.entries.size() == 1 && is_scored(scores.entries[0])) text += '\n' + explained(scores.entries[0]);
  text += '\n' + counts_text(scores);
  if (scores.benchmarks)
    text += fmt::format("Benchmarks: {}, version {}, {}.\n", scores.benchmarks->name,
                        scores.benchmarks->version, scores.benchmarks->calibration);
  else
    text += "Benchmarks are design values, uncalibrated.\n";
  if (scores.exercise.api == 1) text += fmt::format("{}\n", api_1_remark);
  return text;
}

std::string failure_text(const OrderedJson& entry) {
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
