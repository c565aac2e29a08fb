// Which points of a tree of curves become joints, for any number of joints.
#pragma once

#include <vector>

#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber {

// A rooted tree of curves: nodes with parents before children. Of a model that is its own mirror image at x = 0 it has
// the half with x >= 0, in which a paired node represents its image as well and the others lie on the plane; below a
// paired node all are paired.
//
// weights  fraction of the surface that belongs to a node; of a pair, to one of the two
// parents  kNoIndex for the root, which is node 0
struct CurveTree {
  bool isMirrored = false;
  std::vector<Vec3> points;
  std::vector<double> radii, weights;
  std::vector<char> isPaired;
  std::vector<Index> parents;
};

// `count` joints on the tree, as a level whose edges are the bones. Added one (or a pair) at a time, what counts most
// first:
// - the end of the longest branch that has no joint yet, with a joint where it comes off; it counts as long as it
//   sticks out of the body there. Branches that come off within the body's thickness at a joint share it.
// - a joint on a bone, where the curve is farthest from it, or in the middle of one that is nearly straight; it counts
//   as far as the curve is off, and a quarter of the bone's length.
// On a mirrored tree joints come in exact mirror pairs or lie on the plane; only where one joint is left over and no
// bone lies on the plane it has no image. Throws Error kUnsupported where the tree is a single point and more joints
// are requested. Cost: O(#nodes + count log count), besides looking through each bone's curve.
SphereMeshLevel chooseJoints(const CurveTree& tree, Index count);

// For each count from 0 (infinite) to maxCount what counts most of what is not joined yet, as above: a length, never
// growing. Where two joints come at once, the count between has the value of the one below it.
std::vector<double> choiceErrors(const CurveTree& tree, Index maxCount);

}  // namespace limber
