#include "limber/character/matching/body_skin.h"

#include <algorithm>
#include <utility>

#include "limber/character/matching/plain_skeleton.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

// Vertices; 1000 and more; of which a body's skin is read: bounds time; set by hand.
constexpr std::size_t kMaxSamples = 6000;

}  // namespace

std::shared_ptr<const BodySkin> makeBodySkin(const Skeleton& skeleton, std::span<const Vec3f> bound,
                                             const SkinWeights& weights) {
  BodySkin skin;
  // As bodies are posed: without mirrored joints.
  const PlainSkeleton plain(skeleton);
  const std::vector<Affine> globals = restGlobals(plain.skeleton());
  std::vector<Mat3> toJoint;
  for (const Affine& global : globals) toJoint.push_back(global.rotation().transpose());
  const std::size_t step = (bound.size() + kMaxSamples - 1) / kMaxSamples;
  for (std::size_t v = 0; v < bound.size(); v += step) {
    const auto joints = weights.jointsOf(static_cast<Index>(v));
    const auto influences = weights.weightsOf(static_cast<Index>(v));
    const auto most = std::max_element(influences.begin(), influences.end());
    if (most == influences.end() || !(*most > 0)) continue;
    const Index joint = joints[static_cast<std::size_t>(most - influences.begin())];
    skin.joints.push_back(joint);
    skin.positions.push_back(toJoint[joint] * (bound[v].cast<double>() - globals[joint].translation()));
  }
  return std::make_shared<const BodySkin>(std::move(skin));
}

}  // namespace limber
