#include "render/gl_functions.h"

#include <string>

namespace calot {

Result<GlFunctions> load_gl(GlLoader loader) {
  GlFunctions gl;
  std::string missing;
#define CALOT_GL_LOAD(TYPE, name)                                    \
  gl.name = reinterpret_cast<PFNGL##TYPE##PROC>(loader("gl" #name)); \
  if (!gl.name) missing += " gl" #name;
  CALOT_GL_FUNCTIONS(CALOT_GL_LOAD)
#undef CALOT_GL_LOAD
  if (!missing.empty()) return fail(FailureKind::resource, "the OpenGL library lacks" + missing);
  return gl;
}

}  // namespace calot
