#include "limber/crowd/crowd.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "limber/core/parallel.h"
#include "limber/crowd/testing/dragon_crowd.h"
#include "limber/crowd/testing/moved_nodes.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/write.h"
#include "limber/motion/retarget/retarget_clip.h"
#include "limber/samples/motions/sample_motions.h"

namespace limber {
namespace {

CrowdOptions fewBodies() {
  CrowdOptions options;
  options.bodies = 9;
  options.builds = 3;
  options.offsets = 4;
  return options;
}

// World positions of one body's joints at a time of the file's animation.
std::vector<Vec3> jointsAt(const Asset& asset, Index skin, double seconds) {
  return testing::nodesAt(asset, asset.document.skins[skin].joints, seconds);
}

TEST(Crowd, ShowsEachBodyItsClipAtItsOffsetAndPlace) {
  const CrowdOptions options = fewBodies();
  const Crowd crowd = dragonCrowd(options);
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
    retargetOnto(alone, Character(alone), makeSampleMotion("flap"), retarget);
    for (const double moment : {0.0, 0.5, 1.0}) {
      const double clipMoment = std::fmod(moment + body.offset, crowd.seconds);
      if (clipMoment > crowd.seconds - 1 / options.framesPerSecond) continue;
      const std::vector<Vec3> wanted = jointsAt(alone, 0, clipMoment),
                              positions = jointsAt(crowd.asset, static_cast<Index>(i), moment);
      ASSERT_EQ(positions.size(), wanted.size());
      for (std::size_t j = 0; j < wanted.size(); ++j) {
        ASSERT_LT((positions[j] - wanted[j] - body.position).norm(), 1e-4) << "body " << i << ", joint " << j;
      }
    }
  }
  EXPECT_GT(offsets.size(), 1u);
}

TEST(Crowd, HoldsNoCopyForEachBody) {
  CrowdOptions options = fewBodies();
  options.bodies = 40;
  const std::size_t some = dragonCrowd(options).asset.buffers[0].bytes.size();
  options.bodies = 80;
  const Crowd twice = dragonCrowd(options);
  EXPECT_EQ(twice.asset.buffers[0].bytes.size(), some);
  EXPECT_EQ(twice.asset.document.meshes.size(), 3 * dragon().document.meshes.size());
}

TEST(Crowd, IsTheSameForAnyNumberOfThreads) {
  setThreadCount(1);
  const Bytes one = writeGlb(dragonCrowd(fewBodies()).asset);
  setThreadCount(0);
  EXPECT_EQ(writeGlb(dragonCrowd(fewBodies()).asset), one);
}

// The first frame of a motion, as often as asked.
Motion holdPose(const Motion& motion, std::size_t frames) {
  PoseSequence all = sampleFrames(motion.skeleton, motion.clips[0], 30);
  all.poses.assign(frames, all.poses.front());
  Motion pose = motion;
  pose.clips = {clipOf(motion.skeleton, all, "held")};
  return pose;
}

TEST(Crowd, TakesPosesThatAreHeld) {
  const Motion flap = makeSampleMotion("flap");
  for (const std::size_t frames : {1, 30}) {
    const Crowd still = dragonCrowd(fewBodies(), {holdPose(flap, frames)});
    const Crowd both = dragonCrowd(fewBodies(), {holdPose(flap, frames), flap});
    EXPECT_EQ(still.bodies.size(), both.bodies.size());
    EXPECT_GT(both.seconds, 0.5);
    const std::vector<Vec3> first = jointsAt(still.asset, 0, 0), last = jointsAt(still.asset, 0, still.seconds);
    for (std::size_t j = 0; j < first.size(); ++j) EXPECT_LT((last[j] - first[j]).norm(), 1e-6);
  }
}

// Of three dragons with three clips.
Crowd mixedCrowd(Index bodies) {
  std::vector<Asset> characters;
  std::vector<Motion> motions;
  for (const char* name : {"first", "second", "third"}) {
    characters.push_back(dragon());
    characters.back().name = name;
    motions.push_back(makeSampleMotion("flap"));
    motions.back().name = name;
  }
  CrowdOptions options;
  options.bodies = bodies;
  options.builds = 5;
  Progress progress;
  return makeCrowd(characters, motions, options, progress);
}

TEST(Crowd, GivesEachCharacterBuildAndClipABodyBeforeOneHasTwo) {
  const Crowd crowd = mixedCrowd(10);
  ASSERT_EQ(crowd.builds.size(), 5u);
  ASSERT_EQ(crowd.clips.size(), 3u);
  std::set<std::string> characters;
  for (std::size_t i = 0; i < 3; ++i) characters.insert(crowd.builds[crowd.bodies[i].build].name);
  EXPECT_EQ(characters.size(), 3u);
  for (const std::size_t first : {0, 5}) {
    std::set<Index> builds;
    for (std::size_t i = first; i < first + 5; ++i) builds.insert(crowd.bodies[i].build);
    EXPECT_EQ(builds.size(), 5u);
  }
  for (const std::size_t first : {0, 3, 6}) {
    std::set<Index> clips;
    for (std::size_t i = first; i < first + 3; ++i) clips.insert(crowd.bodies[i].clip);
    EXPECT_EQ(clips.size(), 3u);
  }
  for (const Warning& warning : crowd.asset.warnings.items()) EXPECT_EQ(warning.kind, "doubtful-matches");
}

TEST(Crowd, OfFewerBodiesSaysWhatIsLeftOut) {
  const Crowd all = mixedCrowd(10), two = mixedCrowd(2);
  ASSERT_EQ(two.builds.size(), 2u);
  ASSERT_EQ(two.clips.size(), 2u);
  EXPECT_EQ(two.asset.document.materials.size(), 2 * dragon().document.materials.size());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(two.builds[two.bodies[i].build].name, all.builds[all.bodies[i].build].name);
    EXPECT_EQ(two.clips[two.bodies[i].clip], all.clips[all.bodies[i].clip]);
    EXPECT_EQ(two.bodies[i].offset, all.bodies[i].offset);
  }
  std::vector<Warning> warnings = two.asset.warnings.items();
  std::erase_if(warnings, [](const Warning& warning) { return warning.kind == "doubtful-matches"; });
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0].kind, "characters-left-out");
  EXPECT_TRUE(warnings[0].message.ends_with(all.builds[2].name)) << warnings[0].message;
  EXPECT_EQ(warnings[1].kind, "clips-left-out");
  EXPECT_TRUE(warnings[1].message.ends_with(all.clips[2])) << warnings[1].message;
}

// The dragon with its whole scene displaced.
Asset movedDragon(const Vec3& by) {
  Asset asset = dragon();
  gltf::Document& document = asset.document;
  gltf::Node above;
  above.translation = by;
  above.children = document.scenes[0].nodes;
  document.scenes[0].nodes = {static_cast<Index>(document.nodes.size())};
  document.nodes.push_back(std::move(above));
  return asset;
}

TEST(Crowd, StandsInItsRowsWhereverCharactersAndMotionsBegin) {
  const Motion flap = makeSampleMotion("flap");
  Motion elsewhere = flap;
  for (Track<Vec3f>& track : elsewhere.clips[0].translations) {
    if (elsewhere.skeleton.joints[track.joint].parent) continue;
    for (Vec3f& value : track.values) value += Vec3f(3, 0, -2);
  }
  CrowdOptions options = fewBodies();
  options.heading = 180;
  const Crowd plain = dragonCrowd(options, {flap});
  std::vector<Asset> characters;
  characters.push_back(movedDragon(Vec3(5, 1, -4)));
  Progress progress;
  const Crowd moved = makeCrowd(characters, {{elsewhere}}, options, progress);
  for (Index i = 0; i < options.bodies; ++i) {
    EXPECT_EQ(plain.bodies[i].heading, moved.bodies[i].heading);
    for (const double moment : {0.0, 0.5}) {
      const std::vector<Vec3> wanted = jointsAt(plain.asset, i, moment), positions = jointsAt(moved.asset, i, moment);
      for (std::size_t j = 0; j < wanted.size(); ++j) {
        // Retargeting scales how high one flies with the hips' height over the origin.
        ASSERT_LT((positions[j] - wanted[j]).norm(), 0.05) << "body " << i << ", joint " << j;
      }
    }
  }
}

TEST(Crowd, RefusesNothing) {
  CrowdOptions options = fewBodies();
  options.bodies = 0;
  EXPECT_THROW(dragonCrowd(options), Error);
}

}  // namespace
}  // namespace limber
