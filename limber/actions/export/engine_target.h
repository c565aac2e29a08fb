// Other programs that models are made for, and what their importers and retargeters expect of a skeleton.
#pragma once

#include <span>
#include <string_view>

#include "limber/actions/export/bone_axes.h"
#include "limber/actions/export/bone_names.h"
#include "limber/actions/export/name_style.h"
#include "limber/character/anatomy/skeleton_reading.h"
#include "limber/document/asset.h"
#include "limber/document/fbx/export_fbx.h"
#include "limber/skeleton/motion.h"

namespace limber {

struct EngineTarget {
  std::string_view name, summary;
  BoneNames boneNames;
  NameStyle style;
  std::string_view rootName;  // of the joint at the origin above all others; empty: none is made
  BoneAxes axes;
  FbxUnit fbxUnit;  // of an FBX for it

  // Nothing is changed.
  bool isPlain() const { return name == "gltf"; }
};

inline constexpr std::string_view kPlainTarget = "gltf";

std::span<const EngineTarget> engineTargets();
// Throws Error kBadArgument with the names that there are.
const EngineTarget& findTarget(std::string_view name);

// The same model as the target expects it. The joints of the skeleton have the target's names and axes; where it asks
// for a root, a joint at the origin is the parent of them all, nodes above the skeleton are gone, and joints have no
// scale in bind pose. A node that is no joint is renamed where a joint needs its name. Surface, bind pose and clips
// look as they did; inverse bind matrices and keys are new.
//
// Joints keep their axes where something else depends on them: a mesh, a camera or an extension of the node,
// colliders, a view's offset. Joints whose scale is uneven are turned by quarters. The warning "kept-axes" counts both.
// A skeleton alone, which a motion has (isSkeletonAlone, movingSkeleton), is a model without a surface. Every asset for
// the target "gltf" stays as it is; so does one that has neither a rig nor such a skeleton, with the warning
// "no-skeleton". Throws as readAnatomy does.
//
// known  a reading of the skeleton, if there is one
void toTarget(Asset& asset, const EngineTarget& target, const SkeletonReading& known = Skeleton());

// The same for a motion: joints are where they were in every frame. Keys are single precision afterwards.
void toTarget(Motion& motion, const EngineTarget& target);

}  // namespace limber
