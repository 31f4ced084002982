#pragma once
// Bytes of input from standard input, a file, a pipe or a socket, read by a thread of their own, decoded and put into a
// mailbox.

#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "input/live_decoder.h"
#include "input/sockets.h"

namespace calot {

/// A fresh one for each connection; `source` is what messages are to call it.
using DecoderMaker = std::function<std::unique_ptr<LiveDecoder>(const std::string& source)>;

class InputFeed {
 public:
  /// `input`: "-" is standard input; "unix:PATH" a local socket that is made there, "tcp:PORT" and "tcp:*:PORT" a port of
  /// this machine (input/sockets.h): each takes one sender at a time, one after another; "tcp:HOST:PORT" is connected to,
  /// and again where that is lost; anything else is a file or named pipe. Fails (usage) where that cannot be read or made.
  static Result<std::unique_ptr<InputFeed>> open(const std::string& input, DecoderMaker maker,
                                                 LiveMailbox& mailbox);
  /// Whether all there will be is there already: lines that come in no time of their own.
  bool is_file() const { return is_file_; }
  /// Address and port where it waits for senders; empty where it does not.
  const std::string& heard_at() const { return heard_at_; }
  /// Closes the mailbox too.
  ~InputFeed();
  InputFeed(const InputFeed&) = delete;
  InputFeed& operator=(const InputFeed&) = delete;

 private:
  InputFeed(std::string name, DecoderMaker maker, LiveMailbox& mailbox);
  std::optional<Failure> open_source(const std::string& input);
  std::optional<Failure> open_file(const std::string& path);
  std::optional<Failure> open_network(const std::string& place);
  void run();
  void accept_all();
  void stay_connected();
  void serve(int file, bool may_return);
  bool wait_for(int file, int most_ms = -1) const;

  std::string name_;
  DecoderMaker maker_;
  LiveMailbox& mailbox_;
  Descriptor file_, listener_;
  std::optional<NetworkPlace> server_;  ///< who is connected to
  Descriptor wake_, waker_;             ///< a pipe: written to, it ends the thread
  std::string socket_path_, heard_at_;  ///< to be removed; see heard_at()
  bool is_standard_ = false, is_file_ = false;
  bool told_ = false;  ///< that somebody sent nothing that can be used
  std::thread thread_;
};

}  // namespace calot
