#include "limber/rigging/roles/joint_roles.h"

#include <algorithm>
#include <array>
#include <map>

#include <gtest/gtest.h>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/reading/shape_weights.h"
#include "limber/reading/weights_file.h"

namespace limber {

namespace {

// Of joints that have roles, by their names.
std::map<std::string, RolePosition> rolesOf(const Skeleton& skeleton, const AnatomyOptions& options) {
  const std::vector<std::optional<RolePosition>> roles = jointRoles(skeleton, readAnatomy(skeleton, options));
  EXPECT_EQ(roles.size(), skeleton.joints.size());
  std::map<std::string, RolePosition> named;
  for (std::size_t j = 0; j < roles.size(); ++j) {
    if (roles[j]) named[skeleton.joints[j].name] = *roles[j];
  }
  return named;
}

class JointRoles : public ::testing::Test {
 protected:
  void read(const Skeleton& skeleton, const AnatomyOptions& options = {}) { roles_ = rolesOf(skeleton, options); }

  // The joint's own role; empty for one between two and for one without.
  std::string roleOf(const std::string& joint) const {
    const auto found = roles_.find(joint);
    return found == roles_.end() || !found->second.isRole() ? "" : found->second.from;
  }
  bool hasNone(const std::string& joint) const { return !roles_.contains(joint); }

  void expectBetween(const std::string& joint, const std::string& from, const std::string& to, double fraction) const {
    SCOPED_TRACE(joint);
    ASSERT_TRUE(roles_.contains(joint));
    EXPECT_EQ(roles_.at(joint).from, from);
    EXPECT_EQ(roles_.at(joint).to, to);
    EXPECT_NEAR(roles_.at(joint).fraction, fraction, 1e-6);
  }

 private:
  std::map<std::string, RolePosition> roles_;
};

// A finger of that many joints on a person's hand.
void addFinger(Skeleton& skeleton, const std::string& side, const std::string& finger,
               const std::vector<std::string>& bones, double forward) {
  std::string parent = side + "Hand";
  const double out = side == "left" ? 1 : -1;
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const std::string name = side + finger + bones[i];
    testing::addJoint(skeleton, name, parent, Vec3(out * (i == 0 ? 0.05 : 0.03), 0, i == 0 ? forward : 0));
    parent = name;
  }
}

// One with fewer pairs of legs: of spider().
Skeleton withLegs(Index pairs) {
  const Skeleton spider = testing::spider().skeleton;
  Skeleton fewer;
  for (const Joint& joint : spider.joints) {
    const std::size_t leg = joint.name.find("_Leg");
    if (leg != std::string::npos && static_cast<Index>(joint.name[leg + 4] - '0') > pairs) continue;
    testing::addJoint(fewer, joint.name, joint.parent ? spider.joints[*joint.parent].name : "", joint.rest.translation);
  }
  return fewer;
}

TEST_F(JointRoles, APersonsLimbsAreRoles) {
  read(testing::vrmPerson());
  EXPECT_EQ(roleOf("neck"), "neck");
  EXPECT_EQ(roleOf("head"), "head");
  for (const auto& [side, of] : {std::pair<std::string, std::string>("left", ".L"), {"right", ".R"}}) {
    EXPECT_EQ(roleOf(side + "Shoulder"), "fore_base" + of);
    EXPECT_EQ(roleOf(side + "UpperArm"), "fore_upper" + of);
    EXPECT_EQ(roleOf(side + "LowerArm"), "fore_middle" + of);
    EXPECT_EQ(roleOf(side + "Hand"), "fore_end" + of);
    EXPECT_EQ(roleOf(side + "UpperLeg"), "hind_upper" + of);
    EXPECT_EQ(roleOf(side + "LowerLeg"), "hind_middle" + of);
    EXPECT_EQ(roleOf(side + "Foot"), "hind_end" + of);
    EXPECT_EQ(roleOf(side + "Toes"), "hind_toes" + of);
  }
}

// At 0.95, 1.05, 1.17 and 1.29 m, where four roles are at equal distances.
TEST_F(JointRoles, JointsOfTheTrunkLieAlongItsRoles) {
  read(testing::vrmPerson());
  EXPECT_EQ(roleOf("hips"), "trunk_0");
  expectBetween("spine", "trunk_0", "trunk_1", 0.30 / 0.34);
  expectBetween("chest", "trunk_1", "trunk_2", 0.66 / 0.34 - 1);
  EXPECT_EQ(roleOf("upperChest"), "trunk_3");
}

TEST_F(JointRoles, DoNotDependOnNamesSizeOrOrientation) {
  const std::vector<std::optional<RolePosition>> usual =
      jointRoles(testing::vrmPerson(), readAnatomy(testing::vrmPerson()));
  Skeleton other = testing::turnedAsAWhole(testing::nameless(testing::vrmPerson()), testing::turn(Vec3::UnitX(), -90));
  for (Joint& joint : other.joints) joint.rest.translation *= 100;
  const std::vector<std::optional<RolePosition>> roles = jointRoles(other, readAnatomy(other));
  ASSERT_EQ(roles.size(), usual.size());
  for (std::size_t j = 0; j < roles.size(); ++j) {
    ASSERT_EQ(roles[j].has_value(), usual[j].has_value()) << j;
    if (!roles[j]) continue;
    EXPECT_EQ(roles[j]->from, usual[j]->from);
    EXPECT_EQ(roles[j]->to, usual[j]->to);
    EXPECT_NEAR(roles[j]->fraction, usual[j]->fraction, 1e-6);
  }
}

TEST_F(JointRoles, TwistJointsLieBetween) {
  read(testing::withJointBefore(testing::vrmPerson(), "leftHand", "leftForearmTwist"));
  expectBetween("leftForearmTwist", "fore_middle.L", "fore_end.L", 0.4);
  EXPECT_EQ(roleOf("leftHand"), "fore_end.L");
}

TEST_F(JointRoles, AnAnimalsFrontLegsAreLikeArms) {
  read(testing::dog().skeleton);
  EXPECT_EQ(roleOf("Pelvis"), "trunk_0");
  EXPECT_EQ(roleOf("Spine3"), "trunk_3");
  EXPECT_EQ(roleOf("Neck1"), "neck");
  EXPECT_EQ(roleOf("Head"), "head");
  EXPECT_EQ(roleOf("Jaw"), "jaw");
  const double first = Vec3(0, 0.08, 0.08).norm(), second = Vec3(0, 0.09, 0.07).norm();
  expectBetween("Neck2", "neck", "head", first / (first + second));
  for (const auto& [side, of] : {std::pair<std::string, std::string>("L_", ".L"), {"R_", ".R"}}) {
    EXPECT_EQ(roleOf(side + "Scapula"), "fore_base" + of);
    EXPECT_EQ(roleOf(side + "UpperArm"), "fore_upper" + of);
    EXPECT_EQ(roleOf(side + "Forearm"), "fore_middle" + of);
    EXPECT_EQ(roleOf(side + "Thigh"), "hind_upper" + of);
    EXPECT_EQ(roleOf(side + "Calf"), "hind_middle" + of);
    EXPECT_EQ(roleOf(side + "Foot"), "hind_hock" + of);
    EXPECT_EQ(roleOf(side + "Toe"), "hind_end" + of);
    EXPECT_EQ(roleOf(side + "Ear"), "ear" + of);
  }
}

TEST_F(JointRoles, TailsHaveFourRolesHoweverManyJoints) {
  read(testing::dog().skeleton);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(roleOf("Tail" + std::to_string(i + 1)), "tail_" + std::to_string(i));
  read(testing::crow().skeleton);
  EXPECT_EQ(roleOf("Tail1"), "tail_0");
  EXPECT_EQ(roleOf("Tail2"), "tail_3");
  Skeleton longTailed = testing::dog().skeleton;
  for (int i = 5; i < 8; ++i) {
    testing::addJoint(longTailed, "Tail" + std::to_string(i), "Tail" + std::to_string(i - 1), {0, -0.05, -0.1});
  }
  read(longTailed);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(roleOf("Tail" + std::to_string(2 * i + 1)), "tail_" + std::to_string(i));
  expectBetween("Tail4", "tail_1", "tail_2", 0.5);
}

TEST_F(JointRoles, BirdsHaveWingsAndHindLegs) {
  read(testing::crow().skeleton);
  for (const auto& [side, of] : {std::pair<std::string, std::string>("Left", ".L"), {"Right", ".R"}}) {
    EXPECT_EQ(roleOf(side + "Wing1"), "wing_0" + of);
    expectBetween(side + "Wing2", "wing_0" + of, "wing_1" + of, 2.0 / 3);
    expectBetween(side + "Wing3", "wing_1" + of, "wing_2" + of, 1.0 / 3);
    EXPECT_EQ(roleOf(side + "Wing4"), "wing_2" + of);
    EXPECT_EQ(roleOf(side + "Thigh"), "hind_upper" + of);
    EXPECT_EQ(roleOf(side + "Shin"), "hind_middle" + of);
  }
}

TEST_F(JointRoles, PairsOfLegsBetweenTheFirstAndTheLastAreCounted) {
  const std::map<Index, std::vector<std::string>> cases = {
      {1, {"hind"}}, {2, {"fore", "hind"}}, {3, {"fore", "mida", "hind"}}, {4, {"fore", "mida", "midb", "hind"}}};
  for (const auto& [pairs, legs] : cases) {
    const Skeleton skeleton = withLegs(pairs);
    // The reading of the whole spider, without the parts that are cut off: on one or two pairs no spider stands.
    Anatomy anatomy = readAnatomy(testing::spider().skeleton);
    std::erase_if(anatomy.parts,
                  [kept = pairs](const Part& part) { return part.kind == PartKind::kLeg && part.pair >= kept; });
    for (Part& part : anatomy.parts) {
      const auto moved = [&](Index joint) { return *skeleton.find(testing::spider().skeleton.joints[joint].name); };
      for (Index& joint : part.joints) joint = moved(joint);
      for (std::optional<Index>* mark : {&part.upper, &part.middle, &part.hock, &part.end, &part.toes}) {
        if (*mark) *mark = moved(**mark);
      }
    }
    ASSERT_EQ(anatomy.pairsOf(PartKind::kLeg), pairs);
    const std::vector<std::optional<RolePosition>> roles = jointRoles(skeleton, anatomy);
    for (Index pair = 0; pair < pairs; ++pair) {
      const Index coxa = *skeleton.find("L_Leg" + std::to_string(pair + 1) + "_Coxa");
      ASSERT_TRUE(roles[coxa]) << pairs << " pairs, leg " << pair;
      EXPECT_EQ(roles[coxa]->from, legs[pair] + "_upper.L") << pairs;
      EXPECT_EQ(roles[coxa + 1]->from, legs[pair] + "_middle.L") << pairs;
      EXPECT_EQ(roles[coxa + 2]->from, legs[pair] + "_end.L") << pairs;
    }
  }
}

TEST_F(JointRoles, FishHaveTwoPairsOfFins) {
  read(testing::fish().skeleton);
  EXPECT_EQ(roleOf("PectoralFin1_L"), "fin0_0.L");
  EXPECT_EQ(roleOf("PectoralFin2_R"), "fin0_1.R");
  EXPECT_EQ(roleOf("PelvicFin1_R"), "fin1_0.R");
  EXPECT_TRUE(hasNone("PelvicFin2_R")) << "beyond the last role";
}

TEST_F(JointRoles, TheBoneInsideThePalmIsNoRole) {
  Skeleton person = testing::vrmPerson();
  for (const std::string side : {"left", "right"}) {
    addFinger(person, side, "Thumb", {"Metacarpal", "Proximal", "Distal"}, 0.04);
    addFinger(person, side, "Index", {"Metacarpal", "Proximal", "Intermediate", "Distal"}, 0.02);
    addFinger(person, side, "Middle", {"Proximal", "Intermediate", "Distal", "End"}, 0);
  }
  read(person);
  for (const auto& [side, of] : {std::pair<std::string, std::string>("left", ".L"), {"right", ".R"}}) {
    EXPECT_EQ(roleOf(side + "ThumbMetacarpal"), "finger_1_0" + of) << "the thumb's moves";
    EXPECT_EQ(roleOf(side + "ThumbDistal"), "finger_1_2" + of);
    EXPECT_TRUE(hasNone(side + "IndexMetacarpal"));
    EXPECT_EQ(roleOf(side + "IndexProximal"), "finger_2_0" + of);
    EXPECT_EQ(roleOf(side + "IndexDistal"), "finger_2_2" + of);
    EXPECT_EQ(roleOf(side + "MiddleProximal"), "finger_3_0" + of);
    EXPECT_EQ(roleOf(side + "MiddleDistal"), "finger_3_2" + of);
    EXPECT_TRUE(hasNone(side + "MiddleEnd"));
  }
}

TEST_F(JointRoles, PropsAndHairHaveNone) {
  Skeleton person = testing::vrmPerson();
  testing::addJoint(person, "Sword", "rightHand", {-0.1, 0, 0.1});
  testing::addJoint(person, "SwordTip", "Sword", {0, 0, 0.6});
  testing::addJoint(person, "Hair1", "head", {0, 0.15, -0.1});
  testing::addJoint(person, "Hair2", "Hair1", {0, -0.1, -0.05});
  const std::array<FixedLabel, 2> labels = {
      {{*person.find("Sword"), PartKind::kProp}, {*person.find("Hair1"), PartKind::kHair}}};
  AnatomyOptions options;
  options.fixed = labels;
  read(person, options);
  for (const char* joint : {"Sword", "SwordTip", "Hair1", "Hair2"}) EXPECT_TRUE(hasNone(joint)) << joint;
  EXPECT_EQ(roleOf("rightHand"), "fore_end.R");
  EXPECT_EQ(roleOf("head"), "head");
}

// Joints at one position have no lengths to lie along.
TEST_F(JointRoles, FractionsAreFinite) {
  Skeleton person = testing::vrmPerson();
  for (const char* joint : {"spine", "chest", "upperChest"}) {
    person.joints[*person.find(joint)].rest.translation = Vec3::Zero();
  }
  for (const auto& role : jointRoles(person, readAnatomy(person))) {
    if (!role) continue;
    EXPECT_GE(role->fraction, 0);
    EXPECT_LE(role->fraction, 1);
  }
}

TEST(PartOfRole, IsThePartThatTheJointMoves) {
  const std::map<std::string, std::string> expected = {{"trunk_2", "trunk"},
                                                       {"head", "head"},
                                                       {"jaw", "head"},
                                                       {"tail_3", "tail"},
                                                       {"fore_base.L", "trunk"},
                                                       {"fore_upper.R", "fore_upper.R"},
                                                       {"fore_middle.L", "fore_lower.L"},
                                                       {"fore_end.R", "fore_end.R"},
                                                       {"finger_2_1.L", "fore_end.L"},
                                                       {"hind_hock.R", "hind_lower.R"},
                                                       {"hind_toes.L", "hind_end.L"},
                                                       {"midb_middle.R", "mid.R"},
                                                       {"wing_1.L", "wing.L"},
                                                       {"fin0_1.R", "fin.R"},
                                                       {"ear.L", "ear.L"}};
  for (const auto& [role, part] : expected) EXPECT_EQ(partOfRole(role), part) << role;
  const std::shared_ptr<const ReadingWeights> weights = shapeWeights();
  for (const std::string& role : weights->roles) {
    const std::string part = partOfRole(role);
    EXPECT_NE(std::find(weights->parts.begin(), weights->parts.end(), part), weights->parts.end()) << role << part;
  }
}

}  // namespace
}  // namespace limber
