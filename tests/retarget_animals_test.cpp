// Animals' shared motions on animals, by the measures of evaluate motion.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/core/text/numbers.h"
#include "limber/document/clip/motion_io.h"
#include "retarget_measured.h"
#include "shared_data.h"

namespace limber::testing {

// Of animals, over the joints that go with one of the source's each: how far those but of legs and tails are off the
// turn that the source's make, degrees; and how deep the deepest but of tails, which may be longer, sinks below the
// lowest in rest pose, in sizes of the body.
struct AnimalMeasures {
  double turn = 0, depth = 0, sourceDepth = 0;
};

class AnimalSide {
 public:
  AnimalSide(const RetargetSetup& setup, MapSide side)
      : neutral(side == MapSide::kSource ? setup.sourceNeutral : setup.targetNeutral),
        kinematics(side == MapSide::kSource ? setup.sourceKinematics : setup.targetKinematics) {
    for (const JointMatch& match : setup.map.matches) {
      if (match.source.size() > 1 || match.target.size() > 1) continue;
      joints.push_back(side == MapSide::kSource ? match.source.front() : match.target.front());
    }
    for (const Vec3& position : neutral.restPositions) box_.add(position);
    ground_ = lowest(neutral.restPositions);
  }

  double depth() const { return (ground_ - lowest(frame.positions)) / box_.diagonal(); }

  const NeutralPose& neutral;
  const BodyKinematics& kinematics;
  std::vector<Index> joints;  // of the matches
  BodyFrame frame;

 private:
  double lowest(const std::vector<Vec3>& positions) const {
    double low = HUGE_VAL;
    for (const Index joint : joints) low = std::min(low, positions[joint].y());
    return low;
  }

  Box box_;
  double ground_ = 0;
};

AnimalMeasures measuredAnimal(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& result) {
  AnimalMeasures measures;
  AnimalSide from(setup, MapSide::kSource), to(setup, MapSide::kTarget);
  const std::vector<Index>& tail = setup.targetTail;
  for (std::size_t f = 0; f < result.poses.size(); ++f) {
    from.kinematics.globals(source.poses[f], from.frame);
    to.kinematics.globals(result.poses[f], to.frame);
    measures.sourceDepth = std::max(measures.sourceDepth, from.depth());
    measures.depth = std::max(measures.depth, to.depth());
    for (std::size_t i = 0; i < from.joints.size(); ++i) {
      const Index s = from.joints[i], t = to.joints[i];
      if (isOfLeg(setup, t) || std::find(tail.begin(), tail.end(), t) != tail.end()) continue;
      const Quat turned = from.frame.rotations[s] * from.neutral.rotations[s].conjugate();
      const Quat expected = turned * to.neutral.rotations[t];
      measures.turn = std::max(measures.turn, expected.angularDistance(to.frame.rotations[t]) * 180 / kPi);
    }
  }
  return measures;
}

// Every clip of some quadrupeds on their families. Bodies that come down to the ground or leave it have no feet that
// tell how deep they may be: longer or shorter legs then take other joints below it.
TEST(RetargetAnimals, QuadrupedsMoveTheirFamilies) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const std::vector<const char*> foxes = {"m2m_fox_fox.glb", "m2m_fox_cat.glb", "m2m_fox_dog.glb"};
  const std::vector<const char*> farm = {"quaternius_alpaca.glb", "quaternius_cow.glb", "quaternius_horse.glb",
                                         "quaternius_wolf.glb"};
  Spread depth;
  for (const char* file : {"motions/m2m_fox_animations.glb", "rigged/quaternius_alpaca.glb",
                           "rigged/quaternius_cow.glb", "rigged/quaternius_horse.glb", "rigged/quaternius_wolf.glb"}) {
    const Motion motion = readMotion(*sharedDataFolder() / file);
    EXPECT_GE(motion.clips.size(), 12u);
    for (const char* animal : std::string(file).starts_with("motions") ? foxes : farm) {
      const Skeleton target = readMotion(*sharedDataFolder() / "rigged" / animal).skeleton;
      const SkeletonMap map = matchSkeletons(motion.skeleton, target);
      EXPECT_GE(map.matches.size(), 25u);
      for (const Clip& clip : motion.clips) {
        SCOPED_TRACE(std::string(file) + ' ' + clip.name + ' ' + animal);
        const PoseSequence frames = sampleFrames(motion.skeleton, clip, 30);
        const RetargetSetup setup(motion.skeleton, target, map, {}, &frames);
        EXPECT_FALSE(setup.person);
        const AnimalMeasures measures =
            measuredAnimal(setup, frames, retargetFrames(findRetargetMethod("limb-ik"), setup, frames));
        EXPECT_LT(measures.turn, 0.01);
        depth.add(measures.depth - measures.sourceDepth, std::string(file) + ' ' + clip.name + ' ' + animal);
      }
    }
  }
  depth.expectBelow(0.05, 0.97, "depth over the source's, sizes of the body");
}

// The shared clips walk on the spot; so the body goes forward as fast as its standing feet go back.
PoseSequence walkingAhead(const Skeleton& source, const Skeleton& target, const SkeletonMap& map, const Clip& clip) {
  PoseSequence frames = sampleFrames(source, clip, 30);
  const RetargetSetup setup(source, target, map, {}, &frames);
  BodyFrame before, now;
  std::vector<double> steps;  // of feet that are low
  for (std::size_t f = 0; f < frames.poses.size(); ++f, std::swap(before, now)) {
    setup.sourceKinematics.globals(frames.poses[f], now);
    for (const AnimalLeg& leg : setup.animalLegs) {
      const Index foot = leg.source.end;
      if (f == 0 || now.positions[foot].y() > setup.sourceNeutral.positions[foot].y() + 0.01) continue;
      steps.push_back(now.positions[foot].z() - before.positions[foot].z());
    }
  }
  if (steps.empty()) return frames;  // its feet never come down
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  for (std::size_t f = 0; f < frames.poses.size(); ++f) {
    for (Index j = 0; j < setup.source->jointCount(); ++j) {
      if (setup.source->joints[j].parent) continue;
      frames.poses[f].locals[j].translation.z() -= static_cast<double>(f) * *middle;
    }
  }
  return frames;
}

TEST(RetargetAnimals, PawsStandWhereTheyStand) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Motion motion = readMotion(*sharedDataFolder() / "motions/m2m_fox_animations.glb");
  Spreads spreads;
  for (const char* animal : {"m2m_fox_cat.glb", "m2m_fox_dog.glb"}) {
    const PlainSkeleton plain(readMotion(*sharedDataFolder() / "rigged" / animal).skeleton);
    const Skeleton& target = plain.skeleton();
    const SkeletonMap map = matchSkeletons(motion.skeleton, target);
    for (const Clip& clip : motion.clips) {
      const PoseSequence frames = walkingAhead(motion.skeleton, target, map, clip);
      const RetargetSetup setup(motion.skeleton, target, map, {}, &frames);
      ASSERT_EQ(setup.animalLegs.size(), 4u);
      for (const char* method : {"limb-ik", "spacetime"}) {
        const MotionMetrics result = measured(setup, method, frames);
        spreads.add(result, result.sourcePenetration,
                    std::string(clip.name).append(" ").append(animal).append(" ") + method);
      }
    }
  }
  spreads.sliding.expectAllBelow(0.02, "sliding");
  spreads.slides.expectAllBelow(1e-4, "sliding over the source's");
  spreads.depth.expectAllBelow(5, "depth over the source's: those who sit lay their feet down");
  spreads.lost.expectAllBelow(0.01, "contacts lost");
  spreads.jerk.expectAllBelow(1.1, "jerk");
  spreads.expectPlantedFeet();
}

// How far a shin's end is from the foot on a root of its own that belongs there, leg lengths, at worst.
double gapAtFeet(const RetargetSetup& setup, const PoseSequence& result) {
  const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
  double worst = 0;
  BodyFrame frame;
  for (const Pose& pose : result.poses) {
    setup.targetKinematics.globals(pose, frame);
    for (const AnimalLeg& leg : setup.animalLegs) {
      const Index shin = leg.target.carrier.value(), foot = leg.target.end;
      const double change = (frame.positions[foot] - frame.positions[shin]).norm() - (rest[foot] - rest[shin]).norm();
      worst = std::max(worst, std::abs(change) / (rest[foot] - rest[leg.target.upper]).norm());
    }
  }
  return worst;
}

// Rigs for inverse kinematics, with feet on roots of their own.
TEST(RetargetAnimals, LegsReachFeetOnRootsOfTheirOwn) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const std::vector<std::string> farm = {"alpaca", "cow", "horse", "wolf"};
  Spreads spreads;
  const auto fileOf = [](const std::string& animal) {
    return *sharedDataFolder() / "rigged" / ("quaternius_" + animal + ".glb");
  };
  for (const std::string& from : farm) {
    const Motion motion = readMotion(fileOf(from));
    for (const std::string& to : farm) {
      if (from == to) continue;
      const PlainSkeleton plain(readMotion(fileOf(to)).skeleton);
      const Skeleton& target = plain.skeleton();
      const SkeletonMap map = matchSkeletons(motion.skeleton, target);
      for (const Clip& clip : motion.clips) {
        const std::string pair = std::string(from).append(" ").append(to).append(" ").append(clip.name);
        SCOPED_TRACE(pair);
        const PoseSequence frames = walkingAhead(motion.skeleton, target, map, clip);
        const RetargetSetup setup(motion.skeleton, target, map, {}, &frames);
        ASSERT_EQ(setup.animalLegs.size(), 4u);
        for (const char* method : {"limb-ik", "spacetime"}) {
          SCOPED_TRACE(method);
          const PoseSequence moved = retargetFrames(findRetargetMethod(method), setup, frames);
          const MotionMetrics result = measureMotion(setup, frames, moved);
          EXPECT_LT(gapAtFeet(setup, moved), 1e-6);
          const double sunk = setup.scale * result.sourcePenetration * result.sourceHeight / result.height;
          spreads.add(result, sunk, pair + " " + method);
        }
      }
    }
  }
  spreads.jerk.expectAllBelow(1.1, "jerk");
  spreads.expectPlantedFeet();
  spreads.sliding.expectBelow(0.011, 0.89, "sliding");
  spreads.sliding.expectAllBelow(0.1, "sliding");
  spreads.depth.expectAllBelow(5, "depth over the source's");
  spreads.lost.expectBelow(0.02, 0.96, "contacts lost");
  spreads.lost.expectAllBelow(0.06, "contacts lost");
  spreads.turned.expectBelow(10, 0.5, "bones: knees bend as theirs, or to the other side");
  spreads.turned.expectAllBelow(39, "bones");
}

// Skeletons of no names in common or of few, and of other numbers of joints.
TEST(RetargetAnimals, QuadrupedsAreMatchedByTheirForm) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const std::vector<const char*> sources = {
      "motions/m2m_fox_animations", "motions/m2m_horse_animations", "motions/m2m_dragon_animations",
      "rigged/fox_khronos",         "rigged/quaternius_alpaca",     "rigged/quaternius_cow",
      "rigged/quaternius_horse",    "rigged/quaternius_wolf",       "rigged/quaternius_triceratops"};
  const std::vector<const char*> animals = {
      "m2m_fox_fox",       "m2m_fox_cat",    "m2m_fox_dog",      "m2m_rigonly/rig_horse", "fox_khronos",
      "quaternius_alpaca", "quaternius_cow", "quaternius_horse", "quaternius_wolf",       "quaternius_triceratops"};
  int strangers = 0;
  Spreads spreads;
  for (const std::string file : sources) {
    const Motion motion = readMotion(*sharedDataFolder() / (file + ".glb"));
    for (const std::string animal : animals) {
      const PlainSkeleton plain(readMotion(*sharedDataFolder() / "rigged" / (animal + ".glb")).skeleton);
      const SkeletonMap map = matchSkeletons(motion.skeleton, plain.skeleton());
      if (!map.isQuadruped()) continue;  // of one family
      ++strangers;
      for (const char* method : {"limb-ik", "spacetime"}) {
        EXPECT_GE(map.matches.size(), 17u);
        for (const Clip& clip : motion.clips) {
          const PoseSequence frames = walkingAhead(motion.skeleton, plain.skeleton(), map, clip);
          if (frames.poses.size() < 5) continue;
          const RetargetSetup setup(motion.skeleton, plain.skeleton(), map, {}, &frames);
          ASSERT_EQ(setup.animalLegs.size(), 4u);
          const MotionMetrics result = measured(setup, method, frames);
          const double sunk = setup.scale * result.sourcePenetration * result.sourceHeight / result.height;
          spreads.add(result, sunk,
                      std::string(file).append(" ").append(clip.name).append(" ").append(animal) + " " + method);
        }
      }
    }
  }
  spreads.jerk.expectBelow(1.1, 0.99, "jerk");
  spreads.expectPlantedFeet();
  spreads.sliding.expectBelow(0.02, 0.96, "sliding");
  spreads.depth.expectBelow(5, 0.99, "depth over the source's");
  spreads.lost.expectBelow(0.05, 0.96, "contacts lost");
  EXPECT_EQ(strangers, 68);
}

}  // namespace limber::testing
