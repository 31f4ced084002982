#include "session/acts.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/suggest.h"
#include "session/json_fields.h"

namespace calot {

const std::vector<std::string>& session_act_names() {
  static const std::vector<std::string> names = {to_text(EventKind::time_out), to_text(EventKind::bail_out)};
  return names;
}

bool is_session_act(std::string_view name) {
  const std::vector<std::string>& names = session_act_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

Result<SessionAct> read_session_act(const std::string& name, const std::string& text) {
  if (!is_session_act(name))
    return fail(FailureKind::usage, fmt::format("\"{}\" is no act", shortened(name, 40)),
                suggestion(name, session_act_names()));
  if (text.size() > longest_act_text)
    return fail(FailureKind::usage, fmt::format("what is said at a {} is too long", name),
                fmt::format("say it in {} bytes", longest_act_text));
  const auto controls = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  if (!is_utf8(text) || std::any_of(text.begin(), text.end(), controls))
    return fail(FailureKind::usage, fmt::format("what is said at a {} is no plain text", name),
                "write it in UTF-8, on one line");
  return SessionAct{*event_called(name), text};
}

}  // namespace calot
