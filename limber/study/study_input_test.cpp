#include "limber/study/study_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "limber/core/error.h"
#include "temporary_folder.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class StudyInputs : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name :
         {"one/fox.glb", "one/fox.obj", "one/notes.txt", "two/deep/fox.glb", "two/cat.STL", "walk.bvh"}) {
      fs::create_directories((folder_.path() / name).parent_path());
      std::ofstream(folder_.path() / name) << "x";
    }
  }
  std::vector<std::string> namesOf(const std::vector<std::string>& asked, InputKind kind = InputKind::kModel) const {
    std::vector<std::string> names;
    for (const StudyInput& input : findInputs(asked, kind, folder_.path(), folder_.path() / "made")) {
      names.push_back(input.name);
    }
    return names;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(StudyInputs, FoldersHoldTheirModels) {
  const std::vector<StudyInput> inputs =
      findInputs(std::vector<std::string>{"two"}, InputKind::kModel, folder_.path(), "made");
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0].file, fs::absolute(folder_.path() / "two/cat.STL"));
  EXPECT_EQ(inputs[0].group, "two");
  EXPECT_EQ(inputs[1].group, "deep");
}

TEST_F(StudyInputs, NamesAreAsShortAsTheyTellModelsApart) {
  EXPECT_THAT(namesOf({"two"}), ElementsAre("cat", "fox"));
  EXPECT_THAT(namesOf({"one"}), ElementsAre("fox.glb", "fox.obj"));
  EXPECT_THAT(namesOf({"one", "two"}), ElementsAre("one/fox.glb", "fox.obj", "cat", "deep/fox.glb"));
}

TEST_F(StudyInputs, AFileCountsOnce) {
  EXPECT_THAT(namesOf({"one/fox.glb", "one/../one", "one/fox.obj"}), ElementsAre("fox.glb", "fox.obj"));
}

TEST_F(StudyInputs, MotionsAreOtherFiles) {
  EXPECT_THAT(namesOf({"walk.bvh"}, InputKind::kMotion), ElementsAre("walk"));
  EXPECT_THAT(namesOf({"two"}, InputKind::kMotion), ElementsAre("fox"));
}

TEST_F(StudyInputs, SamplesAreToBeMade) {
  const std::vector<StudyInput> inputs =
      findInputs(std::vector<std::string>{"sample:stool"}, InputKind::kModel, folder_.path(), folder_.path() / "made");
  ASSERT_EQ(inputs.size(), 1u);
  EXPECT_EQ(inputs[0].sample, "stool");
  EXPECT_EQ(inputs[0].name, "stool");
  EXPECT_EQ(inputs[0].file, fs::absolute(folder_.path() / "made/stool.glb"));
}

TEST_F(StudyInputs, RefusesWhatIsNotThere) {
  fs::create_directories(folder_.path() / "empty");
  for (const char* name : {"three", "empty", "one/fox.png", "sample:../stool", "sample:-o"}) {
    EXPECT_THROW(namesOf({name}), Error) << name;
  }
}

}  // namespace
}  // namespace limber
