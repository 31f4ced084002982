#pragma once
// What a definition's table may hold, declared once: each key with its member, unit, limits and documentation.
// Reading a scenario, checking a scene, and what is generated for authors all go by these declarations; defaults are
// those of the definition's own members.

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <typeinfo>
#include <variant>
#include <vector>

#include "anatomy/field_check.h"

namespace calot {

enum class KeyKind {
  number,
  boolean,
  text,
  choice,  ///< a text out of `choices`
  point,   ///< {x, y, z}
  place,   ///< {x, y, z} or a landmark "organ.landmark"
  function,
  table,       ///< of the keys of table `of`
  made_table,  ///< such a table, or a function of the parameters that returns it
  list,        ///< items of table `of`, or of numbers or texts ("number", "text")
  map,         ///< author's names to tables `of`, or to points ("point")
  any
};

/// An enumeration's member; its values count as the choices do.
struct EnumField {
  void* place = nullptr;
  void (*set)(void* place, int choice) = nullptr;
};

/// The member that a key is kept in; none for keys that need more than an assignment.
using KeyTarget = std::variant<std::monostate, double*, std::optional<double>*, int*, bool*, std::string*,
                               Vec3*, EnumField>;

/// The instruments that a key of an instrument is for: all, or those with jaws, that set clips, that draw something out,
/// that carry current.
enum class KeyOwner { all, jaws, clips, needle, current };

struct Key {
  std::string name;
  KeyKind kind = KeyKind::number;
  std::string doc;
  bool required = false;
  const Quantity* quantity = &quantity::number;  ///< of numbers and points
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string fallback{};              ///< the default as an author would write it; may be empty
  std::string of{};                    ///< for tables, lists and maps
  std::vector<std::string> choices{};  ///< for choices
  std::string signature{};             ///< for functions, as the editor's type
  std::string what{};  ///< completes "70 m is not ...": "a gallbladder's length"; empty: "a sensible <name>"
  KeyOwner owner = KeyOwner::all;  ///< it means nothing to other instruments

  std::function<KeyTarget(void* definition)> field{};
  /// Of tables that are members: the member; null for one that is absent, unless it is to be made.
  std::function<void*(void* definition, bool make)> inner{};

  std::string expected() const { return what.empty() ? "a sensible " + name : what; }
};

/// Complains where a vector, of places or of angles, is beyond its key's limit; whether it is not.
bool check_vector(FieldCheck& check, const std::string& path, const Vec3& value, const Key& key);

struct KeyTable {
  std::string name, doc;
  std::vector<Key> keys;
  std::string items{};  ///< tables of the positional entries ("a|b"); empty: there are none
  /// The struct that its keys' members are of; null when none are bound.
  const std::type_info* definition = nullptr;
  /// Its limits are checked by validate(), on the whole definition.
  bool checked_by_validate = false;

  const Key* find(const std::string& key) const;
  std::vector<std::string> key_names() const;
};

/// The tables of a scene: "scene", "anatomy", "organ", "wall", ... (scene_keys.cpp).
const std::vector<KeyTable>& scene_key_tables();

/// Checks the limits of all numbers and places of a definition and of the tables within it. `leave_out`: a key that
/// does not matter here.
void check_limits(FieldCheck& check, const std::string& path, const KeyTable& table, const void* definition,
                  const std::string& leave_out = {});
template <class T>
void check_limits(FieldCheck& check, const std::string& path, const std::string& table, const T& definition,
                  const std::string& leave_out = {});

// ---- makers: the shorter a table reads, the fewer its mistakes

/// A number as an author writes it in the quantity's first unit: "80 * mm".
std::string written(double value, const Quantity& quantity);
std::string written(const Vec3& value, const Quantity& quantity);

Key number(std::string name, const Quantity& quantity, double low, double high, std::string fallback,
           std::string doc);
Key point(std::string name, const Quantity& quantity, double reach, std::string fallback, std::string doc);
Key text(std::string name, std::string fallback, std::string doc);
Key flag(std::string name, std::string fallback, std::string doc);
Key choice(std::string name, std::vector<std::string> choices, std::string fallback, std::string doc);
Key table(std::string name, std::string of, std::string doc);
Key made_table(std::string name, std::string of, std::string doc);
Key list(std::string name, std::string of, std::string doc);
Key map(std::string name, std::string of, std::string doc);
Key function(std::string name, std::string signature, std::string doc);
/// Has to be given, so that its default is none.
Key required(Key key);
Key only_of(KeyOwner owner, Key key);

/// Binds a key to a member of T.
template <class T, class M>
Key bound(Key key, M T::*member) {
  key.field = [member](void* definition) -> KeyTarget { return &(static_cast<T*>(definition)->*member); };
  return key;
}

template <class T>
Key number(std::string name, double T::*member, const Quantity& quantity, double low, double high,
           std::string what, std::string doc) {
  Key key = number(std::move(name), quantity, low, high, written(T{}.*member, quantity), std::move(doc));
  key.what = std::move(what);
  return bound(std::move(key), member);
}
template <class T>
Key number(std::string name, std::optional<double> T::*member, const Quantity& quantity, double low,
           double high, std::string what, std::string doc) {
  Key key = number(std::move(name), quantity, low, high, "", std::move(doc));
  key.what = std::move(what);
  return bound(std::move(key), member);
}
/// A whole number.
template <class T>
Key count(std::string name, int T::*member, int low, int high, std::string what, std::string doc) {
  Key key = number(std::move(name), quantity::number, low, high, std::to_string(T{}.*member), std::move(doc));
  key.what = std::move(what);
  return bound(std::move(key), member);
}
template <class T>
Key place(std::string name, Vec3 T::*member, double reach, std::string what, std::string doc) {
  Key key =
      point(std::move(name), quantity::length, reach, written(T{}.*member, quantity::length), std::move(doc));
  key.what = std::move(what);
  return bound(std::move(key), member);
}
/// A direction has no limits of its own.
template <class T>
Key direction(std::string name, Vec3 T::*member, std::string doc) {
  return bound(point(std::move(name), quantity::number, std::numeric_limits<double>::infinity(),
                     written(T{}.*member, quantity::number), std::move(doc)),
               member);
}
template <class T>
Key text(std::string name, std::string T::*member, std::string doc) {
  const std::string value = T{}.*member;
  return bound(text(std::move(name), value.empty() ? "" : '"' + value + '"', std::move(doc)), member);
}
template <class T>
Key flag(std::string name, bool T::*member, std::string doc) {
  return bound(flag(std::move(name), T{}.*member ? "true" : "false", std::move(doc)), member);
}
template <class T>
Key choice(std::string name, std::string T::*member, std::vector<std::string> choices, std::string doc) {
  return bound(choice(std::move(name), std::move(choices), "", std::move(doc)), member);
}
/// `choices` in the order of the enumeration's values.
template <class T, class E>
requires std::is_enum_v<E> Key choice(std::string name, E T::*member, std::vector<std::string> choices,
                                      std::string doc) {
  const std::string standard = choices[static_cast<std::size_t>(T{}.*member)];
  Key key = choice(std::move(name), std::move(choices), '"' + standard + '"', std::move(doc));
  key.field = [member](void* definition) -> KeyTarget {
    return EnumField{&(static_cast<T*>(definition)->*member),
                     [](void* at, int value) { *static_cast<E*>(at) = static_cast<E>(value); }};
  };
  return key;
}
/// A table that is a member.
template <class T, class M>
Key table(std::string name, M T::*member, std::string of, std::string doc) {
  Key key = table(std::move(name), std::move(of), std::move(doc));
  key.inner = [member](void* definition, bool) -> void* { return &(static_cast<T*>(definition)->*member); };
  return key;
}
template <class T, class M>
Key table(std::string name, std::optional<M> T::*member, std::string of, std::string doc) {
  Key key = table(std::move(name), std::move(of), std::move(doc));
  key.inner = [member](void* definition, bool make) -> void* {
    std::optional<M>& value = static_cast<T*>(definition)->*member;
    if (!value && make) value.emplace();
    return value ? &*value : nullptr;
  };
  return key;
}

/// A table whose keys are bound to T's members.
template <class T>
KeyTable keys_of(std::string name, std::string doc, std::vector<Key> keys) {
  KeyTable result{std::move(name), std::move(doc), std::move(keys)};
  result.definition = &typeid(T);
  return result;
}

/// The table of that name among the scene's. Ends the process for any other name or struct: both are our own code's.
const KeyTable& scene_key_table(const std::string& name, const std::type_info& definition);

template <class T>
void check_limits(FieldCheck& check, const std::string& path, const std::string& table, const T& definition,
                  const std::string& leave_out) {
  check_limits(check, path, scene_key_table(table, typeid(T)), &definition, leave_out);
}

}  // namespace calot
