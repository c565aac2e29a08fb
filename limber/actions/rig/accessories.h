// What a character wears or holds and is no part of its body: hats, capes, weapons, bags.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "limber/document/scene/geometry.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/skeleton/skin_weights.h"

namespace limber {

// Accessories are told by the words of their nodes, meshes and materials ("Knight_Cape", "1H_Sword"), where the other
// words do not name a joint of the body ("Head_Hat" is a head). Those of one
// name at one node are one.
struct Accessories {
  std::vector<std::string> names;  // as in the file, of #A accessories
  std::vector<std::string> words;  // #A, by which each was told: "cape"
  std::vector<bool> hangs;         // #A: whether it swings: capes, scarves, braids
  std::vector<Index> ofTriangle;   // #F of Geometry: the accessory that it belongs to; kNoIndex: none

  bool empty() const { return names.empty(); }
};

// None where they would be more than half of the model's surface: then the model is one, and no body.
Accessories findAccessories(const Asset& asset, const Geometry& geometry);

// Geometry::triangles without those of accessories.
std::vector<Triangle> bodyTriangles(const Geometry& geometry, const Accessories& accessories);

// Where an accessory is bound.
struct HungAccessory {
  std::vector<Index> vertices;  // of prepared.mesh, its own
  Index joint = 0;
  Vec3 position = Vec3::Zero();  // in the middle of its vertices that are nearest to the body; space of prepared.mesh
};

// Has each accessory follow one joint: the one that holds most of the body where the accessory is nearest to it.
// weights  of prepared.mesh
// Returns #A; none where there is no body.
std::vector<HungAccessory> hangAccessories(const Geometry& geometry, const PreparedMesh& prepared,
                                           const Accessories& accessories, SkinWeights& weights);

}  // namespace limber
