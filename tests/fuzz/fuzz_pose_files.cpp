// Any bytes as a file of poses, of one pose with its skeleton or of joint limits: an Error, or something that the
// solvers can work with and, for limits and the one pose, that comes back from writing.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "limber/actions/pose/pose_asset.h"
#include "limber/actions/pose/put_pose.h"
#include "limber/core/error.h"
#include "limber/document/clip/pose_file.h"
#include "limber/skeleton/ik/ik_skeletons.h"
#include "limber/skeleton/ik/limits/limits_json.h"

namespace {

using namespace limber;

constexpr std::size_t kMaxEdits = 20;  // so that no input takes seconds

void useLimits(const Skeleton& skeleton, const JointLimits& limits) {
  const std::string written = limitsToJson(limits, skeleton);
  if (limitsToJson(limitsFromJson(written, skeleton), skeleton).empty()) std::abort();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const Quat allowed = nearestAllowed(limits.joints[j], Quat(0.6, 0, 0.8, 0));
    if (!(std::abs(allowed.norm() - 1) < 1e-6)) std::abort();
  }
}

void usePoses(const Skeleton& skeleton, const std::vector<NamedPose>& poses) {
  PoseOptions options;
  options.ik.maxIterations = 5;
  options.ik.restarts = 1;
  for (const NamedPose& named : poses) {
    const PoseEdits& edits = named.edits;
    if (edits.turns.size() + edits.moves.size() + edits.reaches.size() > kMaxEdits) continue;
    Pose pose = restPose(skeleton);
    try {
      editPose(skeleton, pose, edits, nullptr, options);
    } catch (const Error&) {
    }
    if (&named - poses.data() > 3) return;
  }
}

void useFreePose(const Skeleton& skeleton, const PortablePose& pose) {
  const std::string written = poseToJson(pose);
  if (poseToJson(poseFromJson(written)) != written) std::abort();
  if (pose.skeleton.jointCount() > 100) return;
  for (const Transform& local : putPose(pose, skeleton, restPose(skeleton)).locals) {
    if (!local.translation.allFinite() || !local.rotation.coeffs().allFinite()) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Skeleton skeleton = practiceHumanoid();
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    useLimits(skeleton, limitsFromJson(text, skeleton));
  } catch (const Error&) {
  }
  try {
    usePoses(skeleton, parsePoses(text));
  } catch (const Error&) {
  }
  try {
    useFreePose(skeleton, poseFromJson(text));
  } catch (const Error&) {
  }
  return 0;
}
