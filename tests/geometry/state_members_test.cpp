// What a struct's list of members makes of it: bytes that are read again by every bit, refused where they are not whole, and
// hashes that tell lists apart.

#include "geometry/state_members.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/digest.h"
#include "base/hash.h"

namespace calot {
namespace {

enum class Colour { red, green, blue };
constexpr Colour last_of(Colour) { return Colour::blue; }

struct Leaf {
  int number = 0;
  bool green = false;
  bool operator==(const Leaf&) const = default;
};
void visit_members(auto&& visit, MembersOf<Leaf> auto& leaf) {
  auto& [number, green] = leaf;
  visit(number, green);
}

struct Tree {
  std::string name;
  Colour colour = Colour::red;
  std::vector<Leaf> leaves;
  std::vector<double> heights;
  std::vector<std::vector<int>> rings;
  std::array<float, 2> sides{};
  std::optional<Leaf> fallen;
  std::map<std::string, Leaf> known;
  std::pair<int, double> both{};
  std::variant<int, std::string> either;
  Vec3 at = Vec3::Zero();
  VecX places;
  Eigen::MatrixXd matrix;
  std::uint64_t count = 0;
  bool operator==(const Tree&) const = default;
};
void visit_members(auto&& visit, MembersOf<Tree> auto& tree) {
  auto& [name, colour, leaves, heights, rings, sides, fallen, known, both, either, at, places, matrix,
         count] = tree;
  visit(name, colour, leaves, heights, rings, sides, fallen, known, both, either, at, places, matrix, count);
}

Tree grown() {
  Tree tree;
  tree.name = "beech";
  tree.colour = Colour::blue;
  tree.leaves = {{1, true}, {-2, false}};
  tree.heights = {0.1, -0.0, 1e300};
  tree.rings = {{}, {1, 2, 3}, {4}};
  tree.sides = {0.5F, -1.5F};
  tree.fallen = Leaf{7, true};
  tree.known = {{"ash", {1, true}}, {"oak", {2, false}}};
  tree.both = {3, 0.3};
  tree.either = "maple";
  tree.at = Vec3(1, 2, 3);
  tree.places = VecX::LinSpaced(7, 0, 1);
  tree.matrix = VecX::LinSpaced(6, -1, 1).reshaped(3, 2);
  tree.count = std::numeric_limits<std::uint64_t>::max();
  return tree;
}

std::string bytes_of(const auto& value) {
  ByteWriter out;
  MemberWriter{out}(value);
  return out.bytes();
}

/// Whether the bytes are those of such a value, which it then is.
bool take(const std::string& bytes, auto& value) {
  ByteReader in(bytes);
  MemberReader{in}(value);
  return in.complete();
}

std::uint64_t hash_of(const auto& value) {
  Hash hash;
  MemberWriter{hash}(value);
  return hash.value();
}

TEST(StateMembers, WrittenAndReadAgainAreTheSameByEveryBit) {
  for (const Tree& tree : {Tree(), grown()}) {
    Tree read = tree == Tree() ? grown() : Tree();
    ASSERT_TRUE(take(bytes_of(tree), read));
    EXPECT_EQ(read, tree);
    EXPECT_EQ(bytes_of(read), bytes_of(tree)) << "-0.0 is another number than 0.0";
  }
}

TEST(StateMembers, CutOffAnywhereOrWithMoreBehindThemAreRefused) {
  const std::string whole = bytes_of(grown());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    Tree read;
    EXPECT_FALSE(take(whole.substr(0, length), read)) << length;
  }
  Tree read;
  EXPECT_FALSE(take(whole + '\0', read));
}

TEST(StateMembers, ThatOnlyClaimToBeManyAreRefusedBeforeThereIsRoomForThem) {
  for (const std::size_t claimed : {std::size_t{100}, std::size_t{1} << 40, ~std::size_t{0}}) {
    const std::string claim = bytes_of(claimed);
    const auto refuses = [&](auto value, const std::string& bytes) { EXPECT_FALSE(take(bytes, value)); };
    refuses(std::string(), claim);
    refuses(std::vector<double>(), claim);
    refuses(std::vector<Leaf>(), claim);
    refuses(std::vector<std::vector<int>>(), claim);
    refuses(std::map<std::string, Leaf>(), claim);
    refuses(VecX(), claim);
    refuses(Eigen::MatrixXd(), claim + claim);
    refuses(Eigen::MatrixXd(), claim + bytes_of(std::size_t{1} << 61));
    refuses(Eigen::MatrixXd(), bytes_of(std::size_t{1} << 32) + bytes_of(std::size_t{1} << 32));
  }
}

TEST(StateMembers, OfNoSuchValueAreRefused) {
  bool yes = false;
  EXPECT_FALSE(take("\2", yes));
  Colour colour = Colour::green;
  EXPECT_FALSE(take(bytes_of(3), colour));
  EXPECT_FALSE(take(bytes_of(-1), colour));
  EXPECT_EQ(colour, Colour::green);
  std::variant<int, std::string> either;
  EXPECT_FALSE(take(bytes_of(std::size_t{2}), either));
  std::map<int, int> table;
  EXPECT_FALSE(take(bytes_of(std::vector<std::pair<int, int>>{{2, 0}, {1, 0}}), table)) << "out of order";
  EXPECT_FALSE(take(bytes_of(std::vector<std::pair<int, int>>{{1, 0}, {1, 0}}), table)) << "one twice";
  EXPECT_TRUE(take(bytes_of(std::vector<std::pair<int, int>>{{1, 0}, {2, 0}}), table));
}

TEST(StateMembers, HashesTellWhereListsEnd) {
  using Lists = std::pair<std::vector<int>, std::vector<int>>;
  EXPECT_NE(hash_of(Lists{{1}, {2, 3}}), hash_of(Lists{{1, 2}, {3}}));
  using Texts = std::pair<std::string, std::string>;
  EXPECT_NE(hash_of(Texts{"a", "bc"}), hash_of(Texts{"ab", "c"}));
  using Maybe = std::pair<std::optional<int>, std::optional<int>>;
  EXPECT_NE(hash_of(Maybe{1, {}}), hash_of(Maybe{{}, 1}));
  EXPECT_NE(hash_of(Eigen::MatrixXd(Eigen::MatrixXd::Zero(2, 3))),
            hash_of(Eigen::MatrixXd(Eigen::MatrixXd::Zero(3, 2))));
}

TEST(StateMembers, HashDigestAndBytesAreOfTheSameList) {
  const std::string bytes = bytes_of(grown());
  Hash hash;
  hash.add_bytes(bytes.data(), bytes.size());
  EXPECT_EQ(hash_of(grown()), hash.value());
  Digest of_bytes, of_members;
  of_bytes.add_bytes(bytes.data(), bytes.size());
  MemberWriter{of_members}(grown());
  EXPECT_EQ(of_members.hex(), of_bytes.hex());
}

}  // namespace
}  // namespace calot
