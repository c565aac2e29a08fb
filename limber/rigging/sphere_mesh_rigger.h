// The sphere mesh as a rigger: each sphere becomes a joint that a user can take hold of.
#pragma once

#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/sphere_mesh/handle_tree.h"
#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber {

// Counts of handles worth choosing, best first: where the error (SphereMesh::errors) falls steeply up to the count and
// slowly from there on, both in logarithms; counts near three for each limb and five more before others, and none at
// which a long limb is without a handle (SphereMesh::limbs). There is always at least one. Cost: O(1).
std::vector<HandleSuggestion> suggestHandles(const SphereMesh& spheres);
// The same of any errors for each count from 0 to suggestedFrom(), of a model that can have up to maxHandles and needs
// `fewest`, for which `usual` suit most.
std::vector<HandleSuggestion> suggestHandles(std::vector<double> errors, Index maxHandles, Index usual = 20,
                                             Index fewest = 1);
Index suggestedFrom();

// The skeleton of `count` handles: a joint at each sphere's centre with the sphere's radius, without rotation, all in
// one tree. Names: handle_00 (the root), handle_01, ...; the two of a mirror pair share a number and end in .L (the
// positive side of the plane: the model's left where it faces +Z) and .R. Throws as SphereMesh::level does. Cost:
// O(count log #V).
Skeleton handleSkeleton(const SphereMesh& spheres, Index count);
Skeleton handleSkeleton(const SphereMeshLevel& level);
// tree  handleTree(level)
Skeleton handleSkeleton(const SphereMeshLevel& level, const HandleTree& tree);

// Throws Error kBadArgument unless 1 <= options.handles <= #V, where a number is asked for.
void checkHandles(const TriMesh& mesh, const RigOptions& options);

// Builds the sphere mesh, suggests counts, and makes the skeleton of options.handles handles (default: the best
// suggestion); the region of a joint is what its sphere represents. Throws Error kBadArgument, before it computes, where
// there are fewer vertices than handles.
AutoRig rigWithSphereMesh(const TriMesh& mesh, const RigOptions& options, Progress& progress);

}  // namespace limber
