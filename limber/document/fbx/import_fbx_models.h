// The tree of an FBX file's models.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/asset.h"
#include "limber/document/fbx/import_fbx_curve.h"
#include "limber/document/fbx/import_fbx_objects.h"
#include "limber/document/fbx/import_fbx_transform.h"

namespace limber {

// The curves that move a model in one clip: by kind (translation, rotation, scaling) and axis; null where a component
// has no curve, which then has the value in `still`.
struct FbxMotion {
  std::array<std::array<const FbxCurve*, 3>, 3> curves = {};
  std::array<Vec3, 3> still;
  std::array<bool, 3> moves = {};  // by kind: by a curve, or away from the rest for the whole clip

  explicit FbxMotion(const FbxPose& rest) : still{rest.translation, rest.rotation, rest.scaling} {}
  FbxPose at(std::int64_t ticks, bool fromLeft) const;
};

struct FbxModel {
  Index object = 0;
  std::optional<Index> parent;  // model
  FbxTransform transform;
  // Does it inherit its parents' scale in a manner that glTF does not have (FbxInherit), with an effect? Then its
  // transform in the document depends on those of its parents.
  bool isCompensated = false;
};

// Models in the order of the tree, parents before children. What hangs on itself is left out.
class FbxModels {
 public:
  explicit FbxModels(const FbxObjects& objects);

  const std::vector<FbxModel>& list() const { return models_; }
  const FbxModel& operator[](Index model) const { return models_[model]; }
  Index count() const { return static_cast<Index>(models_.size()); }
  std::optional<Index> modelOf(Index object) const;
  const std::vector<Index>& childrenOf(Index model) const { return children_[model]; }

  // Sets isCompensated, from the rest scales and from those that curves may give. `curvesScale`: #models, whether a
  // curve gives the model another scale than its rest's.
  void findCompensated(const std::vector<bool>& curvesScale);

  // A model's transform relative to its parent by glTF's inheritance, where each is posed by `poseOf(model)`.
  template <typename PoseOf>
  Affine localOf(Index model, const PoseOf& poseOf) const;
  Affine restLocal(Index model) const;
  Affine restWorld(Index model) const;

  // A model and its parents, the topmost first.
  std::vector<Index> chainOf(Index model) const;

 private:
  template <typename PoseOf>
  Affine worldOf(const std::vector<Index>& chain, std::size_t length, const PoseOf& poseOf) const;

  std::vector<FbxModel> models_;
  std::vector<std::vector<Index>> children_;
  std::vector<std::optional<Index>> byObject_;
};

template <typename PoseOf>
Affine FbxModels::worldOf(const std::vector<Index>& chain, std::size_t length, const PoseOf& poseOf) const {
  Affine world = Affine::Identity();
  Vec3 scaling = Vec3::Ones();
  for (std::size_t i = 0; i < length; ++i) {
    const FbxTransform& transform = models_[chain[i]].transform;
    const FbxPose pose = poseOf(chain[i]);
    world = inheritedWorld(world, scaling, transform.local(pose), transform.inherit);
    scaling = pose.scaling;
  }
  return world;
}

template <typename PoseOf>
Affine FbxModels::localOf(Index model, const PoseOf& poseOf) const {
  if (!models_[model].isCompensated) return models_[model].transform.local(poseOf(model)).toAffine();
  const std::vector<Index> chain = chainOf(model);
  const Affine parent = worldOf(chain, chain.size() - 1, poseOf);
  const Affine local = parent.inverse() * worldOf(chain, chain.size(), poseOf);
  return local.matrix().allFinite() ? local : models_[model].transform.local(poseOf(model)).toAffine();
}

}  // namespace limber
