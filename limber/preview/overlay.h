// What is drawn inside or over the model: handles, bones, and the colours of weights.
#pragma once

#include <vector>

#include "limber/preview/render.h"
#include "limber/preview/shapes.h"

namespace limber {

// One colour for each vertex of the scene. Throws Error kBadArgument where weights are asked for and missing.
std::vector<Vec3f> surfaceColors(const Scene& scene, const PreviewOptions& options);

// The solids inside the model; none for kModel. Throws Error kBadArgument where the scene has no joints.
ShapeMesh overlayShapes(const Scene& scene, const PreviewOptions& options);

}  // namespace limber
