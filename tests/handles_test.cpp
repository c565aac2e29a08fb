// Handles of the project's own samples and of shared models: their limbs have some, and what they follow is near.
#include <gtest/gtest.h>

#include "limber/actions/rig/auto_rig.h"
#include "limber/document/write.h"
#include "limber/evaluate/rig/handle_quality.h"
#include "limber/samples/samples.h"
#include "shared_data.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

std::vector<HandleTableRow> measured(const std::vector<fs::path>& files, const std::vector<Index>& counts) {
  const auto rig = [](Asset& asset, Index count) {
    AutoRigOptions options;
    options.rigger = "sphere-mesh";
    options.existingRig = ExistingRig::kReplace;
    options.rig.handles = count;
    Progress progress;
    autoRig(asset, options, progress);
  };
  Progress progress;
  Warnings skipped;
  std::vector<HandleTableRow> rows = evaluateHandles(
      files, counts, rig, [](const Asset&) {}, progress, skipped);
  EXPECT_EQ(rows.size(), files.size() * counts.size());
  return rows;
}

struct SampleHandles {
  const char* name;
  Index coveredEnds;  // at 20 handles, at least
};

std::ostream& operator<<(std::ostream& out, const SampleHandles& sample) {
  return out << sample.name;
}

class HandlesOfSamples : public ::testing::TestWithParam<SampleHandles> {};

TEST_P(HandlesOfSamples, ReachTheEndsOfLimbs) {
  const fs::path file = testing::testOutputFolder() / ("handles_" + std::string(GetParam().name) + ".glb");
  writeFile(file, writeGlb(makeSample(GetParam().name)));
  for (const HandleTableRow& row : measured({file}, {12, 20})) {
    const HandleQuality& quality = row.quality;
    SCOPED_TRACE(quality.handles);
    EXPECT_EQ(quality.idle, 0u);
    EXPECT_EQ(quality.inside, 1);
    EXPECT_LT(quality.overAir, 0.005);
    EXPECT_LT(quality.movedBeside, 0.01);
    EXPECT_GE(quality.coveredEnds, quality.handles == 20 ? GetParam().coveredEnds : 5);
  }
}

// The stools' ends are mostly corners of their seats: feet are four.
INSTANTIATE_TEST_SUITE_P(All, HandlesOfSamples,
                         ::testing::Values(SampleHandles{"stool", 8}, SampleHandles{"footstool", 8},
                                           SampleHandles{"biped", 5}, SampleHandles{"quadruped", 10},
                                           SampleHandles{"winged", 6}, SampleHandles{"theropod", 6},
                                           SampleHandles{"robot", 7}),
                         [](const auto& sample) { return std::string(sample.param.name); });

// Limbs by another method than that which positions handles; a chair's and a stool's are mostly corners of plates.
TEST(HandlesOfSharedModels, ReachTheEndsOfLimbs) {
  const std::optional<fs::path> data = testing::sharedDataFolder();
  if (!data) GTEST_SKIP() << testing::kNoSharedData;
  std::vector<fs::path> files;
  for (const char* name : {"stool.glb", "chair_1.glb", "m2m_dragon_static.glb", "m2m_bird_static.glb",
                           "m2m_horse_static.glb", "m2m_spider_static.glb", "m2m_kaiju_static.glb",
                           "cat_low_resolution.obj", "hand_lowres.obj", "fish_low_resolution.obj"}) {
    files.push_back(*data / "meshes" / name);
  }
  Index ends = 0, covered = 0, unequal = 0, stray = 0, idle = 0, handles = 0;
  double inside = 0;
  for (const HandleTableRow& row : measured(files, {12, 20})) {
    ends += row.quality.ends;
    covered += row.quality.coveredEnds;
    unequal += row.quality.unequalEnds;
    stray += row.quality.strayParents;
    idle += row.quality.idle;
    handles += row.quality.handles;
    inside += row.quality.inside * row.quality.handles;
    SCOPED_TRACE(row.file);
    EXPECT_LT(row.quality.overAir, 0.005) << row.quality.handles;
    EXPECT_LT(row.quality.movedBeside, 0.01) << row.quality.handles;
  }
  EXPECT_GE(covered, 0.7 * ends) << ends;
  EXPECT_LE(unequal, 0.05 * ends);
  EXPECT_GE(inside, 0.98 * handles);
  EXPECT_LE(stray, 0.05 * handles);
  EXPECT_EQ(idle, 0u);
}

}  // namespace
}  // namespace limber
