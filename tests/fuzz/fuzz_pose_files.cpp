// Any bytes as a file of poses or of joint limits: an Error, or something that the solvers can work with and, for
// limits, that comes back from writing.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "limber/core/error.h"
#include "limber/ik/ik_skeletons.h"
#include "limber/ik/limits_json.h"
#include "limber/pipeline/pose_asset.h"

namespace {

using namespace limber;

constexpr std::size_t kMostEdits = 20;  // so that no input takes seconds

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
    if (edits.turns.size() + edits.moves.size() + edits.reaches.size() > kMostEdits) continue;
    Pose pose = restPose(skeleton);
    try {
      editPose(skeleton, pose, edits, nullptr, options);
    } catch (const Error&) {
    }
    if (&named - poses.data() > 3) return;
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
  return 0;
}
