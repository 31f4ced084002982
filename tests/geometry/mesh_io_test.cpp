#include "geometry/mesh_io.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace calot::test {
namespace {

using ::testing::HasSubstr;

/// A file of its own for each test, removed at the end.
class ObjFile : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  std::string write(const std::string& text) {
    path_ = ::testing::TempDir() + "calot_" + std::to_string(getpid()) + ".obj";
    std::ofstream(path_) << text;
    return path_;
  }

  void expect_problem(const std::string& text, int line, const std::string& message) {
    const auto mesh = read_obj(write(text), 1);
    ASSERT_FALSE(mesh) << text;
    const Problem& problem = mesh.failure().problems.front();
    EXPECT_EQ(problem.place.file, path_);
    EXPECT_EQ(problem.place.line, line) << text;
    EXPECT_THAT(problem.message, HasSubstr(message));
  }

  std::string path_;
};

const std::string kPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";

TEST_F(ObjFile, GivesPointsTimesScaleAndTriangles) {
  const auto mesh =
      read_obj(write("# a comment\no thing\n" + kPoints + "vn 0 0 1\n\nf 1 2 3  # the first\n"), 1e-3);
  ASSERT_TRUE(mesh) << to_text(mesh.failure());
  EXPECT_THAT(mesh->points,
              ::testing::ElementsAre(Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(0, 1e-3, 0), Vec3(1e-3, 1e-3, 0)));
  EXPECT_THAT(mesh->triangles, ::testing::ElementsAre(Triangle{0, 1, 2}));
}

TEST_F(ObjFile, AByteOrderMarkIsNoPartOfTheFirstPoint) {
  const auto mesh = read_obj(write("\xef\xbb\xbf" + kPoints + "f 1 2 3\n"), 1);
  ASSERT_TRUE(mesh) << to_text(mesh.failure());
  EXPECT_EQ(mesh->points.size(), 4u);
}

TEST_F(ObjFile, CutsPolygonsIntoFansAndReadsEveryFormOfIndex) {
  for (const std::string face :
       {"f 1 2 4 3", "f 1/1 2/2 4/4 3/3", "f 1/1/1 2/2/1 4/4/1 3/3/1", "f 1//1 2//1 4//1 3//1",
        "f -4 -3 -1 -2", "f 1 2 \\\n 4 3", "f\t1\t2\t4\t3\r"}) {
    const auto mesh = read_obj(write(kPoints + face + "\n"), 1);
    ASSERT_TRUE(mesh) << face << to_text(mesh.failure());
    EXPECT_THAT(mesh->triangles, ::testing::ElementsAre(Triangle{0, 1, 3}, Triangle{0, 3, 2})) << face;
  }
}

TEST_F(ObjFile, ReadsExponentsSignsAndFurtherColumns) {
  const auto mesh = read_obj(write("v +1e-1 -2.5E+0 .5 1 0.2 0.3\nv 1 0 0\nv 0 1 0\nf 1 2 3"), 1);
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->points[0], Vec3(0.1, -2.5, 0.5));
}

TEST_F(ObjFile, ErrorsNameFileAndLine) {
  expect_problem(kPoints + "f 1 2 5\n", 5, "names point 5, there are 4");
  expect_problem(kPoints + "f 1 2 0\n", 5, "names point 0");
  expect_problem(kPoints + "f 1 2 -5\n", 5, "names point -5");
  expect_problem(kPoints + "f 1 2 x\n", 5, "'x' is not a point");
  expect_problem(kPoints + "f 1 2 1.5\n", 5, "'1.5' is not a point");
  expect_problem(kPoints + "f 1 2\n", 5, "three points");
  expect_problem("v 0 0\n", 1, "three coordinates");
  expect_problem("\nv 0 0 1,5\n", 2, "'1,5' is not a finite number");
  expect_problem("v 0 0 nan\n", 1, "'nan' is not a finite number");
  expect_problem("v 0 0 1e999\n", 1, "'1e999' is not a finite number");
  expect_problem(kPoints + "f 1 \\\n2 3\nf 1 2 9\n", 7, "names point 9");
  expect_problem(kPoints, 4, "no faces");
}

TEST_F(ObjFile, EveryBadLineIsReported) {
  const auto mesh = read_obj(write("v a b c\nv 1 0\nf 1 2 3\n"), 1);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.failure().problems.size(), 3u);
}

TEST_F(ObjFile, ThousandsOfBadLinesAreCountedNotListed) {
  std::string text = kPoints;
  for (int i = 0; i < 20'000; ++i) text += "f 1 2 x\n";
  const auto mesh = read_obj(write(text), 1);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.failure().problems.size(), 21u);
  EXPECT_EQ(mesh.failure().problems.back().message, "19980 more lines are wrong");
}

TEST_F(ObjFile, AHugeFileIsRefusedUnread) {
  const std::string path = write(kPoints);
  std::filesystem::resize_file(path, std::uintmax_t{1} << 40);  // a hole: takes no space
  const auto mesh = read_obj(path, 1);
  ASSERT_FALSE(mesh);
  EXPECT_THAT(mesh.failure().problems.front().message, HasSubstr("1099511627776 bytes"));
}

TEST_F(ObjFile, RefusesAScaleThatIsNotPositive) {
  const std::string path = write(kPoints + "f 1 2 3\n");
  for (double scale : {0.0, -1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)})
    EXPECT_FALSE(read_obj(path, scale)) << scale;
}

TEST_F(ObjFile, AMissingFileOrAFolderIsAnError) {
  for (const std::string& path : {::testing::TempDir() + "calot_no_such.obj", ::testing::TempDir()}) {
    const auto mesh = read_obj(path, 1);
    ASSERT_FALSE(mesh);
    EXPECT_EQ(mesh.failure().problems.front().place.file, path);
  }
}

}  // namespace
}  // namespace calot::test
