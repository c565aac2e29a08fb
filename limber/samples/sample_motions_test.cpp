#include "limber/samples/sample_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "limber/asset/bvh_read.h"
#include "limber/asset/bvh_write.h"
#include "limber/core/error.h"
#include "limber/samples/motion_recipes.h"

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
    return {"leftFront", "rightFront", "leftHind", "rightHind"};
  }

  const Skeleton figure = GetParam().skeleton();
};

TEST_P(SampleMotions, LegsAreNeverStraight) {
  for (int f = 0; f < frames(); ++f) {
    const std::vector<Affine> globals = globalsAt(f * kFrame);
    for (const std::string& side : legs()) {
      const Vec3 hip = at(globals, side + "UpperLeg"), knee = at(globals, side + "LowerLeg"),
                 ankle = at(globals, side + "Foot");
      const double straight = ((knee - hip).norm() + (ankle - knee).norm()) - (ankle - hip).norm();
      EXPECT_GT(straight, 1e-3 * (knee - hip).norm()) << side << f;
      const double bend = (knee - 0.5 * (hip + ankle)).z();
      EXPECT_GT(side.ends_with("Front") ? -bend : bend, 0) << "knees forward, elbows back " << side << f;
    }
  }
}

TEST_P(SampleMotions, FeetStandStillAndStayAboveTheGround) {
  const std::vector<Affine> rest = restGlobals(figure);
  int standing = 0, still = 0;
  for (int f = 0; f < frames(); ++f) {
    const std::vector<Affine> now = globalsAt(f * kFrame), then = globalsAt((f + 1) * kFrame);
    for (const std::string& side : legs()) {
      const double ground = at(rest, side + "Toes").y();
      EXPECT_GT(at(now, side + "Toes").y(), ground - 1e-9) << f;
      if (isPerson()) {
        EXPECT_GT((now[figure.find(side + "Foot").value()] * kToHeel).y(), -1e-9) << f;
        EXPECT_GT(at(now, side + "Toes_end").y(), 0.02 - 1e-3) << f;
      }
      const bool stands = std::max(at(now, side + "Toes").y(), at(then, side + "Toes").y()) < ground + 1e-9;
      standing += stands;
      still += stands && (at(then, side + "Toes") - at(now, side + "Toes")).norm() < 1e-9;
    }
  }
  EXPECT_EQ(standing, still);
  EXPECT_GT(standing, 0.4 * frames() * static_cast<double>(legs().size()));
}

TEST_P(SampleMotions, IsSmooth) {
  for (Index j = 0; j < figure.jointCount(); ++j) {
    for (int f = 0; f < frames(); ++f) {
      const auto place = [&](int step) -> Vec3 { return globalsAt((f + step) * kFrame)[j].translation(); };
      const Vec3 bend = place(2) - 2 * place(1) + place(0);
      EXPECT_LT(bend.norm() / (kFrame * kFrame), 60) << figure.joints[j].name << ' ' << f;
    }
  }
}

TEST_P(SampleMotions, RepeatsAndSurvivesAFile) {
  const Motion made = makeSampleMotion(GetParam().name);
  checkMotion(made);
  Pose first = restPose(made.skeleton), last = first;
  sampleClip(made.clips[0], 0, first);
  sampleClip(made.clips[0], made.clips[0].duration(), last);
  const Vec3 way = last.locals[0].translation - first.locals[0].translation;
  EXPECT_LT(std::hypot(way.x(), way.y()), 1e-5);
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

INSTANTIATE_TEST_SUITE_P(All, SampleMotions, ::testing::ValuesIn(sampleMotions().begin(), sampleMotions().end()),
                         [](const auto& sample) {
                           std::string name(sample.param.name);
                           std::erase(name, '-');
                           return name;
                         });

// Half a stride later the walk is its own mirror image.
TEST(Walk, IsSymmetric) {
  const Skeleton figure = figureSkeleton();
  for (double seconds = 0; seconds < 1.1; seconds += 0.07) {
    const std::vector<Affine> now = poseGlobals(figure, poseOf(figure, walkAt(seconds))),
                              later = poseGlobals(figure, poseOf(figure, walkAt(seconds + 0.55)));
    for (const char* joint : {"UpperArm", "Hand", "LowerLeg", "Foot", "Toes"}) {
      const Vec3 left = now[figure.find(std::string("left") + joint).value()].translation(),
                 right = later[figure.find(std::string("right") + joint).value()].translation();
      EXPECT_NEAR(left.x(), -right.x(), 1e-9);
      EXPECT_NEAR(left.y(), right.y(), 1e-9);
      EXPECT_NEAR(left.z() + 0.6, right.z(), 1e-9) << "half a stride ahead";
    }
  }
}

TEST(SampleMotion, UnknownNamesAreRefused) {
  EXPECT_THROW(makeSampleMotion("flight"), Error);
}

}  // namespace
}  // namespace limber
