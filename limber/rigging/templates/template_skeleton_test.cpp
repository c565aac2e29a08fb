#include "limber/rigging/templates/template_skeleton.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/skeleton/humanoid_bones.h"

namespace limber {

namespace {

Skeleton line(std::initializer_list<std::pair<const char*, Vec3>> joints) {
  Skeleton skeleton;
  Vec3 last = Vec3::Zero();
  for (const auto& [name, position] : joints) {
    Joint joint;
    joint.name = name;
    if (!skeleton.joints.empty()) joint.parent = skeleton.jointCount() - 1;
    joint.rest.translation = position - last;
    last = position;
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

}  // namespace

TEST(TemplateSkeleton, TablesAreSound) {
  for (const TemplateSkeleton& skeleton : templateSkeletons()) {
    SCOPED_TRACE(skeleton.name);
    std::set<std::string> names;
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      const TemplateJoint& joint = skeleton.joints[j];
      SCOPED_TRACE(joint.name);
      EXPECT_TRUE(names.insert(joint.name).second);
      if (joint.parent) {
        EXPECT_LT(*joint.parent, j);
      }
      EXPECT_EQ(joint.parent.has_value(), j > 0);
      if (joint.mirror) {
        const TemplateJoint& other = skeleton.joints[*joint.mirror];
        EXPECT_EQ(other.mirror, j);
        EXPECT_EQ(other.position, joint.position.cwiseProduct(Vec3(-1, 1, 1)));
      } else {
        EXPECT_EQ(joint.position.x(), 0);
      }
    }
    EXPECT_EQ(findTemplate(skeleton.name), &skeleton);
  }
  EXPECT_EQ(findTemplate("centaur"), nullptr);
}

TEST(TemplateSkeleton, PeopleHaveTheNamesAndParentsOfVrm) {
  for (const char* name : {"humanoid", "humanoid-fingers"}) {
    const TemplateSkeleton& skeleton = *findTemplate(name);
    for (const TemplateJoint& joint : skeleton.joints) {
      if (joint.role == TemplateRole::kTip) continue;
      const auto bones = humanoidBones();
      EXPECT_NE(std::find(bones.begin(), bones.end(), joint.name), bones.end()) << joint.name;
      const std::optional<std::string_view> parent = humanoidParent(joint.name);
      ASSERT_EQ(parent.has_value(), joint.parent.has_value()) << joint.name;
      if (parent) {
        EXPECT_EQ(skeleton.joints[*joint.parent].name, *parent);
      }
    }
  }
}

TEST(TemplateSkeleton, OfAUsersSkeleton) {
  Skeleton own = line({{"root", {0, 0, 0}}, {"neck", {0, 1, 0}}, {"top", {0, 2, 0}}});
  for (const double side : {1.0, -1.0}) {
    Joint arm;
    arm.name = side > 0 ? "arm.L" : "arm.R";
    arm.parent = 1;
    arm.rest.translation = Vec3(side, 0.2, 0);
    own.joints.push_back(arm);
  }
  const TemplateSkeleton skeleton = templateFrom(own, "mine");
  EXPECT_EQ(skeleton.jointCount(), 8u);  // five, and a tip to each of three ends
  EXPECT_EQ(std::count_if(skeleton.joints.begin(), skeleton.joints.end(),
                          [](const TemplateJoint& joint) { return joint.role == TemplateRole::kTip; }),
            3);
  EXPECT_EQ(skeleton.joints[3].mirror, Index{4});
  EXPECT_EQ(skeleton.joints[4].mirror, Index{3});
  EXPECT_EQ(skeleton.joints[0].position.y(), 0);
  EXPECT_NEAR(skeleton.joints[2].position.y(), 0.95, 1e-12);
}

TEST(TemplateSkeleton, PairsInTheMiddleHaveNoSides) {
  Skeleton own = line({{"root", {0, 0, 0}}, {"neck", {0, 1, 0}}, {"top", {0, 2, 0}}});
  for (const double side : {1.0, -1.0}) {
    const std::string of = side > 0 ? "Left" : "Right";
    own.joints.push_back({of + "Collar", Index{1}, {}, 0});
    own.joints.back().rest.translation = Vec3(0, 0.5, 0);
    own.joints.push_back({of + "Shoulder", own.jointCount() - 1, {}, 0});
    own.joints.back().rest.translation = Vec3(side, 0, 0);
  }
  const TemplateSkeleton skeleton = templateFrom(own, "mine");
  EXPECT_FALSE(skeleton.joints[*skeleton.find("LeftCollar")].mirror);
  EXPECT_EQ(skeleton.joints[*skeleton.find("LeftShoulder")].mirror, skeleton.find("RightShoulder"));
}

TEST(TemplateSkeleton, RefusesWhatIsNone) {
  EXPECT_THROW(templateFrom(Skeleton(), "none"), Error);
  try {
    templateFrom(line({{"flat", {0, 0, 0}}, {"also", {1, 0, 0}}}), "floor");
    FAIL() << "a flat skeleton was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("flat"), std::string::npos);
  }
  Skeleton cycle = line({{"a", {0, 0, 0}}, {"b", {0, 1, 0}}});
  cycle.joints[0].parent = 1;
  EXPECT_THROW(templateFrom(cycle, "cycle"), Error);
}

}  // namespace limber
