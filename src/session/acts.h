#pragma once
// Time-outs and bail-outs as who operates takes them, whatever the device.

#include <string>
#include <string_view>
#include <vector>

#include "base/status.h"
#include "tools/step_report.h"

namespace calot {

inline constexpr std::size_t longest_act_text = 200;  ///< bytes

/// "time_out", "bail_out".
const std::vector<std::string>& session_act_names();
bool is_session_act(std::string_view name);

/// Fails (usage) where the name is none of those, or the text is too long, no UTF-8, or has control characters.
Result<SessionAct> read_session_act(const std::string& name, const std::string& text);

}  // namespace calot
