#pragma once
// What happened in a session as JSON, as reports and recordings hold it, and back.

#include <string>
#include <vector>

#include "session/json.h"
#include "session/progress.h"

namespace calot {

OrderedJson steps_json(const Progress& progress);
OrderedJson events_json(const Progress& progress);
OrderedJson notes_json(const Progress& progress);

/// From such lists, without metrics; what is wrong with them is added to `problems`.
Progress read_progress(const Json& steps, const Json& events, const Json& notes,
                       std::vector<std::string>& problems);

}  // namespace calot
