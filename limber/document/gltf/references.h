// Where a document refers to its elements by number.
#pragma once

#include <functional>

#include "limber/document/gltf/gltf.h"

namespace limber {

// What a number can mean. The last two are lists that an extension keeps for the whole document
// (KHR_lights_punctual, KHR_materials_variants).
enum class ElementKind {
  kBuffer,
  kBufferView,
  kAccessor,
  kImage,
  kSampler,
  kTexture,
  kMaterial,
  kMesh,
  kSkin,
  kCamera,
  kNode,
  kScene,
  kAnimation,
  kLight,
  kVariant,
};

// How many elements of that kind the document has.
Index elementCount(const gltf::Document& document, ElementKind kind);

// Lets `act` see every object of a document, the document first.
void forEachObject(gltf::Document& document, const std::function<void(gltf::Object&)>& act);

// Calls visit(kind, number) for every reference from one element to another, those in extensions that limber knows
// included (meshopt, instancing, level of detail, lights, variants, node constraints, pointers of animations, textures
// in any extension of a material, buffer views in any extension at all). Not included: what extensions of the whole
// document refer to, and the document's default scene. Numbers are as the document has them, in range or not.
void visitReferences(const gltf::Document& document, const std::function<void(ElementKind kind, Index number)>& visit);

// The same to change the numbers. A number set to kNoIndex is taken out: of its list, or as a member of its object,
// with the extension where that says nothing without it. Only for references that a document need not have: `change`
// never sets another (an attribute's accessor, a buffer view's buffer, a texture's use, a sampler's input) to kNoIndex.
void changeReferences(gltf::Document& document, const std::function<void(ElementKind kind, Index& number)>& change);

// The same for what extensions of the whole document refer to, after nodes were renumbered: `newNode` is the number of
// each of the nodes as it is now, kNoIndex where it is gone. Springs of VRMC_springBone with a node that is gone go,
// and the extension with the last of them; so do bones, annotations and expressions of a VRM (1.0, 0.x, animation) that
// name one, while the extension stays. False where something there may now name another node: colliders of
// VRMC_springBone on such nodes, any other extension that seems to name nodes.
bool renumberDocumentExtensions(gltf::Document& document, const std::vector<Index>& newNode);

// What a VRM 1.0 says of the mesh of one node (expressions, what the wearer sees) it says of another from now on.
void moveVrmMesh(gltf::Document& document, Index from, Index to);

}  // namespace limber
