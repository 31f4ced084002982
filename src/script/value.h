#pragma once
// A Lua value as plain data, so that definitions are checked without touching Lua.

#include <string>
#include <vector>

#include "base/status.h"

struct lua_State;

namespace calot {

struct ValueField;

struct Value {
  enum class Kind { nil, boolean, number, text, table, function, other };
  Kind kind = Kind::nil;
  bool boolean = false;
  double number = 0;
  std::string text;                ///< a text; of other kinds what they are called
  std::vector<ValueField> fields;  ///< text keys, sorted
  std::vector<Value> items;        ///< keys 1 to n
  bool has_other_keys = false;     ///< keys that are neither text nor 1 to n
  int function = 0;                ///< registry reference

  const Value* field(const std::string& name) const;
  bool is(Kind wanted) const { return kind == wanted; }
};

struct ValueField {
  std::string name;
  Value value;
};

/// "a number", "a table", ...: for messages.
std::string name_of(Value::Kind kind);

/// Copies the value at `index`, which the author knows as `path`. Fails, at the path of what is too much, for
/// tables nested deeper than 32, texts longer than 4,000 bytes, and more than 16 MiB in all: nothing is copied
/// before it is measured.
Result<Value> read_value(lua_State* L, int index, const std::string& path = {});

}  // namespace calot
