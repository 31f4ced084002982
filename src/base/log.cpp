#include "base/log.h"

#include <cstdio>
#include <utility>

namespace calot {
namespace {

LogSink& sink() {
  static LogSink current = [](LogLevel level, const std::string& text) {
    std::fprintf(stderr, "%s%s\n", level == LogLevel::warning ? "warning: " : "", text.c_str());
  };
  return current;
}

}  // namespace

LogSink set_log_sink(LogSink next) { return std::exchange(sink(), std::move(next)); }
void log_info(const std::string& text) { sink()(LogLevel::info, text); }
void log_warning(const std::string& text) { sink()(LogLevel::warning, text); }

}  // namespace calot
