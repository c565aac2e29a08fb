// Accessors that an edit leaves without use.
#pragma once

#include <vector>

#include "limber/document/asset.h"

namespace limber {

// Made before an edit, swept after it: accessors that something used before and nothing uses now (weights and inverse
// binds of a rig that is gone, keys of its clips) are removed from the document's list. Accessors that the edit added
// take over their numbers; where it added fewer than it freed, later ones move up and all references are renumbered.
// Buffers and buffer views stay as they are, to the byte. Does nothing to a document with unknown extensions that may
// refer to accessors.
class AccessorSweep {
 public:
  explicit AccessorSweep(const Asset& asset);
  void sweep(Asset& asset) const;

 private:
  std::vector<bool> usedBefore_;
};

}  // namespace limber
