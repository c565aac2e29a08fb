#include "limber/actions/rig/figure_geometry.h"

#include <set>

#include "limber/document/rig/rig_io.h"

namespace limber {

RemovedRig takeRigOut(Asset& asset) {
  std::set<Index> joints;
  for (const gltf::Skin& skin : asset.document.skins) joints.insert(skin.joints.begin(), skin.joints.end());
  const std::size_t clips = asset.document.animations.size();
  removeRig(asset);
  return {static_cast<Index>(joints.size()), static_cast<Index>(clips - asset.document.animations.size())};
}

}  // namespace limber
