#include "limber/character/anatomy/anatomy.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "limber/character/anatomy/testing/bodies.h"
#include "limber/core/error.h"
#include "limber/core/text/numbers.h"

namespace limber {
namespace {

using limber::testing::kNameHabits;
using limber::testing::MadeBody;
using limber::testing::NameHabit;
using limber::testing::nameless;
using limber::testing::personWith;
using limber::testing::turnedAsAWhole;

std::string text(const BodyPart& part) {
  return std::string(nameOf(part.side)) + " " + std::string(nameOf(part.kind)) + " " + std::to_string(part.pair);
}

std::optional<Index> landmark(const Part& part, Segment segment) {
  switch (segment) {
    case Segment::kUpper:
      return part.upper;
    case Segment::kMiddle:
      return part.middle;
    case Segment::kHock:
      return part.hock;
    case Segment::kEnd:
      return part.end;
    case Segment::kToes:
      return part.toes;
    default:
      return std::nullopt;
  }
}

// Each joint is of the part that it was made for, and landmarks are where they are.
void expectReadRight(const MadeBody& body, const Anatomy& anatomy) {
  ASSERT_EQ(anatomy.partOf.size(), body.parts.size());
  for (Index j = 0; j < body.parts.size(); ++j) {
    const BodyPart& made = body.parts[j];
    const std::string& name = body.skeleton.joints[j].name;
    if (!anatomy.partOf[j]) {
      ADD_FAILURE() << name << " is of no part, not " << text(made);
      continue;
    }
    const Part& part = anatomy.parts[*anatomy.partOf[j]];
    EXPECT_EQ(text({part.kind, part.side, part.pair, {}, 0}), text(made)) << name;
    EXPECT_TRUE(part.has(j)) << name;
    if (made.segment > Segment::kBase) {
      EXPECT_EQ(landmark(part, made.segment), j) << name;
    }
    if (made.segment == Segment::kBase && made.kind != PartKind::kTrunk) {
      EXPECT_TRUE(part.joints.front() == j && part.upper != j) << name;
    }
  }
}

// What any answer fulfils.
void expectInOrder(const Anatomy& anatomy, const Skeleton& skeleton) {
  ASSERT_EQ(anatomy.partOf.size(), skeleton.jointCount());
  std::vector<int> times(skeleton.jointCount(), 0);
  for (std::size_t p = 0; p < anatomy.parts.size(); ++p) {
    const Part& part = anatomy.parts[p];
    EXPECT_FALSE(part.joints.empty());
    if (part.carrier) {
      EXPECT_LT(*part.carrier, p) << "a part's carrier before it";
    }
    for (const std::vector<Index>& joints : {part.joints, part.branches}) {
      for (const Index joint : joints) {
        ++times[joint];
        EXPECT_EQ(anatomy.partOf[joint], p);
      }
    }
    EXPECT_GE(part.confidence, 0);
    EXPECT_LE(part.confidence, 1 + 1e-9);
  }
  for (Index j = 0; j < skeleton.jointCount(); ++j) EXPECT_EQ(times[j], anatomy.partOf[j] ? 1 : 0);
  EXPECT_NEAR(anatomy.axes.up.norm(), 1, 1e-9);
  EXPECT_NEAR(anatomy.axes.front.norm(), 1, 1e-9);
  EXPECT_NEAR(anatomy.axes.up.dot(anatomy.axes.front), 0, 1e-9);
}

void expectStraight(const Anatomy& anatomy, const Quat& turn = Quat::Identity()) {
  EXPECT_LT((anatomy.axes.up - turn * Vec3::UnitY()).norm(), 1e-6) << anatomy.axes.up.transpose();
  EXPECT_LT((anatomy.axes.front - turn * Vec3::UnitZ()).norm(), 1e-6) << anatomy.axes.front.transpose();
}

TEST(Anatomy, PeopleOfAllHabitsWithAndWithoutNames) {
  for (const NameHabit habit : kNameHabits) {
    const MadeBody person = personWith(habit);
    for (const bool names : {true, false}) {
      SCOPED_TRACE(person.skeleton.joints[0].name + (names ? "" : " by form"));
      const Anatomy anatomy = readAnatomy(person.skeleton, {names, {}});
      expectInOrder(anatomy, person.skeleton);
      expectStraight(anatomy);
      expectReadRight(person, anatomy);
      EXPECT_NEAR(anatomy.ground,
                  person.skeleton.find("mixamorig:LeftToe_End") || habit == NameHabit::kBiped ? 0.02 : 0.025, 1e-9);
    }
    const Anatomy unnamed = readAnatomy(nameless(person.skeleton));
    for (const Part& part : unnamed.parts) EXPECT_EQ(part.evidence, Evidence::kForm);
  }
}

TEST(Anatomy, AxesTurnWithTheBody) {
  const MadeBody person = personWith(NameHabit::kMixamo);
  for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())}) {
    for (const double degrees : {90.0, -90.0, 180.0}) {
      SCOPED_TRACE(axis.transpose());
      const Quat turn(Eigen::AngleAxisd(degrees * kPi / 180, axis));
      const Anatomy anatomy = readAnatomy(turnedAsAWhole(person.skeleton, turn));
      expectStraight(anatomy, turn);
      expectReadRight(person, anatomy);
    }
  }
}

TEST(Anatomy, SizesAreMeasured) {
  Skeleton person = personWith(NameHabit::kMixamo).skeleton;
  const Anatomy one = readAnatomy(person);
  for (Joint& joint : person.joints) joint.rest.translation *= 100;
  const Anatomy other = readAnatomy(person);
  EXPECT_NEAR(other.size, 100 * one.size, 1e-6);
  EXPECT_NEAR(other.ground, 100 * one.ground, 1e-6);
  ASSERT_EQ(one.parts.size(), other.parts.size());
  for (std::size_t p = 0; p < one.parts.size(); ++p) EXPECT_EQ(one.parts[p].joints, other.parts[p].joints);
}

void expectAnimalReadRight(const MadeBody& body, const Skeleton& skeleton) {
  const Anatomy anatomy = readAnatomy(skeleton);
  expectInOrder(anatomy, skeleton);
  expectStraight(anatomy);
  expectReadRight(body, anatomy);
}

TEST(Anatomy, ADog) {
  const MadeBody dog = limber::testing::dog();
  expectAnimalReadRight(dog, dog.skeleton);
}

// A lone joint ahead of the head may be a snout or a jaw: form does not tell.
TEST(Anatomy, ADogByItsForm) {
  MadeBody dog = limber::testing::dog();
  const Index jaw = dog.skeleton.find("Jaw").value();
  const Skeleton unnamed = nameless(dog.skeleton);
  const Anatomy anatomy = readAnatomy(unnamed);
  ASSERT_TRUE(anatomy.partOf[jaw]);
  const PartKind kind = anatomy.parts[*anatomy.partOf[jaw]].kind;
  EXPECT_TRUE(kind == PartKind::kJaw || kind == PartKind::kHead) << nameOf(kind);
  dog.parts[jaw].kind = kind;
  expectAnimalReadRight(dog, unnamed);
}

TEST(Anatomy, ACrow) {
  const MadeBody crow = limber::testing::crow();
  expectAnimalReadRight(crow, crow.skeleton);
}

TEST(Anatomy, ACrowByItsForm) {
  const MadeBody crow = limber::testing::crow();
  expectAnimalReadRight(crow, nameless(crow.skeleton));
}

TEST(Anatomy, ASpider) {
  const MadeBody spider = limber::testing::spider();
  expectAnimalReadRight(spider, spider.skeleton);
}

TEST(Anatomy, AFish) {
  const MadeBody fish = limber::testing::fish();
  expectAnimalReadRight(fish, fish.skeleton);
}

// A trunk, a neck and a tail are much alike in a snake; a head at its front, and nothing beside it, is not.
TEST(Anatomy, ASnakeHasAHeadAndNoLimbs) {
  const MadeBody snake = limber::testing::snake();
  for (const bool names : {true, false}) {
    SCOPED_TRACE(names);
    const Anatomy anatomy = readAnatomy(snake.skeleton, {names, {}});
    expectInOrder(anatomy, snake.skeleton);
    expectStraight(anatomy);
    for (const Part& part : anatomy.parts) {
      EXPECT_EQ(part.side, Side::kCenter);
      const bool isCenter = part.kind == PartKind::kTrunk || part.kind == PartKind::kNeck ||
                            part.kind == PartKind::kHead || part.kind == PartKind::kTail || part.kind == PartKind::kJaw;
      EXPECT_TRUE(isCenter) << nameOf(part.kind);
    }
    ASSERT_TRUE(anatomy.find(PartKind::kHead));
    EXPECT_TRUE(anatomy.find(PartKind::kHead)->has(snake.skeleton.find("Head").value()));
  }
}

// Legs and trunk on one joint over the middle: the pairs of legs are mirror images to the front and back as well.
TEST(Anatomy, FourLegsAndATrunkOnOneJointByForm) {
  const Skeleton animal = limber::testing::quadrupedOnOneJoint();
  for (const bool names : {true, false}) {
    const Anatomy anatomy = readAnatomy(animal, {names, {}});
    expectStraight(anatomy);
    EXPECT_EQ(anatomy.pairsOf(PartKind::kLeg), 2u);
    for (const Side side : kSides) {
      for (const Index pair : {0u, 1u}) {
        const Part* leg = anatomy.find(PartKind::kLeg, side, pair);
        ASSERT_TRUE(leg);
        const std::string stem = std::string(pair == 0 ? "b1" : "b0") + (side == Side::kLeft ? "Left" : "Right");
        EXPECT_EQ(animal.joints[leg->upper.value()].name, stem + "One");
      }
    }
  }
}

// Names of joints are not looked at.
TEST(Anatomy, PeopleOnLooseFeetAreToldByForm) {
  const Skeleton whole = personWith(NameHabit::kVrm).skeleton;
  for (const char* loose : {"Foot", "UpperLeg"}) {
    const Skeleton person =
        limber::testing::onTheGround(whole, {std::string("left") + loose, std::string("right") + loose});
    const Anatomy anatomy = readAnatomy(nameless(person));
    for (const Side side : kSides) {
      const Part* leg = anatomy.find(PartKind::kLeg, side);
      ASSERT_TRUE(leg) << loose;
      const std::string name(nameOf(side));
      EXPECT_EQ(leg->upper, person.find(name + "UpperLeg")) << loose;
      EXPECT_EQ(leg->middle, person.find(name + "LowerLeg")) << loose;
      EXPECT_EQ(leg->end, person.find(name + "Foot")) << loose;
    }
  }
}

TEST(Anatomy, FixedLabelsStand) {
  const MadeBody person = personWith(NameHabit::kVrm);
  const auto joint = [&](const char* name) { return person.skeleton.find(name).value(); };
  const std::vector<FixedLabel> fixed = {{joint("leftShoulder"), PartKind::kWing}, {joint("head"), PartKind::kProp}};
  const Anatomy anatomy = readAnatomy(person.skeleton, {true, fixed});
  expectInOrder(anatomy, person.skeleton);
  for (const FixedLabel& label : fixed) {
    ASSERT_TRUE(anatomy.partOf[label.joint]);
    const Part& part = anatomy.parts[*anatomy.partOf[label.joint]];
    EXPECT_EQ(part.kind, label.kind);
    EXPECT_EQ(part.evidence, Evidence::kUser);
  }
  const Index rightShoulder = joint("rightShoulder");
  EXPECT_EQ(anatomy.parts[anatomy.partOf[rightShoulder].value()].kind, PartKind::kWing) << "and so its partner";
  const Part* leg = anatomy.find(PartKind::kLeg, Side::kLeft);
  ASSERT_TRUE(leg);
  EXPECT_EQ(leg->upper, joint("leftUpperLeg")) << "all else is read around it";
}

TEST(Anatomy, LabelsOfJointsThatAreNotThereChangeNothing) {
  const Skeleton person = personWith(NameHabit::kVrm).skeleton;
  const std::vector<FixedLabel> fixed = {{9999, PartKind::kTail}};
  const Anatomy one = readAnatomy(person), other = readAnatomy(person, {true, fixed});
  EXPECT_EQ(one.parts.size(), other.parts.size());
}

TEST(Anatomy, DeclaredBonesAreCertainAndTellTheFront) {
  const Skeleton facingBack = turnedAsAWhole(limber::testing::declaredPerson(), Quat(0, 0, 1, 0));
  const Anatomy anatomy = readAnatomy(facingBack);
  EXPECT_LT((anatomy.axes.front + Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_GT(anatomy.confidence, 0.99);
  for (Index j = 0; j < facingBack.jointCount(); ++j) {
    const std::string_view bone = facingBack.joints[j].declaredBone;
    if (bone.starts_with("left") || bone.starts_with("right")) {
      EXPECT_EQ(nameOf(bodyPartAt(anatomy, j).value()), bone);
    }
    EXPECT_GT(anatomy.parts[anatomy.partOf[j].value()].confidence, 0.99) << bone;
  }
}

TEST(Anatomy, ALabelOfTheUsersIsAboveADeclaredBone) {
  const Skeleton person = limber::testing::declaredPerson();
  const auto jointOf = [&](std::string_view bone) {
    const auto found = std::find_if(person.joints.begin(), person.joints.end(),
                                    [&](const Joint& joint) { return joint.declaredBone == bone; });
    return static_cast<Index>(found - person.joints.begin());
  };
  const FixedLabel label{jointOf("rightToes"), PartKind::kProp};
  const Anatomy anatomy = readAnatomy(person, {.fixed = {&label, 1}});
  for (const char* toes : {"leftToes", "rightToes"}) {
    EXPECT_EQ(anatomy.parts[anatomy.partOf[jointOf(toes)].value()].kind, PartKind::kProp) << toes;
  }
}

TEST(Anatomy, BonesThatNoBodyCanHaveArePassedOver) {
  Skeleton person = personWith(NameHabit::kMixamo).skeleton;
  const Anatomy plain = readAnatomy(person);
  person.joints[person.find("mixamorig:Head").value()].declaredBone = "leftToes";
  person.joints[person.find("mixamorig:HeadTop_End").value()].declaredBone = "hips";
  const Anatomy anatomy = readAnatomy(person);
  ASSERT_EQ(anatomy.parts.size(), plain.parts.size());
  for (std::size_t p = 0; p < plain.parts.size(); ++p) {
    EXPECT_EQ(anatomy.parts[p].kind, plain.parts[p].kind);
    EXPECT_EQ(anatomy.parts[p].joints, plain.parts[p].joints);
  }
}

TEST(Anatomy, PlacesThatAreNoNumbersAreRefusedByName) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    Skeleton person = personWith(NameHabit::kVrm).skeleton;
    person.joints[person.find("rightToes").value()].rest.translation.y() = bad;
    try {
      readAnatomy(person);
      ADD_FAILURE() << "read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadData);
      EXPECT_THAT(error.what(), ::testing::HasSubstr("rightToes"));
    }
  }
}

TEST(Anatomy, NothingIsNothing) {
  const Anatomy anatomy = readAnatomy(Skeleton());
  EXPECT_TRUE(anatomy.parts.empty());
  EXPECT_TRUE(anatomy.partOf.empty());
}

// With names that pair them, and without.
TEST(Anatomy, JointsInOnePlaceGetAnAnswer) {
  Skeleton person = personWith(NameHabit::kMixamo).skeleton;
  for (Joint& joint : person.joints) joint.rest.translation = Vec3::Zero();
  for (const Skeleton& skeleton : {person, nameless(person)}) {
    const Anatomy anatomy = readAnatomy(skeleton);
    expectInOrder(anatomy, skeleton);
    EXPECT_TRUE(std::isfinite(anatomy.ground));
    EXPECT_TRUE(std::isfinite(anatomy.size));
  }
}

Skeleton manyJoints(int count, const auto& parentOf, const auto& offsetOf) {
  Skeleton skeleton;
  for (int i = 0; i < count; ++i) {
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = "j" + std::to_string(i);
    if (i > 0) joint.parent = static_cast<Index>(parentOf(i));
    joint.rest.translation = offsetOf(i);
  }
  return skeleton;
}

// Joints in the plane of symmetry are nobody's, whatever one side has that the other lacks.
TEST(Anatomy, ABodyThatIsNotAlikeOnBothSidesHasOneNeckAndOneHead) {
  for (const bool named : {true, false}) {
    MadeBody body = limber::testing::personWith(limber::testing::NameHabit::kMixamo);
    for (int finger = 0; finger < 5; ++finger) {
      limber::testing::addChain(body, "mixamorig:RightHandFinger" + std::to_string(finger), 3, "mixamorig:RightHand",
                                {-0.76, 1.4, 0.05 - 0.025 * finger}, {-0.03, 0, 0},
                                {PartKind::kFinger, Side::kRight, static_cast<Index>(finger), Segment::kWhole, 0});
    }
    const Skeleton skeleton = named ? body.skeleton : nameless(body.skeleton);
    const Anatomy anatomy = readAnatomy(skeleton);
    for (const PartKind kind : {PartKind::kTrunk, PartKind::kNeck, PartKind::kHead}) {
      ASSERT_TRUE(anatomy.find(kind)) << nameOf(kind);
      EXPECT_FALSE(anatomy.find(kind, Side::kRight)) << nameOf(kind);
      EXPECT_FALSE(anatomy.find(kind, Side::kLeft)) << nameOf(kind);
    }
    for (const Side side : kSides) EXPECT_TRUE(anatomy.find(PartKind::kArm, side));
  }
}

// Without any name: what hangs beside the legs is no further pair of these, and breasts are no arms.
TEST(Anatomy, SkirtsStrapsAndBreastsAreNoLimbs) {
  for (const int kind : {0, 1, 2}) {
    MadeBody body = limber::testing::personWith(limber::testing::NameHabit::kVrm);
    const BodyPart other{PartKind::kOther, Side::kCenter, 0, Segment::kWhole, 0};
    for (const double x : {1.0, -1.0}) {
      const std::string side = x > 0 ? "_L_" : "_R_";
      if (kind == 0) {
        limber::testing::addChain(body, "ring" + side, 3, "hips", {0.1 * x, 0.93, 0.09}, {0, -0.13, 0}, other);
        limber::testing::addChain(body, "back" + side, 3, "hips", {0.1 * x, 0.93, -0.09}, {0, -0.13, 0}, other);
      } else if (kind == 1) {
        limber::testing::addChain(body, "strap" + side, 3, "hips", {0.13 * x, 0.93, 0.02}, {0, -0.15, 0}, other);
      } else {
        limber::testing::addChain(body, "b" + side, 2, "upperChest", {0.08 * x, 1.28, 0.1}, {0, 0.01, 0.04}, other);
      }
    }
    const Anatomy anatomy = readAnatomy(nameless(body.skeleton));
    EXPECT_EQ(anatomy.pairsOf(PartKind::kLeg), 1u) << kind;
    EXPECT_EQ(anatomy.pairsOf(PartKind::kArm), 1u) << kind;
    for (const Side side : kSides) {
      const Part* leg = anatomy.find(PartKind::kLeg, side);
      ASSERT_TRUE(leg && leg->end) << kind;
      EXPECT_EQ(body.parts[*leg->end], body_part::leg(side, Segment::kEnd)) << kind;
    }
  }
}

// A person may lie askew to all axes.
TEST(Anatomy, ABodyAskewToAllAxesIsRead) {
  const MadeBody body = limber::testing::personWith(limber::testing::NameHabit::kMixamo);
  const Quat askew = Quat::FromTwoVectors(Vec3::UnitX(), Vec3(1, 1, 1));
  for (const bool named : {true, false}) {
    const Skeleton skeleton = limber::testing::turnedAsAWhole(named ? body.skeleton : nameless(body.skeleton), askew);
    const Anatomy anatomy = readAnatomy(skeleton);
    expectInOrder(anatomy, skeleton);
    EXPECT_FALSE(anatomy.parts.empty());
  }
}

// Neither depth nor breadth stops the reading.
TEST(Anatomy, ThousandsOfJointsAreRead) {
  constexpr int kMany = 8000;
  const auto aside = [](int i) { return Vec3(std::sin(1.7 * i), std::cos(2.3 * i), std::sin(0.9 * i)); };
  const auto onwards = [](int i) { return Vec3(0.001 * (i % 3), 0, 0.01); };
  const auto nowhere = [](int) { return Vec3(Vec3::Zero()); };
  const auto before = [](int i) { return i - 1; };
  const Skeleton row = manyJoints(kMany, before, onwards);
  const Skeleton star = manyJoints(
      kMany, [](int) { return 0; }, aside);
  const Skeleton point = manyJoints(kMany, before, nowhere);
  const Skeleton tree = manyJoints(
      kMany, [](int i) { return (i - 1) / 2; }, aside);
  for (const Skeleton& skeleton : {row, star, point, tree}) expectInOrder(readAnatomy(skeleton), skeleton);
}

}  // namespace
}  // namespace limber
