#include "process/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace calot {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

constexpr char announcement[] =
    "\nStopping in order; interrupt again to end at once and lose what is not written.\n";

extern "C" void calot_on_interrupt(int) {
  interrupted = true;
  // What runs may take seconds to end. Nothing can be done about a message that can't be written.
  const ssize_t written = write(STDERR_FILENO, announcement, sizeof announcement - 1);
  static_cast<void>(written);
}

}  // namespace

namespace {

bool listen() {
  struct sigaction action = {};
  action.sa_handler = calot_on_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the second signal has its default effect
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return true;
}

}  // namespace

const std::atomic<bool>& interrupt_flag() {
  static const bool listening = listen();  // once: the second signal must find its default effect
  static_cast<void>(listening);
  return interrupted;
}

}  // namespace calot
