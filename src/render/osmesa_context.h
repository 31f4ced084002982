#pragma once
// A software OpenGL context without a window: the one place that knows OSMesa.

#include "base/status.h"
#include "render/gl_context.h"

namespace calot {

/// OpenGL 4.5 core profile on llvmpipe. Before the first context the process pins the processor's feature
/// class (AVX where this binary needs it anyway, SSE 4.1 in a build for older ones), so that one binary draws
/// the same picture on every machine it runs on.
class OsmesaContext : public GlContext {
 public:
  /// Fails (resource) when the library gives no such context.
  static Result<OsmesaContext> create();
  OsmesaContext(OsmesaContext&& other) noexcept;
  OsmesaContext& operator=(OsmesaContext&& other) noexcept;
  ~OsmesaContext() override;

  bool make_current() override;
  GlLoader loader() const override { return &function; }

  using Function = void (*)();
  static Function function(const char* name);

 private:
  explicit OsmesaContext(void* context) : context_(context) {}
  void* context_ = nullptr;
  unsigned char pixel_[4] = {0, 0, 0, 0};  // OSMesa wants a buffer of its own; ours is a framebuffer object
};

}  // namespace calot
