#include "render/image_compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

namespace calot {
namespace {

struct Blob {
  int pixels = 0, left = 0, top = 0, right = 0, bottom = 0;
};

std::vector<int> pixel_deltas(const Image& a, const Image& b) {
  std::vector<int> delta(static_cast<std::size_t>(a.width) * a.height);
  for (std::size_t i = 0; i < delta.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      delta[i] = std::max(delta[i], std::abs(a.rgb[3 * i + c] - b.rgb[3 * i + c]));
  return delta;
}

/// Floods the blob that holds `start` and clears it from `marked`.
Blob take_blob(std::vector<char>& marked, int width, int height, int start) {
  Blob blob{0, width, height, 0, 0};
  std::vector<int> stack{start};
  marked[start] = 0;
  while (!stack.empty()) {
    const int x = stack.back() % width, y = stack.back() / width;
    stack.pop_back();
    ++blob.pixels;
    blob.left = std::min(blob.left, x), blob.right = std::max(blob.right, x);
    blob.top = std::min(blob.top, y), blob.bottom = std::max(blob.bottom, y);
    for (int ny = std::max(y - 1, 0); ny <= std::min(y + 1, height - 1); ++ny)
      for (int nx = std::max(x - 1, 0); nx <= std::min(x + 1, width - 1); ++nx)
        if (marked[ny * width + nx]) {
          marked[ny * width + nx] = 0;
          stack.push_back(ny * width + nx);
        }
  }
  return blob;
}

Blob largest_blob(const std::vector<int>& delta, int width, int height, int above) {
  std::vector<char> marked(delta.size());
  for (std::size_t i = 0; i < delta.size(); ++i) marked[i] = delta[i] > above;
  Blob largest;
  for (std::size_t i = 0; i < delta.size(); ++i) {
    if (!marked[i]) continue;
    const Blob blob = take_blob(marked, width, height, static_cast<int>(i));
    if (blob.pixels > largest.pixels) largest = blob;
  }
  return largest;
}

Image difference_picture(const Image& b, const std::vector<int>& delta) {
  Image picture = b;
  for (std::size_t i = 0; i < delta.size(); ++i) {
    unsigned char* p = &picture.rgb[3 * i];
    const int grey = (p[0] + p[1] + p[2]) / 9;
    p[0] = p[1] = p[2] = static_cast<unsigned char>(grey);
    if (delta[i] == 0) continue;
    p[0] = 255;  // even a difference of 1 must be seen
    p[1] = static_cast<unsigned char>(delta[i]);
    p[2] = 0;
  }
  return picture;
}

}  // namespace

Result<ImageDifference> compare(const Image& a, const Image& b, const CompareTolerance& tolerance) {
  if (a.width != b.width || a.height != b.height)
    return fail(FailureKind::usage, fmt::format("pictures of {} x {} and {} x {} cannot be compared", a.width,
                                                a.height, b.width, b.height));
  const std::vector<int> delta = pixel_deltas(a, b);
  ImageDifference result;
  for (const int d : delta) {
    result.max_delta = std::max(result.max_delta, d);
    if (d > tolerance.small_delta) ++result.differing_pixels;
  }
  const Blob blob = largest_blob(delta, a.width, a.height, tolerance.large_delta);
  result.largest_blob = blob.pixels;
  if (blob.pixels > 0) {
    result.blob_x = blob.left, result.blob_y = blob.top;
    result.blob_width = blob.right - blob.left + 1, result.blob_height = blob.bottom - blob.top + 1;
  }
  result.within =
      result.differing_pixels <= tolerance.differing_pixels && blob.pixels <= tolerance.blob_pixels;
  result.picture = difference_picture(b, delta);
  return result;
}

}  // namespace calot
