// A small model made in code, for tests of sessions. Not installed.
#pragma once

#include "limber/asset/read.h"
#include "limber/asset/testing/gltf_builder.h"
#include "limber/core/error.h"
#include "limber/rigging/testing/shape_meshes.h"
#include "limber/session/rigged_model.h"

namespace limber::testing {

// A creature of cubes 1.7 m high, its own image in x.
inline const Bytes& bipedGlb() {
  static const Bytes bytes = [] {
    const TriMesh mesh = blockBiped(1);
    std::vector<float> positions;
    std::vector<Index> indices;
    for (const Vec3f& p : mesh.positions) {
      for (int i = 0; i < 3; ++i) positions.push_back(0.17f * p[i]);
    }
    for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
    GltfBuilder builder;
    const Index position = builder.accessor(positions, 5126, "VEC3", mesh.positions.size());
    const Index index = builder.accessor(indices, 5125, "SCALAR", indices.size());
    builder.json["meshes"] =
        Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", position}}}, {"indices", index}}})}}});
    builder.json["nodes"] = Json::array({{{"name", "biped"}, {"mesh", 0}}});
    builder.json["scenes"] = Json::array({{{"nodes", {0}}}});
    builder.json["scene"] = 0;
    return builder.glb();
  }();
  return bytes;
}

inline std::shared_ptr<const RiggedModel> rigBiped(Index handles) {
  Progress progress;
  AutoRigOptions options;
  options.rig.handles = handles;
  return makeRiggedModel(readAsset(bipedGlb(), "biped.glb"), options, progress);
}

}  // namespace limber::testing
