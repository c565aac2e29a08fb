// Accessors taken over from other documents, what is equal once.
#pragma once

#include <cstddef>
#include <unordered_map>

#include "limber/core/types.h"
#include "limber/document/asset.h"

namespace limber {

// Adds to one document, which must outlive it.
class SharedAccessors {
 public:
  explicit SharedAccessors(Asset& to) : to_(to) {}

  // The accessor with the same elements; one that was added before where type, use and bytes are the same. Of vertex
  // attributes (kVertexTarget) elements begin every four bytes. Sparse accessors become plain ones. Cost: linear in its
  // bytes. Throws as accessorLayout does.
  Index add(const Asset& from, Index accessor, Index target);

 private:
  Asset& to_;
  std::unordered_multimap<std::size_t, Index> byHash_;  // accessors of `to`
};

}  // namespace limber
