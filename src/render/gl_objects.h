#pragma once
// Programs, textures and framebuffers of one context. Names live as long as their context does.

#include <string>

#include "render/gl_functions.h"

namespace calot {

/// Compiles and links; the pieces of each stage are joined. Fails (internal) with the compiler's log and
/// `name`.
Result<GLuint> build_program(const GlFunctions& gl, const std::string& name, const std::string& vertex,
                             const std::string& fragment);

struct TextureShape {
  GLenum internal = GL_RGBA8, format = GL_RGBA, type = GL_UNSIGNED_BYTE;
  int width = 0, height = 0;
  bool linear = true;
};

/// A texture clamped to its edge, without mip levels.
GLuint make_texture(const GlFunctions& gl, const TextureShape& shape);

/// What is drawn into: a framebuffer object and its attachments' names (0 when absent).
struct Target {
  GLuint framebuffer = 0, colour = 0, depth = 0;
  int width = 0, height = 0;
};

/// Colour only, one sample: RGBA8, or RGBA32F for what is measured.
Result<Target> make_colour_target(const GlFunctions& gl, int width, int height);
Result<Target> make_measured_target(const GlFunctions& gl, int width, int height);
/// Colour (RGBA16F: light that another exposure scales must not lie in steps) and depth (32-bit float) renderbuffers with
/// `samples` samples a pixel.
Result<Target> make_multisample_target(const GlFunctions& gl, int width, int height, int samples);
/// What a multisampled target is resolved into: such colour and depth as textures.
Result<Target> make_resolved_target(const GlFunctions& gl, int width, int height);
/// Depth only, compared in hardware (sampler2DShadow).
Result<Target> make_shadow_target(const GlFunctions& gl, int side);

/// The name of a pending OpenGL error, empty when there is none.
std::string pending_error(const GlFunctions& gl);

}  // namespace calot
