#include "lua/table_file.h"

#include <algorithm>

#include "lua/calot_module.h"
#include "script/lua_headers.h"
#include "script/sandbox.h"

namespace calot {

Result<TableFile> read_table_file(const std::filesystem::path& path, const std::filesystem::path& modules,
                                  const std::string& what) {
  Result<std::string> text = Sandbox::read_text(path);
  if (!text) return text.failure();
  SandboxOptions options;
  options.script = path;
  options.modules = modules;
  Result<std::unique_ptr<Sandbox>> sandbox = Sandbox::create(options);
  if (!sandbox) return sandbox.failure();
  TableFile file;
  file.file = path.string();
  Result<Value> root = Value{};
  const std::optional<Failure> failure = sandbox.value()->protect([&](lua_State* L) {
    open_calot_module(L);
    sandbox.value()->push_chunk(L, path, text.value());
    file.map = SourceMap(text.value());  // lines are sought only in a text that Lua has found sound
    lua_call(L, 0, 1);
    root = read_value(L, -1);
  });
  if (failure) return *failure;
  if (!root) return root.failure();
  if (!root->is(Value::Kind::table))
    return fail(FailureKind::scenario, "this returns no table", what,
                {file.file, std::max(1, file.map.line_of("")), {}});
  file.root = std::move(root).value();
  file.source_hash = sandbox.value()->source_hash();
  return file;
}

void locate(Problem& problem, const SourceMap& map, const std::string& file) {
  if (!problem.place.file.empty()) return;
  problem.place.file = file;
  problem.place.line = std::max(1, map.line_of(problem.place.path));
}

}  // namespace calot
