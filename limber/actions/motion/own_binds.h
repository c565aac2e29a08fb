// Skins that were bound in another pose than that of their joints, each moved by its own inverse binds.
#pragma once

#include <span>
#include <vector>

#include "limber/character/character.h"
#include "limber/deform/deformer.h"
#include "limber/document/scene/shape_surface.h"

namespace limber {

// What withJoinedBinds makes of such skins is right in one pose, and where joints take a vertex apart in another the
// vertex is elsewhere than the file has it. Linear blending and dual quaternions move each of these vertices from where
// its own skin has it, which is exact.
class OwnBinds {
 public:
  // weights  #S rows, of the character's surface; joints are those of `skeleton`
  OwnBinds(const Character& character, const AssetSkeleton& skeleton, const SkinWeights& weights);

  // Moves the vertices of these skins; all others of `positions` and `normals` (#S) stay.
  //
  // deformer    one without a preparation
  // transforms  #J, from the rest pose of `skeleton` to the pose
  // shapes      weights of the blend shapes
  // Throws as moveByShapes does. Cost: linear in the vertices and the joints of the skins.
  void deform(const Deformer& deformer, std::span<const Affine> transforms, const ShapeWeights& shapes,
              std::span<Vec3f> positions, std::span<Vec3f> normals) const;

 private:
  struct Part {
    Index firstVertex = 0;
    SkinWeights weights;
    std::vector<Affine> toRest;  // #J, from where this skin has the surface to where the joint's rest pose has it
    std::vector<Vec3> centers;   // #J, of the joints, where this skin has the surface
  };

  Character character_;
  std::vector<Vec3f> normals_;  // #S
  std::vector<Part> parts_;
};

}  // namespace limber
