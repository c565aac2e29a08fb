#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/check_asset.h"
#include "limber/document/gltf/document_errors.h"
#include "limber/document/gltf/extensions.h"

namespace limber {

namespace {

// JOINTS_n of one primitive: 64 influences of a vertex. Programs write one or two.
constexpr std::size_t kMaxInfluenceSets = 16;
// Neither NaN nor infinite, told from the exponent's bits so that the loop stays simple enough to run on vectors.
bool allFinite(const std::uint8_t* data, std::size_t count) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  bool bad = false;
  for (std::size_t i = 0; i < count; ++i) bad |= (loadAs<std::uint32_t>(data + 4 * i) & kExponent) == kExponent;
  return !bad;
}

bool allFinite(const AccessorLayout& layout) {
  const std::size_t components = layout.info.components, count = layout.info.count;
  if (layout.info.type != ComponentType::kF32) return true;
  if (layout.sparse && !allFinite(layout.sparse->values, layout.sparse->count * components)) return false;
  if (layout.data == nullptr) return true;
  if (layout.packed()) return allFinite(layout.data, count * components);
  for (std::size_t i = 0; i < count; ++i) {
    if (!allFinite(layout.data + i * layout.stride, components)) return false;
  }
  return true;
}

bool isUnsigned(ComponentType type) {
  return type == ComponentType::kU8 || type == ComponentType::kU16 || type == ComponentType::kU32;
}

// The largest of an accessor's unsigned integers; 0 where it has none.
Index largest(const AccessorLayout& layout) {
  Index result = 0;
  const auto take = [&](const std::uint8_t* element) {
    for (std::size_t c = 0; c < layout.info.components; ++c) {
      const std::uint8_t* at = element + c * layout.componentBytes;
      const Index value = layout.componentBytes == 1   ? *at
                          : layout.componentBytes == 2 ? Index{loadAs<std::uint16_t>(at)}
                                                       : loadAs<std::uint32_t>(at);
      result = std::max(result, value);
    }
  };
  if (layout.data != nullptr) {
    for (std::size_t i = 0; i < layout.info.count; ++i) take(layout.data + i * layout.stride);
  }
  if (!layout.sparse) return result;
  for (std::size_t i = 0; i < layout.sparse->count; ++i) take(layout.sparse->values + i * layout.elementSize);
  return result;
}

class DataChecker {
 public:
  explicit DataChecker(const Asset& asset) : asset_(asset), document_(asset.document) {}

  void run() {
    checkBuffers();
    for (Index i = 0; i < document_.accessors.size(); ++i) layouts_.push_back(accessorLayout(asset_, i));
    finite_.assign(layouts_.size(), false);
    largest_.assign(layouts_.size(), std::nullopt);
    for (std::size_t m = 0; m < document_.meshes.size(); ++m) {
      const std::vector<gltf::Primitive>& primitives = document_.meshes[m].primitives;
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        const std::string location = fmt::format("meshes[{}].primitives[{}]", m, p);
        checkPrimitive(primitives[p], location);
        checkUnpackedSize(primitives[p], location);
      }
    }
    for (std::size_t i = 0; i < document_.skins.size(); ++i) checkSkin(document_.skins[i], fmt::format("skins[{}]", i));
    namedJoint_.assign(document_.meshes.size(), std::nullopt);
    usedJoint_.assign(document_.meshes.size(), std::nullopt);
    for (std::size_t i = 0; i < document_.nodes.size(); ++i) checkSkinnedNode(document_.nodes[i], i);
    for (std::size_t i = 0; i < document_.nodes.size(); ++i) checkInstancing(document_.nodes[i], i);
  }

 private:
  void checkBuffers() {
    const std::vector<gltf::Buffer>& buffers = document_.buffers;
    if (buffers.size() != asset_.buffers.size()) {
      failAt("buffers",
             fmt::format("has {} elements, but {} buffers are in memory", buffers.size(), asset_.buffers.size()));
    }
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      stored_ += buffers[i].byteLength;
      if (buffers[i].byteLength == asset_.buffers[i].bytes.size()) continue;
      failAt(fmt::format("buffers[{}]", i), "has not as many bytes as its byteLength");
    }
    for (Index i = 0; i < document_.bufferViews.size(); ++i) viewLayout(asset_, i);
  }

  // What readers of the primitive will ask memory and time for.
  void checkUnpackedSize(const gltf::Primitive& primitive, const std::string& where) {
    std::size_t sets = 0;
    const auto add = [&](Index accessor) {
      const AccessorInfo& info = layouts_[accessor].info;
      unpacked_ += std::uint64_t{info.count} * info.components * sizeof(float);
    };
    for (const auto& [name, accessor] : primitive.attributes) {
      add(accessor);
      if (name.starts_with("JOINTS_")) ++sets;
    }
    for (const auto& target : primitive.targets) {
      for (const auto& [name, accessor] : target) add(accessor);
    }
    if (primitive.indices) add(*primitive.indices);
    if (sets > kMaxInfluenceSets) {
      throw Error(ErrorCode::kLimit, fmt::format("has {} sets of weights, more than {}", sets, kMaxInfluenceSets),
                  where + ".attributes", "bind vertices to fewer joints");
    }
    if (unpacked_ <= read_bounds::kVertexData.of(stored_)) return;
    throw Error(
        ErrorCode::kLimit,
        fmt::format(
            "comes to more than {} MB of vertices, indices and blend shapes, which {} bytes of buffers do not explain",
            unpacked_ >> 20, stored_),
        where, "take blend shapes out, or do its meshes one by one");
  }

  void requireFinite(Index accessor, const std::string& user) {
    if (!finite_[accessor] && !allFinite(layouts_[accessor])) {
      failAt(user, fmt::format("accessor {} holds a number that is not finite", accessor));
    }
    finite_[accessor] = true;
  }

  Index largestOf(Index accessor) {
    if (!largest_[accessor]) largest_[accessor] = largest(layouts_[accessor]);
    return *largest_[accessor];
  }

  // Shapes common to a primitive's attributes and its morph targets. `tangent`: components of TANGENT, of which morph
  // targets leave out the handedness.
  static void checkShape(std::string_view name, const AccessorInfo& info, Index tangent, const std::string& location) {
    const auto require = [&](Index least, Index most, std::string_view shape) {
      if (info.components >= least && info.components <= most && info.type != ComponentType::kU32) return;
      failAt(location, fmt::format("must be of type {}, of floats or of integers of 8 or 16 bits", shape));
    };
    if (name == "NORMAL") {
      require(3, 3, "VEC3");
    } else if (name == "TANGENT") {
      require(tangent, tangent, tangent == 3 ? "VEC3" : "VEC4");
    } else if (name.starts_with("TEXCOORD_")) {
      require(2, 2, "VEC2");
    } else if (name.starts_with("COLOR_")) {
      require(3, 4, "VEC3 or VEC4");
    } else if (name == "POSITION" && (info.components != 3 || info.type == ComponentType::kU32)) {
      failAt(location, "positions must be of type VEC3");
    }
  }

  static void checkInfluences(std::string_view name, const AccessorInfo& info, const std::string& location) {
    if (name.starts_with("JOINTS_")) {
      if (info.components != 4 || !isUnsigned(info.type)) failAt(location, "joints must be four unsigned integers");
    } else if (name.starts_with("WEIGHTS_")) {
      const bool fraction = info.type == ComponentType::kF32 || (isUnsigned(info.type) && info.normalized);
      if (info.components != 4 || !fraction) failAt(location, "weights must be four floats or normalised integers");
    }
  }

  // Counts of all of a primitive's attributes and morph targets, which must agree.
  Index checkAttributes(const gltf::Primitive& primitive, const std::string& where) {
    std::optional<Index> count;
    const auto checked = [&](Index accessor, const std::string& location) -> const AccessorInfo& {
      requireElement(accessor, layouts_.size(), [&] { return location; });
      const AccessorInfo& info = layouts_[accessor].info;
      if (count.value_or(info.count) != info.count) {
        failAt(location, fmt::format("has {} elements where other attributes have {}", info.count, *count));
      }
      count = info.count;
      return info;
    };
    for (const auto& [name, accessor] : primitive.attributes) {
      const std::string location = fmt::format("{}.attributes.{}", where, shortened(name));
      const AccessorInfo& info = checked(accessor, location);
      checkShape(name, info, 4, location);
      checkInfluences(name, info, location);
      if (name == "POSITION") requireFinite(accessor, location);
    }
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
      for (const auto& [name, accessor] : primitive.targets[t]) {
        const std::string location = fmt::format("{}.targets[{}].{}", where, t, shortened(name));
        checkShape(name, checked(accessor, location), 3, location);
      }
    }
    return count.value_or(0);
  }

  void checkPrimitive(const gltf::Primitive& primitive, const std::string& where) {
    const Index vertexCount = checkAttributes(primitive, where);
    requireElement(primitive.material, document_.materials.size(), [&] { return where + ".material"; });
    requireElement(primitive.mode, gltf::kTriangleFan + 1, [&] { return where + ".mode"; });
    if (!primitive.indices) return;
    const auto location = [&] { return where + ".indices"; };
    requireElement(primitive.indices, layouts_.size(), location);
    const AccessorInfo& info = layouts_[*primitive.indices].info;
    if (info.components != 1 || !isUnsigned(info.type)) failAt(location(), "indices must be unsigned integers");
    if (info.count > 0 && largestOf(*primitive.indices) >= vertexCount) {
      failAt(location(), fmt::format("index {} is beyond the {} vertices", largestOf(*primitive.indices), vertexCount));
    }
  }

  void checkSkin(const gltf::Skin& skin, const std::string& where) {
    const std::string joints = where + ".joints";
    if (skin.joints.empty()) failAt(joints, "has no joint");
    for (std::size_t i = 0; i < skin.joints.size(); ++i) {
      requireElement(skin.joints[i], document_.nodes.size(), [&] { return fmt::format("{}[{}]", joints, i); });
    }
    std::vector<Index> sorted = skin.joints;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) failAt(joints, fmt::format("has node {} twice", *twice));
    requireElement(skin.skeleton, document_.nodes.size(), [&] { return where + ".skeleton"; });

    if (!skin.inverseBindMatrices) return;
    const std::string location = where + ".inverseBindMatrices";
    requireElement(skin.inverseBindMatrices, layouts_.size(), [&] { return location; });
    const AccessorInfo& info = layouts_[*skin.inverseBindMatrices].info;
    if (info.components != 16 || info.type != ComponentType::kF32) failAt(location, "must be matrices of floats");
    if (info.count < skin.joints.size()) {
      failAt(location, fmt::format("has {} matrices for {} joints", info.count, skin.joints.size()));
    }
    requireFinite(*skin.inverseBindMatrices, location);
  }

  // The largest joint number that a primitive's vertices name.
  Index largestJoint(const gltf::Primitive& primitive) {
    Index result = 0;
    for (const auto& [name, accessor] : primitive.attributes) {
      if (name.starts_with("JOINTS_")) result = std::max(result, largestOf(accessor));
    }
    return result;
  }

  // The same of those whose weight is not zero: unused slots may hold anything.
  Index largestUsedJoint(const gltf::Primitive& primitive) {
    Index result = 0;
    for (int set = 0;; ++set) {
      const std::optional<Index> joints = primitive.attributes.find(fmt::format("JOINTS_{}", set));
      const std::optional<Index> weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", set));
      if (!joints || !weights) return result;
      const std::vector<Index> joint = readIndices(asset_, *joints);
      const std::vector<float> weight = readFloats(asset_, *weights);
      for (std::size_t i = 0; i < joint.size(); ++i) {
        if (weight[i] > 0) result = std::max(result, joint[i]);
      }
    }
  }

  template <typename OfPrimitive>
  static Index overPrimitives(std::optional<Index>& known, const gltf::Mesh& mesh, const OfPrimitive& ofPrimitive) {
    if (!known) {
      known = 0;
      for (const gltf::Primitive& primitive : mesh.primitives) known = std::max(*known, ofPrimitive(primitive));
    }
    return *known;
  }

  void checkSkinnedNode(const gltf::Node& node, std::size_t index) {
    if (!node.mesh || !node.skin) return;
    const gltf::Mesh& mesh = document_.meshes[*node.mesh];
    const std::size_t jointCount = document_.skins[*node.skin].joints.size();
    const auto named = [&](const gltf::Primitive& primitive) { return largestJoint(primitive); };
    if (overPrimitives(namedJoint_[*node.mesh], mesh, named) < jointCount) return;
    const auto used = [&](const gltf::Primitive& primitive) { return largestUsedJoint(primitive); };
    const Index joint = overPrimitives(usedJoint_[*node.mesh], mesh, used);
    if (joint >= jointCount) {
      failAt(fmt::format("nodes[{}].mesh", index),
             fmt::format("has a vertex on joint {}, but the skin has {} joints", joint, jointCount));
    }
  }

  // EXT_mesh_gpu_instancing: a transform per instance. Attributes of other names are the application's own.
  void checkInstancing(const gltf::Node& node, std::size_t index) {
    if (extensionOf(node, kInstancingName) == nullptr) return;
    const std::string where = fmt::format("nodes[{}]", index);
    std::optional<Index> count;
    for (const auto& [name, accessor] : instancingOf(node, where)) {
      const std::string location =
          fmt::format("{}.extensions.{}.attributes.{}", where, kInstancingName, shortened(name));
      requireElement(accessor, layouts_.size(), [&] { return location; });
      const AccessorInfo& info = layouts_[accessor].info;
      const bool rotation = name == "ROTATION";
      if (!rotation && name != "TRANSLATION" && name != "SCALE") continue;
      if (info.components != (rotation ? 4u : 3u)) {
        failAt(location, fmt::format("must be of type {}", rotation ? "VEC4" : "VEC3"));
      }
      if (!count) count = info.count;
      if (info.count != *count) {
        failAt(location, fmt::format("has {} elements where other attributes have {}", info.count, *count));
      }
    }
  }

  const Asset& asset_;
  const gltf::Document& document_;
  std::vector<AccessorLayout> layouts_;                       // #accessors
  std::uint64_t stored_ = 0;                                  // bytes, of all buffers
  std::uint64_t unpacked_ = 0;                                // bytes, of the primitives so far
  std::vector<bool> finite_;                                  // #accessors: checked and found so
  std::vector<std::optional<Index>> largest_;                 // #accessors, where it was asked for
  std::vector<std::optional<Index>> namedJoint_, usedJoint_;  // #meshes, where it was asked for
};

}  // namespace

void checkData(const Asset& asset) {
  DataChecker(asset).run();
}

}  // namespace limber
