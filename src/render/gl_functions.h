#pragma once
// The OpenGL functions we use, filled through a loader: libepoxy resolves through GLX or EGL, not through
// OSMesa.

#include <GL/glcorearb.h>

#include <functional>

#include "base/status.h"

namespace calot {

// type suffix as in PFNGL...PROC, name as in gl...
#define CALOT_GL_FUNCTIONS(X)                                                                                \
  X(ACTIVETEXTURE, ActiveTexture)                                                                            \
  X(ATTACHSHADER, AttachShader)                                                                              \
  X(BINDBUFFER, BindBuffer)                                                                                  \
  X(BINDFRAMEBUFFER, BindFramebuffer)                                                                        \
  X(BINDRENDERBUFFER, BindRenderbuffer)                                                                      \
  X(BLENDEQUATION, BlendEquation) X(BLENDFUNC, BlendFunc) X(SCISSOR, Scissor) X(BINDTEXTURE, BindTexture) X( \
      BINDVERTEXARRAY, BindVertexArray) X(BLITFRAMEBUFFER, BlitFramebuffer) X(BUFFERDATA, BufferData)        \
      X(CHECKFRAMEBUFFERSTATUS, CheckFramebufferStatus) X(CLEAR, Clear) X(CLEARCOLOR, ClearColor) X(         \
          COLORMASK, ColorMask) X(COMPILESHADER, CompileShader) X(CREATEPROGRAM, CreateProgram)              \
          X(CREATESHADER, CreateShader) X(DELETESHADER, DeleteShader) X(DEPTHFUNC, DepthFunc) X(             \
              DISABLE, Disable) X(DRAWARRAYS, DrawArrays) X(DRAWBUFFER, DrawBuffer)                          \
              X(DRAWELEMENTS, DrawElements) X(ENABLE, Enable) X(                                             \
                  ENABLEVERTEXATTRIBARRAY, EnableVertexAttribArray) X(FRAMEBUFFERRENDERBUFFER,               \
                                                                      FramebufferRenderbuffer)               \
                  X(FRAMEBUFFERTEXTURE2D, FramebufferTexture2D) X(GENBUFFERS, GenBuffers) X(                 \
                      GENFRAMEBUFFERS, GenFramebuffers) X(GENRENDERBUFFERS, GenRenderbuffers)                \
                      X(GENTEXTURES, GenTextures) X(GENVERTEXARRAYS, GenVertexArrays) X(GETERROR, GetError)  \
                          X(GETPROGRAMINFOLOG, GetProgramInfoLog)                                            \
                              X(GETPROGRAMIV, GetProgramiv) X(GETSHADERINFOLOG, GetShaderInfoLog) X(         \
                                  GETSHADERIV, GetShaderiv) X(GETSTRING, GetString)                          \
                                  X(GETUNIFORMLOCATION, GetUniformLocation) X(LINKPROGRAM, LinkProgram) X(   \
                                      PIXELSTOREI, PixelStorei) X(POLYGONOFFSET, PolygonOffset)              \
                                      X(READBUFFER, ReadBuffer) X(READPIXELS, ReadPixels)                    \
                                          X(RENDERBUFFERSTORAGEMULTISAMPLE, RenderbufferStorageMultisample)  \
                                              X(SHADERSOURCE, ShaderSource) X(TEXIMAGE2D, TexImage2D)        \
                                                  X(TEXIMAGE3D, TexImage3D) X(TEXPARAMETERI, TexParameteri)  \
                                                      X(UNIFORM1F, Uniform1f) X(UNIFORM1I, Uniform1i)        \
                                                          X(UNIFORM2F, Uniform2f) X(UNIFORM3F, Uniform3f) X( \
                                                              UNIFORMMATRIX4FV, UniformMatrix4fv)            \
                                                              X(USEPROGRAM, UseProgram) X(                   \
                                                                  VERTEXATTRIBPOINTER, VertexAttribPointer)  \
                                                                  X(VIEWPORT, Viewport)                      \
                                                                      X(DELETETEXTURES, DeleteTextures)

struct GlFunctions {
#define CALOT_GL_MEMBER(TYPE, name) PFNGL##TYPE##PROC name = nullptr;
  CALOT_GL_FUNCTIONS(CALOT_GL_MEMBER)
#undef CALOT_GL_MEMBER
};

using GlLoader = std::function<void (*(const char* name))()>;

/// Fails (resource) naming the functions that the loader does not know.
Result<GlFunctions> load_gl(GlLoader loader);

}  // namespace calot
