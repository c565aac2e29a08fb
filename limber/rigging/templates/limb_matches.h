// Which limbs of a template a body lacks.
#pragma once

#include <string>
#include <vector>

#include "limber/rigging/templates/template_embedding.h"

namespace limber {

// A chain of a template's joints that does not branch, from where it leaves the joint above to where it parts or ends.
struct TemplateLimb {
  std::vector<Index> joints;  // downwards; without tips
  std::vector<Index> placed;  // those that are searched for in the model, a tip at the end among them
  bool hasMatch = true;
};

// All limbs, each with a match.
std::vector<TemplateLimb> limbChains(const TemplateSkeleton& skeleton);

// The same limbs. One has no match where its joints fit the body too badly, in the mean of their costs; nor has either
// of a mirrored pair that ends in one and the same part of the body, as feet do in the stump of a bust; nor one that
// ends far deeper in the body than that of the other side, as an arm in the trunk; nor, of a template that was bent,
// one that lies in another limb.
//
// embedding  with the costs of `skeleton`'s joints
std::vector<TemplateLimb> limbsIn(const TemplateSkeleton& skeleton, const TemplateEmbedding& embedding,
                                  const BodyVolume& body, const AnatomicalFrame& frame);

// A person's head has no match either in a model that hardly goes on above the shoulders. This is decided once
// landmarks have positioned the joints; before, an embedding makes the most of a stump.
//
// positions  body space, of all joints
void findHeadless(const TemplateSkeleton& skeleton, const std::vector<Vec3>& positions,
                  std::vector<TemplateLimb>& limbs);

// Between a position and the straight bone from `a` to `b`.
double distanceToBone(const Vec3& position, const Vec3& a, const Vec3& b);

// Of those without a match: "leftUpperLeg to leftToes, ..."; empty where there are none.
std::string unmatchedLimbs(const TemplateSkeleton& skeleton, const std::vector<TemplateLimb>& limbs);

}  // namespace limber
