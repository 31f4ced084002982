// A solid's reduction that was kept is the one that would be made, to the last bit, and no other solid's.

#include "fem/kept_reduction.h"

#include <gtest/gtest.h>

#include "support/remembered_results.h"
#include "support/solids.h"

namespace calot {
namespace {

struct TwoPieces : test::BentBox {
  ElasticSolid material{6e3, 0.45};
  TwoPieces() : BentBox(test::bent_box({2, 2, 2}, 2, test::wedge)) {}
  ReducedSolid reduced(KeptResults* results) const {
    return kept_or_reduced(mesh, rest, material, results).value();
  }
  std::string key() const { return reduction_key(mesh, rest, material); }
};

TEST(KeptReduction, ThatIsFoundHasTheSameBits) {
  const TwoPieces solid;
  const std::string anew = to_bytes(reduce(solid.mesh, solid.rest, solid.material).value());
  test::RememberedResults results;
  EXPECT_EQ(to_bytes(solid.reduced(nullptr)), anew);
  EXPECT_EQ(to_bytes(solid.reduced(&results)), anew);
  ASSERT_EQ(results.kept, 1);
  const ReducedSolid found = solid.reduced(&results);
  EXPECT_EQ(to_bytes(found), anew);
  EXPECT_EQ(results.found, 1);
  EXPECT_EQ(results.kept, 1) << "it was not made again";
  EXPECT_EQ(found.parts.pieces.size(), 2u);
  EXPECT_EQ(found.parts.stiffness.size(), 3u);
}

TEST(KeptReduction, ThatIsBrokenIsMadeAnew) {
  const TwoPieces solid;
  test::RememberedResults results;
  solid.reduced(&results);
  std::string& kept = results.all.begin()->second;
  const std::string whole = kept;
  std::string other_pieces = whole, other_node = whole;
  other_pieces[0] = static_cast<char>(other_pieces[0] + 1);
  other_node[3 * sizeof(std::size_t) - 1] = '\x7f';  // the first piece's nodes follow two counts
  for (const std::string& broken :
       {std::string(), whole.substr(0, whole.size() / 2), whole.substr(0, whole.size() - 1), whole + "x",
        other_pieces, other_node}) {
    EXPECT_FALSE(reduced_solid_of(broken, solid.mesh.nodes));
    kept = broken;
    EXPECT_EQ(to_bytes(solid.reduced(&results)), whole);
    EXPECT_EQ(kept, whole) << "and takes its place";
  }
}

TEST(KeptReduction, OfASolidWithOtherNodesIsRefused) {
  const TwoPieces solid;
  const std::string bytes = to_bytes(solid.reduced(nullptr));
  EXPECT_TRUE(reduced_solid_of(bytes, solid.mesh.nodes));
  EXPECT_FALSE(reduced_solid_of(bytes, solid.mesh.nodes + 1));
  EXPECT_FALSE(reduced_solid_of(bytes, solid.mesh.nodes - 1));
}

TEST(KeptReduction, OfASolidThatFoldsOverItselfIsNotKept) {
  TwoPieces folded;
  for (int i = 2; i < folded.rest.size(); i += 3) folded.rest[i] = -folded.rest[i];
  test::RememberedResults results;
  EXPECT_FALSE(kept_or_reduced(folded.mesh, folded.rest, folded.material, &results));
  EXPECT_EQ(results.kept, 0);
}

TEST(KeptReduction, OfAnotherSolidHasAnotherKey) {
  const std::string usual = TwoPieces().key();
  EXPECT_EQ(TwoPieces().key(), usual);
  const auto key_with = [](const std::function<void(TwoPieces&)>& change) {
    TwoPieces solid;
    change(solid);
    return solid.key();
  };
  EXPECT_NE(key_with([](TwoPieces& s) { s.material.young += 1e-9; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { s.material.poisson += 1e-12; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { s.rest[7] += 1e-15; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { std::swap(s.mesh.tets[0], s.mesh.tets[1]); }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { s.mesh.rows.value.back() += 1e-12; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { ++s.mesh.rows.node.back(); }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { ++s.mesh.rows.begin[3]; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { s.mesh.averaged[0] ^= 1; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { s.mesh.piece_of[0] ^= 1; }), usual);
  EXPECT_NE(key_with([](TwoPieces& s) { ++s.mesh.nodes; }), usual);
}

}  // namespace
}  // namespace calot
