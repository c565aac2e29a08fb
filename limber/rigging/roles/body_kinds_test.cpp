#include "limber/rigging/roles/body_kinds.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/body/testing/capsule_animal.h"

namespace limber {

namespace {

const ReadingWeights& weights() {
  static const std::shared_ptr<const ReadingWeights> loaded = shapeWeights();
  return *loaded;
}

// The frame as they are built: up +Y, front +Z, symmetric to x = 0.
RoleReading readingOf(const TriMesh& mesh, const std::map<std::string, Vec3>& known = {}) {
  Box box;
  for (const Vec3f& position : mesh.positions) box.add(position.cast<double>());
  AnatomicalFrame frame;
  frame.origin = Vec3(0, box.min.y(), box.center().z());
  frame.height = box.size().y();
  frame.asymmetry = 0;
  return RoleReading(sampleSurface(mesh, weights().sampleCount()), weights(), frame, known);
}

// Read once for all tests. What the networks find in each is not what the tests are about.
const std::map<std::string, RoleReading>& readings() {
  static const std::map<std::string, RoleReading> all = [] {
    std::map<std::string, RoleReading> made;
    for (const auto& [name, mesh] : {std::pair<std::string, TriMesh>("hound", testing::capsuleHound()),
                                     {"theropod", testing::capsuleTheropod()},
                                     {"insect", testing::capsuleSpider(3)},
                                     {"spider", testing::capsuleSpider(4)},
                                     {"snake", testing::capsuleSnake()},
                                     {"fish", testing::capsuleFish()}}) {
      made.emplace(name, readingOf(mesh));
    }
    return made;
  }();
  return all;
}

using Check = std::function<void(const BodyKind&, const RoleReading&, const RoledSkeleton&)>;

// For all whose joints depend on the body.
void forAllKindsAndBodies(const Check& check) {
  for (const BodyKind& kind : bodyKinds()) {
    if (findTemplate(kind.name)) continue;
    for (const auto& [body, reading] : readings()) {
      SCOPED_TRACE(std::string(kind.name) + " in a " + body);
      check(kind, reading, skeletonOfKind(kind, reading));
    }
  }
}

bool hasOnASide(const RoleReading& reading, const std::string& role) {
  return reading.has(role + ".L") || reading.has(role + ".R");
}

// Of joints, without tips, in the skeleton's order.
std::vector<std::string> namesWith(const RoledSkeleton& made, std::string_view beginning, std::string_view part) {
  std::vector<std::string> names;
  for (const TemplateJoint& joint : made.skeleton.joints) {
    if (joint.role != TemplateRole::kTip && joint.name.starts_with(beginning) &&
        joint.name.find(part) != std::string::npos) {
      names.push_back(joint.name);
    }
  }
  return names;
}

std::string roleOf(const RoledSkeleton& made, std::string_view joint) {
  const std::optional<Index> found = made.skeleton.find(joint);
  return found && made.roles[*found] && made.roles[*found]->isRole() ? made.roles[*found]->from : "";
}

std::string parentOf(const RoledSkeleton& made, std::string_view joint) {
  const std::optional<Index> found = made.skeleton.find(joint);
  return found && made.skeleton.joints[*found].parent ? made.skeleton.joints[*made.skeleton.joints[*found].parent].name
                                                      : "";
}

bool walks(const BodyKind& kind) {
  return kind.plan != "swims" && kind.plan != "crawls";
}

}  // namespace

TEST(BodyKinds, AreFoundByTheirNames) {
  std::set<std::string_view> names;
  for (const BodyKind& kind : bodyKinds()) {
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_EQ(&findBodyKind(kind.name), &kind);
    EXPECT_FALSE(kind.summary.empty());
    EXPECT_NE(std::find(weights().plans.begin(), weights().plans.end(), kind.plan), weights().plans.end()) << kind.plan;
  }
  for (const TemplateSkeleton& skeleton : templateSkeletons()) EXPECT_TRUE(names.contains(skeleton.name));
  EXPECT_THROW(findBodyKind("centaur"), Error);
}

TEST(BodyKinds, SkeletonsAreSound) {
  forAllKindsAndBodies([](const BodyKind& kind, const RoleReading& reading, const RoledSkeleton& made) {
    EXPECT_EQ(made.skeleton.name, kind.name);
    ASSERT_EQ(made.roles.size(), made.skeleton.joints.size());
    ASSERT_GT(made.skeleton.jointCount(), 3u);
    std::set<std::string> names;
    for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
      const TemplateJoint& joint = made.skeleton.joints[j];
      SCOPED_TRACE(joint.name);
      EXPECT_TRUE(names.insert(joint.name).second);
      EXPECT_EQ(joint.parent.has_value(), j > 0);
      EXPECT_LT(joint.parent.value_or(0), std::max<Index>(j, 1));
      ASSERT_TRUE(made.roles[j]);
      EXPECT_LT((joint.position - reading.position(*made.roles[j])).norm(), 1e-12);
      EXPECT_GE(made.roles[j]->fraction, 0);
      EXPECT_LE(made.roles[j]->fraction, 1);
      EXPECT_NE(joint.role, TemplateRole::kBetween);
    }
    // Every end has a tip, and every tip ends a bone.
    std::vector<int> children(made.skeleton.joints.size());
    for (const TemplateJoint& joint : made.skeleton.joints) {
      if (joint.parent) ++children[*joint.parent];
    }
    for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
      const bool isTip = made.skeleton.joints[j].role == TemplateRole::kTip;
      EXPECT_EQ(children[j] == 0, isTip) << made.skeleton.joints[j].name;
    }
  });
}

TEST(BodyKinds, SidesMirrorEachOther) {
  forAllKindsAndBodies([](const BodyKind&, const RoleReading&, const RoledSkeleton& made) {
    for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
      const TemplateJoint& joint = made.skeleton.joints[j];
      SCOPED_TRACE(joint.name);
      const bool isLeft = joint.name.starts_with("left"), isRight = joint.name.starts_with("right");
      ASSERT_EQ(joint.mirror.has_value(), isLeft || isRight);
      EXPECT_EQ(made.roles[j]->from.ends_with(".L"), isLeft);
      EXPECT_EQ(made.roles[j]->from.ends_with(".R"), isRight);
      if (!joint.mirror) continue;
      EXPECT_EQ(made.skeleton.joints[*joint.mirror].mirror, j);
      const std::string& role = made.roles[j]->from;
      EXPECT_EQ(made.roles[*joint.mirror]->from.substr(0, role.size() - 2), role.substr(0, role.size() - 2));
    }
  });
}

TEST(BodyKinds, HaveAsManyLegsAsTheBodyWithinTheirLimits) {
  forAllKindsAndBodies([](const BodyKind& kind, const RoleReading& reading, const RoledSkeleton& made) {
    if (!walks(kind)) {
      EXPECT_TRUE(namesWith(made, "left", "Leg").empty());
      return;
    }
    std::size_t legs = 0;
    const bool hasArms = made.skeleton.find("leftUpperArm").has_value();
    for (const std::string role : {"fore", "mida", "midb", "midc", "hind"}) {
      if ((role != "fore" || !hasArms) && hasOnASide(reading, role + "_upper")) ++legs;
    }
    const std::size_t arms = hasArms ? 1 : 0;
    legs = std::max<std::size_t>(std::clamp(legs + arms, kind.minPairs, kind.maxPairs) - arms, 1);
    const std::vector<std::string> names = namesWith(made, "left", "UpperLeg");
    EXPECT_EQ(names.size(), legs);
    for (std::size_t pair = 0; pair < names.size(); ++pair) {
      std::string expected = "leftUpperLeg";
      if (legs == 2) expected = pair == 0 ? "leftFrontUpperLeg" : "leftHindUpperLeg";
      if (legs > 2 && pair > 0) expected += std::to_string(pair);
      EXPECT_EQ(names[pair], expected);
    }
    EXPECT_EQ(made.skeleton.find("tail").has_value(), reading.has("tail_0"));
    EXPECT_EQ(made.skeleton.find("leftUpperWing").has_value(), hasOnASide(reading, "wing_0"));
    EXPECT_EQ(made.skeleton.find("head").has_value(), reading.has("head"));
  });
}

// Joints that are known are there: a body whatever the networks see.
TEST(BodyKinds, NameTheJointsOfALimb) {
  std::map<std::string, Vec3> known;
  for (const double s : {1.0, -1.0}) {
    const std::string of = s > 0 ? ".L" : ".R";
    known["hind_hock" + of] = Vec3(0.08 * s, 0.2, -0.3);
    known["fore_upper" + of] = Vec3(0.08 * s, 0.6, 0.3);
  }
  known["tail_0"] = Vec3(0, 0.7, -0.4);
  const RoleReading reading = readingOf(testing::capsuleTheropod(), known);
  const RoledSkeleton made = skeletonOfKind(findBodyKind("dinosaur"), reading);
  EXPECT_EQ(roleOf(made, "hips"), "trunk_0");
  EXPECT_EQ(roleOf(made, "chest"), "trunk_3");
  EXPECT_EQ(parentOf(made, "chest"), "spine");
  EXPECT_EQ(roleOf(made, "leftUpperArm"), "fore_upper.L");
  EXPECT_EQ(parentOf(made, "leftUpperArm"), "chest");
  EXPECT_EQ(parentOf(made, "tail"), "hips");
  EXPECT_EQ(roleOf(made, "tail3"), "tail_3");
  EXPECT_EQ(parentOf(made, "tail3"), "tail2");
  // On the pair of legs that is the last.
  const std::vector<std::string> uppers = namesWith(made, "left", "UpperLeg");
  const std::string& upper = uppers.back();
  const std::string before = upper.substr(4, upper.find("UpperLeg") - 4), behind = upper.substr(upper.find("Leg") + 3);
  EXPECT_EQ(roleOf(made, upper), "hind_upper.L");
  EXPECT_EQ(roleOf(made, "left" + before + "LowerLeg" + behind), "hind_middle.L");
  EXPECT_EQ(roleOf(made, "left" + before + "Foot" + behind), "hind_hock.L") << "the raised heel";
  EXPECT_EQ(roleOf(made, "left" + before + "Toes" + behind), "hind_end.L") << "what it rests on";
  EXPECT_EQ(parentOf(made, "left" + before + "Toes" + behind), "left" + before + "Foot" + behind);
}

TEST(BodyKinds, InsectsHaveThreePairsOfLimbsAndSpidersFourOrMore) {
  for (const auto& [body, reading] : readings()) {
    SCOPED_TRACE(body);
    const auto pairs = [&](const char* kind) {
      const RoledSkeleton made = skeletonOfKind(findBodyKind(kind), reading);
      return namesWith(made, "left", "UpperLeg").size() + namesWith(made, "left", "UpperArm").size();
    };
    EXPECT_EQ(pairs("insect"), 3u);
    EXPECT_GE(pairs("spider"), 4u);
  }
}

TEST(BodyKinds, ALimbOnOneSideIsOnBoth) {
  const RoleReading reading = readingOf(testing::capsuleSpider(3), {{"mida_upper.R", Vec3(-0.1, 0.5, 0)}});
  const RoledSkeleton made = skeletonOfKind(findBodyKind("insect"), reading);
  const auto roles = [&](const std::string& role) {
    return std::count_if(made.roles.begin(), made.roles.end(), [&](const auto& r) { return r && r->from == role; });
  };
  EXPECT_GE(roles("mida_upper.L"), 1);
  EXPECT_GE(roles("mida_upper.R"), 1);
}

TEST(BodyKinds, SerpentsAreChains) {
  for (const auto& [body, reading] : readings()) {
    SCOPED_TRACE(body);
    const RoledSkeleton made = skeletonOfKind(findBodyKind("serpent"), reading);
    std::size_t joints = 0;
    for (const TemplateJoint& joint : made.skeleton.joints) joints += joint.role == TemplateRole::kTip ? 0 : 1;
    EXPECT_EQ(joints, 12u);
    EXPECT_EQ(made.skeleton.joints.front().name, "chest");
    EXPECT_EQ(parentOf(made, "head"), "neck");
    EXPECT_EQ(parentOf(made, "neck"), "chest");
    EXPECT_EQ(parentOf(made, "tail"), "spine3");
    EXPECT_EQ(parentOf(made, "tail4"), "tail3");
  }
}

TEST(BodyKinds, FishHaveTheFinsThatTheBodyHas) {
  for (const auto& [body, reading] : readings()) {
    SCOPED_TRACE(body);
    const RoledSkeleton made = skeletonOfKind(findBodyKind("fish"), reading);
    EXPECT_EQ(parentOf(made, "spine"), "chest");
    EXPECT_EQ(parentOf(made, "tail"), "spine");
    EXPECT_EQ(parentOf(made, "tail2"), "tail1");
    EXPECT_EQ(made.skeleton.find("leftFin").has_value(), hasOnASide(reading, "fin0_0"));
    EXPECT_EQ(made.skeleton.find("rightFin1").has_value(), hasOnASide(reading, "fin1_0"));
  }
  const RoleReading finned = readingOf(testing::capsuleFish(), {{"fin0_0.L", Vec3(0.2, 0.5, 0.5)}});
  EXPECT_EQ(roleOf(skeletonOfKind(findBodyKind("fish"), finned), "rightFin"), "fin0_0.R");
}

}  // namespace limber
