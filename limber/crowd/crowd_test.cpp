#include "limber/crowd/crowd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "limber/asset/accessor.h"
#include "limber/asset/clip_io.h"
#include "limber/asset/motion_io.h"
#include "limber/asset/scene_graph.h"
#include "limber/asset/write.h"
#include "limber/core/parallel.h"
#include "limber/crowd/testing/dragon.h"
#include "limber/crowd/testing/moved_nodes.h"
#include "limber/samples/sample_motions.h"

namespace limber {
namespace {

CrowdOptions fewBodies() {
  CrowdOptions options;
  options.bodies = 9;
  options.builds = 3;
  options.offsets = 4;
  return options;
}

Crowd crowdOf(const CrowdOptions& options) {
  std::vector<Asset> characters;
  characters.push_back(dragon());
  const std::vector<Motion> motions = {makeSampleMotion("flap")};
  Progress progress;
  return makeCrowd(characters, motions, options, progress);
}

// World places of one body's joints at a moment of the file's animation.
std::vector<Vec3> jointsAt(const Asset& asset, Index skin, double seconds) {
  return testing::nodesAt(asset, asset.document.skins[skin].joints, seconds);
}

TEST(Crowd, ShowsEachBodyItsClipAtItsOffsetAndPlace) {
  const CrowdOptions options = fewBodies();
  const Crowd crowd = crowdOf(options);
  ASSERT_EQ(crowd.bodies.size(), 9u);
  ASSERT_EQ(crowd.asset.document.skins.size(), 9u);
  ASSERT_EQ(crowd.builds.size(), 3u);
  std::set<double> offsets;
  for (std::size_t i = 0; i < crowd.bodies.size(); ++i) {
    const CrowdBody& body = crowd.bodies[i];
    offsets.insert(body.offset);
    Asset alone = crowd.builds[body.build].clone();
    RetargetAssetOptions retarget;
    retarget.frameRate = options.framesPerSecond;
    retargetOnto(alone, makeSampleMotion("flap"), retarget);
    for (const double moment : {0.0, 0.5, 1.0}) {
      const double clipMoment = std::fmod(moment + body.offset, crowd.seconds);
      if (clipMoment > crowd.seconds - 1 / options.framesPerSecond) continue;
      const std::vector<Vec3> wanted = jointsAt(alone, 0, clipMoment),
                              places = jointsAt(crowd.asset, static_cast<Index>(i), moment);
      ASSERT_EQ(places.size(), wanted.size());
      for (std::size_t j = 0; j < wanted.size(); ++j) {
        ASSERT_LT((places[j] - wanted[j] - body.place).norm(), 1e-4) << "body " << i << ", joint " << j;
      }
    }
  }
  EXPECT_GT(offsets.size(), 1u);
}

TEST(Crowd, HoldsNoCopyForEachBody) {
  CrowdOptions options = fewBodies();
  options.bodies = 40;
  const std::size_t some = crowdOf(options).asset.buffers[0].bytes.size();
  options.bodies = 80;
  const Crowd twice = crowdOf(options);
  EXPECT_EQ(twice.asset.buffers[0].bytes.size(), some);
  EXPECT_EQ(twice.asset.document.meshes.size(), 3 * dragon().document.meshes.size());
}

TEST(Crowd, IsTheSameForAnyNumberOfThreads) {
  setThreadCount(1);
  const Bytes one = writeGlb(crowdOf(fewBodies()).asset);
  setThreadCount(0);
  EXPECT_EQ(writeGlb(crowdOf(fewBodies()).asset), one);
}

TEST(Crowd, RefusesNothing) {
  CrowdOptions options = fewBodies();
  options.bodies = 0;
  EXPECT_THROW(crowdOf(options), Error);
}

}  // namespace
}  // namespace limber
