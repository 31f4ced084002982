#pragma once
// Draws Dear ImGui's lists by OpenGL 3.3: Debian's library has a backend for OpenGL 2 only.

#include "render/gl_functions.h"

struct ImDrawData;

namespace calot {

class DrawLists {
 public:
  /// Takes ImGui's font as it is now; needs its context and OpenGL's. Failures (internal): a shader.
  static Result<DrawLists> create(const GlFunctions& gl);
  /// Into the context's own framebuffer.
  void draw(const ImDrawData& data) const;

 private:
  explicit DrawLists(const GlFunctions& gl) : gl_(gl) {}
  void make_font();

  GlFunctions gl_;
  GLuint program_ = 0, font_ = 0, vertex_array_ = 0, vertices_ = 0, indices_ = 0;
};

}  // namespace calot
