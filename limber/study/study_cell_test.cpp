#include "limber/study/study_cell.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <set>

#include <nlohmann/json.hpp>

namespace limber {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

std::vector<std::string> stepsOf(const StudyCell& cell) {
  std::vector<std::string> names;
  for (const CellStep& step : cell.steps) names.push_back(step.name);
  return names;
}

StudyPlan rigPlanOf(std::vector<RigCombination> combinations) {
  StudyPlan plan;
  plan.rig.models = {"m"};
  plan.rig.combinations = std::move(combinations);
  return plan;
}

const StudyModel kBare = {{"/data/bare.obj", "bare", "data", {}}, false};
const StudyModel kRigged = {{"/data/rigged.glb", "rigged", "data", {}}, true};

TEST(StudyCells, ARiggedModelIsComparedWithItsOwnRig) {
  const std::vector<StudyCell> cells =
      rigCells(rigPlanOf({{"template", "bone-heat", {}}}), std::vector{kBare, kRigged});
  ASSERT_EQ(cells.size(), 2u);
  EXPECT_THAT(stepsOf(cells[0]), ElementsAre("rig", "evaluate model", "preview bones", "preview weights"));
  EXPECT_THAT(stepsOf(cells[1]),
              ElementsAre("rig", "evaluate rig", "evaluate model", "preview bones", "preview weights"));
  EXPECT_THAT(cells[0].steps[0].arguments, Not(Contains("--replace-rig")));
  EXPECT_THAT(cells[1].steps[0].arguments, Contains("--replace-rig"));
}

TEST(StudyCells, OwnSkeletonsAreKeptAndTheirWeightsCompared) {
  const std::vector<StudyCell> cells = rigCells(rigPlanOf({{"own", "bone-heat", {}}}), std::vector{kBare, kRigged});
  ASSERT_EQ(cells.size(), 1u);
  EXPECT_THAT(stepsOf(cells[0]),
              ElementsAre("rig", "evaluate weights", "evaluate model", "preview bones", "preview weights"));
  EXPECT_THAT(cells[0].steps[0].arguments, Contains("--keep-skeleton"));
}

// What does not depend on the deformer is measured once: else methods with one rig would differ in chance alone.
TEST(StudyCells, FurtherDeformersMeasureTheSurfaceInMotionAlone) {
  RigCombination first{"template", "bone-heat", {}}, second = first, other{"template", "geodesic-voxel", {}};
  first.deformer = "linear-blend";
  second.deformer = other.deformer = "delta-mush";
  const std::vector<StudyCell> cells = rigCells(rigPlanOf({first, second, other}), std::vector{kRigged});
  ASSERT_EQ(cells.size(), 3u);
  const auto whole =
      ElementsAre("rig", "evaluate rig", "evaluate model", "preview bones", "preview weights", "preview stretch");
  EXPECT_THAT(stepsOf(cells[0]), whole);
  EXPECT_THAT(stepsOf(cells[1]), ElementsAre("rig", "evaluate model", "preview stretch"));
  EXPECT_THAT(stepsOf(cells[2]), whole);
  EXPECT_TRUE(cells[0].steps[0].isTimed);
  EXPECT_FALSE(cells[1].steps[0].isTimed);
  EXPECT_EQ(cells[1].steps[0].arguments, cells[0].steps[0].arguments);
  EXPECT_EQ(cells[1].method(), "template + bone-heat + delta-mush");
  for (const std::size_t step : {1u, 2u}) {
    EXPECT_THAT(cells[1].steps[step].arguments, ::testing::IsSupersetOf({"--deformer", "delta-mush"}));
  }
  EXPECT_EQ(cells[1].steps[1].measures, MeasureSource::kModelMotion);
}

TEST(StudyCells, WithoutADeformerInThePlanNoneIsMentioned) {
  const std::vector<StudyCell> cells = rigCells(rigPlanOf({{"template", "bone-heat", {}}}), std::vector{kBare});
  EXPECT_EQ(cells[0].deformer, "");
  for (const CellStep& step : cells[0].steps) EXPECT_THAT(step.arguments, Not(Contains("--deformer")));
}

// So that a changed adapter runs anew.
TEST(StudyCells, AdaptersAreInputsOfTheirCells) {
  const std::vector<StudyCell> cells =
      rigCells(rigPlanOf({{"learned", "bone-heat", {}, {"/mine/learned.json"}}}), std::vector{kBare});
  EXPECT_THAT(cells[0].steps[0].arguments, ::testing::IsSupersetOf({"--adapter", "/mine/learned.json"}));
  EXPECT_THAT(cells[0].inputs, Contains(std::filesystem::path("/mine/learned.json")));
  StudyPlan plan;
  plan.retarget.combinations = {{"moves", "", {"/mine/moves.json"}}};
  const StudyInput motion = {"/m/walk.bvh", "walk", "m", {}};
  const StudyCell moving = retargetCells(plan, {&kRigged.input, 1}, {&motion, 1}).front();
  EXPECT_THAT(moving.steps[0].arguments,
              ::testing::IsSupersetOf({"--method", "moves", "--adapter", "/mine/moves.json"}));
  EXPECT_THAT(moving.inputs, Contains(std::filesystem::path("/mine/moves.json")));
}

TEST(StudyCells, MethodsAreToldApartByTheirNames) {
  const std::vector<StudyCell> cells = rigCells(
      rigPlanOf({{"template", "bone-heat", {}}, {"template", "bone-heat", {"20 handles", {"--handles", "20"}}}}),
      std::vector{kBare});
  EXPECT_EQ(cells[0].method(), "template + bone-heat");
  EXPECT_EQ(cells[1].method(), "template + bone-heat, 20 handles");
  EXPECT_THAT(cells[1].steps[0].arguments, Contains("--handles"));
}

TEST(StudyCells, EachCharacterMeetsEachMotion) {
  StudyPlan plan;
  plan.retarget.combinations = {{"limb-ik", "fabrik"}, {"copy", ""}};
  const std::vector<StudyInput> characters = {kRigged.input},
                                motions = {{"/m/walk.bvh", "walk", "m", {}}, {"/m/run.bvh", "run", "m", {}}};
  const std::vector<StudyCell> cells = retargetCells(plan, characters, motions);
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[0].subject(), "rigged, walk");
  EXPECT_EQ(cells[0].method(), "limb-ik + fabrik");
  EXPECT_EQ(cells[3].subject(), "rigged, run");
  EXPECT_EQ(cells[3].method(), "copy");
  EXPECT_THAT(cells[3].steps[0].arguments, Not(Contains("--solver")));
}

// A shell gives back what it was given.
TEST(CommandText, IsReadByAShellAsItWasMeant) {
  CellStep step;
  step.arguments = {"rig", "a b.glb", "it's", "$HOME", "`id`", "", "x;y", "\"", "back\\slash", "new\nline"};
  const std::string script = "limber() { printf '%s|' \"$@\"; }\n" + commandText(step);
  std::FILE* shell = popen(("/bin/sh -c '" +
                            [&] {
                              std::string quoted;
                              for (const char c : script)
                                quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
                              return quoted;
                            }() +
                            "'")
                               .c_str(),
                           "r");
  ASSERT_NE(shell, nullptr);
  std::string out;
  for (int c = 0; (c = std::fgetc(shell)) != EOF;) out += static_cast<char>(c);
  EXPECT_EQ(pclose(shell), 0);
  std::string expected;
  for (const std::string& argument : step.arguments) expected += argument + "|";
  EXPECT_EQ(out, expected);
}

TEST(Measures, NamesAreAllDifferentAndFoundAgain) {
  std::set<std::string_view> names;
  for (const Measure& measure : studyMeasures()) {
    EXPECT_TRUE(names.insert(measure.name).second) << measure.name;
    EXPECT_EQ(&findMeasure(measure.name), &measure);
  }
}

TEST(Measures, AreReadWhereTheyAreNumbers) {
  const Json figures = {{"l1", 0.5}, {"precision", "much"}, {"deform_mean", 2}, {"other", 1}};
  const std::vector<MeasuredValue> values = measuresIn(figures, MeasureSource::kWeightTruth);
  ASSERT_EQ(values.size(), 2u);
  EXPECT_EQ(values[0].measure->name, "weight_l1");
  EXPECT_EQ(values[0].value, 0.5);
  EXPECT_EQ(values[1].value, 2);
  EXPECT_TRUE(measuresIn(Json::array(), MeasureSource::kMotion).empty());
}

TEST(Measures, OfAModelHoldThoseOfItsMotion) {
  const Json figures = {{"coverage", 0.5}, {"motion", {{"stretch", 0.25}}}};
  const std::vector<MeasuredValue> all = measuresIn(figures, MeasureSource::kModel),
                                   motion = measuresIn(figures, MeasureSource::kModelMotion);
  ASSERT_EQ(all.size(), 2u);
  ASSERT_EQ(motion.size(), 1u);
  EXPECT_EQ(motion[0].measure->name, "stretch");
  EXPECT_FALSE(includes(MeasureSource::kModelMotion, findMeasure("coverage")));
}

}  // namespace
}  // namespace limber
