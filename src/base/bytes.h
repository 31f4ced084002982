#pragma once
// Numbers as the bytes that they are in memory: for files that only this program on this machine reads again.

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace calot {

class ByteWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(T value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  /// With their number.
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) {
    add(values.size());
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  }
  void add(const std::vector<std::vector<int>>& lists) {
    add(lists.size());
    for (const std::vector<int>& list : lists) add(std::span<const int>(list));
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Reads what a ByteWriter wrote, in that order. Where bytes lack, all that follows is zeros and empty.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}
  template <class T>
  requires std::is_arithmetic_v<T> T number() {
    T value{};
    if (has(sizeof value)) take(&value, sizeof value);
    return value;
  }
  template <class T>
  requires std::is_arithmetic_v<T> std::vector<T> numbers() {
    const std::size_t count = counted(sizeof(T));
    std::vector<T> out(count);
    if (count > 0) take(out.data(), count * sizeof(T));
    return out;
  }
  std::vector<std::vector<int>> lists() {
    std::vector<std::vector<int>> out(counted(sizeof(std::size_t)));
    for (std::vector<int>& list : out) list = numbers<int>();
    return out;
  }
  /// How many things follow, of so many bytes each at least.
  std::size_t counted(std::size_t each) {
    const auto count = number<std::size_t>();
    if (count <= left_.size() / each) return count;
    lacking_ = true;
    return 0;
  }
  /// What was read does not fit together: it counts as if bytes had lacked.
  void refuse() { lacking_ = true; }
  /// Whether all was there, and nothing is left.
  bool complete() const { return !lacking_ && left_.empty(); }

 private:
  bool has(std::size_t size) {
    lacking_ |= left_.size() < size;
    return !lacking_;
  }
  void take(void* to, std::size_t size) {
    std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }

  std::string_view left_;
  bool lacking_ = false;
};

}  // namespace calot
