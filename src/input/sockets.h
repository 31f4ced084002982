#pragma once
// Sockets that others connect to, and one that connects to others. All failures are usage, with what to do.

#include <string>

#include "base/status.h"

namespace calot {

/// A file of the system, closed with its holder; -1 is none.
class Descriptor {
 public:
  explicit Descriptor(int file = -1) : file_(file) {}
  ~Descriptor();
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  int get() const { return file_; }
  explicit operator bool() const { return file_ >= 0; }

 private:
  int file_;
};

/// At a path, for whoever may read the user's files. A socket that a program left which is gone is in nobody's way.
Result<Descriptor> listen_at_path(const std::string& path);

/// "PORT", "HOST:PORT" or, for all of this machine's networks, "*:PORT".
struct NetworkPlace {
  std::string host, port;
  bool is_here = false;  ///< it is to be listened at
};
Result<NetworkPlace> read_network_place(const std::string& text);

/// At a port of this machine, from itself only unless the host is "*". `heard_at` becomes the address and port: port 0 is
/// one that is free.
Result<Descriptor> listen_at(const NetworkPlace& place, std::string& heard_at);
/// Waits at most some seconds, or until `wake` can be read.
Result<Descriptor> connect_to(const NetworkPlace& place, int wake);
/// The next one who connects; none where it is gone again.
Descriptor accept_from(int listener);

}  // namespace calot
