#include "geometry/mesh_io.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/byte_order_mark.h"

namespace calot {

namespace {

constexpr std::uintmax_t longest_file = 8 << 20;  // bytes: a control mesh of 4,000 points has a tenth of that
constexpr std::size_t most_problems = 20;

/// The whole word as a number, or nothing.
template <class T>
bool parse(std::string_view word, T& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

class ObjReader {
 public:
  ObjReader(const std::string& path, double scale) : path_(path), scale_(scale) {}

  Result<TriMesh> read(std::istream& in) {
    std::string text;
    while (std::getline(in, text)) {
      ++line_;
      if (line_ == 1) text = std::string(without_byte_order_mark(text));
      while (text.ends_with('\r') || text.ends_with(' ')) text.pop_back();
      // A backslash at the end joins the next line to this one.
      for (std::string more; text.ends_with('\\') && std::getline(in, more); ++joined_) {
        text.back() = ' ';
        text += more;
        while (text.ends_with('\r')) text.pop_back();
      }
      read_record(text);
      line_ += std::exchange(joined_, 0);
    }
    if (in.bad()) complain("the file could not be read to its end");
    if (problems_.empty() && mesh_.triangles.empty())
      complain("the file has no faces", "export the mesh with its faces (f records)");
    if (unsaid_ > 0)
      problems_.push_back({{path_, line_, {}}, fmt::format("{} more lines are wrong", unsaid_), {}});
    if (!problems_.empty()) return Failure{FailureKind::scenario, std::move(problems_)};
    return std::move(mesh_);
  }

 private:
  void complain(std::string message, std::string hint = {}) {
    if (problems_.size() < most_problems)
      problems_.push_back({{path_, line_, {}}, std::move(message), std::move(hint)});
    else
      ++unsaid_;
  }

  /// A word as it can stand in a message.
  static std::string quoted(const std::string& word) { return word.substr(0, 40); }

  void read_record(const std::string& text) {
    std::istringstream words(text.substr(0, text.find('#')));
    std::string key;
    words >> key;
    if (key == "v") read_point(words);
    if (key == "f") read_face(words);
  }

  void read_point(std::istream& words) {
    Vec3 p = Vec3::Zero();
    std::string word;
    for (int k = 0; k < 3; ++k) {
      if (!(words >> word)) return complain("a point needs three coordinates", "v x y z");
      if (!parse(word, p[k]) || !std::isfinite(p[k]))
        return complain(fmt::format("'{}' is not a finite number", quoted(word)), "v x y z");
    }
    mesh_.points.push_back(scale_ * p);
  }

  void read_face(std::istream& words) {
    std::vector<int> corners;
    std::string word;
    while (words >> word) {
      int index = 0;
      if (!parse(std::string_view(word).substr(0, word.find('/')), index)) {
        return complain(fmt::format("'{}' is not a point of a face", quoted(word)),
                        "f 1 2 3, or f 1/1/1 2/2/2 3/3/3");
      }
      const int count = static_cast<int>(mesh_.points.size());
      const int zero_based = index > 0 ? index - 1 : count + index;  // negative: back from the last point
      if (index == 0 || zero_based < 0 || zero_based >= count) {
        return complain(fmt::format("the face names point {}, there are {} so far", index, count),
                        "indices start at 1, or at -1 from the last point back");
      }
      corners.push_back(zero_based);
    }
    if (corners.size() < 3) return complain("a face needs three points or more");
    for (std::size_t k = 2; k < corners.size(); ++k)
      mesh_.triangles.push_back({corners[0], corners[k - 1], corners[k]});
  }

  std::string path_;
  double scale_;
  int line_ = 0, joined_ = 0;
  int unsaid_ = 0;  ///< problems beyond those that are told
  TriMesh mesh_;
  std::vector<Problem> problems_;
};

}  // namespace

Result<TriMesh> read_obj(const std::string& path, double scale) {
  if (!(scale > 0) || !std::isfinite(scale)) {
    return fail(FailureKind::scenario, fmt::format("a mesh cannot be scaled by {}", scale),
                "give metres per unit of the file: 0.001 for millimetres", {path, 0, {}});
  }
  std::error_code unknown;
  if (const std::uintmax_t size = std::filesystem::file_size(path, unknown);
      !unknown && size > longest_file) {
    return fail(FailureKind::scenario, fmt::format("the mesh file has {} bytes", size),
                fmt::format("simplify the mesh: at most {} are read", longest_file), {path, 0, {}});
  }
  std::ifstream in(path);
  if (!in)
    return fail(FailureKind::scenario, "the mesh file cannot be opened", "check the path", {path, 0, {}});
  return ObjReader(path, scale).read(in);
}

}  // namespace calot
