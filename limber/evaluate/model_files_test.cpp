#include "limber/evaluate/model_files.h"

#include <filesystem>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/file/file.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

TEST(ModelFiles, AreOrderedByNameAndThenByPath) {
  const fs::path folder = fs::temp_directory_path() / "limber_model_files_test";
  fs::remove_all(folder);
  std::vector<fs::path> expected;
  for (const char* path : {"z/ant.glb", "a/bee.glb", "a/bee.gltf", "b/bee.glb", "c/bee.GLB", "b/cat.gltf"}) {
    fs::create_directories((folder / path).parent_path());
    writeFile(folder / path, asBytes("x"));
    expected.push_back(folder / path);
  }
  writeFile(folder / "a" / "bee.txt", asBytes("x"));
  EXPECT_EQ(modelsBelow(folder), expected);
  fs::remove_all(folder);
  EXPECT_THROW(modelsBelow(folder), Error);
}

TEST(ModelFiles, AFoldersLastNameIsTheSameHoweverItsPathEnds) {
  EXPECT_EQ(lastName("creatures/tune"), "tune");
  EXPECT_EQ(lastName("creatures/tune/"), "tune");
}

}  // namespace
}  // namespace limber
