#include "render/jpeg.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <memory>

namespace calot {
namespace {

struct DestroyCoder {
  void operator()(void* coder) const { tjDestroy(coder); }
};

}  // namespace

Result<std::string> jpeg_bytes(const Image& image, int quality) {
  if (image.width <= 0 || image.height <= 0 ||
      image.rgb.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3)
    return fail(FailureKind::usage, fmt::format("a picture of {} x {} with {} bytes cannot be coded",
                                                image.width, image.height, image.rgb.size()));
  const std::unique_ptr<void, DestroyCoder> coder(tjInitCompress());
  std::string bytes(tjBufSize(image.width, image.height, TJSAMP_420), '\0');
  auto* begin = reinterpret_cast<unsigned char*>(bytes.data());
  unsigned long size = bytes.size();
  const bool coded = coder != nullptr && tjCompress2(coder.get(), image.rgb.data(), image.width, 0,
                                                     image.height, TJPF_RGB, &begin, &size, TJSAMP_420,
                                                     quality, TJFLAG_NOREALLOC | TJFLAG_ACCURATEDCT) == 0;
  if (!coded)
    return fail(FailureKind::resource,
                fmt::format("a picture cannot be coded as JPEG: {}", tjGetErrorStr2(coder.get())));
  bytes.resize(size);
  return bytes;
}

}  // namespace calot
