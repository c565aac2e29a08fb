#include "limber/evaluate/skinned_model.h"

#include <utility>

#include "limber/asset/geometry.h"
#include "limber/asset/rig_io.h"

namespace limber {

SkinnedModel readSkinnedModel(const Asset& asset) {
  if (!hasRig(asset)) {
    throw Error(ErrorCode::kUnsupported, "has no skin weights to compare", asset.name, "rig it first: limber rig");
  }
  Geometry geometry = collectGeometry(asset);
  AssetSkeleton skeleton = readSkeleton(asset);
  SkinnedModel result;
  result.weights = readWeights(asset, geometry, skeleton);
  result.skeleton = std::move(skeleton.skeleton);
  result.mesh = {std::move(geometry.positions), std::move(geometry.triangles)};
  return result;
}

}  // namespace limber
