#include "limber/actions/rig/joint_landmarks.h"

#include <algorithm>
#include <functional>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "limber/core/known_error.h"
#include "limber/document/testing/scene_builder.h"
#include "limber/rigging/transfer/testing/capsule_person.h"

namespace limber {
namespace {

using testing::riggedCapsulePerson;

Skeleton mappedSkeleton(const std::function<Vec3(const Vec3&)>& map) {
  const Skeleton person = riggedCapsulePerson().skeleton;
  std::vector<Vec3> positions;
  for (const Vec3& position : testing::jointPositions(person)) positions.push_back(map(position));
  Skeleton result = person;
  for (Index j = 0; j < result.jointCount(); ++j) {
    const std::optional<Index> parent = result.joints[j].parent;
    result.joints[j].rest.translation = parent ? Vec3(positions[j] - positions[*parent]) : positions[j];
  }
  return result;
}

const Vec3* positionOf(const std::vector<JointLandmark>& landmarks, Index joint) {
  const auto at =
      std::find_if(landmarks.begin(), landmarks.end(), [&](const JointLandmark& l) { return l.joint == joint; });
  return at == landmarks.end() ? nullptr : &at->position;
}

// A chain that is no body.
Skeleton chain() {
  Skeleton skeleton;
  for (Index j = 0; j < 3; ++j) {
    Joint joint;
    joint.name = std::string("link_").append(std::to_string(j));
    if (j > 0) joint.parent = j - 1;
    joint.rest.translation = {0.3, 0, 0};
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

TEST(JointLandmarks, JointsInCommonAreWhereTheOtherBodyHasThem) {
  const Skeleton source = riggedCapsulePerson().skeleton;
  Skeleton target = mappedSkeleton([](const Vec3& p) { return Vec3(1.2 * p.x(), 1.5 * p.y(), p.z() + 3); });
  for (Joint& joint : target.joints) joint.name += "_other";
  const std::vector<JointLandmark> landmarks = commonLandmarks(source, target);
  const std::vector<Vec3> positions = testing::jointPositions(target);
  for (const char* name : {"leftUpperArm", "leftLowerArm", "leftHand", "rightUpperLeg", "rightLowerLeg", "rightFoot"}) {
    const Index joint = source.find(name).value();
    const Vec3* position = positionOf(landmarks, joint);
    ASSERT_NE(position, nullptr) << name;
    EXPECT_LT((*position - positions[joint]).norm(), 1e-12) << name;
  }
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(landmarks[i].joint, landmarks[k].joint);
  }
}

TEST(JointLandmarks, OfUnlikeBodiesAreRefusedInTheWordsOfARig) {
  const Skeleton person = riggedCapsulePerson().skeleton;
  for (const bool isSource : {true, false}) {
    try {
      isSource ? commonLandmarks(chain(), person) : commonLandmarks(person, chain());
      ADD_FAILURE() << "took it";
    } catch (const KnownError& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUnlikeRigs);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("the rig of "));
      EXPECT_THAT(error.what(), ::testing::Not(::testing::HasSubstr("motion")));
      ASSERT_EQ(error.values().size(), 2u);
      EXPECT_EQ(error.values()[0].value, isSource ? "3" : "15");
    }
  }
}

// The template lies in both bodies, a little off in each; what is between source and template stays between them.
TEST(JointLandmarks, ByATemplateKeepTheirPlaceAgainstIt) {
  const Skeleton source = riggedCapsulePerson().skeleton;
  const auto off = [](const Vec3& p) { return Vec3(p + Vec3(0, 0, 0.02)); };
  const auto turned = [&](const Vec3& p) { return Vec3(2 * Vec3(p.z(), p.y(), -p.x()) + Vec3(1, 0, 0)); };
  const Skeleton inSource = mappedSkeleton(off);
  const Skeleton inTarget = mappedSkeleton([&](const Vec3& p) { return turned(off(p)); });
  const std::vector<JointLandmark> landmarks = landmarksByTemplate(source, inSource, inTarget, 1.8);
  EXPECT_GE(landmarks.size(), 12u);
  const std::vector<Vec3> positions = testing::jointPositions(source);
  for (const JointLandmark& landmark : landmarks) {
    EXPECT_LT((landmark.position - turned(positions[landmark.joint])).norm(), 0.02)
        << source.joints[landmark.joint].name;
  }
}

TEST(JointLandmarks, ATemplateThatIsFarOffIsNotBelievedOfTheSource) {
  const Skeleton source = riggedCapsulePerson().skeleton;
  Skeleton inSource = source;
  const Index hand = source.find("leftHand").value();
  inSource.joints[hand].rest.translation += Vec3(0, 0, 0.5);  // of 1.8: far more than templates err
  const Skeleton inTarget = source;
  const std::vector<JointLandmark> landmarks = landmarksByTemplate(source, inSource, inTarget, 1.8);
  const Vec3* position = positionOf(landmarks, hand);
  ASSERT_NE(position, nullptr);
  EXPECT_LT((*position - testing::jointPositions(source)[hand]).norm(), 1e-6)
      << "where the template has it in the target";
}

Asset bareScene(const TriMesh& mesh) {
  testing::SceneBuilder scene;
  Json primitives = Json::array({scene.primitive(mesh.positions, mesh.triangles)});
  scene.addScene({scene.addNode({{"mesh", scene.addMesh(std::move(primitives))}})});
  return scene.build();
}

TEST(JointLandmarks, AFitCanBeCancelledAndTellsItsSteps) {
  const Asset person = bareScene(riggedCapsulePerson().mesh);
  std::vector<std::string> reported;
  Progress progress([&](std::string_view stage, double) {
    reported.emplace_back(stage);
    if (reported.size() == 2) progress.cancel();
  });
  progress.stage("fit target");
  try {
    fittedSkeleton(person, collectGeometry(person), progress);
    ADD_FAILURE() << "went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  }
  EXPECT_LE(reported.size(), 3u);
  EXPECT_THAT(reported.back(), ::testing::StartsWith("fit target: "));
}

TEST(JointLandmarks, WhatHasNoLimbsHasNoTemplate) {
  TriMesh ball;
  testing::addCapsule(ball, Vec3(0, 0.5, 0), Vec3(0, 0.6, 0), 0.4);
  const Asset asset = bareScene(ball);
  Progress progress;
  EXPECT_FALSE(fittedSkeleton(asset, collectGeometry(asset), progress));
}

// The person on a joint on the ground that carries legs and hips side by side, as some makers have it.
Skeleton onTheGround() {
  Skeleton result;
  result.joints.push_back({"root", std::nullopt, {}, 0});
  for (Joint joint : testing::riggedCapsulePerson().skeleton.joints) {
    if (!joint.parent) {
      joint.parent = 0;
    } else if (*joint.parent == 0) {  // the spine hangs on the hips, the legs on the ground
      const bool isLeg = joint.name != "spine";
      if (isLeg) joint.rest.translation += testing::personJoints()[0].position;
      joint.parent = isLeg ? 0 : 1;
    } else {
      ++*joint.parent;
    }
    result.joints.push_back(joint);
  }
  return result;
}

std::optional<Vec3> landmarkOf(const std::vector<JointLandmark>& landmarks, const Skeleton& skeleton,
                               const std::string& name) {
  for (const JointLandmark& landmark : landmarks) {
    if (skeleton.joints[landmark.joint].name == name) return landmark.position;
  }
  return std::nullopt;
}

TEST(JointLandmarks, HipsAreInTheBodyAndNotOnTheGround) {
  const Skeleton source = onTheGround(), target = testing::riggedCapsulePerson().skeleton;
  const std::vector<JointLandmark> landmarks = commonLandmarks(source, target);
  const std::optional<Vec3> hips = landmarkOf(landmarks, source, "hips");
  ASSERT_TRUE(hips);
  EXPECT_LT((*hips - testing::personJoints()[0].position).norm(), 1e-6);
  EXPECT_FALSE(landmarkOf(landmarks, source, "root"));
}

TEST(JointLandmarks, EachJointHasOneAtMost) {
  const Skeleton source = onTheGround();
  std::vector<Index> joints;
  for (const JointLandmark& landmark : commonLandmarks(source, testing::riggedCapsulePerson().skeleton)) {
    joints.push_back(landmark.joint);
  }
  std::sort(joints.begin(), joints.end());
  EXPECT_EQ(std::adjacent_find(joints.begin(), joints.end()), joints.end());
}

}  // namespace
}  // namespace limber
