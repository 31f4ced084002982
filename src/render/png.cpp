#include "render/png.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace calot {
namespace {

constexpr png_uint_32 max_side = 4096;  // of our pictures: a header that claims more is not given the memory

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Failure file_failure(const std::string& path, const std::string& what, const std::string& hint = {}) {
  return fail(FailureKind::usage, what, hint, {path, 0, {}});
}

// The simplified libpng interface reports errors by value: no longjmp crosses C++ frames.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(&image); }
};

}  // namespace

Result<std::string> write_png(const std::string& path, const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.rgb.size() != static_cast<std::size_t>(image.width) * image.height * 3)
    return file_failure(path, fmt::format("a picture of {} x {} with {} bytes cannot be written", image.width,
                                          image.height, image.rgb.size()));
  const std::string temporary = path + ".part";
  File file(std::fopen(temporary.c_str(), "wb"));
  if (!file)
    return file_failure(path, fmt::format("cannot write {}: {}", temporary, std::strerror(errno)),
                        "check that the folder exists and may be written to");
  PngImage png;
  png.image.width = static_cast<png_uint_32>(image.width);
  png.image.height = static_cast<png_uint_32>(image.height);
  png.image.format = PNG_FORMAT_RGB;
  const bool written = png_image_write_to_stdio(&png.image, file.get(), 0, image.rgb.data(), 0, nullptr) != 0;
  const bool closed = std::fclose(file.release()) == 0;
  std::error_code error;
  if (written && closed) std::filesystem::rename(temporary, path, error);
  if (written && closed && !error) return path;
  const std::string reason = !written ? png.image.message : error ? error.message() : "the disk may be full";
  std::filesystem::remove(temporary, error);
  return file_failure(path, "cannot write the picture: " + reason,
                      "choose a folder that exists and has space");
}

Result<Image> read_png(const std::string& path) {
  File file(std::fopen(path.c_str(), "rb"));
  if (!file) return file_failure(path, fmt::format("cannot read the picture: {}", std::strerror(errno)));
  PngImage png;
  if (png_image_begin_read_from_stdio(&png.image, file.get()) == 0)
    return file_failure(path, fmt::format("not a readable PNG: {}", png.image.message));
  if (png.image.width > max_side || png.image.height > max_side)
    return file_failure(path, fmt::format("picture of {} x {} is larger than {} a side", png.image.width,
                                          png.image.height, max_side));
  png.image.format = PNG_FORMAT_RGB;
  Image image;
  image.width = static_cast<int>(png.image.width);
  image.height = static_cast<int>(png.image.height);
  image.rgb.resize(PNG_IMAGE_SIZE(png.image));
  const png_color background{0, 0, 0};  // what transparent pixels are laid over
  if (png_image_finish_read(&png.image, &background, image.rgb.data(), 0, nullptr) == 0)
    return file_failure(path, fmt::format("broken PNG: {}", png.image.message));
  return image;
}

}  // namespace calot
