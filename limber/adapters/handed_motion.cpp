#include "limber/adapters/handed_motion.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/adapters/handed_model.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/unique_names.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {

namespace {

constexpr unsigned char kDelete = 127;

Bytes writtenFor(const Adapter& adapter, Motion motion, std::size_t clip, double framesPerSecond) {
  motion.skeleton = plainlyNamed(std::move(motion.skeleton));
  if (adapter.inputUp != AdapterUp::kY) {
    motion = turnedMotion(std::move(motion), Quat(Mat3(toHandedSpace(adapter.inputUp, 1).linear())));
  }
  BvhWriteOptions options;
  options.clip = clip;
  options.metresPerUnit = adapter.inputMetresPerUnit;
  options.fps = framesPerSecond;
  return writeBvh(motion, options);
}

}  // namespace

Skeleton plainlyNamed(Skeleton skeleton) {
  UniqueNames names;
  for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
    std::string& name = skeleton.joints[j].name;
    const auto isBad = [](unsigned char c) { return c <= ' ' || c == kDelete || c == '{' || c == '}'; };
    std::replace_if(name.begin(), name.end(), isBad, '_');
    name = names.add(name.empty() ? fmt::format("joint_{}", j) : name);
  }
  return skeleton;
}

Motion turnedMotion(Motion motion, const Quat& turn) {
  for (Clip& clip : motion.clips) clip = turnClip(std::move(clip), motion.skeleton, turn);
  for (Joint& joint : motion.skeleton.joints) {
    if (joint.parent) continue;
    joint.rest.rotation = turn * joint.rest.rotation;
    joint.rest.translation = turn * joint.rest.translation;
  }
  return motion;
}

Bytes handedMotion(const Motion& motion, std::size_t clip, double framesPerSecond, const Adapter& adapter) {
  return writtenFor(adapter, motion, clip, framesPerSecond);
}

Bytes handedSkeleton(const Skeleton& skeleton, double framesPerSecond, const Adapter& adapter) {
  Motion still;
  still.skeleton = skeleton;
  still.framesPerSecond = framesPerSecond;
  Clip clip;
  clip.name = "rest";
  const Quat& first = skeleton.joints.front().rest.rotation;
  clip.rotations.push_back({0, Interpolation::kLinear, {0}, {first.normalized().cast<float>()}});
  still.clips.push_back(std::move(clip));
  return writtenFor(adapter, std::move(still), 0, framesPerSecond);
}

}  // namespace limber
