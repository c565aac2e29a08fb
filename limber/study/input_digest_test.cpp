#include "limber/study/input_digest.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "limber/core/error.h"
#include "limber/jobs/sha256.h"
#include "temporary_folder.h"

namespace limber {
namespace {

std::filesystem::path put(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

std::string digestOf(const std::filesystem::path& file) {
  return InputDigests().of(file).all;
}

TEST(InputDigest, ChangesWithTheInput) {
  const testing::TemporaryFolder folder;
  const std::string before = digestOf(put(folder.path(), "a.glb", "one"));
  EXPECT_EQ(digestOf(put(folder.path(), "b.glb", "one")), before);  // the name alone is nothing
  EXPECT_NE(digestOf(put(folder.path(), "a.obj", "one")), before);  // the format is
  EXPECT_NE(digestOf(put(folder.path(), "a.glb", "two")), before);
  EXPECT_THROW(digestOf(folder.path() / "missing.glb"), Error);
  EXPECT_EQ(InputDigests().of(folder.path() / "a.glb").bytes, sha256OfFile(folder.path() / "a.glb"));
}

// Neither is opened: both would be read without end.
TEST(InputDigest, RefusesPipesAndFilesTooLarge) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path pipe = folder.path() / "pipe.glb";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THROW(digestOf(pipe), Error);
  const std::filesystem::path model = put(folder.path(), "a.glb", "four");
  EXPECT_NO_THROW(InputDigests(4).of(model));
  EXPECT_THROW(InputDigests(3).of(model), Error);
  put(folder.path(), "skin.mtl", "far more than the model holds itself");
  EXPECT_THROW(InputDigests(30).of(put(folder.path(), "a.obj", "mtllib skin.mtl")), Error);
  std::filesystem::resize_file(folder.path() / "skin.mtl", std::uintmax_t{1} << 40);
  EXPECT_THROW(InputDigests(30).of(folder.path() / "a.obj"), Error);
}

TEST(InputDigest, SeesFilesThatAreNamed) {
  const testing::TemporaryFolder folder;
  put(folder.path(), "skin.mtl", "map_Kd my%20skin.png");
  put(folder.path(), "my skin.png", "red");
  put(folder.path(), "other.png", "blue");
  const std::filesystem::path model = put(folder.path(), "a.obj", "mtllib skin.mtl\nv 0 0 0\n");
  const std::string before = digestOf(model);
  put(folder.path(), "other.png", "green");
  EXPECT_EQ(digestOf(model), before);
  put(folder.path(), "my skin.png", "green");
  const std::string after = digestOf(model);
  EXPECT_NE(after, before);
  put(folder.path(), "skin.mtl", "map_Kd none");
  EXPECT_NE(digestOf(model), after);
}

TEST(InputDigest, SeesFilesInFoldersBelowThatAreNamed) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "my textures" / "wood");
  put(folder.path(), "skin.mtl", "map_Kd my%20textures/wood/dark%20oak.png");
  const auto expectSeen = [&](const std::string& name, const std::string& text) {
    put(folder.path(), name, "one");
    const std::filesystem::path model = put(folder.path(), "a.fbx", text);
    const std::string before = digestOf(model);
    put(folder.path(), name, "two");
    EXPECT_NE(digestOf(model), before) << text;
  };
  expectSeen("my textures/skin.png", R"("uri": "my%20textures/skin.png")");
  expectSeen("my textures/skin.png", R"("uri": "my%20textures\/skin.png")");
  expectSeen("my textures/wood/oak.png", R"("my textures\\wood\\oak.png")");
  expectSeen("my textures/skin.png", R"(C:\models\my textures\skin.png)");
  expectSeen("my textures/wood/oak.png", R"(.\my textures\wood\oak.png)");
  expectSeen("my textures/wood/dark oak.png", "mtllib skin.mtl");
  const std::filesystem::path model = put(folder.path(), "a.obj", "f 1/2/3 textures/skin.png my textures/other.png");
  const std::string before = digestOf(model);
  put(folder.path(), "my textures/skin.png", "three");
  EXPECT_EQ(digestOf(model), before);
}

}  // namespace
}  // namespace limber
