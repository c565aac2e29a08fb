// Where limbs get to, on bodies made in code.
#include "limber/evaluate/skin/range_of_motion.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"

namespace limber {
namespace {

using limber::testing::vrmPerson;

const RangeOfMotionPose* findPose(const std::vector<RangeOfMotionPose>& poses, std::string_view name) {
  const auto pose = std::find_if(poses.begin(), poses.end(), [&](const auto& p) { return p.name == name; });
  return pose == poses.end() ? nullptr : &*pose;
}

std::vector<RangeOfMotionPose> rangeOf(const Skeleton& skeleton) {
  return rangeOfMotion(skeleton, readAnatomy(skeleton));
}

Vec3 directionIn(const Skeleton& skeleton, const Pose& pose, std::string_view from, std::string_view to) {
  const std::vector<Vec3> positions = posePositions(skeleton, pose);
  return (positions[skeleton.find(to).value()] - positions[skeleton.find(from).value()]).normalized();
}

double degreesBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

// A person of VRM faces +Z, the left hand at +X.
TEST(RangeOfMotion, APersonsLimbsTurnByHalfTheirRangeToTheirSides) {
  const Skeleton person = vrmPerson();
  const std::vector<RangeOfMotionPose> poses = rangeOf(person);
  const Pose rest = restPose(person);
  struct Case {
    std::string_view pose;
    std::string from, to;
    double degrees;
    Vec3 towards;
  };
  const Case cases[] = {{"legs forward", "UpperLeg", "Foot", 60, {0, 0, 1}},
                        {"legs back", "UpperLeg", "Foot", 15, {0, 0, -1}},
                        {"knees", "LowerLeg", "Foot", 67.5, {0, 0, -1}},
                        {"arms forward", "UpperArm", "Hand", 90, {0, 0, 1}},
                        {"arms up", "UpperArm", "Hand", 90, {0, 1, 0}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.pose);
    const RangeOfMotionPose* pose = findPose(poses, one.pose);
    ASSERT_TRUE(pose);
    for (const std::string side : {"left", "right"}) {
      const Vec3 before = directionIn(person, rest, side + one.from, side + one.to);
      const Vec3 after = directionIn(person, pose->pose, side + one.from, side + one.to);
      EXPECT_NEAR(degreesBetween(before, after), one.degrees, 1e-6);
      EXPECT_GT((after - before).dot(one.towards), 0.05);
    }
  }
}

TEST(RangeOfMotion, BothSidesAreMirrorImages) {
  const Skeleton person = vrmPerson();
  for (const RangeOfMotionPose& one : rangeOf(person)) {
    if (one.name == "trunk bent aside" || one.name == "trunk turned" || one.name == "neck bent aside" ||
        one.name == "head turned") {
      continue;
    }
    SCOPED_TRACE(one.name);
    const std::vector<Vec3> positions = posePositions(person, one.pose);
    for (Index j = 0; j < person.jointCount(); ++j) {
      const std::string& name = person.joints[j].name;
      if (name.rfind("left", 0) != 0) continue;
      const Vec3& right = positions[person.find("right" + name.substr(4)).value()];
      EXPECT_NEAR((positions[j] - Vec3(-right.x(), right.y(), right.z())).norm(), 0, 1e-9) << name;
    }
  }
}

// Whatever the joints' own axes and the orientation of the whole, the same positions are reached.
TEST(RangeOfMotion, DoesNotDependOnTheJointsFrames) {
  const Skeleton person = vrmPerson();
  Skeleton other = person;
  const std::vector<Vec3> positions = restPositions(person);
  std::vector<Quat> frames;
  for (Index j = 0; j < other.jointCount(); ++j) {
    frames.push_back(Quat(Eigen::AngleAxisd(0.3 * (j % 7), Vec3(1, j % 3, 2).normalized())));
    const auto parent = person.joints[j].parent;
    Transform& local = other.joints[j].rest;
    local.rotation = parent ? Quat(frames[*parent].conjugate() * frames[j]) : frames[j];
    if (parent) local.translation = frames[*parent].conjugate() * (positions[j] - positions[*parent]);
  }
  const std::vector<RangeOfMotionPose> plain = rangeOf(person), turned = rangeOf(other);
  ASSERT_EQ(plain.size(), turned.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const std::vector<Vec3> a = posePositions(person, plain[i].pose), b = posePositions(other, turned[i].pose);
    for (std::size_t j = 0; j < a.size(); ++j) EXPECT_NEAR((a[j] - b[j]).norm(), 0, 1e-6) << plain[i].name;
  }
}

// A dog's forelegs bend at the elbow in the direction in which they are bent at rest: the angle grows.
TEST(RangeOfMotion, KneesBendFurtherTheWayThatTheyAreBent) {
  const Skeleton dog = limber::testing::dog().skeleton;
  const std::vector<RangeOfMotionPose> poses = rangeOf(dog);
  const RangeOfMotionPose* knees = findPose(poses, "knees");
  ASSERT_TRUE(knees);
  const std::vector<Vec3> before = restPositions(dog), after = posePositions(dog, knees->pose);
  const auto bend = [&](const std::vector<Vec3>& positions, const char* a, const char* b, const char* c) {
    const Vec3& knee = positions[dog.find(b).value()];
    return degreesBetween(knee - positions[dog.find(a).value()], positions[dog.find(c).value()] - knee);
  };
  EXPECT_GT(bend(after, "L_Thigh", "L_Calf", "L_Foot"), bend(before, "L_Thigh", "L_Calf", "L_Foot") + 20);
  EXPECT_GT(bend(after, "R_UpperArm", "R_Forearm", "R_Hand"), bend(before, "R_UpperArm", "R_Forearm", "R_Hand") + 20);
}

TEST(RangeOfMotion, AnimalsMoveWhatTheyHave) {
  const auto has = [](const Skeleton& skeleton, std::string_view name) {
    return findPose(rangeOf(skeleton), name) != nullptr;
  };
  EXPECT_TRUE(has(limber::testing::dog().skeleton, "tail aside"));
  EXPECT_FALSE(has(limber::testing::dog().skeleton, "wings up"));
  EXPECT_TRUE(has(limber::testing::crow().skeleton, "wings up"));
  EXPECT_TRUE(has(limber::testing::fish().skeleton, "tail aside"));
  EXPECT_FALSE(has(limber::testing::fish().skeleton, "legs forward"));
  EXPECT_TRUE(has(limber::testing::spider().skeleton, "legs forward"));
}

TEST(RangeOfMotion, OfOneJointOrNoneThereIsNothing) {
  Skeleton one;
  EXPECT_TRUE(rangeOf(one).empty());
  limber::testing::addJoint(one, "root", "", Vec3::Zero());
  EXPECT_TRUE(rangeOf(one).empty());
}

}  // namespace
}  // namespace limber
