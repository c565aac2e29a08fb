// A mesh that was bound in another pose than the joints of its skin, for tests. Not installed.
#pragma once

#include <vector>

#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"

namespace limber::testing {

// Gives the mesh that the node shows, which the joints of these nodes hold, a skin of its own, bound `by` off where its
// other joints are: once skinned it looks as before.
inline void bindElsewhere(Asset& asset, Index node, const std::vector<Index>& jointNodes, const Vec3f& by) {
  gltf::Document& document = asset.document;
  gltf::Skin skin = document.skins[document.nodes[node].skin.value()];
  std::vector<float> binds = readFloats(asset, skin.inverseBindMatrices.value());
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    Eigen::Map<Eigen::Matrix4f> bind(&binds[16 * j]);
    for (const Index joint : jointNodes) {
      if (skin.joints[j] == joint) bind.col(3).head<3>() -= bind.topLeftCorner<3, 3>() * by;
    }
  }
  skin.inverseBindMatrices = addFloatAccessor(asset, binds, 16);
  document.nodes[node].skin = addElement(document.skins, std::move(skin));
  for (gltf::Primitive& primitive : document.meshes[document.nodes[node].mesh.value()].primitives) {
    std::vector<float> positions = readFloats(asset, primitive.attributes.find("POSITION").value());
    for (std::size_t i = 0; i < positions.size(); ++i) positions[i] += by[static_cast<Eigen::Index>(i % 3)];
    primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  }
}

}  // namespace limber::testing
