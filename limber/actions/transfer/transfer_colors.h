// The colours of one model on another one, on which its surface was laid.
#pragma once

#include <functional>
#include <span>

#include "limber/actions/transfer/vertex_colors.h"
#include "limber/geometry/surface/figure_surface.h"
#include "limber/rigging/transfer/rig_transfer.h"

namespace limber {

// How colours come over.
struct ColorTransfer {
  SurfaceColor at;  // of the source; none: they do not; called from several threads
  // Makes a PNG file of a picture that wide and as high, linear RGB; none: all colours go to vertices.
  std::function<Bytes(int size, std::span<const Vec3f> pixels)> picture = {};
  int pictureSize = 1024;  // pixels, 1 or more
};

// The source of a transfer, as its Geometry and welded from that, and what became of it.
struct LaidSource {
  const Geometry& geometry;
  const PreparedMesh& prepared;
  const RigTransfer& rig;
};

// Each point of the target has the colour of the source's point that it takes after (SurfaceProjector): in a texture
// where the target's materials have texture coordinates in which nothing lies on anything else (texelsOf), else at its
// vertices (setVertexColors). Primitives of the figure's surroundings stay as they are; where the figure's have some of
// them, these become white.
// figure  of the target's Geometry, as the transfer took it
// Cost: for each pixel of a texture two nearest points.
void transferColors(const LaidSource& source, const ColorTransfer& colors, Asset& target, const Geometry& geometry,
                    const FigureSurface& figure);

}  // namespace limber
