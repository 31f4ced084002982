#include "window/draw_lists.h"

#include <imgui.h>

#include <cstddef>
#include <cstdint>

#include "render/gl_objects.h"

namespace calot {
namespace {

constexpr const char* vertex_shader = R"(#version 330 core
layout(location = 0) in vec2 place;
layout(location = 1) in vec2 at;
layout(location = 2) in vec4 tint;
uniform vec2 lower, size;
out vec2 uv;
out vec4 colour;
void main() {
  uv = at;
  colour = tint;
  vec2 share = (place - lower) / size;
  gl_Position = vec4(2.0 * share.x - 1.0, 1.0 - 2.0 * share.y, 0.0, 1.0);
})";
constexpr const char* fragment_shader = R"(#version 330 core
in vec2 uv;
in vec4 colour;
uniform sampler2D font;
out vec4 result;
void main() { result = colour * texture(font, uv); })";

const void* offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

}  // namespace

Result<DrawLists> DrawLists::create(const GlFunctions& gl) {
  DrawLists lists(gl);
  const Result<GLuint> program = build_program(gl, "overlay", vertex_shader, fragment_shader);
  if (!program) return program.failure();
  lists.program_ = program.value();
  lists.make_font();
  gl.GenVertexArrays(1, &lists.vertex_array_);
  gl.GenBuffers(1, &lists.vertices_);
  gl.GenBuffers(1, &lists.indices_);
  gl.BindVertexArray(lists.vertex_array_);
  gl.BindBuffer(GL_ARRAY_BUFFER, lists.vertices_);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, lists.indices_);
  for (GLuint i = 0; i < 3; ++i) gl.EnableVertexAttribArray(i);
  constexpr auto stride = static_cast<GLsizei>(sizeof(ImDrawVert));
  gl.VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, offset(offsetof(ImDrawVert, pos)));
  gl.VertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, offset(offsetof(ImDrawVert, uv)));
  gl.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride, offset(offsetof(ImDrawVert, col)));
  return lists;
}

void DrawLists::make_font() {
  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
  gl_.GenTextures(1, &font_);
  gl_.BindTexture(GL_TEXTURE_2D, font_);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
}

void DrawLists::draw(const ImDrawData& data) const {
  const ImVec2 scale = data.FramebufferScale;
  const int height = static_cast<int>(data.DisplaySize.y * scale.y);
  gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl_.Viewport(0, 0, static_cast<int>(data.DisplaySize.x * scale.x), height);
  gl_.Disable(GL_DEPTH_TEST);
  gl_.Disable(GL_CULL_FACE);
  gl_.Enable(GL_BLEND);
  gl_.BlendEquation(GL_FUNC_ADD);
  gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.UseProgram(program_);
  gl_.Uniform1i(gl_.GetUniformLocation(program_, "font"), 0);
  gl_.Uniform2f(gl_.GetUniformLocation(program_, "lower"), data.DisplayPos.x, data.DisplayPos.y);
  gl_.Uniform2f(gl_.GetUniformLocation(program_, "size"), data.DisplaySize.x, data.DisplaySize.y);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.BindTexture(GL_TEXTURE_2D, font_);
  gl_.BindVertexArray(vertex_array_);
  gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_);
  for (int k = 0; k < data.CmdListsCount; ++k) {
    const ImDrawList& list = *data.CmdLists[k];
    gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                   GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr) continue;  // none is given
      const float left = (command.ClipRect.x - data.DisplayPos.x) * scale.x;
      const float upper = (command.ClipRect.y - data.DisplayPos.y) * scale.y;
      const float right = (command.ClipRect.z - data.DisplayPos.x) * scale.x;
      const float lower = (command.ClipRect.w - data.DisplayPos.y) * scale.y;
      if (right <= left || lower <= upper) continue;
      gl_.Scissor(static_cast<int>(left), height - static_cast<int>(lower), static_cast<int>(right - left),
                  static_cast<int>(lower - upper));
      gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount),
                       sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                       offset(command.IdxOffset * sizeof(ImDrawIdx)));
    }
  }
  // The scene's passes take these as they are at the start.
  gl_.Disable(GL_SCISSOR_TEST);
  gl_.Disable(GL_BLEND);
}

}  // namespace calot
