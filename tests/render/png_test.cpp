#include "render/png.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/rng.h"

namespace calot {
namespace {

Image random_image(int width, int height) {
  Rng rng(7);
  Image image{width, height, std::vector<unsigned char>(static_cast<std::size_t>(3) * width * height)};
  for (unsigned char& byte : image.rgb) byte = static_cast<unsigned char>(rng.next());
  return image;
}

/// A fresh folder of this test.
std::string folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::string path = ::testing::TempDir() + "calot_" + test->name();
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path;
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST(Png, WhatIsWrittenIsRead) {
  const std::string path = folder() + "/a.png";
  const Image image = random_image(37, 23);
  ASSERT_TRUE(write_png(path, image));
  const Result<Image> back = read_png(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(back.value().width, 37);
  EXPECT_EQ(back.value().height, 23);
  EXPECT_EQ(back.value().rgb, image.rgb);
}

TEST(Png, SamePictureGivesSameBytes) {
  const std::string in = folder();
  ASSERT_TRUE(write_png(in + "/a.png", random_image(40, 30)));
  ASSERT_TRUE(write_png(in + "/b.png", random_image(40, 30)));
  EXPECT_EQ(bytes_of(in + "/a.png"), bytes_of(in + "/b.png"));
}

TEST(Png, AFailedWriteLeavesTheOldFileWhole) {
  const std::string path = folder() + "/a.png";
  ASSERT_TRUE(write_png(path, random_image(8, 8)));
  const std::string before = bytes_of(path);
  std::filesystem::create_directory(path + ".part");  // takes the temporary name: the write must fail
  EXPECT_FALSE(write_png(path, random_image(9, 9)));
  EXPECT_EQ(bytes_of(path), before);
}

TEST(Png, NothingTemporaryRemains) {
  const std::string in = folder();
  ASSERT_TRUE(write_png(in + "/a.png", random_image(8, 8)));
  std::filesystem::create_directory(in + "/b.png");  // cannot be replaced by a file
  EXPECT_FALSE(write_png(in + "/b.png", random_image(8, 8)));
  EXPECT_FALSE(std::filesystem::exists(in + "/a.png.part"));
  EXPECT_FALSE(std::filesystem::exists(in + "/b.png.part"));
}

TEST(Png, FailuresNameFileAndReason) {
  const std::string in = folder();
  const Result<std::string> nowhere = write_png(in + "/missing/a.png", random_image(8, 8));
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(to_text(nowhere.failure()), ::testing::HasSubstr("missing/a.png"));
  EXPECT_THAT(to_text(nowhere.failure()), ::testing::HasSubstr("No such file"));

  Image short_of_bytes = random_image(8, 8);
  short_of_bytes.rgb.pop_back();
  EXPECT_FALSE(write_png(in + "/short.png", short_of_bytes));
  EXPECT_FALSE(write_png(in + "/empty.png", Image{}));

  const Result<Image> absent = read_png(in + "/absent.png");
  ASSERT_FALSE(absent);
  EXPECT_THAT(to_text(absent.failure()), ::testing::HasSubstr("No such file"));

  std::ofstream(in + "/text.png") << "this is no picture";
  const Result<Image> text = read_png(in + "/text.png");
  ASSERT_FALSE(text);
  EXPECT_THAT(to_text(text.failure()), ::testing::HasSubstr("not a readable PNG"));
}

TEST(Png, APictureWiderThanAnyOfOursIsRefusedBeforeItGetsMemory) {
  const std::string path = folder() + "/a.png";
  ASSERT_TRUE(write_png(path, random_image(4097, 1)));
  const Result<Image> back = read_png(path);
  ASSERT_FALSE(back);
  EXPECT_THAT(to_text(back.failure()),
              ::testing::HasSubstr("a.png: picture of 4097 x 1 is larger than 4096 a side"));
}

TEST(Png, ATruncatedFileIsRefused) {
  const std::string path = folder() + "/a.png";
  ASSERT_TRUE(write_png(path, random_image(64, 64)));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  const Result<Image> back = read_png(path);
  ASSERT_FALSE(back);
  EXPECT_THAT(to_text(back.failure()), ::testing::HasSubstr("a.png"));
}

}  // namespace
}  // namespace calot
