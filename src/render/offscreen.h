#pragma once
// The laparoscope's picture of a scene, drawn into memory: in software without a window, or by a window's context, which
// it is then shown in.

#include <memory>

#include "base/status.h"
#include "render/gl_context.h"
#include "render/image.h"
#include "render/lens.h"
#include "render/scene.h"

namespace calot {

/// How finely a scene is drawn before the lens bends it.
struct DrawQuality {
  int samples = 4;    ///< a pixel; 0: its middle alone
  double detail = 1;  ///< pixels along a side for one of golden images
  int shadow = 640;   ///< pixels along a side of the light's view
  bool operator==(const DrawQuality&) const = default;
};
inline constexpr DrawQuality golden_quality{};
/// For who operates without a graphics card: with SceneDetail::coarse (view/coarse_mesh.h) a fifth of golden quality's time
/// (tests/bench/frame_bench.cpp).
inline constexpr DrawQuality live_quality{0, 0.6, 448};

/// Same scene, same size and quality: same bytes, at any thread count. Use it from the thread that created it.
class OffscreenRenderer {
 public:
  /// Failures: usage (a size outside 16 to 4096), resource (no OpenGL), internal (a shader does not compile).
  static Result<OffscreenRenderer> create(int width = 960, int height = 540,
                                          const DrawQuality& quality = golden_quality);
  /// By another context, which is current and stays so while this draws; what it draws depends on its OpenGL.
  static Result<OffscreenRenderer> create(std::unique_ptr<GlContext> context, int width, int height,
                                          const DrawQuality& quality = golden_quality);
  OffscreenRenderer(OffscreenRenderer&&) noexcept;
  OffscreenRenderer& operator=(OffscreenRenderer&&) noexcept;
  ~OffscreenRenderer();

  /// Failures (internal): arrays of a mesh that do not fit each other, numbers that are not finite, OpenGL
  /// errors.
  Result<Image> render(const Scene& scene);

  /// The same without reading the picture back.
  Result<bool> draw(const Scene& scene);
  /// Copies the picture drawn last into the context's own framebuffer, scaled; the place is in px from its lower left.
  void show(int x, int y, int width, int height) const;
  /// What is in that framebuffer there.
  Image shown(int x, int y, int width, int height) const;

  const Lens& lens() const;
  const DrawQuality& quality() const;
  /// What draws: "llvmpipe (LLVM 15.0.6, 128 bits), Mesa 22.3.6", for reports and golden images.
  std::string description() const;

 private:
  struct Impl;
  explicit OffscreenRenderer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace calot
