#include "limber/crowd/shared_accessors.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <string_view>

#include "limber/document/gltf/accessor_layout.h"

namespace limber {

namespace {

std::size_t strideFor(const AccessorLayout& layout, Index target) {
  return target == kVertexTarget ? (layout.elementSize + 3) / 4 * 4 : layout.elementSize;
}

Bytes elementsOf(const AccessorLayout& layout, std::size_t stride) {
  Bytes bytes(layout.info.count * stride, 0);
  for (std::size_t i = 0; layout.data && i < layout.info.count; ++i) {
    std::memcpy(&bytes[i * stride], layout.data + i * layout.stride, layout.usedSize());
  }
  for (std::size_t i = 0; layout.sparse && i < layout.sparse->count; ++i) {
    std::memcpy(&bytes[layout.sparse->index(i) * stride], layout.sparse->values + i * layout.elementSize,
                layout.usedSize());
  }
  return bytes;
}

std::size_t hashOf(const Bytes& bytes) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

Index SharedAccessors::add(const Asset& from, Index accessor, Index target) {
  gltf::Accessor wanted = from.document.accessors[accessor];
  const AccessorLayout layout = accessorLayout(from, accessor);
  const std::size_t stride = strideFor(layout, target);
  const Bytes bytes = elementsOf(layout, stride);
  const auto isSame = [&](Index other) {
    const gltf::Accessor& is = to_.document.accessors[other];
    const gltf::BufferView& view = to_.document.bufferViews[*is.bufferView];
    return is.componentType == wanted.componentType && is.type == wanted.type && is.count == wanted.count &&
           is.normalized == wanted.normalized && is.min == wanted.min && is.max == wanted.max &&
           view.target == target && view.byteLength == bytes.size() &&
           std::equal(bytes.begin(), bytes.end(), to_.buffers[view.buffer].bytes.begin() + view.byteOffset);
  };
  const std::size_t hash = hashOf(bytes);
  for (auto [at, end] = byHash_.equal_range(hash); at != end; ++at) {
    if (isSame(at->second)) return at->second;
  }
  const Index view = addBufferView(to_, bytes, target);
  if (target == kVertexTarget) to_.document.bufferViews[view].byteStride = stride;
  wanted.asRead.reset();
  wanted.sparse.reset();
  wanted.bufferView = view;
  wanted.byteOffset = 0;
  const Index added = addElement(to_.document.accessors, std::move(wanted));
  byHash_.emplace(hash, added);
  return added;
}

}  // namespace limber
