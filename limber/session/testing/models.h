// Small models and a motion made in code, for tests of sessions. Not installed.
#pragma once

#include "limber/character/matching/testing/test_motion.h"
#include "limber/core/error.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"
#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/motion/retarget/retarget_clip.h"
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
    Vec3f least = mesh.positions[0], most = least;
    for (const Vec3f& p : mesh.positions) {
      least = least.cwiseMin(p);
      most = most.cwiseMax(p);
    }
    for (int i = 0; i < 3; ++i) {
      builder.json["accessors"][position]["min"].push_back(0.17f * least[i]);
      builder.json["accessors"][position]["max"].push_back(0.17f * most[i]);
    }
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

// The same with a rig whose joints have a person's names, each vertex on the nearest.
inline Bytes personGlb(bool facesBack) {
  Asset asset = readAsset(bipedGlb(), "person.glb");
  const Geometry geometry = collectGeometry(asset);
  Skeleton skeleton = practiceHumanoid();
  if (facesBack) skeleton.joints[0].rest.rotation = Quat(0, 0, 1, 0);
  const std::vector<Affine> joints = restGlobals(skeleton);
  SkinWeights weights;
  weights.slots = 1;
  for (const Vec3f& position : geometry.positions) {
    Index nearest = 0;
    const auto distance = [&](Index j) { return (joints[j].translation() - position.cast<double>()).norm(); };
    for (Index j = 1; j < skeleton.jointCount(); ++j) nearest = distance(j) < distance(nearest) ? j : nearest;
    weights.joints.push_back(nearest);
    weights.weights.push_back(1.0f);
  }
  attachRig(asset, geometry, skeleton, weights);
  return writeGlb(asset);
}
inline const Bytes& namedPersonGlb() {
  static const Bytes bytes = personGlb(false);
  return bytes;
}

// One second of walking.
inline const Bytes& walkBvh() {
  static const Bytes bytes = [] {
    Motion motion;
    motion.skeleton = practiceHumanoid();
    motion.framesPerSecond = 30;
    motion.clips.push_back(clipOf(motion.skeleton, walk(motion.skeleton, 31, 30), "walk"));
    return writeBvh(motion);
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
