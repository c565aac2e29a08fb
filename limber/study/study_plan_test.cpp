#include "limber/study/study_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <nlohmann/json.hpp>

#include "limber/core/error.h"
#include "limber/deform/deformer.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/weights/weight_method.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "source_folder.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusalOf(const std::string& text) {
  try {
    studyPlanFromJson(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadData) << text;
    return error.what();
  }
  ADD_FAILURE() << "taken: " << text;
  return {};
}

std::string rigPlan(const std::string& members) {
  return R"({"limber_study": 1, "rig": {"models": ["a.glb"])" + members + "}}";
}

TEST(StudyPlan, ListsAreMultipliedOut) {
  const StudyPlan plan = studyPlanFromJson(rigPlan(
      R"(, "riggers": ["own", "template"], "skinning": ["bone-heat", "geodesic-voxel"],
         "options": [{"name": "usual"}, {"name": "rigid", "pieces": "rigid", "max_influences": 2}])"));
  ASSERT_EQ(plan.rig.combinations.size(), 8u);
  EXPECT_EQ(plan.rig.combinations.front().rigger, "own");
  const RigCombination& last = plan.rig.combinations.back();
  EXPECT_EQ(last.rigger, "template");
  EXPECT_EQ(last.skinning, "geodesic-voxel");
  EXPECT_EQ(last.setting.name, "rigid");
  EXPECT_THAT(last.setting.arguments, ElementsAre("--max-influences", "2", "--pieces", "rigid"));
  EXPECT_TRUE(plan.retarget.characters.empty());
}

TEST(StudyPlan, ANameThatIsNoMethodIsAnAdapters) {
  const testing::TemporaryFolder folder;
  const auto put = [&](const char* name, const char* text) { std::ofstream(folder.path() / name) << text; };
  put("learned.json", R"({"limber_adapter": 1, "kind": "rig", "steps": [{"command": ["rig", "{input}"]}]})");
  put("weigher.json", R"({"limber_adapter": 1, "kind": "weights", "steps": [{"command": ["w", "{input}"]}]})");
  put("broken.json", R"({"limber_adapter": 1, "kinds": "rig"})");
  const std::string text = rigPlan(R"(, "riggers": ["learned", "template"], "skinning": ["weigher", "bone-heat"])");
  const StudyPlan plan = studyPlanFromJson(text, {folder.path()});
  ASSERT_EQ(plan.rig.combinations.size(), 4u);
  EXPECT_THAT(plan.rig.combinations[0].adapters,
              ElementsAre(folder.path() / "learned.json", folder.path() / "weigher.json"));
  EXPECT_THAT(plan.rig.combinations[1].adapters, ElementsAre(folder.path() / "learned.json"));
  EXPECT_TRUE(plan.rig.combinations[3].adapters.empty());
  const StudyPlan pairs =
      studyPlanFromJson(rigPlan(R"(, "pairs": [{"rigger": "own", "skinning": "weigher"}])"), {folder.path()});
  EXPECT_THAT(pairs.rig.combinations[0].adapters, ElementsAre(folder.path() / "weigher.json"));
  EXPECT_THAT(refusalOf(text), HasSubstr("riggers[0]: no rigger is called 'learned'"));
  const auto refusal = [&](const std::string& members) {
    try {
      studyPlanFromJson(rigPlan(members), {folder.path()});
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(refusal(R"(, "riggers": ["learned"], "options": [{"name": "few", "handles": 3}])"),
              AllOf(HasSubstr("'few'"), HasSubstr("'learned'")));
  EXPECT_THAT(refusal(R"(, "riggers": ["weigher"])"), HasSubstr("no rigger is called 'weigher'"));
  EXPECT_THAT(refusal(R"(, "riggers": ["broken"])"), HasSubstr("riggers[0]: adapter broken"));
}

TEST(StudyPlan, RetargetingMethodsCanBeAdapters) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "learned.json")
      << R"({"limber_adapter": 1, "kind": "retarget", "steps": [{"command": ["r", "{input_folder}"]}]})";
  const std::string text = R"({"limber_study": 1, "retarget": {"characters": ["c"], "motions": ["m"],
                                "methods": ["learned", "limb-ik"], "solvers": ["two-bone", "fabrik"]}})";
  const StudyPlan plan = studyPlanFromJson(text, {folder.path()});
  ASSERT_EQ(plan.retarget.combinations.size(), 3u);  // a program takes no solver
  EXPECT_EQ(plan.retarget.combinations[0].method, "learned");
  EXPECT_EQ(plan.retarget.combinations[0].solver, "");
  EXPECT_THAT(plan.retarget.combinations[0].adapters, ElementsAre(folder.path() / "learned.json"));
  EXPECT_TRUE(plan.retarget.combinations[1].adapters.empty());
  EXPECT_THAT(refusalOf(text), HasSubstr("methods[0]: "));
}

TEST(StudyPlan, AllStandsForAllThereAre) {
  const StudyPlan plan = studyPlanFromJson(rigPlan(R"(, "riggers": ["all"], "skinning": ["all"])"));
  EXPECT_EQ(plan.rig.combinations.size(), riggerMethods().size() * weightMethods().size());
  const StudyPlan moving = studyPlanFromJson(
      R"({"limber_study": 1, "retarget": {"characters": ["c"], "motions": ["m"], "methods": ["limb-ik", "spacetime", "copy"],
          "solvers": ["all"]}})");
  // The others use no solver: once each.
  ASSERT_EQ(moving.retarget.combinations.size(), ikMethods().size() + 2);
  EXPECT_EQ(moving.retarget.combinations.back().solver, "");
}

TEST(StudyPlan, PairsStandForThemselves) {
  const StudyPlan plan = studyPlanFromJson(rigPlan(R"(, "options": [{"name": "20", "handles": 20}],
         "pairs": [{"rigger": "sphere-mesh", "skinning": "bone-heat", "options": "20"},
                   {"rigger": "template", "skinning": "geodesic-voxel"}])"));
  ASSERT_EQ(plan.rig.combinations.size(), 2u);
  EXPECT_THAT(plan.rig.combinations[0].setting.arguments, ElementsAre("--handles", "20"));
  EXPECT_TRUE(plan.rig.combinations[1].setting.arguments.empty());
}

TEST(StudyPlan, DeformersAreMultipliedOutWhereThePlanNamesSome) {
  const auto deformersOf = [](const std::string& members) {
    std::vector<std::string> names;
    for (const RigCombination& one : studyPlanFromJson(rigPlan(members)).rig.combinations)
      names.push_back(one.deformer);
    return names;
  };
  EXPECT_THAT(deformersOf(""), ElementsAre(""));
  EXPECT_THAT(deformersOf(R"(, "riggers": ["template", "own"], "deformers": ["linear-blend", "dual-quaternion"])"),
              ElementsAre("linear-blend", "dual-quaternion", "linear-blend", "dual-quaternion"));
  EXPECT_EQ(deformersOf(R"(, "deformers": ["all"])").size(), deformers().size());
  EXPECT_THAT(deformersOf(R"(, "pairs": [{"rigger": "own", "skinning": "bone-heat", "deformer": "delta-mush"},
                                         {"rigger": "own", "skinning": "bone-heat"}])"),
              ElementsAre("delta-mush", ""));
}

TEST(StudyPlan, PairsOfRetargetingStandForThemselves) {
  const auto planOf = [](const std::string& pairs) {
    return R"({"limber_study": 1, "retarget": {"characters": ["c"], "motions": ["m"], "pairs": [)" + pairs + "]}}";
  };
  const std::vector<RetargetCombination> pairs =
      studyPlanFromJson(
          planOf(R"({"method": "limb-ik", "solver": "fabrik"}, {"method": "copy"}, {"method": "limb-ik"})"))
          .retarget.combinations;
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].method, "limb-ik");
  EXPECT_EQ(pairs[0].solver, "fabrik");
  EXPECT_EQ(pairs[1].solver, "");
  EXPECT_EQ(pairs[2].solver, "two-bone");
  EXPECT_THAT(refusalOf(planOf(R"({"method": "copy", "solver": "fabrik"})")),
              AllOf(HasSubstr("retarget.pairs[0].solver"), HasSubstr("'copy'")));
  EXPECT_THAT(refusalOf(planOf(R"({"method": "limb-ik", "solver": "magic"})")),
              AllOf(HasSubstr("retarget.pairs[0].solver"), HasSubstr("'magic'")));
  EXPECT_THAT(refusalOf(planOf(R"({"solver": "fabrik"})")), HasSubstr("retarget.pairs[0].method"));
  EXPECT_THAT(refusalOf(planOf("3")), HasSubstr("retarget.pairs[0]"));
  EXPECT_THAT(refusalOf(planOf(R"({"method": "limb-ik"}, {"method": "limb-ik", "solver": "two-bone"})")),
              AllOf(HasSubstr("retarget.pairs[1]"), HasSubstr("twice")));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "pairs": [{"rigger": "own", "skinning": "bone-heat"},
                                              {"rigger": "own", "skinning": "bone-heat"}])")),
              AllOf(HasSubstr("rig.pairs[1]"), HasSubstr("twice")));
  EXPECT_THAT(refusalOf(planOf("")), HasSubstr("no methods"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "retarget": {"characters": ["c"], "motions": ["m"], "methods": ["copy"],
                            "pairs": [{"method": "copy"}]}})"),
              HasSubstr("both 'pairs' and 'methods'"));
}

TEST(StudyPlan, LimitsAreThoseOfThePlan) {
  const StudyPlan plan = studyPlanFromJson(
      R"({"limber_study": 1, "title": "T", "rig": {"models": ["a"]}, "limits": {"seconds": 1.5, "memory_mb": 300},
          "threads": 2})");
  EXPECT_EQ(plan.title, "T");
  EXPECT_EQ(plan.limits.seconds, 1.5);
  EXPECT_EQ(plan.limits.memory, std::size_t{300} << 20);
  EXPECT_EQ(plan.threads, 2);
}

TEST(StudyPlan, WhatIsWrongIsToldWithItsPlace) {
  EXPECT_THAT(refusalOf("{"), HasSubstr("study plan"));
  EXPECT_THAT(refusalOf("[]"), HasSubstr("study plan"));
  EXPECT_THAT(refusalOf("{}"), HasSubstr("limber_study"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 2})"), HasSubstr("limber_study"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1})"), HasSubstr("neither"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": []}})"), AllOf(HasSubstr("rig"), HasSubstr("models")));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": [3]}})"), HasSubstr("rig.models[0]"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": ["a", "a"]}})"), HasSubstr("rig.models[1]"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "limber_study": 1})"), HasSubstr("twice"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "rigers": ["template"])")), AllOf(HasSubstr("rig"), HasSubstr("'rigers'")));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "riggers": ["template", "magic"])")),
              AllOf(HasSubstr("rig.riggers[1]"), HasSubstr("'magic'"), HasSubstr("sphere-mesh")));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "riggers": [])")), HasSubstr("no methods"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "riggers": ["own"], "pairs": [])")), HasSubstr("both 'pairs' and 'riggers'"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "pairs": [{"rigger": "own"}])")), HasSubstr("rig.pairs[0].skinning"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "deformers": ["jelly"])")),
              AllOf(HasSubstr("rig.deformers[0]"), HasSubstr("'jelly'"), HasSubstr("delta-mush")));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "deformers": [])")), HasSubstr("no methods"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "deformers": ["delta-mush"], "pairs": [])")),
              HasSubstr("both 'pairs' and 'deformers'"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "pairs": [{"rigger": "own", "skinning": "bone-heat", "deformer": "jelly"}])")),
              HasSubstr("rig.pairs[0].deformer"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "pairs": [{"rigger": "own", "skinning": "bone-heat", "options": "x"}])")),
              HasSubstr("rig.pairs[0].options"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"handles": 3}])")), HasSubstr("rig.options[0].name"));
  const std::string two = R"(, "options": [{"name": "few", "handles": 3}, {"name": "fish", "template": "fish"}])";
  EXPECT_THAT(refusalOf(rigPlan(two + R"(, "riggers": ["sphere-mesh"])")),
              AllOf(HasSubstr("rig.options: "), HasSubstr("'fish'"), HasSubstr("'sphere-mesh'"), HasSubstr("pairs")));
  EXPECT_THAT(refusalOf(rigPlan(two)), AllOf(HasSubstr("'few'"), HasSubstr("'template'")));
  EXPECT_THAT(refusalOf(rigPlan(two + R"(, "pairs": [{"rigger": "own", "skinning": "bone-heat", "options": "fish"}])")),
              AllOf(HasSubstr("rig.pairs[0].options: "), HasSubstr("'fish'"), HasSubstr("'own'")));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"name": "n", "handles": 0}])")), HasSubstr("handles"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"name": "n", "max_influences": 9}])")), HasSubstr("max_influences"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"name": "n", "pieces": "none"}])")), HasSubstr("pieces"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"name": "n", "template": "yeti"}])")), HasSubstr("template"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"name": "n"}, {"name": "n"}])")), HasSubstr("rig.options[1]"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": ["a"]}, "limits": {"seconds": 0}})"),
              HasSubstr("limits.seconds"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": ["a"]}, "limits": {"memory_mb": 1e12}})"),
              HasSubstr("limits.memory_mb"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "rig": {"models": ["a"]}, "threads": -1})"), HasSubstr("threads"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "retarget": {"characters": ["a"]}})"), HasSubstr("motions"));
}

TEST(StudyPlan, TheExampleIsAPlan) {
  const StudyPlan plan = studyPlanFromJson(exampleStudyPlan());
  EXPECT_FALSE(plan.rig.models.empty());
  EXPECT_FALSE(plan.retarget.characters.empty());
}

// Every key of the schema is read, and only these are, so that the two cannot drift apart.
TEST(StudyPlan, TheSchemaKnowsEveryKey) {
  std::ifstream file(limber::testing::sourceFolder() / "docs/study.schema.json");
  const nlohmann::json schema = nlohmann::json::parse(file);
  const auto keysOf = [](const nlohmann::json& object) {
    EXPECT_EQ(object["additionalProperties"], false);
    std::string keys;
    for (const auto& item : object["properties"].items()) keys += item.key() + " ";
    return keys;
  };
  const nlohmann::json& plan = schema["properties"];
  EXPECT_EQ(keysOf(schema), "limber_study limits retarget rig threads title ");
  EXPECT_EQ(keysOf(plan["rig"]), "deformers models options pairs riggers skinning ");
  EXPECT_EQ(keysOf(plan["rig"]["properties"]["options"]["items"]), "handles max_influences name pieces template ");
  EXPECT_EQ(keysOf(plan["rig"]["properties"]["pairs"]["items"]), "deformer options rigger skinning ");
  EXPECT_EQ(keysOf(plan["retarget"]), "characters methods motions pairs solvers ");
  EXPECT_EQ(keysOf(plan["retarget"]["properties"]["pairs"]["items"]), "method solver ");
  EXPECT_EQ(keysOf(plan["limits"]), "memory_mb seconds ");
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "x": 1})"),
              HasSubstr("limber_study, title, rig, retarget, limits, threads"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "x": 1)")), HasSubstr("models, riggers, skinning, deformers, options, pairs"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "options": [{"x": 1}])")),
              HasSubstr("name, handles, max_influences, pieces, template"));
  EXPECT_THAT(refusalOf(R"({"limber_study": 1, "retarget": {"x": 1}})"),
              HasSubstr("characters, motions, methods, solvers, pairs"));
  EXPECT_THAT(refusalOf(rigPlan(R"(, "pairs": [{"x": 1}])")), HasSubstr("rigger, skinning, deformer, options"));
}

}  // namespace
}  // namespace limber
