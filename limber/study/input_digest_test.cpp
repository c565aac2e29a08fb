#include "limber/study/input_digest.h"

#include <gtest/gtest.h>

#include <fstream>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

std::filesystem::path put(const std::filesystem::path& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder / name, std::ios::binary) << text;
  return folder / name;
}

TEST(InputDigest, ChangesWithTheInput) {
  const testing::TemporaryFolder folder;
  const std::string before = inputDigest(put(folder.path(), "a.glb", "one"));
  EXPECT_EQ(inputDigest(put(folder.path(), "b.glb", "one")), before);  // the name alone is nothing
  EXPECT_NE(inputDigest(put(folder.path(), "a.obj", "one")), before);  // the format is
  EXPECT_NE(inputDigest(put(folder.path(), "a.glb", "two")), before);
  EXPECT_THROW(inputDigest(folder.path() / "missing.glb"), Error);
}

TEST(InputDigest, SeesFilesThatAreNamed) {
  const testing::TemporaryFolder folder;
  put(folder.path(), "skin.mtl", "map_Kd my%20skin.png");
  put(folder.path(), "my skin.png", "red");
  put(folder.path(), "other.png", "blue");
  const std::filesystem::path model = put(folder.path(), "a.obj", "mtllib skin.mtl\nv 0 0 0\n");
  const std::string before = inputDigest(model);
  put(folder.path(), "other.png", "green");
  EXPECT_EQ(inputDigest(model), before);
  put(folder.path(), "my skin.png", "green");
  const std::string after = inputDigest(model);
  EXPECT_NE(after, before);
  put(folder.path(), "skin.mtl", "map_Kd none");
  EXPECT_NE(inputDigest(model), after);
}

}  // namespace
}  // namespace limber
