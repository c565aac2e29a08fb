#include "limber/crowd/retarget_characters.h"

#include <gtest/gtest.h>

#include "limber/core/file/file.h"
#include "limber/core/file/storage_error.h"
#include "limber/crowd/body_build.h"
#include "limber/crowd/testing/dragon.h"
#include "limber/document/read.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/samples.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

TEST(CharacterFileNames, NeverMeet) {
  const std::vector<fs::path> characters = {"a/hero.glb", "b/Hero.fbx", "hero_2.glb"};
  EXPECT_EQ(characterFileNames(characters, {}, ".glb", false),
            (std::vector<std::string>{"hero.glb", "Hero_2.glb", "hero_2_2.glb"}));
  std::vector<Motion> motions(2);
  motions[0].name = "walk";
  motions[1].name = "Walk";
  EXPECT_EQ(characterFileNames(std::span(characters).first(1), motions, ".glb", true),
            (std::vector<std::string>{"hero_walk.glb", "hero_Walk_2.glb"}));
}

TEST(CharacterList, HasAPathALineBesideTheList) {
  const testing::TemporaryFolder folder;
  const fs::path list = folder.path() / "list.txt";
  writeFile(list, asBytes("\xef\xbb\xbf# heroes\n\n  a b.glb \r\n/c.glb"));
  EXPECT_EQ(readCharacterList(list), (std::vector<fs::path>{folder.path() / "a b.glb", "/c.glb"}));
  writeFile(list, asBytes("\n# none\n"));
  EXPECT_THROW(readCharacterList(list), Error);
}

TEST(RetargetCharacters, AFaultyOneCostsItselfAlone) {
  const testing::TemporaryFolder folder;
  Asset character = dragon();
  writeAsset(character, folder.path() / "one.glb");
  writeAsset(character, folder.path() / "same.glb");
  changeBuild(character, randomBuild(3));
  writeAsset(character, folder.path() / "other.glb");
  writeAsset(makeSample("stool"), folder.path() / "stool.glb");
  writeFile(folder.path() / "broken.glb", asBytes("glTF and no more"));
  CharactersJob job;
  for (const char* name : {"one.glb", "broken.glb", "same.glb", "stool.glb", "other.glb", "none.glb"}) {
    job.characters.push_back(folder.path() / name);
  }
  job.motions.push_back(makeSampleMotion("flap"));
  job.folder = folder.path() / "out";
  Progress progress;
  const CharactersReport report = retargetCharacters(job, progress);
  EXPECT_EQ(report.files, 3u);
  EXPECT_EQ(report.failed, 3u);
  EXPECT_EQ(report.matches, 2u);  // one and same are one skeleton
  ASSERT_EQ(report.failures.size(), 3u);
  EXPECT_EQ(report.failures[0].example.filename(), "broken.glb");
  EXPECT_EQ(report.failures[1].example.filename(), "stool.glb");
  EXPECT_EQ(readFile(job.folder / "one.glb").size(), readFile(job.folder / "same.glb").size());
  EXPECT_FALSE(fs::exists(job.folder / "broken.glb"));
  // As each by itself.
  Asset alone = readAsset(folder.path() / "other.glb");
  retargetOnto(alone, Character(alone), job.motions[0], {});
  writeAsset(alone, folder.path() / "alone.glb");
  EXPECT_EQ(readFile(folder.path() / "alone.glb"), readFile(job.folder / "other.glb"));
}

TEST(RetargetCharacters, AFullDiskEndsAll) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  const testing::TemporaryFolder folder;
  writeAsset(dragon(), folder.path() / "one.glb");
  CharactersJob job;
  job.characters = {folder.path() / "one.glb"};
  job.motions.push_back(makeSampleMotion("flap"));
  job.folder = folder.path() / "out";
  fs::create_directory(job.folder);
  fs::create_symlink("/dev/full", job.folder / "one.glb");
  Progress progress;
  EXPECT_THROW(retargetCharacters(job, progress), StorageError);
}

TEST(RetargetCharacters, NeverWriteOverWhatTheyRead) {
  const testing::TemporaryFolder folder;
  CharactersJob job;
  job.characters = {folder.path() / "one.glb"};
  job.motions.push_back(makeSampleMotion("flap"));
  job.folder = folder.path() / "x" / "..";
  fs::create_directory(folder.path() / "x");
  Progress progress;
  EXPECT_THROW(retargetCharacters(job, progress), Error);
}

}  // namespace
}  // namespace limber
