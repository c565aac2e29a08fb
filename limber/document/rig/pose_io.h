// The pose in an Asset: reads it, sets it, and bakes a mesh in it.
#pragma once

#include <span>

#include "limber/document/rig/rig_io.h"
#include "limber/skeleton/pose.h"

namespace limber {

// How the file's joint nodes stand, in the world of the default scene (#J locals; a root's is its global transform).
// Often not the rest pose: that is the bind pose.
Pose readNodePose(const Asset& asset, const AssetSkeleton& skeleton);

// Sets the transforms of the joint nodes to that pose. Nodes whose transform stays the same are not touched; one that
// had a matrix gets translation, rotation and scale. Clips are as they were: they move the joints away from the pose
// when played. Throws Error kBadData naming the node where a root is below a node without an inverse (a scale of 0).
void writeNodePose(Asset& asset, const AssetSkeleton& skeleton, const Pose& pose);

// What a map does to directions at right angles to a surface, but for the sign of its determinant.
Mat3 cofactorsOf(const Mat3& linear);

// glTF's transform of a direction at right angles to the surface: by the cofactors of the linear part, of length 1 or
// 0.
Vec3f turnNormal(const Mat3& linear, const Vec3f& normal);

// #S normals of the vertices of `geometry` in world space, zero where the file has none.
std::vector<Vec3f> readNormals(const Asset& asset, const Geometry& geometry);

// Makes the vertices of `geometry` (collectGeometry(asset)) stand where `positions` says, for good: each mesh of the
// scene goes to a node at the scene's root without a transform, its rig is taken out, and so is what only made sense
// with the old vertices: tangents (readers make them anew) and morph targets. Warnings say so.
//
// positions, normals  #S in world space; normals are written only for parts that had some
void freezeGeometry(Asset& asset, const Geometry& geometry, std::span<const Vec3f> positions,
                    std::span<const Vec3f> normals);

}  // namespace limber
