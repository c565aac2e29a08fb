// A picture of a model, its handles, its bones or its weights, made without a graphics card.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "limber/preview/camera.h"
#include "limber/preview/image/image.h"
#include "limber/preview/scene.h"

namespace limber {

enum class PreviewShow {
  kModel,
  kHandles,  // the model translucent, a sphere at each joint
  kWeights,  // each vertex in the colours of its joints
  kBones,    // the model translucent, its bones inside
  kAnatomy,  // likewise, in the colours of the parts of the body
  kParts,    // each triangle in the colour of its part (PreviewOptions::partOf)
  kStretch,  // how far the surface is from its size at rest: blue where it keeps it, red where twice or half of it
};

// "model", "handles", "weights", "bones", "anatomy", "parts", "stretch". Throws Error kBadArgument that lists them.
PreviewShow parsePreviewShow(std::string_view name);

// What is seen behind the model; its shadow on the ground falls on that.
struct Backdrop {
  enum class Kind {
    kStudio,       // a bright wall
    kColor,        // one colour
    kTransparent,  // nothing: the picture has four channels, and the shadow is half transparent black
  };
  Kind kind = Kind::kStudio;
  Vec3 color = Vec3::Zero();  // linear RGB
};

// "studio", "transparent", or a colour in sRGB such as "#ffffff". Throws Error kBadArgument that says so.
Backdrop parseBackdrop(std::string_view text);

struct PreviewOptions {
  PreviewShow show = PreviewShow::kModel;
  int width = 1024, height = 768;  // pixels, 16 to 8192
  ViewDirection view;
  double turn = 0;  // degrees that the camera, and with it the light, goes on round the middle of the frame
  Backdrop backdrop;
  std::string joint;          // kWeights: the weight of this joint alone, as heat; empty: all
  std::optional<Box> frame;   // what has to be in the picture; none: the scene. For the frames of a clip.
  std::vector<Index> partOf;  // kParts: #F, the part of each triangle (modelParts)
};

// The same scene and options give the same picture, whatever the number of threads. Throws Error kBadArgument where the
// scene lacks what is to be shown (no joints, no weights, no joint of that name, no rig, parts of another number of
// triangles) or the size is out of range. Cost: a fraction of a second for 1024 x 768 and 50k triangles; memory grows
// with the picture and the triangles.
Image render(const Scene& scene, const PreviewOptions& options = {});

// What such a picture shows where there is neither model nor shadow.
Image renderBackdrop(const PreviewOptions& options);

}  // namespace limber
