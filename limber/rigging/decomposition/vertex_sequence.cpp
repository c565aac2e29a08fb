#include "limber/rigging/decomposition/vertex_sequence.h"

#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

void VertexSequence::checkSize(double pointCount, double frameCount) {
  const double stored = kLanes * std::ceil(pointCount / kLanes) * frameCount;
  if (frameCount <= kMaxFrames && stored <= kMaxPositions) return;
  throw Error(ErrorCode::kLimit,
              fmt::format("{:.0f} frames of {:.0f} vertices are too many to be held in memory", frameCount, pointCount),
              {}, "give fewer frames: one clip (--clip), or fewer a second (--fps)");
}

}  // namespace limber
