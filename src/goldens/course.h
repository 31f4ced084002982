#pragma once
// What became of a session, which builds of other bits must share: contacts and tears amplify last bits until pictures differ
// by thousands of pixels, but a demo that works does its steps all the same.

#include <optional>
#include <string>

#include "play/play.h"

namespace calot {

struct Course {
  std::optional<double> score = {};  ///< 0 to 100; none where the exercise is not judged
  int steps_done = 0;
  int errors = 0;  ///< events of the kinds that are errors
};

Course course_of(const Played& played);

/// "99.2 points, steps done: 7, errors: 0"; without a score "not judged, steps done: 7, errors: 0".
std::string to_text(const Course& course);

/// Whether a session that came to its end took a golden's course: the same steps, no more errors, and a score within 2 points.
bool same_course(const Course& golden, const Course& here);

OrderedJson course_json(const Course& course);
Course parse_course(const Json& json, std::vector<std::string>& problems);

}  // namespace calot
