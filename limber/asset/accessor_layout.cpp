#include "limber/asset/accessor_layout.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

// An accessor without data stands for zeros, as many as it likes; what such a file may ask for is held to this or to
// the size of its buffers, whichever is more.
constexpr std::size_t kFreeZeros = 4096;

// glTF allows 252. Others still read well, as long as products of sizes fit 64 bits.
constexpr std::size_t kMaxStride = 65536;

ComponentType readComponentType(const JsonView& owner) {
  const JsonView type = owner.member("componentType");
  const std::size_t code = type.asCount();
  constexpr std::array<std::size_t, 6> kCodes = {5120, 5121, 5122, 5123, 5125, 5126};
  if (std::find(kCodes.begin(), kCodes.end(), code) == kCodes.end()) {
    type.fail(fmt::format("is {}, which is no component type", code));
  }
  return static_cast<ComponentType>(code);
}

void readShape(const JsonView& accessor, AccessorLayout& layout) {
  struct Shape {
    std::string_view name;
    std::size_t columns, rows;
  };
  constexpr std::array<Shape, 7> kShapes = {{{"SCALAR", 1, 1},
                                             {"VEC2", 1, 2},
                                             {"VEC3", 1, 3},
                                             {"VEC4", 1, 4},
                                             {"MAT2", 2, 2},
                                             {"MAT3", 3, 3},
                                             {"MAT4", 4, 4}}};
  const std::string_view name = accessor.text("type");
  const auto* shape = std::find_if(kShapes.begin(), kShapes.end(), [&](const Shape& s) { return s.name == name; });
  if (shape == kShapes.end()) accessor.member("type").fail("is missing or no element type");

  const std::size_t components = shape->columns * shape->rows;
  const std::size_t columnSize = shape->rows * layout.componentBytes;
  const std::size_t columnStride = (columnSize + 3) / 4 * 4;
  layout.info.components = static_cast<Index>(components);
  const bool padded = shape->columns > 1 && columnStride != columnSize;
  layout.columns = padded ? shape->columns : 1;
  layout.rows = padded ? shape->rows : components;
  layout.columnStride = padded ? columnStride : components * layout.componentBytes;
  layout.elementSize = layout.columns * layout.columnStride;
}

ViewLayout viewOf(const Asset& asset, const JsonView& owner) {
  const JsonView views = JsonView(asset).array("bufferViews");
  return viewLayout(asset, views[owner.requireIndex("bufferView", views.size())]);
}

// Where `owner`'s data begin in its view, checked to be `size` bytes that suit components of `alignment` bytes.
const std::uint8_t* dataOf(const ViewLayout& view, const JsonView& owner, std::size_t size, std::size_t alignment) {
  const std::size_t offset = owner.count("byteOffset").value_or(0);
  if (offset > view.bytes.size() || size > view.bytes.size() - offset) {
    owner.fail(
        fmt::format("needs {} bytes from byte {} on, but its buffer view has {}", size, offset, view.bytes.size()));
  }
  if ((view.offset + offset) % alignment != 0 || view.stride % alignment != 0) {
    owner.fail(fmt::format("its data are not aligned to {} bytes", alignment));
  }
  return view.bytes.data() + offset;
}

void readData(const Asset& asset, const JsonView& accessor, AccessorLayout& layout) {
  const ViewLayout view = viewOf(asset, accessor);
  if (view.stride != 0) {
    if (view.stride < layout.elementSize) accessor.fail("has elements larger than its buffer view's byteStride");
    if (view.stride > kMaxStride) accessor.fail(fmt::format("has a byteStride above {}", kMaxStride));
    layout.stride = view.stride;
  }
  const std::size_t count = layout.info.count;
  const std::size_t size = count == 0 ? 0 : (count - 1) * layout.stride + layout.usedSize();
  layout.data = dataOf(view, accessor, size, layout.componentBytes);
}

void checkZeroCount(const Asset& asset, const JsonView& accessor, Index count) {
  std::size_t allowed = kFreeZeros;
  for (const Asset::Buffer& buffer : asset.buffers) {
    if (allowed >= count) break;
    allowed = std::max(allowed, buffer.bytes.size());
  }
  if (count > allowed) {
    throw Error(ErrorCode::kLimit, fmt::format("has {} elements without data, more than the file's size allows", count),
                accessor.path());
  }
}

SparseLayout readSparse(const Asset& asset, const JsonView& sparse, const AccessorLayout& layout) {
  SparseLayout result;
  const std::size_t count = sparse.member("count").asCount();
  if (count > layout.info.count) sparse.fail("has more substitutions than the accessor has elements");
  result.count = static_cast<Index>(count);
  const JsonView indices = sparse.object("indices"), values = sparse.object("values");
  result.indexType = readComponentType(indices);
  if (result.indexType != ComponentType::kU8 && result.indexType != ComponentType::kU16 &&
      result.indexType != ComponentType::kU32) {
    indices.fail("must be of an unsigned component type");
  }
  const std::size_t indexSize = componentSize(result.indexType);
  result.indices = dataOf(viewOf(asset, indices), indices, count * indexSize, indexSize);
  const std::size_t size = count == 0 ? 0 : (count - 1) * layout.elementSize + layout.usedSize();
  result.values = dataOf(viewOf(asset, values), values, size, layout.componentBytes);
  for (std::size_t i = 0; i < count; ++i) {
    if (result.index(i) >= layout.info.count || (i > 0 && result.index(i) <= result.index(i - 1))) {
      indices.fail("must be in rising order and below the accessor's count");
    }
  }
  return result;
}

}  // namespace

std::size_t componentSize(ComponentType type) {
  return withComponentType(type, [](auto component) { return sizeof(component); });
}

Index SparseLayout::index(std::size_t i) const {
  if (indexType == ComponentType::kU8) return indices[i];
  if (indexType == ComponentType::kU16) return loadAs<std::uint16_t>(indices + 2 * i);
  return loadAs<std::uint32_t>(indices + 4 * i);
}

ViewLayout viewLayout(const Asset& asset, const JsonView& view) {
  const Index buffer = view.requireIndex("buffer", asset.buffers.size());
  const Bytes& bytes = asset.buffers[buffer].bytes;
  const std::size_t offset = view.count("byteOffset").value_or(0);
  const std::size_t length = view.member("byteLength").asCount();
  if (offset > bytes.size() || length > bytes.size() - offset) {
    view.fail(fmt::format("needs {} bytes from byte {} on, but its buffer has {}", length, offset, bytes.size()));
  }
  return {ByteSpan(bytes).subspan(offset, length), offset, view.count("byteStride").value_or(0)};
}

AccessorLayout accessorShape(const JsonView& accessor) {
  AccessorLayout layout;
  layout.info.type = readComponentType(accessor);
  layout.info.normalized = accessor.flag("normalized", false);
  const std::size_t count = accessor.member("count").asCount();
  if (count >= kNoIndex) throw Error(ErrorCode::kLimit, "has more elements than 32 bits count", accessor.path());
  layout.info.count = static_cast<Index>(count);
  layout.componentBytes = componentSize(layout.info.type);
  readShape(accessor, layout);
  layout.stride = layout.elementSize;
  return layout;
}

AccessorLayout accessorLayout(const Asset& asset, Index index) {
  const JsonView accessor = JsonView(asset).array("accessors")[index];
  AccessorLayout layout = accessorShape(accessor);
  if (accessor.member("bufferView").exists()) {
    readData(asset, accessor, layout);
  } else {
    checkZeroCount(asset, accessor, layout.info.count);
  }
  if (const JsonView sparse = accessor.object("sparse"); sparse.exists()) {
    layout.sparse = readSparse(asset, sparse, layout);
  }
  return layout;
}

}  // namespace limber
