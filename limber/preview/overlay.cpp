#include "limber/preview/overlay.h"

#include <algorithm>

#include "limber/core/error.h"
#include "limber/evaluate/skin/surface_stretch.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/preview/image/palette.h"

namespace limber {

namespace {

constexpr double kHandleShrink = 0.80;     // of the fitted radius, so that neighbours stay apart
constexpr double kSmallestHandle = 0.009;  // of the model's diagonal
constexpr double kLargestHandle = 0.045;
constexpr double kDotRadius = 0.0055;
constexpr double kFullStretch = 1;   // above the size at rest: twice as long, or half, is red
constexpr double kLinkWidth = 0.30;  // of the handle's radius

double modelSize(const Scene& scene) {
  Box box;
  for (const Vec3f& position : scene.positions) box.add(position.cast<double>());
  return box.diagonal();
}

void requireJoints(const Scene& scene) {
  if (scene.joints.empty()) {
    throw Error(ErrorCode::kBadArgument, "the model has no rig to show", "", "make one with limber rig");
  }
}

std::vector<Vec3f> weightColors(const Scene& scene) {
  std::vector<Vec3f> colors(scene.positions.size());
  const Vec3f unweighted = linearFromSrgb(40, 40, 44);
  for (Index v = 0; v < scene.weights.vertexCount(); ++v) {
    Vec3f sum = Vec3f::Zero();
    float total = 0;
    for (Index slot = 0; slot < scene.weights.slots; ++slot) {
      const float weight = scene.weights.weightsOf(v)[slot];
      sum += weight * jointColor(scene.weights.jointsOf(v)[slot]);
      total += weight;
    }
    colors[v] = total > 0 ? Vec3f(sum / total) : unweighted;
  }
  return colors;
}

std::vector<Vec3f> heatColors(const Scene& scene, const std::string& name) {
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const SceneJoint& candidate) { return candidate.name == name; });
  if (joint == scene.joints.end()) {
    throw Error(ErrorCode::kBadArgument, "there is no joint \"" + name + "\"", "", "limber info lists the joints");
  }
  const Index number = static_cast<Index>(joint - scene.joints.begin());
  std::vector<Vec3f> colors(scene.positions.size());
  for (Index v = 0; v < scene.weights.vertexCount(); ++v) {
    double weight = 0;
    for (Index slot = 0; slot < scene.weights.slots; ++slot) {
      if (scene.weights.jointsOf(v)[slot] == number) weight += scene.weights.weightsOf(v)[slot];
    }
    colors[v] = heatColor(weight);
  }
  return colors;
}

void addHandles(ShapeMesh& shapes, const Scene& scene, double size) {
  const Vec3f red = linearFromSrgb(226, 48, 44), root = linearFromSrgb(244, 170, 40),
              link = linearFromSrgb(96, 104, 118);
  const auto drawnRadius = [&](const SceneJoint& joint) {
    return std::clamp(kHandleShrink * joint.radius, kSmallestHandle * size, kLargestHandle * size);
  };
  for (const SceneJoint& joint : scene.joints) {
    addSphere(shapes, joint.position, drawnRadius(joint), joint.parent ? red : root);
    if (!joint.parent) continue;
    const SceneJoint& parent = scene.joints[*joint.parent];
    const double widest = 0.008 * size;
    addTaperedLink(shapes, parent.position, joint.position, std::min(widest, kLinkWidth * drawnRadius(parent)),
                   std::min(widest, kLinkWidth * drawnRadius(joint)) * 0.6, link);
  }
}

void addBones(ShapeMesh& shapes, const Scene& scene, double size) {
  const Vec3f bone = linearFromSrgb(222, 184, 96), dot = linearFromSrgb(226, 48, 44);
  for (const Bone& segment : scene.bones) addOctahedralBone(shapes, segment.a, segment.b, bone);
  for (const SceneJoint& joint : scene.joints) addSphere(shapes, joint.position, kDotRadius * size, dot);
}

void addAnatomy(ShapeMesh& shapes, const Scene& scene, double size) {
  for (const Bone& segment : scene.bones) {
    const SceneJoint& joint = scene.joints[segment.joint];
    addOctahedralBone(shapes, segment.a, segment.b, linearFromHsv(partColor(joint.kind, joint.side)));
  }
  for (const SceneJoint& joint : scene.joints)
    addSphere(shapes, joint.position, kDotRadius * size, linearFromHsv(partColor(joint.kind, joint.side)));
}

// Of each vertex the mean over its triangles, by their area at rest.
std::vector<Vec3f> stretchColors(const Scene& scene) {
  if (scene.boundPositions.size() != scene.positions.size()) {
    throw Error(ErrorCode::kBadArgument, "the model has no rig by which it could be stretched", "",
                "make one with limber rig");
  }
  const std::vector<double> distortions = triangleDistortions(scene.boundPositions, scene.positions, scene.triangles);
  const TriMesh bound{scene.boundPositions, scene.triangles};
  std::vector<double> sum(scene.positions.size(), 0), areas(scene.positions.size(), 0);
  for (std::size_t f = 0; f < scene.triangles.size(); ++f) {
    const double area = triangleArea(bound, scene.triangles[f]);
    for (const Index v : scene.triangles[f]) {
      sum[v] += area * distortions[f];
      areas[v] += area;
    }
  }
  std::vector<Vec3f> colors;
  for (std::size_t v = 0; v < sum.size(); ++v) {
    colors.push_back(heatColor(areas[v] > 0 ? (sum[v] / areas[v] - 1) / kFullStretch : 0));
  }
  return colors;
}

}  // namespace

std::vector<Vec3f> surfaceColors(const Scene& scene, const PreviewOptions& options) {
  if (options.show == PreviewShow::kWeights) {
    if (scene.weights.vertexCount() != scene.positions.size()) {
      throw Error(ErrorCode::kBadArgument, "the model has no skin weights to show", "", "make them with limber rig");
    }
    return options.joint.empty() ? weightColors(scene) : heatColors(scene, options.joint);
  }
  if (options.show == PreviewShow::kStretch) return stretchColors(scene);
  const bool isSolid = options.show == PreviewShow::kModel || options.show == PreviewShow::kParts;
  if (isSolid && !scene.colors.empty()) return scene.colors;
  const bool inside = !isSolid;
  const Vec3f clay = inside ? linearFromSrgb(150, 170, 195) : linearFromSrgb(190, 181, 172);
  return std::vector<Vec3f>(scene.positions.size(), clay);
}

ShapeMesh overlayShapes(const Scene& scene, const PreviewOptions& options) {
  ShapeMesh shapes;
  const double size = modelSize(scene);
  if (options.show == PreviewShow::kHandles) {
    requireJoints(scene);
    addHandles(shapes, scene, size);
  } else if (options.show == PreviewShow::kWeights) {
    const Vec3f white = linearFromSrgb(236, 236, 236), chosen = linearFromSrgb(226, 48, 44);
    for (const SceneJoint& joint : scene.joints) {
      const bool marked = !options.joint.empty() && joint.name == options.joint;
      addSphere(shapes, joint.position, kDotRadius * size, marked ? chosen : white);
    }
  } else if (options.show == PreviewShow::kBones) {
    requireJoints(scene);
    addBones(shapes, scene, size);
  } else if (options.show == PreviewShow::kAnatomy) {
    requireJoints(scene);
    addAnatomy(shapes, scene, size);
  }
  return shapes;
}

}  // namespace limber
