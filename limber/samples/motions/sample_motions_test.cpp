#include "limber/samples/motions/sample_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "limber/core/error.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/samples/motions/motion_recipes.h"

namespace limber {
namespace {

constexpr double kFrame = 1.0 / 60;

class SampleMotions : public ::testing::TestWithParam<SampleMotion> {
 protected:
  static int frames() { return static_cast<int>(std::lround(GetParam().seconds / kFrame)); }
  std::vector<Affine> globalsAt(double seconds) const { return poseGlobals(figure, GetParam().at(figure, seconds)); }
  Vec3 at(const std::vector<Affine>& globals, const std::string& joint) const {
    return globals[figure.find(joint).value()].translation();
  }
  bool isPerson() const { return figure.find("leftHand").has_value(); }
  std::vector<std::string> legs() const {
    if (isPerson()) return {"left", "right"};
    if (!figure.find("leftHindFoot")) return {};
    return {"leftFront", "rightFront", "leftHind", "rightHind"};
  }

  // Of the toes; of a person's foot its lower end.
  double aboveGround(const std::vector<Affine>& globals, const std::string& side) const {
    const double toes = at(globals, side + "Toes").y() - at(rest, side + "Toes").y();
    return isPerson() ? std::min(toes, (globals[figure.find(side + "Foot").value()] * kToHeel).y()) : toes;
  }
  bool isInTheAir(int frame) const {
    const std::vector<Affine> globals = globalsAt(frame * kFrame);
    return !legs().empty() &&
           std::ranges::all_of(legs(), [&](const std::string& side) { return aboveGround(globals, side) > 1e-6; });
  }
  bool flies() const {
    for (int f = 0; f < frames(); ++f) {
      if (isInTheAir(f)) return true;
    }
    return false;
  }

  const Skeleton figure = GetParam().skeleton();
  const std::vector<Affine> rest = restGlobals(figure);
};

TEST_P(SampleMotions, LegsAreNeverStraight) {
  for (int f = 0; f < frames(); ++f) {
    const std::vector<Affine> globals = globalsAt(f * kFrame);
    for (const std::string& side : legs()) {
      const Vec3 hip = at(globals, side + "UpperLeg"), knee = at(globals, side + "LowerLeg"),
                 ankle = at(globals, side + "Foot");
      const double straight = ((knee - hip).norm() + (ankle - knee).norm()) - (ankle - hip).norm();
      EXPECT_GT(straight, 1e-3 * (knee - hip).norm()) << side << f;
      Vec3 forward = globals[figure.find("hips").value()].linear().col(2);
      forward.y() = 0;
      const double bend = (knee - 0.5 * (hip + ankle)).dot(forward);
      EXPECT_GT(side.ends_with("Front") ? -bend : bend, 0) << "knees forward, elbows back " << side << f;
    }
  }
}

TEST_P(SampleMotions, FeetStandStillAndStayAboveTheGround) {
  if (legs().empty()) return;
  int standing = 0, still = 0;
  for (int f = 0; f < frames(); ++f) {
    const std::vector<Affine> now = globalsAt(f * kFrame), then = globalsAt((f + 1) * kFrame);
    for (const std::string& side : legs()) {
      const double ground = at(rest, side + "Toes").y();
      EXPECT_GT(at(now, side + "Toes").y(), ground - 1e-9) << f;
      if (isPerson()) {
        EXPECT_GT((now[figure.find(side + "Foot").value()] * kToHeel).y(), -1e-9) << side << f;
        EXPECT_GT(at(now, side + "Toes_end").y(), 0.02 - 1e-3) << f;
      }
      const bool isStanding = std::max(at(now, side + "Toes").y(), at(then, side + "Toes").y()) < ground + 1e-9;
      standing += isStanding;
      still += isStanding && (at(then, side + "Toes") - at(now, side + "Toes")).norm() < 1e-9;
    }
  }
  EXPECT_EQ(standing, still);
  EXPECT_GT(standing, (flies() ? 0.2 : 0.4) * frames() * static_cast<double>(legs().size()));
}

// Hands and feet in a run are accelerated by more than 10 g; a joint that pops by a centimetre, by 36 m/s^2 and more.
TEST_P(SampleMotions, IsSmooth) {
  const double most = flies() ? 150 : 60;  // m/s^2
  for (Index j = 0; j < figure.jointCount(); ++j) {
    for (int f = 0; f < frames(); ++f) {
      const auto positionOf = [&](int step) -> Vec3 { return globalsAt((f + step) * kFrame)[j].translation(); };
      const Vec3 bend = positionOf(2) - 2 * positionOf(1) + positionOf(0);
      EXPECT_LT(bend.norm() / (kFrame * kFrame), most) << figure.joints[j].name << ' ' << f;
    }
  }
}

TEST_P(SampleMotions, RepeatsAndSurvivesAFile) {
  const Motion made = makeSampleMotion(GetParam().name);
  checkMotion(made);
  Pose first = restPose(made.skeleton), last = first;
  sampleClip(made.clips[0], 0, first);
  sampleClip(made.clips[0], made.clips[0].duration(), last);
  const Vec3 displacement = last.locals[0].translation - first.locals[0].translation;
  EXPECT_LT(std::hypot(displacement.x(), displacement.y()), 1e-5);
  for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
    EXPECT_LT(first.locals[j].rotation.angularDistance(last.locals[j].rotation), 1e-4);
  }
  const Motion read = readBvh(writeBvh(made), "sample");
  EXPECT_GE(read.skeleton.jointCount(), made.skeleton.jointCount()) << "and ends of bones";
  Pose again = restPose(read.skeleton);
  sampleClip(read.clips[0], 0.5, again);
  sampleClip(made.clips[0], 0.5, first);
  const std::vector<Affine> one = poseGlobals(made.skeleton, first), other = poseGlobals(read.skeleton, again);
  for (Index j = 0; j < made.skeleton.jointCount(); ++j) {
    const Index same = read.skeleton.find(made.skeleton.joints[j].name).value();
    EXPECT_LT((one[j].translation() - other[same].translation()).norm(), 1e-4) << made.skeleton.joints[j].name;
  }
}

TEST_P(SampleMotions, LastsWholeFrames) {
  EXPECT_NEAR(GetParam().seconds / kFrame, frames(), 1e-9) << "or its repetitions drift apart";
}

TEST_P(SampleMotions, ElbowsOnlyBendForwardsAndNothingIsBelowTheFloor) {
  for (int f = 0; f < frames(); ++f) {
    const Pose pose = GetParam().at(figure, f * kFrame);
    for (const Affine& joint : poseGlobals(figure, pose)) EXPECT_GT(joint.translation().y(), 0) << f;
    if (!isPerson()) continue;
    for (const char* side : {"left", "right"}) {
      const double sign = side[0] == 'l' ? 1 : -1;
      const Quat& elbow = pose.locals[figure.find(std::string(side) + "LowerArm").value()].rotation;
      EXPECT_GT(-sign * elbow.y() * elbow.w(), 0) << side << f;
      EXPECT_LT(std::hypot(elbow.x(), elbow.z()), 1e-9) << "a hinge";
    }
  }
}

// A thigh twists a little further than the hips do, whatever direction the body faces.
TEST_P(SampleMotions, ThighsAreNotWrung) {
  if (!isPerson()) return;
  for (int f = 0; f < frames(); ++f) {
    const std::vector<Affine> globals = globalsAt(f * kFrame);
    const Vec3 across = globals[figure.find("hips").value()].linear().col(0);
    for (const char* side : {"left", "right"}) {
      const Vec3 thigh = globals[figure.find(std::string(side) + "UpperLeg").value()].linear().col(0);
      EXPECT_GT(thigh.dot(across), std::cos(0.9)) << side << f;
    }
  }
}

// Whoever has left the ground falls as everything does.
TEST_P(SampleMotions, FliesAsAThrownBodyDoes) {
  if (!isPerson()) return;  // an animal's hips also go up and down about the middle of its trunk
  const auto pelvis = [&](int f) {
    return (globalsAt(f * kFrame)[figure.find("hips").value()] * Vec3(0, -0.04, 0)).y();
  };
  for (int f = 0; f < frames(); ++f) {
    if (!isInTheAir(f - 1) || !isInTheAir(f) || !isInTheAir(f + 1)) continue;
    const double fall = (pelvis(f + 1) - 2 * pelvis(f) + pelvis(f - 1)) / (kFrame * kFrame);
    EXPECT_NEAR(fall, -9.81, 0.05) << f;
  }
}

INSTANTIATE_TEST_SUITE_P(All, SampleMotions, ::testing::ValuesIn(sampleMotions().begin(), sampleMotions().end()),
                         [](const auto& sample) {
                           std::string name(sample.param.name);
                           std::erase(name, '-');
                           return name;
                         });

// How far a joint of the body moves in a frame, along its bone and across it.
TEST(Slither, SlipsAlongItsBodyAlone) {
  const Skeleton serpent = serpentSkeleton();
  for (double seconds = 0; seconds < kSlitherPeriod; seconds += 0.05) {
    const std::vector<Affine> now = poseGlobals(serpent, slitherAt(serpent, seconds)),
                              then = poseGlobals(serpent, slitherAt(serpent, seconds + kFrame));
    for (const char* name : {"spine2", "tail", "tail2"}) {
      const Index joint = serpent.find(name).value();  // the next follows it
      const Vec3 displacement = then[joint].translation() - now[joint].translation();
      const Vec3 along = (now[joint - 1].translation() - now[joint + 1].translation()).normalized();
      EXPECT_GT(displacement.norm(), 0.003) << name;
      EXPECT_GT(displacement.dot(along), 0.97 * displacement.norm()) << name << ' ' << seconds;
    }
  }
}

// Tips on the ground stand where they are; those of no fewer than three legs are there at once, and each swings.
TEST(Scuttle, StandsOnEveryOtherLeg) {
  for (const Skeleton& skeleton : {insectSkeleton(), spiderSkeleton()}) {
    std::vector<Index> tips;
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      const std::string& name = skeleton.joints[j].name;
      if (name.find("Foot") != std::string::npos && name.ends_with("_end")) tips.push_back(j);
    }
    ASSERT_EQ(tips.size() % 2, 0u);
    std::vector<double> highest(tips.size(), 0);
    for (double seconds = 0; seconds < kScuttlePeriod; seconds += kFrame) {
      const std::vector<Affine> now = poseGlobals(skeleton, scuttleAt(skeleton, seconds)),
                                then = poseGlobals(skeleton, scuttleAt(skeleton, seconds + kFrame));
      std::size_t standing = 0;
      for (std::size_t t = 0; t < tips.size(); ++t) {
        const Vec3 a = now[tips[t]].translation(), b = then[tips[t]].translation();
        highest[t] = std::max(highest[t], a.y());
        EXPECT_GT(a.y(), 0.01 - 1e-6);
        if (std::max(a.y(), b.y()) > 0.01 + 1e-6) continue;
        ++standing;
        EXPECT_LT((b - a).norm(), 1e-6) << skeleton.joints[tips[t]].name << ' ' << seconds;
      }
      EXPECT_GE(standing, tips.size() / 2) << seconds;
    }
    for (const double height : highest) EXPECT_GT(height, 0.04);
  }
}

TEST(Swim, TheTailSwingsWidest) {
  const Skeleton fish = fishSkeleton();
  const auto swing = [&](const char* name) {
    double least = 1, most = -1;
    for (double seconds = 0; seconds < kSwimPeriod; seconds += 0.01) {
      const double x = poseGlobals(fish, swimAt(fish, seconds))[fish.find(name).value()].translation().x();
      least = std::min(least, x);
      most = std::max(most, x);
    }
    return most - least;
  };
  EXPECT_GT(swing("tail2"), 2 * swing("head"));
  EXPECT_GT(swing("tail2"), 0.04);
}

TEST(Flap, BothWingsBeatAlikeAndTheirTipsFollow) {
  const Skeleton bird = birdSkeleton();
  double root = 0, tip = 0, rootAt = 0, tipAt = 0;  // highest, and when
  for (double seconds = 0; seconds < kFlapPeriod; seconds += 0.01) {
    const std::vector<Affine> now = poseGlobals(bird, flapAt(bird, seconds));
    const auto at = [&](const char* name) -> Vec3 { return now[bird.find(name).value()].translation(); };
    EXPECT_LT((at("leftWingHand") - at("rightWingHand").cwiseProduct(Vec3(-1, 1, 1))).norm(), 1e-9);
    const double elbow = at("leftLowerWing").y() - at("chest").y(), end = at("leftWingHand_end").y() - at("chest").y();
    if (elbow > root) root = elbow, rootAt = seconds;
    if (end > tip) tip = end, tipAt = seconds;
  }
  EXPECT_GT(tip, 2 * root);
  EXPECT_GT(std::fmod(tipAt - rootAt + kFlapPeriod, kFlapPeriod), 0.02);
}

// Half a stride later the walk is its own mirror image.
TEST(Walk, IsSymmetric) {
  const Skeleton figure = figureSkeleton();
  for (double seconds = 0; seconds < 1.1; seconds += 0.07) {
    const std::vector<Affine> now = poseGlobals(figure, poseOf(figure, gaitAt(kWalkGait, seconds))),
                              later = poseGlobals(figure, poseOf(figure, gaitAt(kWalkGait, seconds + 0.55)));
    for (const char* joint : {"UpperArm", "Hand", "LowerLeg", "Foot", "Toes"}) {
      const Vec3 left = now[figure.find(std::string("left") + joint).value()].translation(),
                 right = later[figure.find(std::string("right") + joint).value()].translation();
      EXPECT_NEAR(left.x(), -right.x(), 1e-9);
      EXPECT_NEAR(left.y(), right.y(), 1e-9);
      EXPECT_NEAR(left.z() + 0.6, right.z(), 1e-9) << "half a stride ahead";
    }
  }
}

// The fraction of the cycle that each leg's toes are on the ground, and when they touch, as a fraction of the cycle.
struct Footfall {
  double fraction, touches;
};
std::vector<Footfall> footfalls(const SampleMotion& motion, const std::vector<std::string>& legs) {
  constexpr int kMoments = 400;
  const Skeleton skeleton = motion.skeleton();
  const std::vector<Affine> rest = restGlobals(skeleton);
  std::vector<Footfall> falls(legs.size());
  for (std::size_t leg = 0; leg < legs.size(); ++leg) {
    const Index toes = skeleton.find(legs[leg] + "Toes").value();
    const auto isStanding = [&](int moment) {
      const std::vector<Affine> now = poseGlobals(skeleton, motion.at(skeleton, motion.seconds * moment / kMoments));
      return now[toes].translation().y() < rest[toes].translation().y() + 1e-7;
    };
    for (int m = 0; m < kMoments; ++m) {
      if (!isStanding(m)) continue;
      falls[leg].fraction += 1.0 / kMoments;
      if (!isStanding(m - 1)) falls[leg].touches = static_cast<double>(m) / kMoments;
    }
  }
  return falls;
}
const SampleMotion& sampleNamed(std::string_view name) {
  return *std::ranges::find(sampleMotions(), name, &SampleMotion::name);
}

TEST(Gaits, FeetFallInTheOrderOfTheirKind) {
  const std::vector<std::string> legs = {"leftHind", "leftFront", "rightHind", "rightFront"};
  const auto walk = footfalls(sampleNamed("quadruped-walk"), legs), trot = footfalls(sampleNamed("trot"), legs),
             gallop = footfalls(sampleNamed("gallop"), legs);
  for (std::size_t leg = 0; leg < 4; ++leg) {
    EXPECT_NEAR(walk[leg].touches, 0.25 * static_cast<double>(leg), 0.01);
    EXPECT_GT(walk[leg].fraction, 0.5) << "always on two legs and more";
    EXPECT_LT(trot[leg].fraction, 0.5);
    EXPECT_LT(gallop[leg].fraction, 0.3);
  }
  EXPECT_NEAR(trot[0].touches, trot[3].touches, 1e-9) << "diagonal pairs";
  EXPECT_NEAR(trot[1].touches, trot[2].touches, 1e-9);
  EXPECT_LT(gallop[0].touches, gallop[2].touches) << "hind legs, then front legs";
  EXPECT_LT(gallop[2].touches, gallop[1].touches);
  EXPECT_LT(gallop[1].touches, gallop[3].touches);
  EXPECT_LT(gallop[3].touches + gallop[3].fraction, 0.9) << "then no leg";
}

TEST(Gaits, ARunHasNoMomentOnBothFeet) {
  const auto run = footfalls(sampleNamed("run"), {"left", "right"});
  for (const Footfall& foot : run) EXPECT_NEAR(foot.fraction, 0.33, 0.05);
  EXPECT_NEAR(run[1].touches - run[0].touches, 0.5, 0.01);
}

TEST(KeyedMotions, PassTheirKeysAndRestBetweenEqualOnes) {
  Stance low;
  low.pelvis.y() = 0.5;
  Stance high = low;
  high.pelvis.y() = 0.9;
  const std::vector<KeyPose> keys = {{0, low}, {1, high}, {2, high}};
  for (const KeyPose& key : keys) {
    EXPECT_NEAR(keyedStance(keys, 3, key.seconds).pelvis.y(), key.stance.pelvis.y(), 1e-12);
  }
  for (double seconds = 1; seconds < 2; seconds += 0.1) {
    EXPECT_EQ(keyedStance(keys, 3, seconds).pelvis.y(), 0.9);
  }
  EXPECT_NEAR(keyedStance(keys, 3, 2.7).pelvis.y(), keyedStance(keys, 3, -0.3).pelvis.y(), 1e-12);
}

TEST(KeyedMotions, FlightsAreParabolas) {
  Stance stance;
  stance.pelvis.y() = 1;
  const std::vector<KeyPose> keys = {{0, stance}, {1, stance, true}, {1.1, Stance(), true}, {1.4, stance}};
  for (double fraction : {0.0, 0.25, 0.5, 1.0}) {
    const double t = 0.4 * fraction;
    EXPECT_NEAR(keyedStance(keys, 3, 1 + t).pelvis.y(), 1 + 0.5 * 9.81 * t * (0.4 - t), 1e-9) << fraction;
  }
}

TEST(SampleMotion, UnknownNamesAreRefused) {
  EXPECT_THROW(makeSampleMotion("flight"), Error);
}

}  // namespace
}  // namespace limber
