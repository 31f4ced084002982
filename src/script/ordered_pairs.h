#pragma once

struct lua_State;

namespace calot {

/// pairs in a fixed order: numbers ascending, then strings by their bytes, then false and true. Lua's own
/// order follows addresses and differs from process to process. Keys of other types are refused. The keys are
/// those at the start; ones removed meanwhile are passed over.
int ordered_pairs(lua_State* L);

}  // namespace calot
