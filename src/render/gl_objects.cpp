#include "render/gl_objects.h"

#include <fmt/format.h>

#include <vector>

namespace calot {
namespace {

Result<GLuint> compile(const GlFunctions& gl, GLenum stage, const std::string& name,
                       const std::string& source) {
  const GLuint shader = gl.CreateShader(stage);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0, length = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  gl.GetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length) + 1, '\0');
  gl.GetShaderInfoLog(shader, length, nullptr, log.data());
  gl.DeleteShader(shader);
  return fail(FailureKind::internal,
              fmt::format("the {} shader `{}` does not compile: {}",
                          stage == GL_VERTEX_SHADER ? "vertex" : "fragment", name, log.c_str()));
}

Result<Target> checked(const GlFunctions& gl, const Target& target, const char* what) {
  const GLenum status = gl.CheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) return target;
  return fail(FailureKind::resource, fmt::format("the {} framebuffer of {} x {} is incomplete (0x{:x})", what,
                                                 target.width, target.height, status));
}

Target begin_target(const GlFunctions& gl, int width, int height) {
  Target target;
  target.width = width, target.height = height;
  gl.GenFramebuffers(1, &target.framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
  return target;
}

void attach(const GlFunctions& gl, GLenum place, GLuint texture) {
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture, 0);
}

}  // namespace

Result<GLuint> build_program(const GlFunctions& gl, const std::string& name, const std::string& vertex,
                             const std::string& fragment) {
  const Result<GLuint> first = compile(gl, GL_VERTEX_SHADER, name, vertex);
  if (!first) return first.failure();
  const Result<GLuint> second = compile(gl, GL_FRAGMENT_SHADER, name, fragment);
  if (!second) return second.failure();
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {first.value(), second.value()}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // freed with the program
  }
  gl.LinkProgram(program);
  GLint linked = 0, length = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked) return program;
  gl.GetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length) + 1, '\0');
  gl.GetProgramInfoLog(program, length, nullptr, log.data());
  return fail(FailureKind::internal,
              fmt::format("the shader program `{}` does not link: {}", name, log.c_str()));
}

GLuint make_texture(const GlFunctions& gl, const TextureShape& shape) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(shape.internal), shape.width, shape.height, 0,
                shape.format, shape.type, nullptr);
  const GLint filter = shape.linear ? GL_LINEAR : GL_NEAREST;
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

Result<Target> make_colour_target(const GlFunctions& gl, int width, int height) {
  Target target = begin_target(gl, width, height);
  target.colour = make_texture(gl, {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height, true});
  attach(gl, GL_COLOR_ATTACHMENT0, target.colour);
  return checked(gl, target, "colour");
}

Result<Target> make_measured_target(const GlFunctions& gl, int width, int height) {
  Target target = begin_target(gl, width, height);
  target.colour = make_texture(gl, {GL_RGBA32F, GL_RGBA, GL_FLOAT, width, height, false});
  attach(gl, GL_COLOR_ATTACHMENT0, target.colour);
  return checked(gl, target, "measured");
}

Result<Target> make_multisample_target(const GlFunctions& gl, int width, int height, int samples) {
  Target target = begin_target(gl, width, height);
  gl.GenRenderbuffers(1, &target.colour);
  gl.GenRenderbuffers(1, &target.depth);
  gl.BindRenderbuffer(GL_RENDERBUFFER, target.colour);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA16F, width, height);
  gl.BindRenderbuffer(GL_RENDERBUFFER, target.depth);
  gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, target.colour);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, target.depth);
  return checked(gl, target, "multisampled");
}

Result<Target> make_resolved_target(const GlFunctions& gl, int width, int height) {
  Target target = begin_target(gl, width, height);
  target.colour = make_texture(gl, {GL_RGBA16F, GL_RGBA, GL_FLOAT, width, height, true});
  target.depth =
      make_texture(gl, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, width, height, false});
  attach(gl, GL_COLOR_ATTACHMENT0, target.colour);
  attach(gl, GL_DEPTH_ATTACHMENT, target.depth);
  return checked(gl, target, "resolved");
}

Result<Target> make_shadow_target(const GlFunctions& gl, int side) {
  Target target = begin_target(gl, side, side);
  target.depth = make_texture(gl, {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, side, side, true});
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  attach(gl, GL_DEPTH_ATTACHMENT, target.depth);
  gl.DrawBuffer(GL_NONE);
  gl.ReadBuffer(GL_NONE);
  return checked(gl, target, "shadow");
}

std::string pending_error(const GlFunctions& gl) {
  switch (const GLenum error = gl.GetError()) {
    case GL_NO_ERROR:
      return {};
    case GL_INVALID_ENUM:
      return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
      return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
      return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
      return "GL_OUT_OF_MEMORY";
    default:
      return fmt::format("OpenGL error 0x{:x}", error);
  }
}

}  // namespace calot
