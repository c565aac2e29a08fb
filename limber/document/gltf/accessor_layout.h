// Where the elements of an accessor lie in memory, after every check that makes reading them safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <type_traits>
#include <vector>

#include "limber/document/gltf/accessor.h"

namespace limber {

std::size_t componentSize(ComponentType type);

// Data of a buffer view.
struct ViewLayout {
  ByteSpan bytes;
  std::size_t offset = 0;  // in its buffer
  std::size_t stride = 0;  // 0 where the view gives none
};

// A sparse accessor's substitutions: value i, `elementSize` bytes, goes to element index i.
struct SparseLayout {
  Index count = 0;
  ComponentType indexType = ComponentType::kU32;
  const std::uint8_t* indices = nullptr;
  const std::uint8_t* values = nullptr;

  Index index(std::size_t i) const;
};

// Matrices whose columns do not fill four bytes have padded columns; everything else counts as one column here.
struct AccessorLayout {
  AccessorInfo info;
  std::size_t componentBytes = 4;
  std::size_t columns = 1, rows = 1, columnStride = 0;  // rows * columns == info.components
  std::size_t elementSize = 0, stride = 0;
  const std::uint8_t* data = nullptr;  // null: zeros (before `sparse`)
  std::optional<SparseLayout> sparse;

  // An element's bytes without the padding behind its last column, which the last element may lack.
  std::size_t usedSize() const { return elementSize - columnStride + rows * componentBytes; }
  bool packed() const { return stride == elementSize && columns == 1; }
};

// Throw Error kBadData, naming the view or accessor, where it does not fit what it lies in.
ViewLayout viewLayout(const Asset& asset, Index view);
AccessorLayout accessorLayout(const Asset& asset, Index accessor);
// Without a look at the data: they are not there yet. Throws kLimit where there are more elements than 32 bits count.
AccessorLayout accessorShape(const Asset& asset, Index accessor);

template <typename T>
T loadAs(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));  // data need not be aligned in memory
  return value;
}

// Calls use(T{}) with the C++ type of the components.
template <typename Use>
decltype(auto) withComponentType(ComponentType type, const Use& use) {
  switch (type) {
    case ComponentType::kI8:
      return use(std::int8_t{});
    case ComponentType::kU8:
      return use(std::uint8_t{});
    case ComponentType::kI16:
      return use(std::int16_t{});
    case ComponentType::kU16:
      return use(std::uint16_t{});
    case ComponentType::kU32:
      return use(std::uint32_t{});
    case ComponentType::kF32:
      break;
  }
  return use(float{});
}

template <typename T, typename Convert, typename Out>
void readElement(const AccessorLayout& layout, const std::uint8_t* at, const Convert& convert, Out* out) {
  for (std::size_t column = 0; column < layout.columns; ++column) {
    const std::uint8_t* component = at + column * layout.columnStride;
    for (std::size_t row = 0; row < layout.rows; ++row) *out++ = convert(loadAs<T>(component + row * sizeof(T)));
  }
}

// Calls use(at) for each element in its order: where its bytes lie, null for zeros.
template <typename Use>
void forEachElement(const AccessorLayout& layout, const Use& use) {
  std::size_t next = 0;  // substitution; they are in rising order
  for (std::size_t i = 0; i < layout.info.count; ++i) {
    if (layout.sparse && next < layout.sparse->count && layout.sparse->index(next) == i) {
      use(layout.sparse->values + next++ * layout.elementSize);
    } else {
      use(layout.data == nullptr ? nullptr : layout.data + i * layout.stride);
    }
  }
}

// All components, converted, into `out`, which holds count * components zeros: data, then sparse substitutions. Where
// nothing is to convert and data are tightly packed this is one copy.
template <typename T, typename Convert, typename Out>
void readElements(const AccessorLayout& layout, const Convert& convert, std::vector<Out>& out) {
  const std::size_t components = layout.info.components;
  if (layout.data != nullptr) {
    if (std::is_same_v<T, Out> && layout.packed()) {
      if (!out.empty()) std::memcpy(out.data(), layout.data, out.size() * sizeof(T));
    } else if (layout.packed()) {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = convert(loadAs<T>(layout.data + i * sizeof(T)));
    } else {
      for (std::size_t i = 0; i < layout.info.count; ++i) {
        readElement<T>(layout, layout.data + i * layout.stride, convert, out.data() + i * components);
      }
    }
  }
  if (!layout.sparse) return;
  for (std::size_t i = 0; i < layout.sparse->count; ++i) {
    Out* target = out.data() + layout.sparse->index(i) * components;
    readElement<T>(layout, layout.sparse->values + i * layout.elementSize, convert, target);
  }
}

}  // namespace limber
