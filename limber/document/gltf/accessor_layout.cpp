#include "limber/document/gltf/accessor_layout.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/core/file/read_bounds.h"
#include "limber/document/gltf/document_errors.h"

namespace limber {

namespace {

// glTF allows 252. Others still read well: products of sizes are taken in 64 bits, in WebAssembly too.
constexpr std::size_t kMaxStride = 65536;

// Numbers of rows and columns of each ElementType.
struct Shape {
  std::size_t columns, rows;
};
constexpr std::array<Shape, 7> kShapes = {{{1, 1}, {1, 2}, {1, 3}, {1, 4}, {2, 2}, {3, 3}, {4, 4}}};

void setShape(gltf::ElementType type, AccessorLayout& layout) {
  const Shape shape = kShapes[static_cast<std::size_t>(type)];
  const std::size_t components = shape.columns * shape.rows;
  const std::size_t columnSize = shape.rows * layout.componentBytes;
  const std::size_t columnStride = (columnSize + 3) / 4 * 4;
  layout.info.components = static_cast<Index>(components);
  const bool padded = shape.columns > 1 && columnStride != columnSize;
  layout.columns = padded ? shape.columns : 1;
  layout.rows = padded ? shape.rows : components;
  layout.columnStride = padded ? columnStride : components * layout.componentBytes;
  layout.elementSize = layout.columns * layout.columnStride;
}

// The view that something at `location` refers to.
ViewLayout viewOf(const Asset& asset, Index view, const std::string& location) {
  requireElement(view, asset.document.bufferViews.size(), [&] { return location + ".bufferView"; });
  return viewLayout(asset, view);
}

// Where data begin in their view, checked to be `size` bytes that suit components of `alignment` bytes.
const std::uint8_t* dataOf(const ViewLayout& view, std::size_t offset, std::uint64_t size, std::size_t alignment,
                           const std::string& location) {
  if (offset > view.bytes.size() || size > view.bytes.size() - offset) {
    failAt(location,
           fmt::format("needs {} bytes from byte {} on, but its buffer view has {}", size, offset, view.bytes.size()));
  }
  if ((view.offset + offset) % alignment != 0 || view.stride % alignment != 0) {
    failAt(location, fmt::format("its data are not aligned to {} bytes", alignment));
  }
  return view.bytes.data() + offset;
}

void findData(const Asset& asset, const gltf::Accessor& accessor, const std::string& location, AccessorLayout& layout) {
  const ViewLayout view = viewOf(asset, *accessor.bufferView, location);
  if (view.stride != 0) {
    if (view.stride < layout.elementSize) failAt(location, "has elements larger than its buffer view's byteStride");
    if (view.stride > kMaxStride) failAt(location, fmt::format("has a byteStride above {}", kMaxStride));
    layout.stride = view.stride;
  }
  const std::uint64_t count = layout.info.count;
  const std::uint64_t size = count == 0 ? 0 : (count - 1) * layout.stride + layout.usedSize();
  layout.data = dataOf(view, accessor.byteOffset, size, layout.componentBytes, location);
}

void checkZeroCount(const Asset& asset, const std::string& location, Index count) {
  std::size_t longest = 0;
  for (const Asset::Buffer& buffer : asset.buffers) {
    if (count <= read_bounds::kZeros.larger(longest)) break;
    longest = std::max(longest, buffer.bytes.size());
  }
  if (count > read_bounds::kZeros.larger(longest)) {
    throw Error(ErrorCode::kLimit, fmt::format("has {} elements without data, more than the file's size allows", count),
                location);
  }
}

SparseLayout findSparse(const Asset& asset, const gltf::Sparse& sparse, const std::string& location,
                        const AccessorLayout& layout) {
  SparseLayout result;
  const std::uint64_t count = sparse.count;
  if (count > layout.info.count) failAt(location, "has more substitutions than the accessor has elements");
  result.count = static_cast<Index>(count);
  const std::string indices = location + ".indices", values = location + ".values";
  result.indexType = sparse.indices.componentType;
  if (result.indexType != ComponentType::kU8 && result.indexType != ComponentType::kU16 &&
      result.indexType != ComponentType::kU32) {
    failAt(indices, "must be of an unsigned component type");
  }
  const std::size_t indexSize = componentSize(result.indexType);
  result.indices = dataOf(viewOf(asset, sparse.indices.bufferView, indices), sparse.indices.byteOffset,
                          count * indexSize, indexSize, indices);
  const std::uint64_t size = count == 0 ? 0 : (count - 1) * layout.elementSize + layout.usedSize();
  result.values = dataOf(viewOf(asset, sparse.values.bufferView, values), sparse.values.byteOffset, size,
                         layout.componentBytes, values);
  for (std::size_t i = 0; i < count; ++i) {
    if (result.index(i) >= layout.info.count || (i > 0 && result.index(i) <= result.index(i - 1))) {
      failAt(indices, "must be in rising order and below the accessor's count");
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

ViewLayout viewLayout(const Asset& asset, Index index) {
  const gltf::BufferView& view = asset.document.bufferViews[index];
  const auto location = [&] { return fmt::format("bufferViews[{}]", index); };
  requireElement(view.buffer, asset.buffers.size(), [&] { return location() + ".buffer"; });
  const Bytes& bytes = asset.buffers[view.buffer].bytes;
  const std::size_t offset = view.byteOffset, length = view.byteLength;
  if (offset > bytes.size() || length > bytes.size() - offset) {
    failAt(location(),
           fmt::format("needs {} bytes from byte {} on, but its buffer has {}", length, offset, bytes.size()));
  }
  return {ByteSpan(bytes).subspan(offset, length), offset, view.byteStride};
}

AccessorLayout accessorShape(const Asset& asset, Index index) {
  const gltf::Accessor& accessor = asset.document.accessors[index];
  AccessorLayout layout;
  layout.info.type = accessor.componentType;
  layout.info.normalized = accessor.normalized;
  if (accessor.count >= kNoIndex) {
    throw Error(ErrorCode::kLimit, "has more elements than 32 bits count", accessorLocation(index));
  }
  layout.info.count = static_cast<Index>(accessor.count);
  layout.componentBytes = componentSize(layout.info.type);
  setShape(accessor.type, layout);
  layout.stride = layout.elementSize;
  return layout;
}

AccessorLayout accessorLayout(const Asset& asset, Index index) {
  const std::size_t count = asset.document.accessors.size();
  if (index >= count) failAt(accessorLocation(index), fmt::format("is missing: there are {} elements", count));
  const gltf::Accessor& accessor = asset.document.accessors[index];
  const std::string location = accessorLocation(index);
  AccessorLayout layout = accessorShape(asset, index);
  if (accessor.bufferView) {
    findData(asset, accessor, location, layout);
  } else {
    checkZeroCount(asset, location, layout.info.count);
  }
  if (accessor.sparse) layout.sparse = findSparse(asset, *accessor.sparse, location + ".sparse", layout);
  return layout;
}

}  // namespace limber
