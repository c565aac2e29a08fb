#include "limber/motion/limbs/body/pelvis.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "limber/character/matching/testing/test_motion.h"
#include "limber/motion/limbs/limb_goals.h"

namespace limber {
namespace {

using limber::testing::turn;

// The practice humanoid with hips that are so much wider.
Skeleton wideHips(double times) {
  Skeleton person = practiceHumanoid();
  for (const char* leg : {"leftUpperLeg", "rightUpperLeg"}) {
    person.joints[person.find(leg).value()].rest.translation.x() *= times;
  }
  return person;
}

// Each leg on a joint of its own, as CMU's skeletons have them.
Skeleton withHipJoints(const Skeleton& person) {
  Skeleton jointed;
  std::vector<Index> indices;
  for (Joint joint : person.joints) {
    if (joint.parent) joint.parent = indices[*joint.parent];
    if (joint.name == "leftUpperLeg" || joint.name == "rightUpperLeg") {
      Joint& between = jointed.joints.emplace_back();
      between.name = joint.name.substr(0, joint.name.find('U')) + "HipJoint";
      between.parent = joint.parent;
      joint.parent = jointed.jointCount() - 1;
    }
    indices.push_back(jointed.jointCount());
    jointed.joints.push_back(joint);
  }
  return jointed;
}

class PelvisOf {
 public:
  explicit PelvisOf(const Skeleton& target, const Skeleton& source = practiceHumanoid())
      : person_(source),
        target_(target),
        setup_(person_, target_, matchSkeletons(person_, target_), {}),
        root_(setup_),
        pelvis_(setup_, root_),
        pose_(restPose(target_)) {}

  // Brings the target to it, hips leveled.
  void level() {
    setup_.targetKinematics.globals(pose_, frame_);
    pelvis_.levelHips(pose_, frame_);
  }
  void turnJoint(const char* name, const Quat& rotation) {
    pose_.locals[target_.find(name).value()].rotation = rotation;
  }
  Vec3 at(const char* name) const { return frame_.positions[target_.find(name).value()]; }
  Vec3 line() const { return (at("leftUpperLeg") - at("rightUpperLeg")).normalized(); }
  double leanDegrees() const { return std::asin(line().y()) * 180 / kPi; }

  const Skeleton person_, target_;
  RetargetSetup setup_;
  RootPositioner root_;
  Pelvis pelvis_;
  Pose pose_;
  BodyFrame frame_;
};

TEST(Pelvis, HipsAsWideAsTheSourcesTurnAsTheyDo) {
  PelvisOf same(practiceHumanoid());
  same.turnJoint("hips", turn(Vec3(0.2, 0.5, 1), 20));
  const Pose before = same.pose_;
  same.level();
  for (Index j = 0; j < same.target_.jointCount(); ++j) {
    EXPECT_EQ(same.pose_.locals[j].rotation.coeffs(), before.locals[j].rotation.coeffs());
  }
}

TEST(Pelvis, WideHipsLeanLess) {
  PelvisOf wide(wideHips(4));
  const Quat lean = turn(Vec3::UnitZ(), 16);
  wide.turnJoint("hips", lean);
  wide.turnJoint("spine", lean.conjugate());
  wide.level();
  EXPECT_NEAR(wide.leanDegrees(), 16 / std::pow(4, 1.5), 0.3);
  const Index foot = wide.target_.find("leftFoot").value();
  EXPECT_LT(wide.frame_.rotations[foot].angularDistance(lean), 1e-6) << "what hangs on it is turned as it was";
}

TEST(Pelvis, WideHipsTurnLessAgainstTheTrunkButWithIt) {
  const Quat aside = turn(Vec3::UnitY(), 20);
  PelvisOf against(wideHips(4)), with(wideHips(4));
  against.turnJoint("hips", aside);
  against.turnJoint("spine", aside.conjugate());
  against.level();
  EXPECT_NEAR(std::atan2(-against.line().z(), against.line().x()) * 180 / kPi, 10 + 10 / std::pow(4, 1.5), 0.2);
  with.turnJoint("hips", aside);
  with.level();
  EXPECT_NEAR(std::atan2(-with.line().z(), with.line().x()) * 180 / kPi, 20, 1e-6);
}

TEST(Pelvis, WhoLiesOnOneSideGoesOnDoingSo) {
  PelvisOf wide(wideHips(4));
  wide.turnJoint("hips", turn(Vec3::UnitZ(), 90));
  wide.level();
  EXPECT_NEAR(wide.leanDegrees(), 90, 1e-3);
}

// Where the hips go is known before they do, also with joints between pelvis and legs.
TEST(Pelvis, HipsGoWhereTheMoveSays) {
  for (const Skeleton& target : {wideHips(2), withHipJoints(wideHips(2))}) {
    PelvisOf wide(target);
    wide.level();
    LimbGoals goals(wide.setup_, wide.root_);
    std::vector<Leg>& legs = goals.legs();
    ASSERT_EQ(legs.size(), 2u);
    for (Leg& leg : legs) {
      leg.state.contact.strength = 1;
      leg.goal.position =
          wide.frame_.positions[leg.spec.end] + Vec3(0, 0.03, leg.spec.upper == legs[0].spec.upper ? 0.1 : -0.05);
      leg.state.changed = wide.pelvis_.changeOf(leg, wide.frame_);
    }
    const Pelvis::Move move = wide.pelvis_.moveFor(legs, wide.frame_);
    EXPECT_GT(toRotationVector(move.turn).norm(), 0.05);
    EXPECT_GT(std::abs(move.up), 0.01);
    const BodyFrame before = wide.frame_;
    wide.pelvis_.apply(move, wide.pose_, wide.frame_);
    for (const Leg& leg : legs) {
      const Vec3 displacement = wide.frame_.positions[leg.spec.upper] - before.positions[leg.spec.upper];
      EXPECT_LT((displacement - wide.pelvis_.hipDisplacement(move, leg.spec, before)).norm(), 1e-9);
      EXPECT_LT(wide.frame_.rotations[leg.spec.upper].angularDistance(before.rotations[leg.spec.upper]), 1e-6);
    }
  }
}

TEST(Pelvis, ALegIsChangedAsFarAsItsGoalIsElsewhere) {
  PelvisOf person(practiceHumanoid());
  person.level();
  LimbGoals goals(person.setup_, person.root_);
  Leg& leg = goals.legs()[0];
  const auto changed = [&](const Vec3& displacement, const Quat& turned) {
    leg.goal.position = person.frame_.positions[leg.spec.end] +
                        person.pelvis_.hipDisplacement({turned, 0}, leg.spec, person.frame_) + displacement;
    return person.pelvis_.changeOf(leg, person.frame_, turned);
  };
  const Quat turned = turn(Vec3::UnitY(), 10);
  EXPECT_LT(changed(Vec3::Zero(), turned), 1e-9) << "it goes along with its hip";
  EXPECT_GT(changed(Vec3(0.01, 0, 0), turned), 0.5);
  EXPECT_GT(changed(Vec3(0.1, 0, 0), turned), 0.9);
}

// The foot of a folded leg is led away to the side, as far as the leg is long and further.
TEST(Pelvis, NothingJumpsWhereALegBecomesTooShort) {
  PelvisOf person(practiceHumanoid());
  person.turnJoint("leftUpperLeg", turn(-Vec3::UnitX(), 60));
  person.turnJoint("leftLowerLeg", turn(Vec3::UnitX(), 120));
  person.level();
  LimbGoals goals(person.setup_, person.root_);
  Leg &leg = goals.legs()[0], &other = goals.legs()[1];
  other.goal.position = person.frame_.positions[other.spec.end];
  leg.state.contact.strength = 1;
  const Vec3 hip = person.frame_.positions[leg.spec.upper];
  const double length = (person.frame_.positions[leg.spec.end] - hip).norm();
  double before = 0;
  for (int step = 0; step < 400; ++step) {
    leg.goal.position = hip + length * Vec3(0.003 * step, -0.5, 0);
    leg.state.changed = person.pelvis_.changeOf(leg, person.frame_);
    const double up = person.pelvis_.moveFor(goals.legs(), person.frame_).up;
    if (step > 0) {
      EXPECT_LT(std::abs(up - before), 0.01 * length) << step;
    }
    before = up;
  }
}

// A free leg of the person that points up, straight or bent: its foot is where its joint angles have it, which asks
// nothing of the pelvis.
TEST(Pelvis, FeetAboveTheHipsDoNotLiftTheBody) {
  struct Position {
    const char* name;
    Quat hips, thighs, knees;
  };
  const Vec3 aside = Vec3::UnitX(), ahead = Vec3::UnitZ();
  const Quat none = Quat::Identity();
  const std::array positions = {
      Position{"handstand", turn(ahead, 180), none, none},
      Position{"bent handstand", turn(ahead, 180), turn(-aside, 45), turn(aside, 110)},
      Position{"kick", none, turn(-aside, 178), none},
      Position{"lies, legs up", turn(-aside, 90), turn(-aside, 90), none},
      Position{"lies, legs to the chest", turn(-aside, 90), turn(-aside, 120), turn(aside, 110)}};
  for (const Position& position : positions) {
    PelvisOf person(practiceHumanoid());
    person.turnJoint("hips", position.hips);
    for (const char* side : {"left", "right"}) {
      person.turnJoint((side + std::string("UpperLeg")).c_str(), position.thighs);
      person.turnJoint((side + std::string("LowerLeg")).c_str(), position.knees);
    }
    person.level();
    LimbGoals goals(person.setup_, person.root_);
    for (Leg& leg : goals.legs()) {
      leg.goal.position = person.frame_.positions[leg.spec.end];
      EXPECT_GT(leg.goal.position.y(), person.frame_.positions[leg.spec.upper].y()) << position.name;
    }
    EXPECT_NEAR(person.pelvis_.moveFor(goals.legs(), person.frame_).up, 0, 1e-3) << position.name;
  }
}

// A folded leg swings up in front of the body until its foot is above its hip, and the goal is nearer to the hip than
// the leg folds. While the foot is below, the body rises so that the leg need not fold further.
TEST(Pelvis, NothingJumpsWhereAFootRisesPastItsHip) {
  PelvisOf person(practiceHumanoid());
  person.turnJoint("leftLowerLeg", turn(Vec3::UnitX(), 120));
  double before = 0, highest = 0;
  for (int step = 0; step <= 360; ++step) {
    person.turnJoint("leftUpperLeg", turn(-Vec3::UnitX(), 60 + 0.5 * step));
    person.level();
    LimbGoals goals(person.setup_, person.root_);
    Leg &leg = goals.legs()[0], &other = goals.legs()[1];
    other.goal.position = person.frame_.positions[other.spec.end];
    const Vec3 hip = person.frame_.positions[leg.spec.upper], foot = person.frame_.positions[leg.spec.end];
    leg.goal.position = hip + 0.4 * leg.spec.folded * (foot - hip).normalized();
    const double up = person.pelvis_.moveFor(goals.legs(), person.frame_).up;
    if (step > 0) {
      EXPECT_LT(std::abs(up - before), 0.03 * leg.spec.folded) << step;
    }
    highest = std::max(highest, up);
    before = up;
  }
  EXPECT_GT(highest, 0.05);
  EXPECT_NEAR(before, 0, 0.005) << "with the foot above";
}

// As of somebody who comes out of the ground: the ground holds a goal above a hip that is below it.
TEST(Pelvis, TheBodyRisesOverAGoalThatIsAboveItsHip) {
  PelvisOf person(practiceHumanoid());
  person.level();
  LimbGoals goals(person.setup_, person.root_);
  for (Leg& leg : goals.legs()) leg.goal.position = person.frame_.positions[leg.spec.upper] + Vec3(0, 0.2, 0.05);
  EXPECT_GT(person.pelvis_.moveFor(goals.legs(), person.frame_).up, 0.3);
}

// A foot-driven one is led away in front, on the ground, as of someone who falls: it pulls the body down, and
// lets go of it once the leg is nearly level.
TEST(Pelvis, AFootTooFarAheadLetsGoOfTheBody) {
  PelvisOf person(practiceHumanoid(), limber::testing::withHocks(practiceHumanoid()));
  person.level();
  LimbGoals goals(person.setup_, person.root_);
  Leg &leg = goals.legs()[0], &other = goals.legs()[1];
  other.goal.position = person.frame_.positions[other.spec.end];
  for (Leg& each : goals.legs()) {
    ASSERT_TRUE(each.spec.drive);
    each.state.changed = 1;
    each.state.bentReach = each.spec.length;
  }
  const Vec3 hip = person.frame_.positions[leg.spec.upper];
  double before = 0, lowest = 0;
  for (int step = 0; step < 400; ++step) {
    leg.goal.position = hip + leg.spec.length * Vec3(0, -0.7, 0.005 * step);
    const double up = person.pelvis_.moveFor(goals.legs(), person.frame_).up;
    if (step > 0) {
      EXPECT_LT(std::abs(up - before), 0.03 * leg.spec.length) << step;
    }
    lowest = std::min(lowest, up);
    before = up;
  }
  EXPECT_LT(lowest, -0.1 * leg.spec.length);
  EXPECT_GT(before, -0.05 * leg.spec.length);
}

// A quadruped that was matched by its form.
class PelvisOfFour : public ::testing::Test {
 protected:
  // Both in rest pose but for that turn.
  void pose(const Quat& turned) {
    Pose from = restPose(animal_);
    to_ = restPose(other_);
    from.locals[0].rotation = to_.locals[0].rotation = turned;
    setup_.sourceKinematics.globals(from, source_);
    setup_.targetKinematics.globals(to_, frame_);
    goals_.adaptPose(source_, 0, to_, frame_);
    goals_.setFeet(source_, frame_, 0);
    before_ = frame_;
  }
  double upAt(const Leg& leg) const {
    return (frame_.positions[leg.spec.upper] - before_.positions[leg.spec.upper]).y();
  }

  const Skeleton animal_ = limber::testing::quadruped(0.5), other_ = limber::testing::quadruped(0.4);
  const RetargetSetup setup_{animal_, other_, limber::testing::matchByForm(animal_, other_), {}};
  const RootPositioner root_{setup_};
  LimbGoals goals_{setup_, root_};
  Pose to_;
  BodyFrame source_, frame_, before_;
};

TEST_F(PelvisOfFour, HipsAndShouldersFollowTheirOwnLegs) {
  pose(Quat::Identity());
  for (Leg& leg : goals_.legs()) {
    EXPECT_EQ(leg.spec.fore, other_.joints[leg.spec.upper].name.starts_with("b1"));
    if (leg.spec.fore) leg.state.bentReach *= 0.8;
  }
  goals_.pelvis().apply(goals_.pelvisMove(frame_), to_, frame_);
  const double shoulders = upAt(goals_.legs().back()), hips = upAt(goals_.legs().front());
  EXPECT_LT(shoulders, -0.1);
  EXPECT_LT(std::abs(hips), 0.25 * std::abs(shoulders)) << "the trunk tilts a little less than legs ask for";
}

TEST_F(PelvisOfFour, FeetThatCannotReachPullTheBodyDownALittle) {
  pose(Quat::Identity());
  for (Leg& leg : goals_.legs()) {
    if (!leg.spec.fore) continue;
    leg.goal.position.y() -= 2;
    leg.state.bentReach = (leg.goal.position - frame_.positions[leg.spec.upper]).norm();  // its bend asks for nothing
  }
  goals_.pelvis().apply(goals_.pelvisMove(frame_), to_, frame_);
  EXPECT_LT(upAt(goals_.legs().back()), -0.1 * setup_.targetHipHeight);
  EXPECT_GT(upAt(goals_.legs().back()), -0.2 * setup_.targetHipHeight);
  EXPECT_NEAR(upAt(goals_.legs().front()), 0, 0.02) << "at the other end not at all";
}

TEST_F(PelvisOfFour, WhoLiesOnOneSideIsNotMovedByLegs) {
  pose(turn(Vec3::UnitZ(), 90));
  for (Leg& leg : goals_.legs()) {
    EXPECT_NEAR(leg.state.upright, 0, 1e-6);
    leg.state.bentReach *= 1.3;
    leg.goal.position += Vec3(0, 0.4, 0);
  }
  goals_.pelvis().apply(goals_.pelvisMove(frame_), to_, frame_);
  for (const Leg& leg : goals_.legs()) EXPECT_NEAR(upAt(leg), 0, 1e-6);
}

}  // namespace
}  // namespace limber
