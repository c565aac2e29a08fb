#include "limber/evaluate/motion/known_answers.h"

#include <gtest/gtest.h>

#include "limber/character/matching/testing/test_motion.h"

namespace limber {
namespace {

using namespace testing;

class KnownAnswers : public ::testing::TestWithParam<const char*> {};

// A tenth of a millimetre of a person. Limbs that rest otherwise are not asserted: what a straight one's twist is at
// rest nobody sees, and the judge's table tells how far off it leaves the motion.
TEST_P(KnownAnswers, AreGivenByEveryMethod) {
  const Skeleton person = practiceHumanoid();
  const PoseSequence motion = walk(person, 60);
  std::vector<std::string_view> changes;
  for (const KnownAnswer& answer : knownAnswers(person)) {
    changes.push_back(answer.change);
    if (answer.change == "reposed") continue;
    EXPECT_LT(errorOfAnswer(findRetargetMethod(GetParam()), person, motion, answer), 1e-4 / 1.7) << answer.change;
  }
  EXPECT_EQ(changes, (std::vector<std::string_view>{"own", "renamed", "scaled", "reposed", "mirrored"}));
}

// A recording whose ground is not the rest pose's, and joints that move against what carries them.
TEST_P(KnownAnswers, AreGivenOfWhatMovesByItself) {
  const Skeleton person = practiceHumanoid();
  PoseSequence motion = walk(person, 60);
  const Index hand = person.find("leftHand").value();
  for (std::size_t f = 0; f < motion.poses.size(); ++f) {
    motion.poses[f].locals[0].translation.y() += 0.15;
    motion.poses[f].locals[hand].translation *= 1 + 0.01 * static_cast<double>(f % 10);
  }
  for (const bool isStanding : {false, true}) {
    RetargetOptions options;
    options.characterOnGround = isStanding;
    for (const KnownAnswer& answer : knownAnswers(person)) {
      if (answer.change == "reposed") continue;
      EXPECT_LT(errorOfAnswer(findRetargetMethod(GetParam()), person, motion, answer, options), 1e-4 / 1.7)
          << answer.change;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, KnownAnswers, ::testing::Values("limb-ik", "spacetime", "aligned"),
                         [](const ::testing::TestParamInfo<const char*>& method) {
                           std::string name = method.param;
                           std::erase(name, '-');
                           return name;
                         });

// About the axis that it faces along itself, as in a file whose axes are others.
TEST(ReposedAnswer, TurnsLimbsInTheBodysOwnFrame) {
  const Skeleton person = practiceHumanoid();
  Skeleton turned = person;
  const Quat turns = turn(Vec3(1, 1, 1), 120);  // up along +Z, facing +X
  for (Joint& joint : turned.joints) {
    if (joint.parent) continue;
    joint.rest.rotation = turns * joint.rest.rotation;
    joint.rest.translation = turns * joint.rest.translation;
  }
  const auto reposed = [](const Skeleton& body) {
    for (const KnownAnswer& answer : knownAnswers(body)) {
      if (answer.change == "reposed") return restPositions(answer.body);
    }
    return std::vector<Vec3>();
  };
  const std::vector<Vec3> upright = reposed(person), lying = reposed(turned);
  ASSERT_EQ(lying.size(), upright.size());
  for (std::size_t j = 0; j < lying.size(); ++j) EXPECT_LT((lying[j] - turns * upright[j]).norm(), 1e-6) << j;
}

TEST(KnownAnswerError, IsThatOfTheWorstJoint) {
  const Skeleton person = practiceHumanoid();
  PoseSequence motion = walk(person, 10);
  KnownAnswer answer = {"longer", person};
  answer.body.joints[person.find("leftHand").value()].rest.translation *= 1.1;
  const double longer = 0.1 * person.joints[person.find("leftHand").value()].rest.translation.norm();
  const double error = errorOfAnswer(findRetargetMethod("copy"), person, motion, answer);
  EXPECT_GT(error, 0.9 * longer / 1.8);
  EXPECT_LT(error, 1.5 * longer / 1.4);
}

}  // namespace
}  // namespace limber
