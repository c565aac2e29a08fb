// Reading numbers out of glTF accessors, and adding new ones.
#pragma once

#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

using gltf::ComponentType;
using gltf::kIndexTarget;
using gltf::kVertexTarget;

// What an accessor says of itself. `components` is 1 for SCALAR, 3 for VEC3, 16 for MAT4.
struct AccessorInfo {
  Index count = 0;
  Index components = 0;
  ComponentType type = ComponentType::kF32;
  bool normalized = false;
};

// All throw Error kBadData naming the accessor where it breaks its format (checkAsset has already been passed by what
// readAsset returns, so then they do not).
AccessorInfo accessorInfo(const Asset& asset, Index accessor);

// count * components floats: normalised integers mapped to [0, 1] or [-1, 1], other integers as they are; sparse
// substitutions applied; strides followed; an accessor without a buffer view is zeros.
std::vector<float> readFloats(const Asset& asset, Index accessor);
// The same for unsigned integers of any width (indices, joints). Throws on float or signed components.
std::vector<Index> readIndices(const Asset& asset, Index accessor);

// Appends `bytes`, aligned to 4, to the buffer that limber adds to (the binary chunk's, else a new one) as a new buffer
// view; returns the view's index. Amortised linear in bytes.size(), whatever the buffer holds.
Index addBufferView(Asset& asset, ByteSpan bytes, Index target = 0);

// The same with an accessor of its own; returns the accessor's index. bytes.size() == count * components * size of
// type. `target`: kVertexTarget for vertex attributes, kIndexTarget for indices, 0 for none.
Index addAccessor(Asset& asset, const AccessorInfo& info, ByteSpan bytes, Index target = 0);
Index addFloatAccessor(Asset& asset, std::span<const float> values, Index components, Index target = 0,
                       bool withMinMax = false);

// Appends the 16 numbers of a matrix as glTF stores them, column after column.
void appendMatrix(const Affine& affine, std::vector<float>& values);

// Writes "min" and "max" as the accessor's data have them (raw values, before normalisation); takes them out where
// there are no elements or not only finite ones.
void setBounds(Asset& asset, Index accessor);

}  // namespace limber
