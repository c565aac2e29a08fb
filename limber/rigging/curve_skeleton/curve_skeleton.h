// Curves through the middle of a body's parts, found by contracting its surface.
#pragma once

#include <optional>
#include <vector>

#include "limber/core/progress.h"
#include "limber/rigging/curve_skeleton/joint_choice.h"
#include "limber/rigging/sphere_mesh/sphere_mesh.h"

namespace limber {

// Au, Tai, Chu, Cohen-Or, Lee: Skeleton Extraction by Mesh Contraction, 2008: the surface shrinks under its Laplacian
// (contraction.h), its triangles are collapsed until curves are left (connectivity_surgery.h), and each node of these
// moves to the middle of the surface that went into it.
//
// All runs on an even sampling of the surface (even_surface.h), of kMaxEvenPoints points at most, so that only reading
// the model takes longer the larger it is. Separate pieces have a curve each, joined where their surfaces are nearest;
// loops are cut. Bits that float about are left out (withoutStrays). A model that is its own mirror image has curves
// that are, exactly: what one side alone has counts for both where x > 0, and not at all on the other side.
class CurveSkeleton {
 public:
  // Throws Error kUnsupported for a model without triangles, and for one that is flat. Cost: some tenths of a second,
  // plus O(#V) of the mesh.
  static CurveSkeleton build(const TriMesh& mesh, Progress& progress);

  Index vertexCount() const { return vertexCount_; }  // of the mesh
  const std::optional<MirrorPlane>& mirror() const { return mirror_; }

  // All nodes of the curves, and joints chosen on them (chooseJoints, whose errors this throws), in the space of the
  // mesh.
  const SphereMeshLevel& curves() const { return curves_; }
  SphereMeshLevel level(Index count) const;

  // choiceErrors, in longest sides of the mesh.
  std::vector<double> errors(Index maxCount) const { return choiceErrors(tree_, maxCount); }

 private:
  SphereMeshLevel toMesh(SphereMeshLevel level) const;

  Index vertexCount_ = 0;
  std::optional<MirrorPlane> mirror_;
  CollapseFrame frame_;
  SphereMeshLevel curves_;
  CurveTree tree_;
};

}  // namespace limber
