// glTF files made in code, byte by byte, for tests.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/uri.h"

namespace limber::testing {

struct GltfBuilder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  Bytes binary;

  template <typename T>
  Index view(const std::vector<T>& values, std::size_t stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    Json added = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride != 0) added["byteStride"] = stride;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
    binary.insert(binary.end(), bytes, bytes + values.size() * sizeof(T));
    return push("bufferViews", added);
  }

  // An accessor over a view of its own.
  template <typename T>
  Index accessor(const std::vector<T>& values, int componentType, const char* type, std::size_t count) {
    const Index own = view(values);
    return push("accessors", {{"bufferView", own}, {"componentType", componentType}, {"count", count}, {"type", type}});
  }

  Index push(const char* section, const Json& element) {
    json[section].push_back(element);
    return static_cast<Index>(json[section].size() - 1);
  }

  // A GLB by the letter of the specification, independent of the library's writer.
  Bytes glb() const {
    Json document = json;
    if (!binary.empty()) document["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    return glbOf(document.dump(), binary);
  }

  // The same as .gltf, with a data URI.
  std::string gltf() const {
    Json document = json;
    document["buffers"] = Json::array(
        {{{"byteLength", binary.size()}, {"uri", "data:application/octet-stream;base64," + encodeBase64(binary)}}});
    return document.dump();
  }

  static void word(Bytes& out, std::size_t value) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
  }

  static Bytes glbOf(std::string text, Bytes chunk) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    chunk.resize((chunk.size() + 3) / 4 * 4);
    Bytes out = {'g', 'l', 'T', 'F'};
    word(out, 2);
    word(out, 12 + 8 + text.size() + (chunk.empty() ? 0 : 8 + chunk.size()));
    word(out, text.size());
    out.insert(out.end(), {'J', 'S', 'O', 'N'});
    out.insert(out.end(), text.begin(), text.end());
    if (chunk.empty()) return out;
    word(out, chunk.size());
    out.insert(out.end(), {'B', 'I', 'N', 0});
    out.insert(out.end(), chunk.begin(), chunk.end());
    return out;
  }
};

inline Bytes pngBytes() {
  return {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 1, 2, 3};
}

// A square on two joints, with one of everything that limber looks at: skin, clip, morph target (sparse), camera,
// material, texture, image, interleaved attributes.
inline GltfBuilder everythingModel() {
  GltfBuilder model;
  // Positions and normals interleaved.
  const Index vertices =
      model.view<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 1, 1, 0, 0, 0, 1}, 24);
  Json position = {{"bufferView", vertices}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}};
  position["min"] = {0.0, 0.0, 0.0};
  position["max"] = {1.0, 1.0, 0.0};
  const Index positions = model.push("accessors", position);
  const Index normals = model.push(
      "accessors",
      {{"bufferView", vertices}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  const Index indices = model.accessor<std::uint16_t>({0, 1, 2, 2, 1, 3}, 5123, "SCALAR", 6);
  const Index joints = model.accessor<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, 5121, "VEC4", 4);
  const Index weights =
      model.accessor<float>({1, 0, 0, 0, .5f, .5f, 0, 0, .25f, .75f, 0, 0, 1, 0, 0, 0}, 5126, "VEC4", 4);
  std::vector<float> bind(32, 0.0f);
  for (std::size_t i = 0; i < 4; ++i) bind[5 * i] = bind[16 + 5 * i] = 1;
  const Index binds = model.accessor(bind, 5126, "MAT4", 2);
  const Index times = model.accessor<float>({0, 1}, 5126, "SCALAR", 2);
  const Index turns = model.accessor<float>({0, 0, 0, 1, 0, 0, 1, 0}, 5126, "VEC4", 2);
  const Index sparseIndices = model.view<std::uint8_t>({1, 3}), sparseValues = model.view<float>({1, 2, 3, 4, 5, 6});
  const Index morph = model.push("accessors", {{"componentType", 5126},
                                               {"count", 4},
                                               {"type", "VEC3"},
                                               {"sparse",
                                                {{"count", 2},
                                                 {"indices", {{"bufferView", sparseIndices}, {"componentType", 5121}}},
                                                 {"values", {{"bufferView", sparseValues}}}}}});
  const Index image = model.view(pngBytes());

  model.push("images", {{"bufferView", image}, {"mimeType", "image/png"}});
  model.push("samplers", Json::object());
  model.push("textures", {{"source", 0}, {"sampler", 0}});
  model.push("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  model.push("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}});
  model.push(
      "meshes",
      {{"name", "square"},
       {"primitives",
        Json::array({{{"attributes",
                       {{"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}},
                      {"indices", indices},
                      {"mode", 4},
                      {"material", 0},
                      {"targets", Json::array({{{"POSITION", morph}}})}}})}});
  model.push("nodes", {{"name", "root"}, {"children", {1, 3}}, {"translation", {0.0, 1.5, 0.0}}});
  model.push("nodes", {{"name", "tip"}, {"rotation", {0.0, 0.0, 0.0, 1.0}}, {"scale", {1.0, 1.0, 1.0}}});
  model.push("nodes", {{"name", "body"}, {"mesh", 0}, {"skin", 0}});
  model.push("nodes", {{"name", "eye"}, {"camera", 0}, {"extras", {{"note", "kept"}, {"large", 9007199254740993}}}});
  model.push("skins", {{"joints", {0, 1}}, {"skeleton", 0}, {"inverseBindMatrices", binds}});
  model.push("animations",
             {{"name", "turn"},
              {"samplers", Json::array({{{"input", times}, {"output", turns}}})},
              {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}})}});
  model.push("scenes", {{"nodes", {0, 2}}});
  model.json["scene"] = 0;
  return model;
}

}  // namespace limber::testing
