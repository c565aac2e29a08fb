// What a picture shows: plain arrays in world space, whatever they came from (a file, a pose, a frame of a clip).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limber/actions/pose/pose_asset.h"
#include "limber/character/character.h"
#include "limber/core/error.h"
#include "limber/document/clip/motion_io.h"
#include "limber/preview/image/texture.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

struct Clip;

struct SceneJoint {
  std::string name;
  Vec3 position = Vec3::Zero();
  std::optional<Index> parent;
  double radius = 0;                 // of the handle; 0 where the skeleton has none
  PartKind kind = PartKind::kOther;  // of the body, as the skeleton is read at rest (readAnatomy)
  Side side = Side::kCenter;
};

// What a colour at each vertex cannot say of a surface.
struct SceneMaterial {
  std::shared_ptr<const Texture> texture;  // times which the colours count; none: white
  bool isOpaque = true;                    // whatever the texture's alpha
  double opacity = 1;                      // where it is not: times the texture's alpha
  std::optional<double> cutoff;            // nothing is seen where that is less, and the rest whole
};

struct Scene {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> colors;  // linear RGB, one for each vertex; empty: one clay colour
  // All three are empty where no surface is textured or lets anything through; uvs also where none is textured.
  std::vector<Vec2f> uvs;         // #V
  std::vector<Index> materialOf;  // #F: which of `materials`, kNoIndex for none
  std::vector<SceneMaterial> materials;
  std::vector<SceneJoint> joints;
  std::vector<Bone> bones;            // segments, as bonesOf gives them
  SkinWeights weights;                // empty, or one row for each vertex, over `joints`
  std::vector<Vec3f> boundPositions;  // of a rigged model: #V, where the vertices are while no joint moves; else empty
  Warnings warnings;                  // of what cannot be drawn as it is: undrawn-textures, many-influences
};

// The model as its file shows it before any clip plays: a rigged one in the pose in which its joints' nodes stand; a
// skeleton without a mesh as its bones.
// Colours are the materials' base colours times vertex colours times base colour textures.
Scene makeScene(const Character& character);

// Pictures of one character, still or moving: what its deformer prepares is prepared once.
class SceneMaker {
 public:
  explicit SceneMaker(const Character& character, const Deformer& deformer = kLinearBlendDeformer);

  Scene still() const;
  // Do the joints' nodes have the rest pose? True without a rig. False where a pose was saved, which still() shows.
  bool isAtRest() const;
  // The character in a clip over its document's movingSkeleton, with blend shapes as its animation of the clip's name
  // has them. Throws Error kUnsupported where meshes move without a skin.
  Scene at(const Clip& clip, double seconds) const;
  double duration(const Clip& clip) const;  // seconds, with the blend shapes of its name
  // In a pose of the character's moving(); it must be rigged.
  Scene at(const Pose& pose) const;

 private:
  Scene at(const Pose& pose, const ShapeWeights& shapes) const;
  Scene unrigged(const ShapeWeights& shapes) const;

  bool hasSkeleton() const { return poser_ || isSkeletonAlone(character_.document()); }

  Character character_;
  std::unique_ptr<AssetPoser> poser_;  // of a rigged one
  std::vector<Vec3f> boundPositions_;
};

}  // namespace limber
