// What must hold of every rigged model, whatever it looked like before.
#pragma once

#include <string>

#include "limber/actions/rig/auto_rig.h"
#include "limber/document/rig/rig_io.h"

namespace limber::testing {

// A copy of the model with a rig made by `options`, as a GLB file.
struct Rigged {
  Bytes glb;
  AutoRigReport report;
};
Rigged rigged(const Asset& asset, const AutoRigOptions& options);

// Each check adds a test failure with what it found, and says nothing where all is well.

// Exactly `handles` joints, or one more that is the common root.
void expectJointCount(const AssetSkeleton& rig, Index handles);

// Where the mesh (positions and triangles in world space) is its own mirror image in x to the last vertex: for each
// joint another one, or itself, at the mirrored position and of the same radius. Returns whether the mesh was.
bool expectSymmetricWhereMeshIs(const Geometry& geometry, const Skeleton& skeleton);

// Every vertex has an influence; weights lie in (0, 1], sum to 1, name joints that there are, none twice.
void expectSoundWeights(const SkinWeights& weights, Index vertexCount, Index jointCount, Index maxInfluences);

// The same vertices at the same positions: counts, box and mean.
void expectSameShape(const Geometry& before, const Geometry& after);

// Every primitive keeps its indices, material and attributes (apart from joints and weights), value by value; images,
// materials, textures, samplers, cameras and extras are the same JSON.
void expectSameContent(const Asset& before, const Asset& after);

// Of two GLB files: the first one's JSON is contained in the second's, with nothing but additions (a mesh and its skin
// may have moved to another node), and its binary chunk is the beginning of the second's. `report` may say that skins
// named a wrong root; then that name may be gone.
void expectOnlyAdditions(ByteSpan before, ByteSpan after, const AutoRigReport& report);

}  // namespace limber::testing
