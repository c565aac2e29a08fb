#include "limber/rigging/templates/limb_chains.h"

namespace limber {

std::vector<TemplateLimb> limbChains(const TemplateSkeleton& skeleton) {
  // What only lies between, as twist joints and hair do, is no limb.
  std::vector<bool> leadsOn(skeleton.jointCount(), false);
  std::vector<Index> children(skeleton.jointCount(), 0), limbOf(skeleton.jointCount(), 0);
  for (Index j = skeleton.jointCount(); j-- > 0;) {
    const TemplateJoint& joint = skeleton.joints[j];
    leadsOn[j] = leadsOn[j] || joint.role != TemplateRole::kBetween;
    if (!joint.parent || !leadsOn[j]) continue;
    leadsOn[*joint.parent] = true;
    ++children[*joint.parent];
  }
  std::vector<TemplateLimb> limbs;
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const TemplateJoint& joint = skeleton.joints[j];
    if (joint.parent && leadsOn[j] && children[*joint.parent] == 1) {
      limbOf[j] = limbOf[*joint.parent];
    } else {
      limbOf[j] = static_cast<Index>(limbs.size());
      limbs.emplace_back();
    }
    if (joint.role != TemplateRole::kTip) limbs[limbOf[j]].joints.push_back(j);
  }
  std::erase_if(limbs, [](const TemplateLimb& limb) { return limb.joints.empty(); });
  return limbs;
}

std::string missingLimbs(const TemplateSkeleton& skeleton, const std::vector<TemplateLimb>& limbs) {
  std::string names;
  for (const TemplateLimb& limb : limbs) {
    if (limb.isThere) continue;
    const std::string &first = skeleton.joints[limb.joints.front()].name,
                      &last = skeleton.joints[limb.joints.back()].name;
    names += names.empty() ? "" : ", ";
    names += first;
    if (first != last) names += " to " + last;
  }
  return names;
}

}  // namespace limber
