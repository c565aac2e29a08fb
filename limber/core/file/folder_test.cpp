#include "limber/core/file/folder.h"

#include <fstream>

#include <gtest/gtest.h>

#include "limber/core/error.h"

namespace limber {
namespace {

TEST(FolderTest, FilesAreFoundAtAnyDepthInOrder) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "limber_folder_test";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "b" / "deep");
  std::filesystem::create_directories(folder / "folder.glb");
  for (const char* name : {"z.glb", "b/deep/x.GLB", "b/a.gltf", "b/a.txt", "glb", "a.glb.part", "folder.glb/in.glb"}) {
    std::ofstream(folder / name) << "x";
  }
  const std::vector<std::filesystem::path> expected = {folder / "b" / "a.gltf", folder / "b" / "deep" / "x.GLB",
                                                       folder / "folder.glb" / "in.glb", folder / "z.glb"};
  EXPECT_EQ(filesBelow(folder, {".glb", ".gltf"}), expected);
  EXPECT_TRUE(filesBelow(folder, {".fbx"}).empty());
  EXPECT_TRUE(filesBelow(folder, {}).empty());
  std::filesystem::remove_all(folder);
  try {
    filesBelow(folder, {".glb"});
    FAIL() << "found files in a folder that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kFile);
    EXPECT_EQ(error.where(), folder.string());
  }
}

TEST(FolderTest, FoldersAreMadeAndRemovedWithWhatIsInThem) {
  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "limber_folders_made";
  removeFolder(folder);
  makeFolder(folder / "a" / "b");
  makeFolder(folder / "a" / "b");
  std::ofstream(folder / "a" / "file") << "x";
  EXPECT_THROW(makeFolder(folder / "a" / "file" / "c"), Error);
  removeFolder(folder);
  EXPECT_FALSE(std::filesystem::exists(folder));
}

}  // namespace
}  // namespace limber
