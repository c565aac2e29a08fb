// Shared walks and runs joined and blended on shared characters: feet and smoothness against those of the motions
// themselves, by the judge's detector of rest (limber/evaluate/motion/contact_oracle.h), which is independent of the
// code that plants feet.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "limber/actions/motion/retarget_asset.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/read.h"
#include "limber/evaluate/motion/contact_oracle.h"
#include "limber/motion/limbs/roughness.h"
#include "limber/motion/mix/blend_motions.h"
#include "limber/motion/mix/crossfade_motions.h"
#include "limber/motion/mix/mix_motion.h"
#include "limber/skeleton/motion.h"
#include "shared_data.h"

namespace limber::testing {

namespace {

constexpr double kLeadIn = 0.1;  // seconds, in which some recordings come out of a T-pose

struct MixFigures {
  double sliding = 0;  // of resting feet and toes, heights a second
  double jerk = 0;     // root mean square of all joints, heights a second cubed
};

MixFigures figuresOf(const MixBody& body, const Clip& clip, double rate) {
  const PoseSequence frames = body.plain().plain(sampleFrames(body.original(), clip, rate));
  const double height = standingHeight(body.setup(), MapSide::kTarget);
  std::vector<BodyFrame> globals(frames.poses.size());
  for (std::size_t f = 0; f < globals.size(); ++f) body.globals(frames.poses[f], globals[f]);
  const auto begin = static_cast<std::size_t>(kLeadIn * rate);
  double pathLength = 0, resting = 0, jerk = 0, steps = 0;
  for (const LegSpec& leg : body.legs()) {
    for (const Index point : {leg.end, leg.toes.value_or(leg.end)}) {
      std::vector<Vec3> path;
      std::vector<double> above;
      for (const BodyFrame& frame : globals) path.push_back(frame.positions[point] / height);
      const auto lowest = std::min_element(path.begin(), path.end(), [](auto& a, auto& b) { return a.y() < b.y(); });
      for (const Vec3& position : path) above.push_back(position.y() - lowest->y());
      const std::vector<bool> rests =
          restingFrames(path, above, std::vector<bool>(path.size(), false), frames.frameSeconds);
      for (std::size_t f = begin + 1; f < path.size(); ++f) {
        if (!rests[f] || !rests[f - 1]) continue;
        pathLength += std::hypot(path[f].x() - path[f - 1].x(), path[f].z() - path[f - 1].z());
        resting += frames.frameSeconds;
      }
    }
  }
  for (std::size_t f = begin + 3; f < globals.size(); ++f) {
    for (std::size_t j = 0; j < globals[f].positions.size(); ++j, ++steps) {
      const auto at = [&](std::size_t back) { return globals[f - back].positions[j]; };
      jerk += (at(0) - at(3) - 3 * (at(1) - at(2))).squaredNorm();
    }
  }
  return {resting > 0 ? pathLength / resting : 0, std::sqrt(jerk / steps) * rate * rate * rate / height};
}

ClipWithContacts onto(Asset& character, const std::filesystem::path& motion) {
  return retargetedClips(Character(character), readMotion(motion), {}, true, character.warnings).clips.front();
}

}  // namespace

TEST(Combining, FeetSlideNoMoreThanInTheMotionsAndNothingIsRougher) {
  const auto shared = sharedDataFolder();
  if (!shared) GTEST_SKIP() << kNoSharedData;
  const char* const pairs[][2] = {{"cmu_daz_12_01_walk.bvh", "cmu_daz_09_01_run.bvh"},
                                  {"cmu_daz_02_03_run.bvh", "cmu_mb_12_01_walk.bvh"},
                                  {"pab_walk.fbx", "pab_run.fbx"},
                                  {"cmu_mb_12_01_walk.bvh", "cmu_daz_02_01_walk.bvh"}};
  double joined = 0, slidMore = 0, rougher = 0;
  for (const char* name : {"cesium_man", "makehuman_mixamo", "quaternius_man_casual", "kenney_human"}) {
    Asset character = readAsset(*shared / "rigged" / (std::string(name) + ".glb"));
    const Skeleton skeleton = animatedSkeleton(character).skeleton;
    const MixBody body(skeleton);
    for (const auto& pair : pairs) {
      const ClipWithContacts a = onto(character, *shared / "motions" / pair[0]),
                             b = onto(character, *shared / "motions" / pair[1]);
      const double rate = std::max(frameRateOf(a.clip), frameRateOf(b.clip));
      const MixFigures ofA = figuresOf(body, a.clip, rate), ofB = figuresOf(body, b.clip, rate);
      const double sliding = std::max(ofA.sliding, ofB.sliding), jerk = std::max(ofA.jerk, ofB.jerk);
      for (const bool blends : {false, true}) {
        const ClipWithContacts made = blends ? blendMotions(skeleton, a, b) : crossfadeMotions(skeleton, a, b);
        const MixFigures mixed = figuresOf(body, made.clip, rate);
        std::printf("%-22s %-22s %-22s %-9s sliding %.3f (%.3f, %.3f), jerk %.2f\n", name, pair[0], pair[1],
                    blends ? "blend" : "crossfade", mixed.sliding, ofA.sliding, ofB.sliding, mixed.jerk / jerk);
        EXPECT_LT(mixed.jerk, (blends ? 1.25 : 1.1) * jerk);
        if (blends) continue;
        EXPECT_LT(mixed.sliding, sliding + 0.015);
        slidMore += mixed.sliding - sliding;
        rougher += mixed.jerk / jerk;
        ++joined;
      }
    }
  }
  EXPECT_LT(slidMore / joined, 0);
  EXPECT_LT(rougher / joined, 1);
}

}  // namespace limber::testing
