#pragma once
// What an author asks for that is not there, and the mistakes that are certain before anything has happened.

#include <string>
#include <vector>

struct lua_State;

namespace calot {

/// The value at a place of the stack where it is a text, else what kind of value it is.
std::string text_or_type(lua_State* L, int index);
/// The texts that are keys of the table at a place of the stack (not one relative to its top), in order; all its keys are.
std::vector<std::string> keys_of(lua_State* L, int table);

/// What is raised next is a mistake of the author's for certain.
void note_mistake(lua_State* L);
/// Whether the last error was one; then it is told no more.
bool take_mistake(lua_State* L);
/// Raises such an error at the line that is running.
[[noreturn]] void raise_mistake(lua_State* L, const std::string& message, const std::string& hint);

}  // namespace calot
