// A rigged surface as a page draws it: arrays in bytes, and an account of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include <nlohmann/json.hpp>

#include "call_result.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/session/rigged_model.h"

namespace limber::wasm {

template <class T>
Bytes bytesOf(const std::vector<T>& values) {
  Bytes bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline constexpr Index kSlots = 4;  // influences that a page draws with

// The strongest of each vertex, scaled to a sum of 1; a vertex without any follows joint 0.
inline void strongest(const SkinWeights& weights, std::vector<std::uint16_t>& joints, std::vector<float>& values) {
  const std::size_t count = weights.vertexCount();
  joints.assign(count * kSlots, 0);
  values.assign(count * kSlots, 0.0f);
  const Index slots = std::min(kSlots, weights.slots);
  for (Index v = 0; v < count; ++v) {
    float sum = 0;
    for (Index k = 0; k < slots; ++k) sum += weights.weightsOf(v)[k];
    if (!(sum > 0)) values[std::size_t{v} * kSlots] = 1;
    for (Index k = 0; k < slots && sum > 0; ++k) {
      joints[std::size_t{v} * kSlots + k] = static_cast<std::uint16_t>(weights.jointsOf(v)[k]);
      values[std::size_t{v} * kSlots + k] = weights.weightsOf(v)[k] / sum;
    }
  }
}

// What a page draws the weights with: #S * 4 floats, then as many joints in 16 bits.
inline Bytes weightsArray(const SkinWeights& weights) {
  std::vector<std::uint16_t> joints;
  std::vector<float> values;
  strongest(weights, joints, values);
  Bytes bytes = bytesOf(values);
  const Bytes behind = bytesOf(joints);
  bytes.insert(bytes.end(), behind.begin(), behind.end());
  return bytes;
}

// The surface as bound, and what it looks like. The account says where in the bytes each array is: all of 4 byte
// elements first, then joints, then the textures' files.
inline CallResult surfaceOf(const RiggedModel& rig) {
  const ExportMesh mesh = exportMesh(rig.asset(), rig.geometry());
  CallResult result{true, {}, {}};
  Json arrays = Json::object();
  const auto add = [&](const char* name, const Bytes& bytes) {
    arrays[name] = {{"offset", result.bytes.size()}, {"size", bytes.size()}};
    result.bytes.insert(result.bytes.end(), bytes.begin(), bytes.end());
  };
  std::vector<std::uint16_t> joints;
  std::vector<float> weights;
  strongest(rig.weights, joints, weights);
  add("positions", bytesOf(mesh.positions));
  add("normals", bytesOf(mesh.normals));
  add("uvs", bytesOf(mesh.uvs));
  add("triangles", bytesOf(mesh.triangles));
  add("weights", bytesOf(weights));
  add("joints", bytesOf(joints));

  Json json = {
      {"arrays", nullptr}, {"parts", Json::array()}, {"materials", Json::array()}, {"textures", Json::array()}};
  for (const ExportPart& part : mesh.parts) {
    json["parts"].push_back({{"name", part.name},
                             {"first", 3 * part.firstTriangle},
                             {"count", 3 * part.triangleCount},
                             {"material", part.material ? Json(*part.material) : Json(nullptr)}});
  }
  for (const ExportMaterial& material : mesh.materials) {
    const Vec4f& c = material.color;
    json["materials"].push_back({{"name", material.name},
                                 {"color", {c[0], c[1], c[2], c[3]}},
                                 {"texture", material.texture ? Json(*material.texture) : Json(nullptr)}});
  }
  for (const ExportTexture& texture : mesh.textures) {
    json["textures"].push_back({{"offset", result.bytes.size()}, {"size", texture.bytes.size()}});
    result.bytes.insert(result.bytes.end(), texture.bytes.begin(), texture.bytes.end());
  }
  json["arrays"] = std::move(arrays);
  result.account = dumpReport(json, -1);
  return result;
}

}  // namespace limber::wasm
