#pragma once
// Structs as one number after another: a function beside each struct lists its members, and from that list come hashes,
// digests and bytes, written and read again.
//
//   void visit_members(auto&& visit, MembersOf<Drop> auto& drop) {
//     auto& [liquid, at, velocity, volume] = drop;
//     visit(liquid, at, velocity, volume);
//   }
//
// The names take the struct apart by all of its members: one that gets another is an error there until that is named.
// What is named and not visited follows from the others, or is no part of any result: a comment says which. A class that
// is read by being made anew has two functions: one of a const object for any visit, and one of a MemberReader.

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "base/bytes.h"
#include "geometry/types.h"

namespace calot {

/// A struct or a const one.
template <class Struct, class Of>
concept MembersOf = std::same_as<std::remove_const_t<Struct>, Of>;

/// Takes any members.
struct AnyVisit {
  void operator()(const auto&...) const {}
};
/// What has a visit_members().
template <class T>
concept Listed = requires(T& value) {
  visit_members(AnyVisit(), value);
};

template <class T>
concept EigenNumbers = std::derived_from<T, Eigen::PlainObjectBase<T>>;
template <class T>
concept Number = std::is_arithmetic_v<T>;
/// What a MemberReader reads, too, has a last_of(value): its last enumerator, of those that count from 0.
template <class T>
concept Enumeration = std::is_enum_v<T>;

/// Writes values by their bits: lists, texts and matrices behind their lengths, what may be absent behind whether it is
/// there. `Out`: Hash, Digest or ByteWriter.
template <class Out>
class MemberWriter {
 public:
  explicit MemberWriter(Out& out) : out_(out) {}
  template <class... Each>
  void operator()(const Each&... each) {
    (put(each), ...);
  }

 private:
  void put(Number auto value) { out_.add(value); }
  template <Enumeration T>
  void put(T value) {
    out_.add(static_cast<std::underlying_type_t<T>>(value));
  }
  void put(const std::string& text) {
    put(text.size());
    out_.add_bytes(text.data(), text.size());
  }
  template <class T>
  void put(const std::vector<T>& list) {
    put(list.size());
    for (const T& each : list) put(each);
  }
  template <Number T>
  void put(const std::vector<T>& list) {
    put(list.size());
    out_.add_bytes(list.data(), list.size() * sizeof(T));
  }
  template <class T, std::size_t count>
  void put(const std::array<T, count>& values) {
    for (const T& each : values) put(each);
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class... T>
  void put(const std::variant<T...>& value) {
    put(value.index());
    std::visit([&](const auto& held) { put(held); }, value);
  }
  template <class One, class Other>
  void put(const std::pair<One, Other>& both) {
    put(both.first);
    put(both.second);
  }
  template <class Key, class T>
  void put(const std::map<Key, T>& table) {
    put(table.size());
    for (const auto& [key, value] : table) {
      put(key);
      put(value);
    }
  }
  template <EigenNumbers T>
  void put(const T& numbers) {
    if (T::RowsAtCompileTime == Eigen::Dynamic) put(numbers.rows());
    if (T::ColsAtCompileTime == Eigen::Dynamic) put(numbers.cols());
    out_.add_bytes(numbers.data(), static_cast<std::size_t>(numbers.size()) * sizeof(typename T::Scalar));
  }
  template <Listed T>
  void put(const T& value) {
    visit_members(*this, value);
  }

  Out& out_;
};

/// Reads what a MemberWriter wrote, in that order. Where bytes lack, or cannot be of such values, the reader refuses them,
/// and what follows is as it was or empty. Nothing is allocated for what the bytes only claim to hold.
class MemberReader {
 public:
  explicit MemberReader(ByteReader& in) : in_(in) {}
  void refuse() { in_.refuse(); }
  bool lacks() const { return in_.lacks(); }
  template <class... Each>
  void operator()(Each&... each) {
    (get(each), ...);
  }

 private:
  template <Number T>
  void get(T& value) {
    value = in_.number<T>();
  }
  void get(bool& value) {
    const auto byte = in_.number<char>();
    if (byte != 0 && byte != 1) in_.refuse();
    value = byte == 1;
  }
  template <Enumeration T>
  void get(T& value) {
    const auto number = in_.number<std::underlying_type_t<T>>();
    if (number < 0 || number > static_cast<std::underlying_type_t<T>>(last_of(T()))) return in_.refuse();
    value = static_cast<T>(number);
  }
  void get(std::string& text) {
    text.assign(in_.counted(1), '\0');
    in_.take(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& list) {
    list.clear();
    for (std::size_t left = in_.counted(1); left > 0 && !in_.lacks(); --left) get(list.emplace_back());
  }
  template <Number T>
  void get(std::vector<T>& list) {
    list = in_.numbers<T>();
  }
  template <class T, std::size_t count>
  void get(std::array<T, count>& values) {
    for (T& each : values) get(each);
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class... T>
  void get(std::variant<T...>& value) {
    const auto index = in_.number<std::size_t>();
    if (index >= sizeof...(T)) return in_.refuse();
    std::size_t kind = 0;
    ((kind++ == index ? get(value.template emplace<T>()) : void()), ...);
  }
  template <class One, class Other>
  void get(std::pair<One, Other>& both) {
    get(both.first);
    get(both.second);
  }
  template <class Key, class T>
  void get(std::map<Key, T>& table) {
    table.clear();
    for (std::size_t left = in_.counted(1); left > 0 && !in_.lacks(); --left) {
      Key key{};
      get(key);
      if (!table.empty() && !(table.rbegin()->first < key)) return in_.refuse();
      get(table[key]);
    }
  }
  template <EigenNumbers T>
  void get(T& numbers) {
    Eigen::Index rows = numbers.rows(), columns = numbers.cols();
    if (T::RowsAtCompileTime == Eigen::Dynamic) rows = in_.number<Eigen::Index>();
    if (T::ColsAtCompileTime == Eigen::Dynamic) columns = in_.number<Eigen::Index>();
    if (rows < 0 || columns < 0) in_.refuse();
    if (in_.lacks()) return;
    constexpr std::size_t each = sizeof(typename T::Scalar);
    const auto count = static_cast<std::size_t>(columns);
    if (!in_.holds(count, each) || (count > 0 && !in_.holds(static_cast<std::size_t>(rows), each * count)))
      return;
    numbers.resize(rows, columns);
    in_.take(numbers.data(), each * static_cast<std::size_t>(numbers.size()));
  }
  template <Listed T>
  void get(T& value) {
    visit_members(*this, value);
  }

  ByteReader& in_;
};

}  // namespace calot
