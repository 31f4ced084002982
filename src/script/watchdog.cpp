#include "script/watchdog.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>

namespace calot {
namespace {

constexpr auto poll_interval = std::chrono::milliseconds(50);

std::int64_t now() {
  const auto since = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since).count();
}

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

/// Past every lock that the hanging thread might hold.
void write_to_stderr(const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = ::write(STDERR_FILENO, text.data() + written, text.size() - written);
    if (count <= 0) return;
    written += static_cast<std::size_t>(count);
  }
}

}  // namespace

Watchdog::Watchdog(std::string script, double seconds, int exit_code)
    : script_(std::move(script)),
      seconds_(seconds),
      exit_code_(exit_code),
      left_(nanoseconds(seconds)),
      thread_([this](const std::stop_token& stop) { watch(stop); }) {}

void Watchdog::arm() { deadline_ = now() + left_; }

void Watchdog::disarm() { left_ = deadline_.exchange(0) - now(); }

void Watchdog::refill() {
  left_ = nanoseconds(seconds_);
  if (deadline_ != 0) arm();
}

void Watchdog::note_place(const std::string& file, int line) {
  file_ = &file;
  line_ = line;
}

void Watchdog::set_flush(std::function<void()> flush) {
  const std::lock_guard lock(mutex_);
  flush_ = std::move(flush);
}

void Watchdog::watch(const std::stop_token& stop) {
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    wake_.wait_for(lock, stop, poll_interval, [] { return false; });
    const std::int64_t deadline = deadline_;
    if (deadline != 0 && now() >= deadline) end_process();
  }
}

void Watchdog::end_process() {
  const std::string* file = file_;
  const std::string place = file != nullptr ? fmt::format("{}:{}", *file, line_.load()) : script_;
  write_to_stderr(fmt::format(
      "error: {}: the script has been running for {:g} s without simulated time going on and cannot "
      "be stopped (look for string.find, match or gsub with nested repetitions, library calls over huge "
      "texts, or tens of thousands of elseif); the process ends here\n",
      place, seconds_));
  if (flush_) flush_();
  std::_Exit(exit_code_);
}

}  // namespace calot
