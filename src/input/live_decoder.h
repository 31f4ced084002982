#pragma once
// What turns bytes that a program sends into events of a live session, whatever its protocol.

#include <string_view>
#include <vector>

#include "session/live.h"

namespace calot {

/// Of one connection. What cannot be used becomes a LiveRefusal with its place and why.
class LiveDecoder {
 public:
  virtual ~LiveDecoder() = default;
  virtual void add(std::string_view bytes, std::vector<LiveEvent>& events) = 0;
  /// After the last byte: what is not whole is refused.
  virtual void finish(std::vector<LiveEvent>& events) = 0;
  /// Whether the source has said that it ends.
  virtual bool ended() const = 0;
  /// Whether nothing that follows can be read.
  virtual bool broken() const { return false; }
};

}  // namespace calot
