#include "limber/rigging/templates/quadruped_landmarks.h"

#include <gtest/gtest.h>

#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

constexpr double kBack = 0.78, kUnderside = 0.46;  // of the trunk

struct MeasuredHorse {
  TriMesh mesh;
  BodyVolume body;
  AnatomicalFrame frame;
  std::vector<Vec3> positions;  // of the template, not of this horse

  explicit MeasuredHorse(const Vec3& tailEnd = {0, 0.5, -0.7}) {
    testing::addCapsule(mesh, {0, 0.62, -0.4}, {0, 0.62, 0.4}, 0.16);
    testing::addCapsule(mesh, {0, 0.7, 0.42}, {0, 0.87, 0.52}, 0.07);
    testing::addCapsule(mesh, {0, 0.92, 0.52}, {0, 0.86, 0.72}, 0.07);
    testing::addCapsule(mesh, {0, 0.66, -0.5}, tailEnd, 0.04);
    for (const double x : {-0.11, 0.11}) {
      for (const double z : {-0.33, 0.34}) testing::addCapsule(mesh, {x, 0.045, z}, {x, 0.55, z}, 0.045);
    }
    body = measureBody(mesh);
    frame = frameAlong(mesh, body, Vec3::UnitY(), Vec3::UnitZ());
    for (const TemplateJoint& joint : findTemplate("quadruped")->joints) {
      Vec3 position = joint.position;
      if (joint.mirror) {  // beside the legs, but in their reach
        position.x() = joint.position.x() > 0 ? 0.1 : -0.1;
        position.z() = joint.position.z() > 0 ? 0.35 : -0.35;
      }
      positions.push_back(frame.toBody(position));
    }
  }
};

const MeasuredHorse& theHorse() {
  static const MeasuredHorse horse;
  return horse;
}

}  // namespace

TEST(QuadrupedLandmarks, LegsStandUnderTheTrunkTheyCarry) {
  const MeasuredHorse& horse = theHorse();
  const TemplateSkeleton& skeleton = *findTemplate("quadruped");
  std::vector<Vec3> positions = horse.positions;
  refineQuadruped(skeleton, horse.body, horse.frame, std::vector<std::optional<Vec3>>(positions.size()), positions);
  const auto positionOf = [&](const char* name) { return horse.frame.fromBody(positions[*skeleton.find(name)]); };
  for (const double side : {1.0, -1.0}) {
    const std::string of = side > 0 ? "left" : "right";
    for (const char* part : {"UpperLeg", "LowerLeg", "Foot", "Toes"}) {
      const Vec3 front = positionOf((of + "Front" + part).c_str()), hind = positionOf((of + "Hind" + part).c_str());
      EXPECT_NEAR(front.x(), side * 0.11, 0.015) << part;
      EXPECT_NEAR(hind.x(), side * 0.11, 0.015) << part;
      EXPECT_NEAR(front.z(), 0.34, 0.02) << part;
      EXPECT_NEAR(hind.z(), -0.33, part == std::string("LowerLeg") ? 0.07 : 0.02) << part;
    }
    for (const char* leg : {"Front", "Hind"}) {
      const double upper = positionOf((of + leg + "UpperLeg").c_str()).y();
      EXPECT_GT(upper, kUnderside);
      EXPECT_LT(upper, kBack);
      EXPECT_GT(upper, positionOf((of + leg + "LowerLeg").c_str()).y());
      EXPECT_GT(positionOf((of + leg + "LowerLeg").c_str()).y(), positionOf((of + leg + "Foot").c_str()).y());
      EXPECT_GT(positionOf((of + leg + "Foot").c_str()).y(), positionOf((of + leg + "Toes").c_str()).y());
    }
  }
  double last = -1;
  for (const char* name : {"tail", "hips", "spine", "spine1", "chest", "neck", "head"}) {
    EXPECT_GT(positionOf(name).z(), last) << name;
    last = positionOf(name).z();
  }
  for (const char* name : {"hips", "spine", "spine1", "chest"}) EXPECT_NEAR(positionOf(name).y(), 0.62, 0.06) << name;
}

TEST(QuadrupedLandmarks, TheTailIsFollowedToItsEnd) {
  for (const Vec3& end : {Vec3(0, 0.4, -0.75), Vec3(0, 1.1, -0.65)}) {
    const MeasuredHorse horse(end);
    const TemplateSkeleton& skeleton = *findTemplate("quadruped");
    std::vector<Vec3> positions = horse.positions;
    refineQuadruped(skeleton, horse.body, horse.frame, std::vector<std::optional<Vec3>>(positions.size()), positions);
    const auto positionOf = [&](const char* name) { return horse.frame.fromBody(positions[*skeleton.find(name)]); };
    const Vec3 root = positionOf("tail"), bone = (end - Vec3(0, 0.66, -0.5)).normalized();
    EXPECT_LT((positionOf("tailTip") - end - 0.04 * bone).norm(), 0.05);
    for (const char* name : {"tail1", "tail2"}) {
      const Vec3 off = positionOf(name) - end;
      EXPECT_LT((off - off.dot(bone) * bone).norm(), 0.05) << name << " is in the middle of the tail";
    }
    EXPECT_LT((positionOf("tail1") - root).norm(), (positionOf("tail2") - root).norm());
  }
}

TEST(QuadrupedLandmarks, PinsStay) {
  const MeasuredHorse& horse = theHorse();
  const TemplateSkeleton& skeleton = *findTemplate("quadruped");
  const Index knee = *skeleton.find("leftHindLowerLeg");
  std::vector<std::optional<Vec3>> pins(horse.positions.size());
  std::vector<Vec3> positions = horse.positions;
  pins[knee] = positions[knee] = Vec3(0.3, 0.3, -0.3);
  refineQuadruped(skeleton, horse.body, horse.frame, pins, positions);
  EXPECT_EQ(positions[knee], *pins[knee]);
}

TEST(QuadrupedLandmarks, LeavesOtherTemplatesAlone) {
  const testing::MeasuredPerson& person = testing::measuredPerson();
  const TemplateSkeleton& skeleton = *findTemplate("humanoid");
  std::vector<Vec3> positions;
  for (const TemplateJoint& joint : skeleton.joints) positions.push_back(joint.position);
  std::vector<Vec3> refined = positions;
  refineQuadruped(skeleton, person.body, person.frame, std::vector<std::optional<Vec3>>(positions.size()), refined);
  EXPECT_EQ(refined, positions);
}

}  // namespace limber
