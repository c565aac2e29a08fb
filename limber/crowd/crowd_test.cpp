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
#include "limber/retarget/retarget_clip.h"
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

Crowd crowdOf(const CrowdOptions& options, const std::vector<Motion>& motions = {makeSampleMotion("flap")}) {
  std::vector<Asset> characters;
  characters.push_back(dragon());
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

// The first frame of a motion, as often as asked.
Motion heldPose(const Motion& motion, std::size_t frames) {
  PoseSequence all = sampleFrames(motion.skeleton, motion.clips[0], 30);
  all.poses.assign(frames, all.poses.front());
  Motion held = motion;
  held.clips = {clipOf(motion.skeleton, all, "held")};
  return held;
}

TEST(Crowd, TakesPosesThatAreHeld) {
  const Motion flap = makeSampleMotion("flap");
  for (const std::size_t frames : {1, 30}) {
    const Crowd still = crowdOf(fewBodies(), {heldPose(flap, frames)});
    const Crowd both = crowdOf(fewBodies(), {heldPose(flap, frames), flap});
    EXPECT_EQ(still.bodies.size(), both.bodies.size());
    EXPECT_GT(both.seconds, 0.5);
    const std::vector<Vec3> first = jointsAt(still.asset, 0, 0), last = jointsAt(still.asset, 0, still.seconds);
    for (std::size_t j = 0; j < first.size(); ++j) EXPECT_LT((last[j] - first[j]).norm(), 1e-6);
  }
}

TEST(Crowd, RefusesNothing) {
  CrowdOptions options = fewBodies();
  options.bodies = 0;
  EXPECT_THROW(crowdOf(options), Error);
}

}  // namespace
}  // namespace limber
