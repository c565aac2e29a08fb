// Single joints of the rig that a document has: added, hung elsewhere, taken out.
#pragma once

#include <string>

#include "limber/document/rig/rig_io.h"

namespace limber {

// All three require skeleton = readSkeleton(asset) of the asset as it is, and no animation of its joints (it would not
// mean the same afterwards). The bind pose, the nodes' world transforms and the skins of all other joints stay. Read
// the skeleton again afterwards: joints have other numbers.

// A joint without weights below another, at `translation` in the other's frame and turned as it is. It joins the skins
// that the joint above belongs to. `name` must not be a joint's.
void addJoint(Asset& asset, const AssetSkeleton& skeleton, Index parent, const Vec3& translation,
              const std::string& name);

// With all that hangs on it; `parent` is neither the joint nor below it.
void hangJoint(Asset& asset, const AssetSkeleton& skeleton, Index joint, Index parent);

// The joint's children become children of its parent. Skins that need a joint as its replacement take `heir`. No vertex
// may have weights of it: see replaceWeights; those of the others are rewritten, as they are in `weights`. A node that
// contains something else than joints stays, and so does a root's: they are no joints any more.
//
// geometry, weights  of the asset as it is, over `skeleton`
void removeJoint(Asset& asset, const Geometry& geometry, const AssetSkeleton& skeleton, const SkinWeights& weights,
                 Index joint, Index heir);

}  // namespace limber
