// The joint above a whole skeleton that engines move a character by.
#pragma once

#include <optional>
#include <string>

#include "limber/document/rig/rig_io.h"

namespace limber {

// The joint that is one already: the only root of animatedSkeleton(asset), at the origin and no higher than the lowest
// joint (within a twentieth of the skeleton's size), that no vertex follows more than any other joint; nullopt where
// there is none.
std::optional<Index> findRootJoint(const Asset& asset, const AssetSkeleton& skeleton);

// Puts a joint called `name` (with a number behind it where a node has that name) above all roots of
// animatedSkeleton(asset), at the world's origin and turned as the world; that is where glTF's models stand. Its
// node is a child of what the roots hang on, of several parents of the nearest node that is above them all; it has that
// node's scale. It joins every skin behind the joints that are there, so that weights stay as they are, and becomes
// their "skeleton". Nothing moves: in no clip, as channels of the roots are written for their new parent.
//
// Returns the skeleton as it is afterwards: the new joint is 0, all others follow in their order, with the names that
// they had. Warning "second-root" where the only root stood as such a joint does. Throws Error kBadData as
// animatedSkeleton does; kUnsupported where the roots do not hang on one node and those between are animated, or where
// a frame between is stretched or sheared and a root is animated.
AssetSkeleton addRootJoint(Asset& asset, const std::string& name = "root");

}  // namespace limber
