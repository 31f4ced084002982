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
  void add(T value) { add_bytes(&value, sizeof value); }
  void add_bytes(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  /// With their number.
  template <class T>
  requires std::is_arithmetic_v<T>
  void add(std::span<const T> values) {
    add(values.size());
    add_bytes(values.data(), values.size_bytes());
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
    take(&value, sizeof value);
    return value;
  }
  template <class T>
  requires std::is_arithmetic_v<T> std::vector<T> numbers() {
    std::vector<T> out(counted(sizeof(T)));
    take(out.data(), out.size() * sizeof(T));
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
    return holds(count, each) ? count : 0;
  }
  /// Whether so many things of so many bytes each can follow; where not, bytes lack.
  bool holds(std::size_t count, std::size_t each) {
    lacking_ |= count > left_.size() / each;
    return !lacking_;
  }
  /// The next bytes, where they are there; else `to` stays as it is.
  void take(void* to, std::size_t size) {
    if (size == 0 || !holds(size, 1)) return;
    std::memcpy(to, left_.data(), size);
    left_.remove_prefix(size);
  }
  /// What was read does not fit together: it counts as if bytes had lacked.
  void refuse() { lacking_ = true; }
  bool lacks() const { return lacking_; }
  /// Whether all was there, and nothing is left.
  bool complete() const { return !lacking_ && left_.empty(); }

 private:
  std::string_view left_;
  bool lacking_ = false;
};

}  // namespace calot
