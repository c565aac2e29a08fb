// Where the joints of one body lie in another one that has no skeleton, or another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/core/progress.h"
#include "limber/document/asset.h"
#include "limber/document/scene/geometry.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/transfer/limb_alignment.h"

namespace limber {

// A template's skeleton in a body.
struct FittedSkeleton {
  Skeleton skeleton;  // in world space
  std::string name;   // of the template
  double confidence = 0;
};

// What the body is taken for without its rig, its accessories left out (findAccessories). Nothing where no template is
// likely (RigOptions::mayAbstain). The steps are those of rigWithTemplate.
std::optional<FittedSkeleton> fittedSkeleton(const Asset& asset, const Geometry& geometry, Progress& progress);

// Landmarks of the joints that `source` has in common with `target`, by their anatomy (matchSkeletons); but for the
// trunk between pelvis and neck, whose joints makers put where they like. Throws KnownError kUnlikeRigs where there are
// too few.
std::vector<JointLandmark> commonLandmarks(const Skeleton& source, const Skeleton& target);

// The same by one template in both bodies. Makers put a hip, a neck or a wrist elsewhere in the same body than the
// template does; so each joint keeps its position relative to the source's own template (alignLimbs), unless it
// is as far from that as templates are only when they are wrong.
// size  of the source's body
std::vector<JointLandmark> landmarksByTemplate(const Skeleton& source, const Skeleton& inSource,
                                               const Skeleton& inTarget, double size);

}  // namespace limber
