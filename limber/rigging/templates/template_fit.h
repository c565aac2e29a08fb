// A template as it was embedded in a body, and what it costs.
#pragma once

#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/limb_matches.h"
#include "limber/rigging/templates/template_embedding.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

// A template embedded in a body, before the shape of the body refines it.
struct TemplateFit {
  TemplateSkeleton skeleton;  // the variant
  AnatomicalFrame frame;
  TemplatePins pins;
  TemplateEmbedding embedding;
  double cost = 0;                  // of the embedding, the orientation and what of the body is left over
  std::vector<TemplateLimb> limbs;  // as embedded
};

inline bool cheaper(const TemplateFit& a, const TemplateFit& b) {
  return a.cost < b.cost;
}

// One fit for each variant (one or more), all but their limbs.
std::vector<TemplateFit> fitVariants(const std::vector<TemplateVariant>& variants, TemplateEmbedder& embedder);

// How far a position (body space) is from all bones of a fit, beyond `radius` (heights): 0 near one, 1 where no bone
// comes near.
double farFromBones(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions, const Vec3& position,
                    double radius);

}  // namespace limber
