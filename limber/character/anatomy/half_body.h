// A skeleton folded along its plane of symmetry: left and right become one, so that what is read of one side holds for
// the other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limber/character/anatomy/joint_tree.h"

namespace limber {

enum class HalfKind { kMiddle, kPair, kSingle };  // in the plane; two mirror images; beside it without a partner

struct HalfJoint {
  Index joint = 0;               // of a pair the one on the side that `lateral` points to
  std::optional<Index> partner;  // of a pair
  HalfKind kind = HalfKind::kMiddle;
  std::optional<Index> parent;  // another HalfJoint, always before this one
  Vec3 at = Vec3::Zero();       // world; of a pair the mean of one and of the other's mirror image
};

// The joint with the same name but for the side.
struct NamedPartner {
  Index partner = 0;
  bool isLeft = false;  // the joint itself, by its name
};

struct HalfBody {
  std::vector<HalfJoint> joints;  // parents first; every joint of the skeleton is in exactly one
  Vec3 lateral = Vec3::UnitX();   // across the plane of symmetry, of length 1; it does not say which side is left
  double pairedFraction = 0;      // of the length of all bones, less where they are no mirror images
  bool sidesByName = false;       // names, not positions, say which of a pair is which: the first is the left one
  bool hasPairs = false;          // else `lateral` is a guess
};

// Joints are partners if they are children of partners, or of one joint in the plane, with subtrees and lengths about
// the same, and lie where the mirror image lies, as far as the pose allows: limbs may be turned. The plane is that
// which makes most of the skeleton's length pairs. Cost: for each joint the square of its children (at most 64 of them
// are compared).
//
// positions  #J, world
// named      #J partners by their names, none where names give none; empty: as if joints had none. They are partners
//            even if they lie at one position; the left one is then the first.
HalfBody foldBody(const JointTree& tree, std::span<const Vec3> positions,
                  std::span<const std::optional<NamedPartner>> named = {});

}  // namespace limber
