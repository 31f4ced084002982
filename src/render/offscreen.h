#pragma once
// The laparoscope's picture of a scene, drawn in software without a window.

#include <memory>

#include "base/status.h"
#include "render/image.h"
#include "render/lens.h"
#include "render/scene.h"

namespace calot {

/// Same scene, same size: same bytes, at any thread count. Use it from the thread that created it.
class OffscreenRenderer {
 public:
  /// Failures: usage (a size outside 16 to 4096), resource (no OpenGL), internal (a shader does not compile).
  static Result<OffscreenRenderer> create(int width = 960, int height = 540);
  OffscreenRenderer(OffscreenRenderer&&) noexcept;
  OffscreenRenderer& operator=(OffscreenRenderer&&) noexcept;
  ~OffscreenRenderer();

  /// Failures (internal): arrays of a mesh that do not fit each other, numbers that are not finite, OpenGL
  /// errors.
  Result<Image> render(const Scene& scene);

  const Lens& lens() const;
  /// What draws: "llvmpipe (LLVM 15.0.6, 128 bits), Mesa 22.3.6", for reports and golden images.
  std::string description() const;

 private:
  struct Impl;
  explicit OffscreenRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace calot
