// A model's surface with its blend shapes in use: how its nodes have them, or an animation at a moment.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "limber/document/scene/geometry.h"

namespace limber {

// #nodes: a weight for each blend shape of the mesh that the node shows; none where it has no shapes.
using ShapeWeights = std::vector<std::vector<float>>;

// As the nodes (or their meshes) have them; where the animation of that number moves them, as it does at `seconds`.
// Keys that are not finite or not later than the one before are passed over. Throws Error kLimit above 16 million
// weights, or where the animation's keys come to more than 128 million numbers.
ShapeWeights readShapeWeights(const Asset& asset, std::optional<Index> animation = std::nullopt, double seconds = 0);

// The first animation of that name, if there is one.
std::optional<Index> animationNamed(const gltf::Document& document, std::string_view name);

// The last key of an animation's blend shapes, in seconds; 0 where it moves none.
double shapeDuration(const Asset& asset, Index animation);

// Brings the vertices of collectGeometry(asset) with shapes to where these weights have them, before any skin moves
// them; normals (#S, readNormals(asset, geometry)) likewise.
void moveByShapes(const Asset& asset, const ShapeWeights& weights, Geometry& geometry,
                  std::vector<Vec3f>* normals = nullptr);

// collectGeometry, with blend shapes as the nodes have them (moveByShapes). Skins that were bound in several poses are
// where each was: joinBindPoses brings them to one.
Geometry shapedGeometry(const Asset& asset);

// Lets the nodes have these weights.
void writeShapeWeights(Asset& asset, const ShapeWeights& weights);

}  // namespace limber
