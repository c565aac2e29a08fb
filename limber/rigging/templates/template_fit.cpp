#include "limber/rigging/templates/template_fit.h"

#include <algorithm>
#include <limits>

#include "limber/rigging/body/feet_direction.h"

namespace limber {

namespace {

constexpr double kOnGround = 0.1;    // heights of the tips of feet
constexpr double kFeetBackward = 2;  // cost of footprints that lie half their length behind the legs
constexpr double kUnexplained = 2;   // cost of a body that no bone comes near
constexpr double kNearBone = 0.08;   // heights beyond the surface of a medial sphere
constexpr double kFarFromBone = 0.25;

// The cost of an orientation before the model is looked at: files mostly have +Y or +Z up, and the front towards the
// viewer.
double unusual(const AnatomicalFrame& frame) {
  const Vec3 up = frame.axes.row(1).transpose(), front = frame.axes.row(2).transpose();
  const bool yUp = up.y() > 0.9, zUp = up.z() > 0.9;
  const double upCost = yUp ? 0 : zUp ? 0.2 : 0.8;
  const bool usualFront = frame.isFrontRead || (yUp ? front.z() > 0.9 : zUp ? front.y() < -0.9 : true);
  return upCost + (usualFront ? 0 : 0.6);
}

// How much of the body no bone comes near, 0 to 1: in equal parts of its medial spheres, and of the ends of its limbs
// by how far these reach.
double unexplained(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions, const BodyVolume& body,
                   const AnatomicalFrame& frame) {
  double spheres = 0, tips = 0, reach = 0;
  for (const MedialSphere& sphere : body.spheres) {
    const double far = farFromBones(skeleton, positions, frame.toBody(sphere.center), sphere.radius / frame.height);
    spheres += far / static_cast<double>(body.spheres.size());
  }
  for (const BodyTip& tip : body.tips) {
    tips += tip.reach * farFromBones(skeleton, positions, frame.toBody(tip.position), 0);
    reach += tip.reach;
  }
  return 0.5 * (spheres + tips / std::max(reach, 1e-12));
}

// Of the placed joints that hold the tips on the ground.
std::vector<Vec3> feetOf(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions) {
  std::vector<Vec3> feet;
  for (Index tip = 0; tip < skeleton.jointCount(); ++tip) {
    const TemplateJoint& joint = skeleton.joints[tip];
    const bool onGround = joint.role == TemplateRole::kTip && joint.position.y() <= kOnGround && joint.parent;
    if (onGround) feet.push_back(positions[placedAbove(skeleton, tip)]);
  }
  return feet;
}

}  // namespace

double farFromBones(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions, const Vec3& position,
                    double radius) {
  double nearest = std::numeric_limits<double>::infinity();
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!skeleton.joints[j].parent) continue;
    nearest = std::min(nearest, distanceToBone(position, positions[*skeleton.joints[j].parent], positions[j]));
  }
  const double beyond = nearest - radius;
  return std::clamp((beyond - kNearBone) / (kFarFromBone - kNearBone), 0.0, 1.0);
}

std::vector<TemplateFit> fitVariants(const std::vector<TemplateVariant>& variants, TemplateEmbedder& embedder) {
  const BodyVolume& body = embedder.body();
  const AnatomicalFrame& frame = embedder.frame();
  std::vector<TemplateEmbedding> embeddings = embedder.embed(variants);
  std::vector<TemplateFit> fits;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    const double left = unexplained(variants[v].skeleton, embeddings[v].positions, body, frame);
    const double cost = embeddings[v].cost + unusual(frame) + kUnexplained * left;
    fits.push_back({variants[v].skeleton, frame, embedder.pins(), std::move(embeddings[v]), cost, {}});
  }
  // Feet point to the front, whichever hypothesis fits the rest of a body; measured once, on the best fit.
  const TemplateFit& best = *std::min_element(fits.begin(), fits.end(), cheaper);
  const double forward = feetForward(body, frame, feetOf(best.skeleton, best.embedding.positions));
  for (TemplateFit& fit : fits) fit.cost += kFeetBackward * std::max(0.0, -forward);
  return fits;
}

}  // namespace limber
