#include "limber/motion/limbs/contacts/foot_lock.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "limber/motion/limbs/contacts/plant_detector.h"

namespace limber {
namespace {

constexpr double kStep = 1.0 / 60;

// A foot that swings forward, slows down, drifts while planted, and leaves again.
FootLock::Frame frameAt(int i) {
  FootLock::Frame frame;
  const double x = i < 30 ? 0.02 * i : i < 90 ? 0.6 + 0.001 * (i - 30) : 0.66 + 0.02 * (i - 90);
  frame.ankle = Vec3(0.1, 0.08, x);
  frame.toes = frame.ankle + Vec3(0, -0.06, 0.12);
  frame.anchor = i >= 30 && i < 90 ? FootAnchor::kToes : FootAnchor::kNone;
  frame.ankleGround = 0.08;
  frame.toesGround = 0.02;
  return frame;
}

TEST(FootLock, HoldsWhatDriftsAndNeverJumps) {
  FootLock lock;
  Vec3 before = frameAt(0).ankle;
  for (int i = 0; i < 130; ++i) {
    const FootLock::Frame frame = frameAt(i);
    const Vec3 out = lock.next(frame, i == 0 ? 0 : kStep, 0.3);
    EXPECT_LT((out - before).norm(), 0.03) << i;
    if (i > 55 && i < 90) {
      EXPECT_LT((out - before).norm(), 1e-4) << i;
    }
    if (i < 30) {
      EXPECT_LT((out - frame.ankle).norm(), 1e-12);
    }
    before = out;
  }
  EXPECT_LT((before - frameAt(129).ankle).norm(), 0.01) << "free again";
}

TEST(FootLock, ALockLeftFarBehindIsGivenUp) {
  FootLock lock;
  for (int i = 0; i < 200; ++i) {
    FootLock::Frame frame;
    frame.ankle = Vec3(0, 0, 0.01 * i);
    frame.toes = frame.ankle;
    frame.anchor = FootAnchor::kAnkle;
    const Vec3 out = lock.next(frame, i == 0 ? 0 : kStep, 0.2);
    EXPECT_LT((out - frame.ankle).norm(), 0.25) << i;
  }
}

TEST(FootLock, AFootThatStopsAtOnceStopsAtOnceWhenHeld) {
  FootLock lock;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 40; ++i) {
    FootLock::Frame frame;
    frame.ankle = frame.toes = Vec3(0, 0, 0.03 * std::min(i, 20));
    frame.anchor = i >= 20 ? FootAnchor::kAnkle : FootAnchor::kNone;
    const Vec3 out = lock.next(frame, i == 0 ? 0 : kStep, 0.3);
    if (i > 20) {
      EXPECT_LT((out - before).norm(), 0.0002) << i;
    }
    before = out;
  }
}

TEST(FootLock, AHeldFootSlipsAsFarAsItMay) {
  const auto directionOf = [](double slip) {
    FootLock lock;
    Vec3 out = Vec3::Zero();
    for (int i = 0; i <= 10; ++i) {
      FootLock::Frame frame;
      frame.ankle = frame.toes = Vec3(0, 0, 0.005 * i);
      frame.anchor = FootAnchor::kAnkle;
      frame.slip = slip;
      out = lock.next(frame, i == 0 ? 0 : kStep, 1);
    }
    return out.z();
  };
  EXPECT_NEAR(directionOf(0), 0, 1e-9);
  EXPECT_GT(directionOf(0.3), 0.3 * 0.05);
  EXPECT_GT(directionOf(0.6), directionOf(0.3) + 0.005);
  EXPECT_NEAR(directionOf(1), 0.05, 1e-9) << "as if free";
}

// Recordings tremble, so that a planted foot is taken for a free one now and then.
TEST(FootLock, ATremblingFootStaysWhereItIsPlanted) {
  FootLock lock;
  double farthest = 0;
  for (int i = 0; i < 200; ++i) {
    FootLock::Frame frame;
    frame.ankle = frame.toes = Vec3(0.01 * std::sin(2.1 * i), 0, 0.01 * std::cos(1.7 * i));
    frame.anchor = i % 10 == 9 ? FootAnchor::kNone : FootAnchor::kAnkle;
    farthest = std::max(farthest, (lock.next(frame, i == 0 ? 0 : 1.0 / 120, 0.3) - Vec3(0, 0, 0.01)).norm());
  }
  EXPECT_LT(farthest, 0.007) << "half of its way";
}

TEST(FootLock, AFlatFootDoesNotTwistAndOneThatTurnsIsLetGo) {
  FootLock lock;
  Vec3 toes = Vec3::Zero();
  for (int i = 0; i < 240; ++i) {
    const double wobble = 0.1 * std::sin(0.9 * i), heading = i < 120 ? wobble : 0.02 * (i - 120);
    FootLock::Frame frame;
    frame.toes = 0.15 * Vec3(std::sin(heading), 0, std::cos(heading));
    frame.anchor = FootAnchor::kToes;
    frame.flat = true;
    const Vec3 ankle = lock.next(frame, i == 0 ? 0 : kStep, 0.3);
    EXPECT_LT(std::abs(lock.twist()), 0.45) << i;
    const Vec3 roll = Eigen::AngleAxisd(lock.twist(), Vec3::UnitY()) * frame.toes;
    if (i > 0) {
      EXPECT_LT((ankle + roll - toes).norm(), 1e-9) << i;
    }
    toes = ankle + roll;
    if (i < 120) {
      EXPECT_LT(ankle.norm(), 1e-9) << i;
    }
  }
}

TEST(PlantDetector, AFootThatSlowsDownIsPlantedWhenItStands) {
  constexpr double kFrame = 1.0 / 120;
  PlantDetector detector(0.9);
  double x = 0;
  for (int i = 0; i < 30; ++i) {
    x += 2 * kFrame;
    EXPECT_EQ(detector.next(Vec3(0, 0, x), 0, i == 0 ? 0 : kFrame), i == 0) << i;
  }
  bool planted = false;
  for (int i = 1; i <= 6; ++i) {
    x += (2 - i / 3.0) * kFrame;
    planted = detector.next(Vec3(0, 0, x), 0, kFrame);
  }
  EXPECT_TRUE(planted) << "it stands now";

  PlantDetector dragged(0.9);
  for (int i = 0; i < 60; ++i)
    planted = dragged.next(Vec3(0, 0, 0.4 * i * kFrame), i == 0 ? 0.1 : 0, i == 0 ? 0 : kFrame);
  EXPECT_FALSE(planted) << "slow, but no slower than before";
}

TEST(PlantDetector, AFootThatRisesIsFreeThoughOneThatCreepsAsFastIsNot) {
  const auto plantedAfter = [](const Vec3& velocity) {
    PlantDetector detector(1);
    bool planted = detector.next(Vec3::Zero(), 0, 0);
    for (int i = 1; i <= 6; ++i) {
      const Vec3 displacement = i * kStep * velocity;
      planted = detector.next(displacement, displacement.y(), kStep);
    }
    return planted;
  };
  EXPECT_FALSE(plantedAfter(Vec3(0, 0.5, 0)));
  EXPECT_TRUE(plantedAfter(Vec3(0, 0, 0.5)));
}

TEST(PlantDetector, StandingIsSlowAndLow) {
  PlantDetector detector(0.9);
  EXPECT_TRUE(detector.next(Vec3(0, 0, 0), 0, 0));
  for (int i = 1; i < 20; ++i) EXPECT_TRUE(detector.next(Vec3(0, 0, 0.001 * i), 0, kStep));
  bool planted = true;
  for (int i = 1; i < 20; ++i) planted = detector.next(Vec3(0, 0.01 * i, 0.02 + 0.03 * i), 0.01 * i, kStep);
  EXPECT_FALSE(planted) << "fast";
  for (int i = 1; i < 20; ++i) planted = detector.next(Vec3(0, 0.3, 0.6), 0.3, kStep);
  EXPECT_FALSE(planted) << "slow, but high";
}

}  // namespace
}  // namespace limber
