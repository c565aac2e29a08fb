// Buffers without the bytes that nothing refers to any more.
#pragma once

#include <set>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// Takes out the bytes of these buffers that no buffer view covers, and moves the views along; their offsets keep their
// remainder by four. A buffer that came from a file and changes becomes one without a name, so that writing never puts
// other bytes under that name. Linear in the number of views and buffers and in the bytes, but for sorting.
void dropUnusedBytes(Asset& asset, const std::set<Index>& buffers);

// Takes out the buffers that hold no bytes and that no buffer view names; renumbers the others in the views.
void removeEmptyBuffers(Asset& asset);

// Made before an edit, swept after it, and after the accessors are (AccessorSweep): buffer views that something used
// before and nothing uses now leave the list, and their bytes the buffers. Views have other numbers then.
class BufferViewSweep {
 public:
  explicit BufferViewSweep(const Asset& asset);
  void sweep(Asset& asset) const;

 private:
  std::vector<bool> usedBefore_;
};

}  // namespace limber
