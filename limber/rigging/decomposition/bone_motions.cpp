#include "limber/rigging/decomposition/bone_motions.h"

#include <algorithm>

namespace limber {

std::vector<Index> compactBones(BoneMotions& motions, const std::vector<bool>& isUsed) {
  const Index count = motions.boneCount();
  std::vector<Index> renumbered(count, kNoIndex);
  Index kept = 0;
  for (Index b = 0; b < count; ++b) {
    if (!isUsed[b]) continue;
    renumbered[b] = kept;
    if (kept < b) std::copy_n(motions.of(b), motions.frameCount, motions.of(kept));
    ++kept;
  }
  motions.motions.resize(std::size_t{kept} * motions.frameCount);
  return renumbered;
}

}  // namespace limber
