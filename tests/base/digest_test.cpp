#include "base/digest.h"

#include <gtest/gtest.h>

namespace calot {
namespace {

std::string sha256(const std::string& text) {
  Digest digest;
  digest.add_bytes(text.data(), text.size());
  return digest.hex();
}

// FIPS 180-4's examples, and one whose length needs a second block.
TEST(Digest, IsSha256) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Digest, IsTheSameHoweverItIsCut) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += static_cast<char>(i);
  Digest cut;
  for (std::size_t at = 0, part = 1; at < text.size(); at += part, part = 2 * part + 1)
    cut.add_bytes(text.data() + at, std::min(part, text.size() - at));
  EXPECT_EQ(cut.hex(), sha256(text));
}

TEST(Digest, TellsListsFromTheirJoin) {
  Digest one, other;
  one.add(std::string_view("ab")), one.add(std::string_view("c"));
  other.add(std::string_view("a")), other.add(std::string_view("bc"));
  EXPECT_NE(one.hex(), other.hex());
}

}  // namespace
}  // namespace calot
