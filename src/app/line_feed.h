#pragma once
// Lines of input (session/live_lines.h) from standard input, a file, a pipe or a local socket, read by a thread of
// their own into a mailbox.

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "session/live_lines.h"

namespace calot {

class LineFeed {
 public:
  /// `input`: "-" is standard input, "unix:PATH" a local socket that is made there and takes one sender at a time, one
  /// after another; anything else a file or named pipe. Fails (usage) where that cannot be read or made.
  static Result<std::unique_ptr<LineFeed>> open(const std::string& input,
                                                std::vector<LiveInstrument> instruments,
                                                LiveMailbox& mailbox);
  /// Whether all there will be is there already: lines that come in no time of their own.
  bool is_file() const { return is_file_; }
  /// Closes the mailbox too.
  ~LineFeed();
  LineFeed(const LineFeed&) = delete;
  LineFeed& operator=(const LineFeed&) = delete;

 private:
  LineFeed(std::string name, std::vector<LiveInstrument> instruments, LiveMailbox& mailbox);
  std::optional<Failure> open_file(const std::string& path);
  std::optional<Failure> listen_at(const std::string& path);
  void run();
  void serve(int file, bool may_return);
  bool wait_for(int file) const;

  std::string name_;
  std::vector<LiveInstrument> instruments_;
  LiveMailbox& mailbox_;
  int file_ = -1, listener_ = -1;
  int wake_[2] = {-1, -1};   ///< a pipe: written to, it ends the thread
  std::string socket_path_;  ///< to be removed
  bool owns_file_ = false, is_file_ = false;
  std::thread thread_;
};

}  // namespace calot
