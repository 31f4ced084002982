#include "render/osmesa_context.h"

#include <GL/osmesa.h>

#include <cstdlib>
#include <utility>

#ifdef __SANITIZE_ADDRESS__
// Mesa 22.3 never frees the buffer record that it makes for a context (56 bytes each): not ours to report.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa.so\n"; }
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
#endif

namespace calot {
namespace {

// The override only takes features away. A binary built for AVX runs nowhere without it; neither class has
// fused multiply-add, the feature whose rounding differs between processors.
#ifdef __AVX__
constexpr const char *cpu_class = "avx", *vector_width = "256";
#else
constexpr const char *cpu_class = "sse4.1", *vector_width = "128";
#endif

}  // namespace

Result<OsmesaContext> OsmesaContext::create() {
  setenv("GALLIUM_OVERRIDE_CPU_CAPS", cpu_class, 1);
  setenv("LP_NATIVE_VECTOR_WIDTH", vector_width, 1);
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  void* context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context)
    return fail(FailureKind::resource, "OSMesa gives no OpenGL 4.5 core context",
                "install libosmesa6 of Mesa 22.3 and see `calot doctor`");
  OsmesaContext owner(context);
  if (!owner.make_current()) return fail(FailureKind::resource, "the OpenGL context cannot be made current");
  return owner;
}

OsmesaContext::OsmesaContext(OsmesaContext&& other) noexcept
    : context_(std::exchange(other.context_, nullptr)) {
  // The current context keeps the address of its buffer, which has just moved.
  if (context_ && OSMesaGetCurrentContext() == context_) make_current();
}

OsmesaContext& OsmesaContext::operator=(OsmesaContext&& other) noexcept {
  std::swap(context_, other.context_);
  if (context_ && OSMesaGetCurrentContext() == context_) make_current();
  return *this;
}

OsmesaContext::~OsmesaContext() {
  if (context_) OSMesaDestroyContext(static_cast<OSMesaContext>(context_));
}

bool OsmesaContext::make_current() {
  return OSMesaMakeCurrent(static_cast<OSMesaContext>(context_), pixel_, GL_UNSIGNED_BYTE, 1, 1) == GL_TRUE;
}

OsmesaContext::Function OsmesaContext::function(const char* name) { return OSMesaGetProcAddress(name); }

}  // namespace calot
