#include <algorithm>
#include <optional>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor_layout.h"
#include "limber/asset/check_asset.h"

namespace limber {

namespace {

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
  DataChecker(const Asset& asset, const Sections& sections) : asset_(asset), sections_(sections) {}

  void run() {
    checkBuffers();
    for (std::size_t i = 0; i < sections_.accessors.size(); ++i) {
      layouts_.push_back(accessorLayout(asset_, static_cast<Index>(i)));
    }
    finite_.assign(layouts_.size(), false);
    largest_.assign(layouts_.size(), std::nullopt);
    for (std::size_t i = 0; i < sections_.meshes.size(); ++i) checkMesh(sections_.meshes[i]);
    for (std::size_t i = 0; i < sections_.skins.size(); ++i) checkSkin(sections_.skins[i]);
    namedJoint_.assign(sections_.meshes.size(), std::nullopt);
    usedJoint_.assign(sections_.meshes.size(), std::nullopt);
    for (std::size_t i = 0; i < sections_.nodes.size(); ++i) checkSkinnedNode(sections_.nodes[i]);
    for (std::size_t i = 0; i < sections_.nodes.size(); ++i) checkInstancing(sections_.nodes[i]);
  }

 private:
  void checkBuffers() {
    if (sections_.buffers.size() != asset_.buffers.size()) {
      sections_.buffers.fail(fmt::format("has {} elements, but {} buffers are in memory", sections_.buffers.size(),
                                         asset_.buffers.size()));
    }
    for (std::size_t i = 0; i < asset_.buffers.size(); ++i) {
      const std::size_t length = sections_.buffers[i].member("byteLength").asCount();
      if (length != asset_.buffers[i].bytes.size())
        sections_.buffers[i].fail("has not as many bytes as its byteLength");
    }
    for (std::size_t i = 0; i < sections_.bufferViews.size(); ++i) viewLayout(asset_, sections_.bufferViews[i]);
  }

  void requireFinite(Index accessor, const JsonView& user) {
    if (!finite_[accessor] && !allFinite(layouts_[accessor])) {
      user.fail(fmt::format("accessor {} holds a number that is not finite", accessor));
    }
    finite_[accessor] = true;
  }

  Index largestOf(Index accessor) {
    if (!largest_[accessor]) largest_[accessor] = largest(layouts_[accessor]);
    return *largest_[accessor];
  }

  // Shapes that a primitive's attributes and its morph targets share. `tangent`: components of TANGENT, of which morph
  // targets leave out the handedness.
  void checkShape(std::string_view name, const JsonView& attribute, const AccessorInfo& info, Index tangent) {
    const auto startsWith = [&](std::string_view prefix) { return name.substr(0, prefix.size()) == prefix; };
    const auto require = [&](Index least, Index most, std::string_view shape) {
      if (info.components >= least && info.components <= most && info.type != ComponentType::kU32) return;
      attribute.fail(fmt::format("must be of type {}, of floats or of integers of 8 or 16 bits", shape));
    };
    if (name == "NORMAL") {
      require(3, 3, "VEC3");
    } else if (name == "TANGENT") {
      require(tangent, tangent, tangent == 3 ? "VEC3" : "VEC4");
    } else if (startsWith("TEXCOORD_")) {
      require(2, 2, "VEC2");
    } else if (startsWith("COLOR_")) {
      require(3, 4, "VEC3 or VEC4");
    }
  }

  void checkAttribute(std::string_view name, const JsonView& attribute, const AccessorInfo& info) {
    const auto startsWith = [&](std::string_view prefix) { return name.substr(0, prefix.size()) == prefix; };
    checkShape(name, attribute, info, 4);
    if (name == "POSITION") {
      if (info.components != 3 || info.type == ComponentType::kU32) attribute.fail("positions must be of type VEC3");
      requireFinite(attribute.asIndex(layouts_.size()), attribute);
    } else if (startsWith("JOINTS_")) {
      if (info.components != 4 || !isUnsigned(info.type)) attribute.fail("joints must be four unsigned integers");
    } else if (startsWith("WEIGHTS_")) {
      const bool fraction = info.type == ComponentType::kF32 || (isUnsigned(info.type) && info.normalized);
      if (info.components != 4 || !fraction) attribute.fail("weights must be four floats or normalised integers");
    }
  }

  // Counts of all of a primitive's attributes and morph targets, which must agree.
  Index checkAttributes(const JsonView& primitive) {
    const JsonView attributes = primitive.object("attributes");
    if (!attributes.exists()) attributes.fail("is missing");
    std::optional<Index> count;
    const auto checkCount = [&](const JsonView& attribute) {
      const AccessorInfo& info = layouts_[attribute.asIndex(layouts_.size())].info;
      if (!count) count = info.count;
      if (info.count != *count) {
        attribute.fail(fmt::format("has {} elements where other attributes have {}", info.count, *count));
      }
    };
    attributes.forEachMember([&](std::string_view name, const JsonView& attribute) {
      checkCount(attribute);
      checkAttribute(name, attribute, layouts_[attribute.asIndex(layouts_.size())].info);
    });
    const JsonView targets = primitive.array("targets");
    for (std::size_t i = 0; i < targets.size(); ++i) {
      targets[i].forEachMember([&](std::string_view name, const JsonView& attribute) {
        checkCount(attribute);
        const AccessorInfo& info = layouts_[attribute.asIndex(layouts_.size())].info;
        if (name == "POSITION" && (info.components != 3 || info.type == ComponentType::kU32)) {
          attribute.fail("positions must be of type VEC3");
        }
        checkShape(name, attribute, info, 3);
      });
    }
    return count.value_or(0);
  }

  void checkPrimitive(const JsonView& primitive) {
    const Index vertexCount = checkAttributes(primitive);
    primitive.index("material", sections_.materials.size());
    primitive.index("mode", 7);
    primitive.object("extensions");
    const std::optional<Index> indices = primitive.index("indices", layouts_.size());
    if (!indices) return;
    const AccessorInfo& info = layouts_[*indices].info;
    const JsonView place = primitive.member("indices");
    if (info.components != 1 || !isUnsigned(info.type)) place.fail("indices must be unsigned integers");
    if (info.count > 0 && largestOf(*indices) >= vertexCount) {
      place.fail(fmt::format("index {} is beyond the {} vertices", largestOf(*indices), vertexCount));
    }
  }

  void checkMesh(const JsonView& mesh) {
    const JsonView primitives = mesh.array("primitives");
    if (!primitives.exists()) primitives.fail("is missing");
    for (std::size_t i = 0; i < primitives.size(); ++i) checkPrimitive(primitives[i]);
  }

  void checkSkin(const JsonView& skin) {
    const JsonView joints = skin.array("joints");
    if (joints.size() == 0) joints.fail("has no joint");
    std::vector<Index> sorted;
    for (std::size_t i = 0; i < joints.size(); ++i) sorted.push_back(joints[i].asIndex(sections_.nodes.size()));
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) joints.fail(fmt::format("has node {} twice", *twice));
    skin.index("skeleton", sections_.nodes.size());

    const std::optional<Index> bind = skin.index("inverseBindMatrices", layouts_.size());
    if (!bind) return;
    const JsonView place = skin.member("inverseBindMatrices");
    const AccessorInfo& info = layouts_[*bind].info;
    if (info.components != 16 || info.type != ComponentType::kF32) place.fail("must be matrices of floats");
    if (info.count < joints.size()) {
      place.fail(fmt::format("has {} matrices for {} joints", info.count, joints.size()));
    }
    requireFinite(*bind, place);
  }

  // The largest joint number that a primitive's vertices name.
  Index largestJoint(const JsonView& primitive) {
    Index result = 0;
    primitive.object("attributes").forEachMember([&](std::string_view name, const JsonView& attribute) {
      if (name.substr(0, 7) == "JOINTS_") result = std::max(result, largestOf(attribute.asIndex(layouts_.size())));
    });
    return result;
  }

  // The same of those whose weight is not zero: unused slots may hold anything.
  Index largestUsedJoint(const JsonView& primitive) {
    Index result = 0;
    const JsonView attributes = primitive.object("attributes");
    for (int set = 0;; ++set) {
      const std::string jointsKey = fmt::format("JOINTS_{}", set), weightsKey = fmt::format("WEIGHTS_{}", set);
      const std::optional<Index> joints = attributes.index(jointsKey, layouts_.size());
      const std::optional<Index> weights = attributes.index(weightsKey, layouts_.size());
      if (!joints || !weights) return result;
      const std::vector<Index> joint = readIndices(asset_, *joints);
      const std::vector<float> weight = readFloats(asset_, *weights);
      for (std::size_t i = 0; i < joint.size(); ++i) {
        if (weight[i] > 0) result = std::max(result, joint[i]);
      }
    }
  }

  template <typename OfPrimitive>
  Index overPrimitives(std::optional<Index>& known, const JsonView& mesh, const OfPrimitive& ofPrimitive) {
    if (!known) {
      known = 0;
      const JsonView primitives = mesh.array("primitives");
      for (std::size_t i = 0; i < primitives.size(); ++i) known = std::max(*known, ofPrimitive(primitives[i]));
    }
    return *known;
  }

  void checkSkinnedNode(const JsonView& node) {
    const std::optional<Index> index = node.index("mesh", sections_.meshes.size());
    const std::optional<Index> skin = node.index("skin", sections_.skins.size());
    if (!index || !skin) return;
    const JsonView mesh = sections_.meshes[*index];
    const std::size_t jointCount = sections_.skins[*skin].array("joints").size();
    const auto named = [&](const JsonView& primitive) { return largestJoint(primitive); };
    if (overPrimitives(namedJoint_[*index], mesh, named) < jointCount) return;
    const auto used = [&](const JsonView& primitive) { return largestUsedJoint(primitive); };
    const Index joint = overPrimitives(usedJoint_[*index], mesh, used);
    if (joint >= jointCount) {
      node.member("mesh").fail(fmt::format("has a vertex on joint {}, but the skin has {} joints", joint, jointCount));
    }
  }

  // EXT_mesh_gpu_instancing: a transform per instance. Attributes of other names are the application's own.
  void checkInstancing(const JsonView& node) {
    const JsonView attributes = node.object("extensions").object("EXT_mesh_gpu_instancing").object("attributes");
    std::optional<Index> count;
    attributes.forEachMember([&](std::string_view name, const JsonView& attribute) {
      const AccessorInfo& info = layouts_[attribute.asIndex(layouts_.size())].info;
      const bool rotation = name == "ROTATION";
      if (!rotation && name != "TRANSLATION" && name != "SCALE") return;
      if (info.components != (rotation ? 4u : 3u)) {
        attribute.fail(fmt::format("must be of type {}", rotation ? "VEC4" : "VEC3"));
      }
      if (!count) count = info.count;
      if (info.count != *count) {
        attribute.fail(fmt::format("has {} elements where other attributes have {}", info.count, *count));
      }
    });
  }

  const Asset& asset_;
  const Sections& sections_;
  std::vector<AccessorLayout> layouts_;                       // #accessors
  std::vector<bool> finite_;                                  // #accessors: checked and found so
  std::vector<std::optional<Index>> largest_;                 // #accessors, where it was asked for
  std::vector<std::optional<Index>> namedJoint_, usedJoint_;  // #meshes, where it was asked for
};

}  // namespace

void checkData(const Asset& asset, const Sections& sections) {
  DataChecker(asset, sections).run();
}

}  // namespace limber
