#include "limber/adapters/adapter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "limber/adapters/adapter_folder.h"
#include "limber/core/error.h"
#include "source_folder.h"
#include "temporary_folder.h"
#include "testing/made_body.h"

namespace limber {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::putFile;

constexpr std::string_view kShort =
    R"({"limber_adapter": 1, "kind": "rig", "steps": [{"command": ["rig", "{input}", "{output}"]}]})";

std::string adapterProblem(std::string_view text) {
  try {
    adapterFromJson(text, "mine");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// The short one with a piece of it replaced.
std::string changed(std::string_view piece, std::string_view other) {
  std::string text(kShort);
  text.replace(text.find(piece), piece.size(), other);
  return text;
}

TEST(Adapter, WhatIsLeftOutHasAUsualValue) {
  const Adapter adapter = adapterFromJson(kShort, "mine");
  EXPECT_EQ(adapter.name, "mine");
  EXPECT_EQ(adapter.kind, AdapterKind::kRig);
  ASSERT_EQ(adapter.steps.size(), 1u);
  EXPECT_THAT(adapter.steps[0].command, ElementsAre("rig", "{input}", "{output}"));
  EXPECT_EQ(adapter.inputFormat, AdapterFormat::kObj);
  EXPECT_EQ(adapter.outputFormat, AdapterFormat::kRignetText);
  EXPECT_EQ(adapter.outputFile, "output/model.txt");
  EXPECT_EQ(adapter.inputSize, 1);
  EXPECT_EQ(adapter.limits.seconds, 600);
  EXPECT_FALSE(adapter.mayRescale);
}

TEST(Adapter, AllEntriesAreRead) {
  const Adapter adapter = adapterFromJson(R"({
    "limber_adapter": 1, "kind": "rig", "summary": "two steps", "seed": 12,
    "steps": [{"command": ["a", "{input_folder}"], "folder": "/opt/a"}, {"command": ["b", "{folder}/x"]}],
    "input": {"format": "obj", "up": "+z", "size": 2},
    "output": {"format": "glb", "file": "made/rig.glb", "may_rescale": true, "weights": false},
    "limits": {"seconds": 5, "memory_mb": 100}})",
                                          "mine");
  EXPECT_EQ(adapter.summary, "two steps");
  EXPECT_EQ(adapter.steps.size(), 2u);
  EXPECT_EQ(adapter.steps[0].folder, "/opt/a");
  EXPECT_EQ(adapter.inputUp, AdapterUp::kZ);
  EXPECT_EQ(adapter.outputUp, AdapterUp::kY);
  EXPECT_EQ(adapter.inputSize, 2);
  EXPECT_EQ(adapter.outputFile, "made/rig.glb");
  EXPECT_TRUE(adapter.mayRescale);
  EXPECT_TRUE(adapter.ignoresWeights);
  EXPECT_EQ(adapter.limits.memory, std::size_t{100} << 20);
  EXPECT_EQ(adapter.seed, 12u);
}

TEST(Adapter, ATextHasTheUpOfWhatItWasMadeFrom) {
  const Adapter adapter = adapterFromJson(changed("\"kind\"", R"("input": {"up": "+z"}, "kind")"), "mine");
  EXPECT_EQ(adapter.outputUp, AdapterUp::kZ);
}

TEST(Adapter, RefusesWhatItDoesNotKnow) {
  EXPECT_THAT(adapterProblem("{"), HasSubstr("adapter mine"));
  EXPECT_THAT(adapterProblem("{}"), HasSubstr("has no \"limber_adapter\": 1"));
  EXPECT_THAT(adapterProblem(changed("1", "2")), HasSubstr("has no \"limber_adapter\": 1"));
  EXPECT_THAT(adapterProblem(changed("\"kind\"", R"("kinds": 1, "kind")")), HasSubstr("'kinds'"));
  EXPECT_THAT(adapterProblem(changed("\"rig\"", "\"rigs\"")), HasSubstr("is none of rig, weights"));
  EXPECT_THAT(adapterProblem(changed("{output}", "{outputs}")),
              HasSubstr("steps[0].command[2]: has a placeholder that is not known: {outputs}"));
  EXPECT_THAT(adapterProblem(changed("{input}", "model.obj")), HasSubstr("never name the file"));
  EXPECT_THAT(adapterProblem(changed(R"([{"command": ["rig", "{input}", "{output}"]}])", "[]")),
              HasSubstr("has no steps"));
  EXPECT_THAT(adapterProblem(changed(R"("rig", "{input}")", R"(3, "{input}")")), HasSubstr("is not a text"));
}

TEST(Adapter, RefusesWhatDoesNotGoTogether) {
  const auto with = [](std::string_view entry) {
    return adapterProblem(changed("\"kind\"", std::string(entry) + ", \"kind\""));
  };
  EXPECT_THAT(with(R"("input": {"format": "bvh"})"), HasSubstr("input.format: is none of obj, glb, which go with"));
  EXPECT_THAT(with(R"("output": {"format": "obj"})"), HasSubstr("is none of rignet-text, glb, fbx"));
  EXPECT_THAT(with(R"("input": {"format": "glb", "up": "+z"})"), HasSubstr("which a GLB always has"));
  EXPECT_THAT(with(R"("input": {"up": "up"})"), HasSubstr("is none of +y, +z"));
  EXPECT_THAT(with(R"("input": {"size": 0})"), HasSubstr("input.size: is not from"));
  EXPECT_THAT(with(R"("output": {"file": "../x"})"), HasSubstr("does not lie in the run's folder"));
  EXPECT_THAT(with(R"("output": {"file": "/x"})"), HasSubstr("does not lie in the run's folder"));
  EXPECT_THAT(with(R"("output": {"may_rescale": true})"), HasSubstr("needs a surface"));
  EXPECT_THAT(with(R"("limits": {"seconds": 0})"), HasSubstr("limits.seconds"));
  EXPECT_THAT(with(R"("limits": {"memory_mb": 0})"), HasSubstr("limits.memory_mb"));
}

TEST(Adapter, RetargetingHasMotionsInAndOut) {
  const std::string text =
      R"({"limber_adapter": 1, "kind": "retarget", "steps": [{"command": ["r", "{motion}", "{skeleton}", "{output}"]}],
          "input": {"up": "+z", "metres_per_unit": 0.01}})";
  const Adapter adapter = adapterFromJson(text, "mine");
  EXPECT_EQ(adapter.kind, AdapterKind::kRetarget);
  EXPECT_EQ(adapter.inputFormat, AdapterFormat::kBvh);
  EXPECT_EQ(adapter.outputFile, "output/motion.bvh");
  EXPECT_EQ(adapter.outputUp, AdapterUp::kZ);
  EXPECT_EQ(adapter.inputMetresPerUnit, 0.01);
  EXPECT_EQ(adapter.outputMetresPerUnit, 0.01);
  const auto with = [&](std::string_view from, std::string_view to) {
    std::string other = text;
    other.replace(other.find(from), from.size(), to);
    return adapterProblem(other);
  };
  EXPECT_THAT(with("{motion}", "{input}"), HasSubstr("not known: {input}; there are: folder, motion, skeleton"));
  EXPECT_THAT(with("\"{skeleton}\", ", ""), HasSubstr("never name the files that are handed over: {motion} and"));
  EXPECT_THAT(with("0.01", "0"), HasSubstr("input.metres_per_unit: is not from"));
  EXPECT_THAT(with("\"up\"", "\"size\": 1, \"up\""), HasSubstr("'size'"));
  EXPECT_THAT(with("}}", R"(}, "output": {"may_rescale": true}})"), HasSubstr("'may_rescale'"));
  EXPECT_THAT(adapterProblem(changed("{input}", "{motion}")), HasSubstr("not known: {motion}"));
  const AdapterPaths paths{"/run", "/run/input/motion.bvh", "/run/output/motion.bvh", "/run/input/skeleton.bvh"};
  EXPECT_EQ(filledIn("{motion}|{skeleton}|{input_folder}", paths, 7),
            "/run/input/motion.bvh|/run/input/skeleton.bvh|/run/input");
}

TEST(Adapter, WeightsOfLimbersAreHandedOverWhereTheProgramTakesThem) {
  const std::string text =
      R"({"limber_adapter": 1, "kind": "weights", "steps": [{"command": ["w", "{input}"]}], "input": {)";
  EXPECT_TRUE(adapterFromJson(text + "}}", "mine").takesWeights);
  EXPECT_FALSE(adapterFromJson(text + "\"weights\": false}}", "mine").takesWeights);
  EXPECT_THAT(adapterProblem(changed("\"kind\"", R"("input": {"weights": false}, "kind")")), HasSubstr("'weights'"));
}

TEST(Adapter, PlaceholdersAreFilledInAndOtherBracesStay) {
  const AdapterPaths paths{"/run", "/run/input/model.obj", "/run/output/model.txt"};
  EXPECT_EQ(filledIn("{folder}|{input}|{input_folder}|{output}|{seed}", paths, 7),
            "/run|/run/input/model.obj|/run/input|/run/output/model.txt|7");
  EXPECT_EQ(filledIn("print({'a': 1}) {} {A} {", paths, 7), "print({'a': 1}) {} {A} {");
  EXPECT_EQ(filledIn("{{seed}}", paths, 7), "{7}");
}

TEST(AdapterFolder, TheFirstFolderThatHasItCounts) {
  const testing::TemporaryFolder first, second;
  putFile(first.path() / "a.json", std::string(kShort));
  putFile(second.path() / "a.json", "nothing");
  putFile(second.path() / "b.json", changed("]}]", R"(], "folder": "b"}])"));
  putFile(second.path() / "notes.txt", "");
  const std::vector<std::filesystem::path> folders = {first.path(), second.path(), "/no/such/folder"};
  EXPECT_THAT(adapterNames(folders), ElementsAre("a", "b"));
  EXPECT_TRUE(findAdapter("a", folders));
  const auto b = findAdapter("b", folders);
  ASSERT_TRUE(b);
  EXPECT_EQ(b->steps[0].folder, second.path() / "b");
  EXPECT_EQ(b->file, second.path() / "b.json");
  EXPECT_EQ(readAdapter(second.path() / "b.json").steps[0].folder, b->steps[0].folder);
  EXPECT_FALSE(findAdapter("c", folders));
}

TEST(AdapterFolder, ANameLeadsNowhereElse) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "inner");
  putFile(folder.path() / "a.json", std::string(kShort));
  for (const char* name : {"../a", "", ".", "inner/../../a", "a\n", "/etc/passwd"}) {
    EXPECT_FALSE(findAdapter(name, {folder.path() / "inner"})) << name;
  }
}

TEST(AdapterFolder, TheOnesThatComeWithLimberAreRead) {
  const std::filesystem::path folder = limber::testing::sourceFolder() / "docs/adapters";
  const std::vector<std::string> names = adapterNames({folder});
  EXPECT_THAT(names, ElementsAre("magicarticulate", "puppeteer", "retarget-script", "rignet", "skintokens", "unirig"));
  for (const std::string& name : names) EXPECT_NO_THROW(EXPECT_TRUE(findAdapter(name, {folder}))) << name;
}

}  // namespace
}  // namespace limber
