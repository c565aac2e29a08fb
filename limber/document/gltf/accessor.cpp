#include "limber/document/gltf/accessor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/document_errors.h"

namespace limber {

namespace {

// One component as a float. Normalised signed integers have two codes for -1.
template <typename T>
float toFloat(T value, bool normalized) {
  if constexpr (std::is_same_v<T, float>) {
    return value;
  } else {
    if (!normalized) return static_cast<float>(value);
    constexpr double kMax = std::numeric_limits<T>::max();
    return static_cast<float>(std::max(static_cast<double>(value) / kMax, -1.0));
  }
}

gltf::ElementType elementType(Index components) {
  switch (components) {
    case 1:
      return gltf::ElementType::kScalar;
    case 2:
      return gltf::ElementType::kVec2;
    case 3:
      return gltf::ElementType::kVec3;
    case 4:
      return gltf::ElementType::kVec4;
    case 9:
      return gltf::ElementType::kMat3;
    case 16:
      return gltf::ElementType::kMat4;
    default:
      throw Error(ErrorCode::kBadArgument, fmt::format("no accessor has {} components", components));
  }
}

// The buffer that bytes are added to: the binary chunk, else the one made here the last time.
Index growingBuffer(Asset& asset) {
  const auto found = std::find_if(asset.buffers.begin(), asset.buffers.end(),
                                  [](const Asset::Buffer& buffer) { return buffer.uri.empty(); });
  if (found != asset.buffers.end()) return static_cast<Index>(found - asset.buffers.begin());
  asset.buffers.emplace_back();
  return addElement(asset.document.buffers, gltf::Buffer());
}

}  // namespace

AccessorInfo accessorInfo(const Asset& asset, Index accessor) {
  return accessorLayout(asset, accessor).info;
}

std::vector<float> readFloats(const Asset& asset, Index accessor) {
  const AccessorLayout layout = accessorLayout(asset, accessor);
  std::vector<float> values(std::size_t{layout.info.count} * layout.info.components);
  const bool normalized = layout.info.normalized;
  withComponentType(layout.info.type, [&](auto component) {
    using T = decltype(component);
    readElements<T>(
        layout, [normalized](T value) { return toFloat(value, normalized); }, values);
  });
  return values;
}

std::vector<Index> readIndices(const Asset& asset, Index accessor) {
  const AccessorLayout layout = accessorLayout(asset, accessor);
  std::vector<Index> values(std::size_t{layout.info.count} * layout.info.components);
  withComponentType(layout.info.type, [&](auto component) {
    using T = decltype(component);
    if constexpr (std::is_unsigned_v<T>) {
      readElements<T>(
          layout, [](T value) { return Index{value}; }, values);
    } else {
      throw Error(ErrorCode::kBadData, "must be of an unsigned component type", accessorLocation(accessor));
    }
  });
  return values;
}

Index addBufferView(Asset& asset, ByteSpan bytes, Index target) {
  const Index buffer = growingBuffer(asset);
  Bytes& storage = asset.buffers[buffer].bytes;
  storage.resize((storage.size() + 3) / 4 * 4);
  gltf::BufferView view;
  view.buffer = buffer;
  view.byteOffset = storage.size();
  view.byteLength = bytes.size();
  view.target = target;
  storage.insert(storage.end(), bytes.begin(), bytes.end());
  asset.document.buffers[buffer].byteLength = storage.size();
  return addElement(asset.document.bufferViews, std::move(view));
}

Index addAccessor(Asset& asset, const AccessorInfo& info, ByteSpan bytes, Index target) {
  if (bytes.size() != std::size_t{info.count} * info.components * componentSize(info.type)) {
    throw Error(ErrorCode::kBadArgument, "the bytes of a new accessor do not fit its count and type");
  }
  gltf::Accessor accessor;
  accessor.type = elementType(info.components);
  accessor.componentType = info.type;
  accessor.normalized = info.normalized;
  accessor.count = info.count;
  accessor.bufferView = addBufferView(asset, bytes, target);
  return addElement(asset.document.accessors, std::move(accessor));
}

Index addFloatAccessor(Asset& asset, std::span<const float> values, Index components, Index target, bool withMinMax) {
  if (components == 0 || values.size() % components != 0) {
    throw Error(ErrorCode::kBadArgument, "the values of a new accessor do not fit its components");
  }
  const AccessorInfo info{static_cast<Index>(values.size() / components), components, ComponentType::kF32, false};
  const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes());
  const Index index = addAccessor(asset, info, bytes, target);
  if (withMinMax) setBounds(asset, index);
  return index;
}

void appendMatrix(const Affine& affine, std::vector<float>& values) {
  for (int i = 0; i < 16; ++i) values.push_back(static_cast<float>(affine.matrix()(i % 4, i / 4)));
}

void setBounds(Asset& asset, Index index) {
  const AccessorLayout layout = accessorLayout(asset, index);
  const std::size_t components = layout.info.components;
  gltf::Accessor& accessor = asset.document.accessors[index];
  accessor.min.clear();
  accessor.max.clear();
  if (layout.info.count == 0) return;

  std::vector<double> low, high, values(components);
  bool isFinite = true;
  withComponentType(layout.info.type, [&](auto component) {
    using T = decltype(component);
    forEachElement(layout, [&](const std::uint8_t* at) {
      std::fill(values.begin(), values.end(), 0.0);
      if (at != nullptr)
        readElement<T>(
            layout, at, [](T value) { return static_cast<double>(value); }, values.data());
      if (low.empty()) low = high = values;
      for (std::size_t c = 0; c < components; ++c) {
        isFinite = isFinite && std::isfinite(values[c]);
        low[c] = std::min(low[c], values[c]);
        high[c] = std::max(high[c], values[c]);
      }
    });
  });
  if (!isFinite) return;  // JSON has no word for it
  accessor.min = std::move(low);
  accessor.max = std::move(high);
}

}  // namespace limber
