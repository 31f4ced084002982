#pragma once
// Where a thread's OpenGL commands go: a picture in memory, or a window.

#include "render/gl_functions.h"

namespace calot {

class GlContext {
 public:
  virtual ~GlContext() = default;
  /// Makes this the calling thread's context; false when the library refuses.
  virtual bool make_current() = 0;
  /// Knows OpenGL's functions by name, once this is current.
  virtual GlLoader loader() const = 0;
};

}  // namespace calot
