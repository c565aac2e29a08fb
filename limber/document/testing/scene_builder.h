// Small glTF documents made in code, for tests.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/core/transform.h"
#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/gltf_json.h"

namespace limber::testing {

class SceneBuilder {
 public:
  Asset& asset() { return asset_; }
  gltf::Node& node(Index n) { return asset_.document.nodes[n]; }
  gltf::Primitive& primitiveOf(Index mesh) { return asset_.document.meshes[mesh].primitives[0]; }

  static std::vector<Vec3f> tetrahedron(const Vec3f& at = Vec3f::Zero(), float size = 1) {
    return {at, at + size * Vec3f::UnitX(), at + size * Vec3f::UnitY(), at + size * Vec3f::UnitZ()};
  }
  // Seen from outside counter-clockwise.
  static std::vector<Triangle> tetrahedronTriangles() { return {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}; }

  Index addPositions(const std::vector<Vec3f>& positions) {
    std::vector<float> values;
    for (const Vec3f& p : positions) values.insert(values.end(), {p.x(), p.y(), p.z()});
    return addFloatAccessor(asset_, values, 3, kVertexTarget, true);
  }
  Index addIndices(const std::vector<std::uint32_t>& indices) {
    return addAccessor(asset_, {static_cast<Index>(indices.size()), 1, ComponentType::kU32, false},
                       {reinterpret_cast<const std::uint8_t*>(indices.data()), indices.size() * 4}, kIndexTarget);
  }
  Json primitive(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
    Json result = {{"attributes", {{"POSITION", addPositions(positions)}}}};
    if (!corners.empty()) result["indices"] = addIndices(corners);
    return result;
  }
  Index addMesh(Json primitives, const char* name = "mesh") {
    const Json mesh = {{"name", name}, {"primitives", std::move(primitives)}};
    return addElement(asset_.document.meshes, documentWith("meshes", mesh).meshes[0]);
  }
  // One tetrahedron as a mesh of its own.
  Index addTetrahedron(const Vec3f& at = Vec3f::Zero(), float size = 1) {
    Json primitives = Json::array({primitive(tetrahedron(at, size), tetrahedronTriangles())});
    return addMesh(std::move(primitives));
  }

  Index addNode(const Json& node) { return addElement(asset_.document.nodes, documentWith("nodes", node).nodes[0]); }
  Index addSkin(const std::vector<Index>& joints, const std::vector<Affine>& inverseBinds) {
    gltf::Skin skin;
    skin.joints = joints;
    if (!inverseBinds.empty()) {
      std::vector<float> values;
      for (const Affine& m : inverseBinds) {
        for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(m.matrix()(i % 4, i / 4)));
      }
      skin.inverseBindMatrices = addFloatAccessor(asset_, values, 16);
    }
    return addElement(asset_.document.skins, std::move(skin));
  }
  // JOINTS_0 and WEIGHTS_0 of one primitive: each vertex with one joint of the skin.
  void bindRigidly(Index mesh, const std::vector<std::uint8_t>& jointOfVertex) {
    std::vector<std::uint8_t> joints;
    std::vector<float> weights;
    for (const std::uint8_t joint : jointOfVertex) {
      joints.insert(joints.end(), {joint, 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
    bind(mesh, joints, weights);
  }
  // The same of four joints and weights for each vertex.
  void bind(Index mesh, const std::vector<std::uint8_t>& joints, const std::vector<float>& weights) {
    const auto count = static_cast<Index>(joints.size() / 4);
    gltf::Attributes& attributes = primitiveOf(mesh).attributes;
    attributes.set("JOINTS_0", addAccessor(asset_, {count, 4, ComponentType::kU8, false}, joints, kVertexTarget));
    attributes.set("WEIGHTS_0", addFloatAccessor(asset_, weights, 4, kVertexTarget));
  }
  // A clip with one channel that moves `node` by two keys.
  void addClip(Index node, const char* path, Index components) {
    const Index input = addFloatAccessor(asset_, std::vector<float>{0, 1}, 1, 0, true);
    const Index output = addFloatAccessor(asset_, std::vector<float>(2 * components, 0.5f),
                                          path == std::string("weights") ? 1 : components);
    gltf::Animation& clip = asset_.document.animations.emplace_back();
    clip.samplers.push_back({{}, input, output});
    clip.channels.push_back({{}, 0, {{}, node, path}});
  }
  Index addScene(const std::vector<Index>& roots) {
    gltf::Scene scene;
    scene.nodes = roots;
    return addElement(asset_.document.scenes, std::move(scene));
  }

  Asset build() {
    checkAsset(asset_);
    return std::move(asset_);
  }

 private:
  // A document that holds a single element.
  static gltf::Document documentWith(const char* kind, const Json& element) {
    return gltf::documentOf({{"asset", {{"version", "2.0"}}}, {kind, Json::array({element})}});
  }

  Asset asset_;
};

inline Affine translation(double x, double y, double z) {
  return Affine(Eigen::Translation3d(x, y, z));
}

}  // namespace limber::testing
