// Buffers without the bytes that nothing refers to any more.
#pragma once

#include <set>

#include "limber/asset/asset.h"
#include "limber/core/types.h"

namespace limber {

// Takes out the bytes of these buffers that no buffer view covers, and moves the views along; their offsets keep their
// remainder by four. A buffer that came from a file and changes becomes one without a name, so that writing never puts
// other bytes under that name. Linear in the number of views and buffers and in the bytes, but for sorting.
void dropUnusedBytes(Asset& asset, const std::set<Index>& buffers);

// Takes out the buffers that hold no bytes and that no buffer view names; renumbers the others in the views.
void removeEmptyBuffers(Asset& asset);

}  // namespace limber
