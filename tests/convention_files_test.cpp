// Every naming convention with more and fewer joints and with attachments, written as files and read again: the sample
// walk finds every joint that has a name.
#include <gtest/gtest.h>

#include <string>

#include "limber/character/anatomy/testing/convention_bodies.h"
#include "limber/character/matching/skeleton_map.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/fbx/export_fbx.h"
#include "limber/document/write.h"
#include "limber/samples/motions/sample_motions.h"

namespace limber::testing {

// A clip in which the first joint moves, so that every format has something to keep.
Motion movingMotion(const Skeleton& skeleton) {
  Motion motion;
  motion.skeleton = skeleton;
  Clip clip;
  clip.name = "move";
  Track<Vec3f> track;
  track.joint = 0;
  track.times = {0, 1};
  const Vec3f from = skeleton.joints[0].rest.translation.cast<float>();
  track.values = {from, from + Vec3f(0, 0, 0.5f)};
  clip.translations.push_back(std::move(track));
  motion.clips.push_back(std::move(clip));
  return motion;
}

// Of the parts that the walk has, every joint with a name follows the same part of it.
void expectMatched(const MadeBody& body, const Skeleton& read, bool lowerBodyBeside, const std::string& what) {
  const Skeleton walk = makeSampleMotion("walk").skeleton;
  const Anatomy walker = readAnatomy(walk);
  SkeletonMap map;
  ASSERT_NO_THROW(map = matchSkeletons(walk, read)) << what;
  std::vector<const JointMatch*> matchOf(read.joints.size(), nullptr);
  for (const JointMatch& match : map.matches) {
    for (const Index joint : match.target) matchOf[joint] = &match;
  }
  for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
    const BodyPart& part = body.parts[j];
    if (part.kind == PartKind::kOther || !walker.find(part.kind, part.side, part.pair)) continue;
    const std::optional<Index> joint = read.find(body.skeleton.joints[j].name);
    ASSERT_TRUE(joint) << what << ": " << body.skeleton.joints[j].name;
    // A lower body beside the spine goes along with the joint that carries both.
    if (part.segment == Segment::kBase && lowerBodyBeside) continue;
    if (part.kind != PartKind::kTrunk && part.segment == Segment::kBase) continue;  // the walk may have none
    const JointMatch* match = matchOf[*joint];
    ASSERT_TRUE(match) << what << ": " << body.skeleton.joints[j].name << " follows nothing";
    EXPECT_EQ(match->part.kind, part.kind) << what << ": " << body.skeleton.joints[j].name;
    EXPECT_EQ(match->part.side, part.side) << what << ": " << body.skeleton.joints[j].name;
    if (part.kind == PartKind::kLeg || part.kind == PartKind::kArm) {
      EXPECT_EQ(match->part.segment, part.segment) << what << ": " << body.skeleton.joints[j].name;
    }
  }
}

class ConventionFiles : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ConventionFiles, AreMatchedWithTheWalk) {
  const NamingConvention& convention = namingConventions()[GetParam()];
  if (!isOfPeople(convention)) return;
  const bool beside = convention.torso == TorsoTree::kLowerBodyBeside;
  for (const PersonVariant& variant : personVariants()) {
    const MadeBody body = personOf(convention, variant);
    const std::string what = std::string(convention.name) + ", " + std::to_string(variant.spines) + " spines";
    const Motion motion = movingMotion(body.skeleton);
    const Asset asset = motionAsset(motion);
    expectMatched(body, readMotion(writeGlb(asset), "body.glb").skeleton, beside, what + ", GLB");
    expectMatched(body, readMotion(encodeFbx(asset).bytes, "body.fbx").skeleton, beside, what + ", FBX");
    expectMatched(body, readMotion(writeBvh(motion), "body.bvh").skeleton, beside, what + ", BVH");
  }
}

INSTANTIATE_TEST_SUITE_P(All, ConventionFiles, ::testing::Range(std::size_t{0}, namingConventions().size()));

}  // namespace limber::testing
