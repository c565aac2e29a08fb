#include "limber/asset/accessor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/accessor_layout.h"

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

std::string accessorPath(Index accessor) {
  return fmt::format("accessors[{}]", accessor);
}

const char* typeName(Index components) {
  switch (components) {
    case 1:
      return "SCALAR";
    case 2:
      return "VEC2";
    case 3:
      return "VEC3";
    case 4:
      return "VEC4";
    case 9:
      return "MAT3";
    case 16:
      return "MAT4";
    default:
      throw Error(ErrorCode::kBadArgument, fmt::format("no accessor has {} components", components));
  }
}

Json& arrayMember(Asset& asset, const char* key) {
  Json& array = asset.json()[key];
  if (array.is_null()) array = Json::array();
  return array;
}

// Whole numbers stay so in the text.
Json boundValues(ComponentType type, const std::vector<double>& values) {
  if (type == ComponentType::kF32) return values;
  return std::vector<std::int64_t>(values.begin(), values.end());
}

// The buffer that bytes are added to: the binary chunk, else the one made here the last time.
std::size_t growingBuffer(Asset& asset) {
  const auto found = std::find_if(asset.buffers.begin(), asset.buffers.end(),
                                  [](const Asset::Buffer& buffer) { return buffer.uri.empty(); });
  if (found != asset.buffers.end()) return static_cast<std::size_t>(found - asset.buffers.begin());
  arrayMember(asset, "buffers").push_back(Json::object());
  asset.buffers.emplace_back();
  return asset.buffers.size() - 1;
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
      throw Error(ErrorCode::kBadData, "must be of an unsigned component type", accessorPath(accessor));
    }
  });
  return values;
}

Index addBufferView(Asset& asset, ByteSpan bytes, int target) {
  const std::size_t buffer = growingBuffer(asset);
  Bytes& storage = asset.buffers[buffer].bytes;
  storage.resize((storage.size() + 3) / 4 * 4);
  Json view = {{"buffer", buffer}, {"byteOffset", storage.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  storage.insert(storage.end(), bytes.begin(), bytes.end());
  asset.json()["buffers"][buffer]["byteLength"] = storage.size();
  Json& views = arrayMember(asset, "bufferViews");
  views.push_back(std::move(view));
  return static_cast<Index>(views.size() - 1);
}

Index addAccessor(Asset& asset, const AccessorInfo& info, ByteSpan bytes, int target) {
  if (bytes.size() != std::size_t{info.count} * info.components * componentSize(info.type)) {
    throw Error(ErrorCode::kBadArgument, "the bytes of a new accessor do not fit its count and type");
  }
  Json accessor = {{"bufferView", addBufferView(asset, bytes, target)},
                   {"componentType", static_cast<int>(info.type)},
                   {"count", info.count},
                   {"type", typeName(info.components)}};
  if (info.normalized) accessor["normalized"] = true;
  Json& accessors = arrayMember(asset, "accessors");
  accessors.push_back(std::move(accessor));
  return static_cast<Index>(accessors.size() - 1);
}

Index addFloatAccessor(Asset& asset, std::span<const float> values, Index components, int target, bool withMinMax) {
  if (components == 0 || values.size() % components != 0) {
    throw Error(ErrorCode::kBadArgument, "the values of a new accessor do not fit its components");
  }
  const AccessorInfo info{static_cast<Index>(values.size() / components), components, ComponentType::kF32, false};
  const ByteSpan bytes(reinterpret_cast<const std::uint8_t*>(values.data()), values.size_bytes());
  const Index index = addAccessor(asset, info, bytes, target);
  if (withMinMax) setBounds(asset, index);
  return index;
}

void setBounds(Asset& asset, Index index) {
  const AccessorLayout layout = accessorLayout(asset, index);
  const std::size_t components = layout.info.components;
  Json& accessor = asset.json()["accessors"][index];
  accessor.erase("min");
  accessor.erase("max");
  if (layout.info.count == 0) return;

  std::vector<double> values(std::size_t{layout.info.count} * components);
  withComponentType(layout.info.type, [&](auto component) {
    using T = decltype(component);
    readElements<T>(
        layout, [](T value) { return static_cast<double>(value); }, values);
  });
  std::vector<double> low(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(components)), high = low;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) return;  // JSON has no word for it
    low[i % components] = std::min(low[i % components], values[i]);
    high[i % components] = std::max(high[i % components], values[i]);
  }
  accessor["min"] = boundValues(layout.info.type, low);
  accessor["max"] = boundValues(layout.info.type, high);
}

}  // namespace limber
