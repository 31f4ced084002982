#pragma once
// Progress and warnings go to stderr; tests replace the sink and fail on any unexpected warning.

#include <functional>
#include <string>

namespace calot {

enum class LogLevel { info, warning };

using LogSink = std::function<void(LogLevel, const std::string&)>;

/// Replaces the process-wide sink and returns the one before. Call it before threads start.
LogSink set_log_sink(LogSink sink);

void log_info(const std::string& text);
void log_warning(const std::string& text);

}  // namespace calot
