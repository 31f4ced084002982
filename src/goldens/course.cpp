#include "goldens/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "session/json_fields.h"

namespace calot {

Course course_of(const Played& played) {
  Course course;
  if (played.report.has_total()) course.score = played.report.score.total;
  course.steps_done = static_cast<int>(played.report.score.steps_done);
  const std::vector<SessionEvent>& events = played.session.progress.events();
  course.errors = static_cast<int>(std::count_if(
      events.begin(), events.end(), [](const SessionEvent& event) { return event_row(event.kind).error; }));
  return course;
}

std::string to_text(const Course& course) {
  return fmt::format("{}, steps done: {}, errors: {}",
                     course.score ? fmt::format("{:.1f} points", *course.score) : "not judged",
                     course.steps_done, course.errors);
}

bool same_course(const Course& golden, const Course& here) {
  constexpr double near = 2;  // points
  const bool same_score = golden.score && here.score ? std::abs(*golden.score - *here.score) <= near
                                                     : golden.score.has_value() == here.score.has_value();
  return same_score && here.steps_done == golden.steps_done && here.errors <= golden.errors;
}

OrderedJson course_json(const Course& course) {
  OrderedJson json = {{"score", nullptr}, {"steps_done", course.steps_done}, {"errors", course.errors}};
  if (course.score) json["score"] = *course.score;
  return json;
}

Course parse_course(const Json& json, std::vector<std::string>& problems) {
  constexpr int most = 1'000'000;
  JsonFields fields(json, problems, "course.");
  Course course;
  const bool judged = !fields.has("score") || !fields.any("score").is_null();
  if (judged) course.score = fields.number("score", 0, 100);
  course.steps_done = fields.integer("steps_done", 0, most);
  course.errors = fields.integer("errors", 0, most);
  fields.expect_no_others();
  return course;
}

}  // namespace calot
