// Birds, fish, snakes, spiders and dinosaurs: shared motions on bodies of the same kind, by equal names or by form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <ostream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/character/matching/skeleton_map.h"
#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/motion_io.h"
#include "retarget_measured.h"
#include "shared_data.h"

namespace limber::testing {

struct Kind {
  const char* motion;
  std::vector<const char*> bodies;
  std::size_t legs;
};

void PrintTo(const Kind& kind, std::ostream* out) {
  *out << kind.motion;
}

// Legs reach for the ground, and tails stay above it.
bool isFootDriven(const RetargetSetup& setup, const JointMatch& match) {
  const Index joint = match.target.front();
  const std::vector<Index>& tail = setup.targetTail;
  const bool personsLeg = setup.person && match.part.kind == PartKind::kLeg;
  return personsLeg || isOfLeg(setup, joint) || std::find(tail.begin(), tail.end(), joint) != tail.end();
}

std::size_t namesInCommon(const Skeleton& one, const Skeleton& other) {
  std::set<std::string> names;
  for (const Joint& joint : one.joints) names.insert(joint.name);
  return static_cast<std::size_t>(std::count_if(other.joints.begin(), other.joints.end(),
                                                [&](const Joint& joint) { return names.contains(joint.name); }));
}

// By how much joints but those of legs and tails are off the turn from rest that the source's make, degrees, at worst.
double worstTurn(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& result) {
  double worst = 0;
  BodyFrame from, to;
  for (std::size_t f = 0; f < result.poses.size(); ++f) {
    setup.sourceKinematics.globals(source.poses[f], from);
    setup.targetKinematics.globals(result.poses[f], to);
    for (const JointMatch& match : setup.map.matches) {
      const Index s = match.source.front(), t = match.target.front();
      if (match.source.size() > 1 || match.target.size() > 1 || isFootDriven(setup, match)) continue;
      const Quat turn = from.rotations[s] * setup.sourceNeutral.rotations[s].conjugate();
      const double off = (turn * setup.targetNeutral.rotations[t]).angularDistance(to.rotations[t]);
      worst = std::max(worst, off * 180 / kPi);
    }
  }
  return worst;
}

class RetargetKinds : public ::testing::TestWithParam<Kind> {};

TEST_P(RetargetKinds, MoveTheirOwn) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Kind& kind = GetParam();
  const Motion motion = readMotion(*sharedDataFolder() / kind.motion);
  const PlainSkeleton from(motion.skeleton);
  Spread lost;
  bool hasLegs = false;
  for (const char* body : kind.bodies) {
    const PlainSkeleton to(readMotion(*sharedDataFolder() / "rigged" / body).skeleton);
    const SkeletonMap map = matchSkeletons(from.skeleton(), to.skeleton());
    std::size_t moved = 0;
    for (const JointMatch& match : map.matches) moved += match.target.size();
    EXPECT_GE(moved + 2, namesInCommon(from.skeleton(), to.skeleton())) << body << ": wings, fins and all but roots";
    for (const Clip& clip : motion.clips) {
      const PoseSequence frames = from.plain(sampleFrames(motion.skeleton, clip, 30));
      if (frames.poses.size() < 5) continue;
      const RetargetSetup setup(from.skeleton(), to.skeleton(), map, {}, &frames);
      EXPECT_EQ(setup.animalLegs.size(), kind.legs);
      for (const char* method : {"limb-ik", "spacetime"}) {
        SCOPED_TRACE(std::string(clip.name).append(" ").append(body).append(" ").append(method));
        const PoseSequence result = retargetFrames(findRetargetMethod(method), setup, frames);
        EXPECT_LT(worstTurn(setup, frames, result), 0.5);
        const MotionMetrics measures = measureMotion(setup, frames, result);
        EXPECT_LT(measures.jerk, 1.1);
        if (!measures.hasLegs) continue;
        EXPECT_LT(measures.sliding, measures.sourceSliding + 0.01);
        lost.add(1 - measures.contactAgreement, std::string(clip.name).append(" ").append(body).append(" ") + method);
        hasLegs = true;
      }
    }
  }
  if (hasLegs) lost.expectBelow(0.05, 0.8, "contacts lost");
}

// Of the same kind, but with other names and other counts of joints.
TEST(RetargetStrangers, MoveByTheirForm) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const struct {
    const char *motion, *body;
    std::size_t parts;
  } pairs[] = {{"motions/m2m_shark_animations.glb", "quaternius_dolphin.glb", 9},
               {"motions/m2m_shark_animations.glb", "quaternius_manta_ray.glb", 9},
               {"rigged/quaternius_dolphin.glb", "m2m_fish_whale.glb", 9},
               {"motions/m2m_snake_animations.glb", "quaternius_snake.glb", 3},
               {"rigged/quaternius_snake.glb", "m2m_rigonly/rig_snake.glb", 3},
               {"motions/m2m_bird_animations.glb", "quaternius_bat.fbx", 18},
               {"motions/m2m_bird_animations.glb", "quaternius_dragon.fbx", 19},
               {"motions/m2m_dragon_animations.glb", "quaternius_dragon.fbx", 19},
               {"motions/m2m_dragon_animations.glb", "m2m_bird_base.glb", 20},
               {"rigged/quaternius_bat.fbx", "m2m_bird_eagle.glb", 18}};
  for (const auto& [file, body, parts] : pairs) {
    SCOPED_TRACE(std::string(file).append(" ").append(body));
    const Motion motion = readMotion(*sharedDataFolder() / file);
    const PlainSkeleton from(motion.skeleton);
    const PlainSkeleton to(readMotion(*sharedDataFolder() / "rigged" / body).skeleton);
    const SkeletonMap map = matchSkeletons(from.skeleton(), to.skeleton());
    EXPECT_GE(map.matches.size(), parts);
    EXPECT_TRUE(map.find(body_part::kPelvis));
    for (const Clip& clip : motion.clips) {
      const PoseSequence frames = from.plain(sampleFrames(motion.skeleton, clip, 30));
      if (frames.poses.size() < 5) continue;
      const RetargetSetup setup(from.skeleton(), to.skeleton(), map, {}, &frames);
      const PoseSequence result = retargetFrames(findRetargetMethod("limb-ik"), setup, frames);
      EXPECT_LT(worstTurn(setup, frames, result), 0.5) << clip.name;
    }
  }
}

// Told as people by their form; hocks of two bend backward, and they have no toes.
TEST(RetargetStrangers, DinosaursGoForwardByAnothersClips) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Motion motion = readMotion(*sharedDataFolder() / "motions/m2m_kaiju_animations.glb");
  for (const char* body : {"quaternius_trex.glb", "quaternius_velociraptor.glb"}) {
    const PlainSkeleton to(readMotion(*sharedDataFolder() / "rigged" / body).skeleton);
    const SkeletonMap map = matchSkeletons(motion.skeleton, to.skeleton());
    for (const auto& [part, joint] : {std::pair{body_part::leg(Side::kLeft, Segment::kEnd), "BackFoot.L"},
                                      {body_part::kTrunk, "Hips"},
                                      {body_part::kHead, "Head"}}) {
      ASSERT_TRUE(map.find(part)) << nameOf(part);
      EXPECT_EQ(to.skeleton().joints[map.find(part)->target.front()].name, joint);
    }
    for (const Clip& clip : motion.clips) {
      const PoseSequence frames = sampleFrames(motion.skeleton, clip, 30);
      if (frames.poses.size() < 5) continue;
      const RetargetSetup setup(motion.skeleton, to.skeleton(), map, {}, &frames);
      for (const char* method : {"limb-ik", "spacetime"}) {
        SCOPED_TRACE(std::string(clip.name).append(" ").append(body).append(" ").append(method));
        const MotionMetrics result = measured(setup, method, frames);
        EXPECT_LT(result.jerk, 1.1);
        EXPECT_LT(result.sliding, std::min(0.02, result.sourceSliding + 1e-4));
        EXPECT_LT(1700 * result.penetration, 5);
        EXPECT_GT(result.contactAgreement, 0.99);
      }
    }
  }
}

// Feet on a root of their own, names that lie about sides, and eight legs.
TEST(RetargetStrangers, FrogsAndSpidersFollowTheirLike) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const auto skeletonOf = [](const char* file) { return readMotion(*sharedDataFolder() / file).skeleton; };
  const Skeleton frog = skeletonOf("rigged/quaternius_frog.fbx");
  EXPECT_TRUE(matchSkeletons(skeletonOf("motions/m2m_fox_animations.glb"), frog).isQuadruped());
  const SkeletonMap legs =
      matchSkeletons(skeletonOf("motions/m2m_spider_animations.glb"), skeletonOf("rigged/quaternius_spider.glb"));
  for (const Side side : kSides) {
    for (Index pair = 0; pair < 4; ++pair) EXPECT_TRUE(legs.find(body_part::leg(side, Segment::kUpper, pair)));
  }
}

// Rather than a wreck: spiders have more legs than wasps, birds fewer.
TEST(RetargetStrangers, WhatIsTooUnlikeIsRefused) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const std::pair<const char*, const char*> pairs[] = {{"motions/m2m_spider_animations.glb", "quaternius_wasp.glb"},
                                                       {"motions/m2m_bird_animations.glb", "quaternius_wasp.glb"},
                                                       {"motions/m2m_snake_animations.glb", "quaternius_spider.glb"},
                                                       {"motions/m2m_snake_animations.glb", "m2m_bird_base.glb"}};
  for (const auto& [file, body] : pairs) {
    const Skeleton from = readMotion(*sharedDataFolder() / file).skeleton;
    const Skeleton to = readMotion(*sharedDataFolder() / "rigged" / body).skeleton;
    EXPECT_THROW(matchSkeletons(from, to), Error) << file << ' ' << body;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Motions, RetargetKinds,
    ::testing::Values(Kind{"motions/m2m_bird_animations.glb",
                           {"m2m_bird_base.glb", "m2m_bird_eagle.glb", "m2m_rigonly/rig_bird.glb"},
                           2},
                      Kind{"motions/m2m_shark_animations.glb",
                           {"m2m_fish_shark.glb", "m2m_fish_whale.glb", "m2m_rigonly/rig_shark.glb"},
                           0},
                      Kind{"motions/m2m_snake_animations.glb", {"m2m_rigonly/rig_snake.glb"}, 0},
                      Kind{"motions/m2m_spider_animations.glb", {"m2m_rigonly/rig_spider.glb"}, 0},
                      Kind{"motions/m2m_dragon_animations.glb", {"m2m_rigonly/rig_dragon.glb"}, 4},
                      Kind{"motions/m2m_kaiju_animations.glb",
                           {"m2m_kaiju_base.glb", "m2m_kaiju_t_rex.glb", "m2m_rigonly/rig_kaiju.glb"},
                           2},
                      Kind{"rigged/quaternius_dolphin.glb", {"quaternius_manta_ray.glb"}, 0},
                      Kind{"rigged/quaternius_manta_ray.glb", {"quaternius_dolphin.glb"}, 0},
                      Kind{"rigged/quaternius_trex.glb", {"quaternius_velociraptor.glb"}, 2},
                      Kind{"rigged/quaternius_velociraptor.glb", {"quaternius_trex.glb"}, 2},
                      Kind{"rigged/quaternius_bat.fbx", {"quaternius_dragon.fbx"}, 0},
                      Kind{"rigged/quaternius_dragon.fbx", {"quaternius_bat.fbx"}, 0}),
    [](const ::testing::TestParamInfo<Kind>& kind) {
      std::string name = kind.param.motion;
      name = name.substr(name.find('_') + 1);
      std::replace_if(
          name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
      return name;
    });

}  // namespace limber::testing
