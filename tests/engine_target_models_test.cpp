// Models for other engines: what artists made, as every target has it, looks as it did and is read as what it was.
#include <algorithm>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "limber/actions/export/engine_target.h"
#include "limber/actions/export/testing/gltf_player.h"
#include "limber/character/anatomy/names/humanoid_joints.h"
#include "limber/character/matching/skeleton_map.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "shared_data.h"
#include "shared_people.h"

namespace limber::testing {

namespace {

constexpr std::size_t kVertexStep = 11, kMomentsOfClip = 3;
constexpr double kUnseen = 1e-6, kSamePosition = 1e-4;  // of the size

std::map<std::string_view, Vec3> bonesOfPerson(const Skeleton& skeleton) {
  const std::vector<Affine> globals = restGlobals(skeleton);
  std::map<std::string_view, Vec3> bones;
  for (const HumanoidJoint& joint : humanoidJoints(skeleton)) bones[joint.bone] = globals[joint.joint].translation();
  return bones;
}

// The person's bones of `source` whose joints match joints at the same positions.
std::set<std::string_view> followedInPlace(const Skeleton& source, const Skeleton& target) {
  const std::vector<Affine> from = restGlobals(source), to = restGlobals(target);
  Box box;
  for (const Affine& global : from) box.add(global.translation());
  std::map<Index, Index> partner;
  for (const JointMatch& match : matchSkeletons(source, target).matches) {
    for (std::size_t i = 0; i < std::min(match.source.size(), match.target.size()); ++i) {
      partner[match.source[i]] = match.target[i];
    }
  }
  std::set<std::string_view> followed;
  for (const HumanoidJoint& bone : humanoidJoints(source)) {
    const auto found = partner.find(bone.joint);
    if (found == partner.end()) continue;
    const Vec3 apart = from[bone.joint].translation() - to[found->second].translation();
    if (apart.norm() < kSamePosition * box.diagonal()) followed.insert(bone.bone);
  }
  return followed;
}

}  // namespace

class TargetPeople : public ::testing::TestWithParam<const char*> {};

TEST_P(TargetPeople, LookAndAreReadAsBefore) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset before = readAsset(*sharedDataFolder() / "rigged" / GetParam());
  const Skeleton source = readSkeleton(before).skeleton;
  const std::map<std::string_view, Vec3> bones = bonesOfPerson(source);
  for (const EngineTarget& target : engineTargets()) {
    Asset after = before.clone();
    toTarget(after, target);
    checkAsset(after);
    EXPECT_LT(largestMove(before, after, kVertexStep, kMomentsOfClip), kUnseen) << target.name;
    const Skeleton skeleton = readSkeleton(after).skeleton;
    const std::map<std::string_view, Vec3> found = bonesOfPerson(skeleton);
    // Rigify counts spine, neck and head in one: a neck that carries the arms is read as a joint of the spine.
    const bool losesNeck = target.name == "rigify" && bones.count("neck") > found.count("neck");
    if (losesNeck) continue;
    EXPECT_EQ(found.size(), bones.size()) << target.name;
    for (const auto& [bone, position] : bones) {
      ASSERT_EQ(found.count(bone), 1u) << target.name << ' ' << bone;
      EXPECT_LT((found.at(bone) - position).norm(), kSamePosition * position.norm()) << target.name << ' ' << bone;
    }
    EXPECT_EQ(followedInPlace(source, skeleton), followedInPlace(source, source)) << target.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, TargetPeople, ::testing::ValuesIn(kSharedPeople));

class TargetAnimals : public ::testing::TestWithParam<const char*> {};

TEST_P(TargetAnimals, LookAsBefore) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset before = readAsset(*sharedDataFolder() / GetParam());
  for (const EngineTarget& target : engineTargets()) {
    Asset after = before.clone();
    toTarget(after, target);
    checkAsset(after);
    EXPECT_LT(largestMove(before, after, kVertexStep, kMomentsOfClip), kUnseen) << target.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Shared, TargetAnimals,
                         ::testing::Values("rigged/quaternius_horse.glb", "rigged/quaternius_spider.glb",
                                           "rigged/m2m_bird_eagle.glb", "motions/m2m_bird_animations.glb",
                                           "motions/m2m_horse_animations.glb", "motions/m2m_spider_animations.glb"));

}  // namespace limber::testing
