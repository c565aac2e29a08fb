// A body model in SMPL's layout of arrays (Loper and others 2015) as a rigged Asset.
#pragma once

#include <string_view>

#include "limber/document/asset.h"
#include "limber/document/smpl/npz.h"

namespace limber {

// The body at rest with its joints and weights, Y up, metres, as the arrays have them:
//   v_template     #V x 3    vertices
//   f              #F x 3    triangles
//   weights        #V x #J   of which the eight greatest of a vertex count
//   kintree_table  2 x #J    above: the number of the joint's parent, -1 (or 2^32 - 1, 2^64 - 1) for none; below: its
//   own J_regressor    #J x #V   joints out of vertices; or else J              #J x 3    joints shapedirs      #V x 3
//   x #S, optional: the first ten become blend shapes "shape_00", ...
// A parent comes before its children. 24 joints have the names of SMPL's, others are "joint_00", ... Shapes that depend
// on the pose (posedirs) stay out, with a warning "pose-shapes".
//
// Throws Error kBadData, naming the array, where one is missing, has another shape, breaks its format or holds what
// cannot be, and kUnsupported as readNpy does; where() begins with `name`. The result has passed checkAsset.
Asset smplBody(const NpzFiles& arrays, std::string_view name);

}  // namespace limber
