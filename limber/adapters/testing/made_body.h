// A body that looks like itself from no other side, its rig, and programs of the tests' own that rig it.
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/adapters/adapter.h"
#include "limber/adapters/handed_model.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/mesh/testing/capsule.h"

namespace limber::testing {

// A trunk along +Y, an arm along +X, a tail along +Z: three pieces.
inline TriMesh madeBody() {
  TriMesh mesh;
  addCapsule(mesh, Vec3(0, 0, 0), Vec3(0, 1.2, 0), 0.2);
  addCapsule(mesh, Vec3(0.3, 1, 0), Vec3(1, 1, 0), 0.1);
  addCapsule(mesh, Vec3(0, 0.1, 0.3), Vec3(0, 0.1, 0.6), 0.08);
  return mesh;
}

struct MadeJoint {
  std::string_view name, parent;
  Vec3 position;
};
inline const std::vector<MadeJoint>& madeJoints() {
  static const std::vector<MadeJoint> joints = {{"hips", "", Vec3(0, 0.1, 0)},
                                                {"chest", "hips", Vec3(0, 1, 0)},
                                                {"arm", "chest", Vec3(0.3, 1, 0)},
                                                {"hand", "arm", Vec3(0.9, 1, 0)},
                                                {"tail", "hips", Vec3(0, 0.1, 0.35)}};
  return joints;
}

inline Skeleton madeSkeleton() {
  Skeleton skeleton;
  for (const MadeJoint& made : madeJoints()) {
    Joint joint;
    joint.name = made.name;
    joint.rest.translation = made.position;
    for (Index j = 0; j < skeleton.jointCount(); ++j) {
      if (madeJoints()[j].name != made.parent) continue;
      joint.parent = j;
      joint.rest.translation -= madeJoints()[j].position;
    }
    skeleton.joints.push_back(joint);
  }
  return skeleton;
}

// The joint that each point of the made body's space is nearest to.
inline Index nearestMadeJoint(const Vec3& position) {
  Index nearest = 0;
  for (Index j = 1; j < madeJoints().size(); ++j) {
    if ((madeJoints()[j].position - position).norm() < (madeJoints()[nearest].position - position).norm()) nearest = j;
  }
  return nearest;
}

// Rigid, but that the 2nd influence of each vertex has a weight that grows along the body.
inline SkinWeights madeWeights(const TriMesh& body) {
  SkinWeights weights;
  weights.slots = 2;
  for (Index v = 0; v < body.vertexCount(); ++v) {
    const Index joint = nearestMadeJoint(body.position(v));
    const float fraction = 0.05f + 0.2f * std::abs(body.positions[v].x());
    weights.joints.insert(weights.joints.end(), {joint, joint == 0 ? Index{1} : Index{0}});
    weights.weights.insert(weights.weights.end(), {1 - fraction, fraction});
  }
  return weights;
}

// The same rig as a document, under a map that turns, scales and moves it.
inline Bytes madeGlb(const TriMesh& body, const SkinWeights& weights, const Affine& map = Affine::Identity()) {
  TriMesh moved = body;
  for (Vec3f& p : moved.positions) p = (map * Vec3(p.cast<double>())).cast<float>();
  Asset asset = meshAsset(moved);
  attachRig(asset, collectGeometry(asset), movedSkeleton(madeSkeleton(), map), weights);
  return writeGlb(asset);
}

// The made body's space to the file's that a program is handed.
inline Affine madeToHanded(const Adapter& adapter) {
  const TriMesh body = madeBody();
  const WorkingFrame frame = prepareMesh(body.positions, body.triangles).frame;
  Affine toWorking = Affine::Identity();
  toWorking.linear() /= frame.scale;
  toWorking.translation() = -frame.offset / frame.scale;
  return toHandedSpace(adapter.inputUp, adapter.inputSize) * toWorking;
}

// RigNet's text for the mesh that is handed over, whose vertices are those of the body in its order; without weights a
// skeleton alone.
inline std::string madeText(const Affine& map, const TriMesh& body, const SkinWeights& weights,
                            std::string_view jointWord = "joints") {
  std::string text;
  for (const MadeJoint& joint : madeJoints()) {
    const Vec3 p = map * joint.position;
    text += fmt::format("{} {} {} {} {}\n", jointWord, joint.name, p.x(), p.y(), p.z());
  }
  text += "root hips\n";
  for (const MadeJoint& joint : madeJoints()) {
    if (!joint.parent.empty()) text += fmt::format("hier {} {}\n", joint.parent, joint.name);
  }
  for (Index v = 0; weights.slots > 0 && v < body.vertexCount(); ++v) {
    text += fmt::format("skin {}", v);
    for (Index slot = 0; slot < weights.slots; ++slot) {
      text += fmt::format(" {} {}", madeJoints()[weights.jointsOf(v)[slot]].name, weights.weightsOf(v)[slot]);
    }
    text += "\n";
  }
  return text;
}

inline void putFile(const std::filesystem::path& file, std::string_view text) {
  std::ofstream(file, std::ios::binary) << text;
}
inline void putFile(const std::filesystem::path& file, const Bytes& bytes) {
  putFile(file, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

// An adapter of one step, a line for a shell that the test itself chooses.
inline Adapter shellAdapter(std::string_view line, AdapterFormat output = AdapterFormat::kRignetText) {
  Adapter adapter;
  adapter.name = "fake";
  adapter.steps = {{{"/bin/sh", "-c", std::string(line), "sh", "{input}", "{output}", "{seed}"}, {}}};
  adapter.limits.seconds = 20;
  adapter.outputFormat = output;
  adapter.outputFile = fmt::format("output/model{}", adapterExtension(output));
  return adapter;
}

}  // namespace limber::testing
