#include "world/world_bytes.h"

#include <fmt/format.h>

#include "anatomy/definition_members.h"
#include "base/bytes.h"
#include "base/digest.h"
#include "base/hash.h"

namespace calot {
namespace {

constexpr std::string_view title = "calot world\n";
/// To be raised with each change of what is listed of a world's state, and of its order.
constexpr int version = 9;
constexpr std::size_t digest_size = 64;

std::uint64_t check_of(std::string_view state) {
  WordHash hash;
  hash.add_bytes(state.data(), state.size());
  return hash.value();
}

Failure refused(const std::string& why, const std::string& hint) {
  return fail(FailureKind::usage, "the saved world cannot be read: " + why, hint);
}

}  // namespace

std::string scene_digest(const SceneDefinition& scene, const Field& field) {
  Digest digest;
  MemberWriter put{digest};
  put(scene);
  for (const Organ& organ : field.organs) put(organ.body->rest(), organ.state.x);
  return digest.hex();
}

std::string with_header(const std::string& scene, const std::string& state) {
  ByteWriter out;
  out.add_bytes(title.data(), title.size());
  out.add(version);
  out.add_bytes(scene.data(), scene.size());
  out.add(check_of(state));
  out.add(state.size());
  out.add_bytes(state.data(), state.size());
  return out.bytes();
}

Result<SavedWorld> saved_world(std::string_view bytes) {
  const std::string again = "save it anew";
  if (!bytes.starts_with(title)) return refused("it does not begin as one", "give what a world was saved to");
  constexpr std::size_t before_scene = title.size() + sizeof version,
                        before_state = before_scene + digest_size + 2 * sizeof(std::uint64_t);
  ByteReader in(bytes.substr(title.size()));
  const auto of_version = in.number<int>();
  if (!in.lacks() && of_version != version)
    return refused(fmt::format("it is of version {}, and this program reads version {}", of_version, version),
                   again + " by this program");
  if (bytes.size() < before_state) return refused("it is cut off", again);
  in = ByteReader(bytes.substr(before_scene + digest_size));
  const auto check = in.number<std::uint64_t>();
  const auto size = in.number<std::size_t>();
  const std::string_view state = bytes.substr(before_state);
  if (state.size() < size)
    return refused(fmt::format("it is cut off: {} of {} bytes", state.size(), size), again);
  if (state.size() > size) return refused(fmt::format("{} bytes follow its end", state.size() - size), again);
  if (check_of(state) != check) return refused("it is damaged", again);
  return SavedWorld{bytes.substr(before_scene, digest_size), state};
}

}  // namespace calot
