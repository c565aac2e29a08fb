#include "limber/document/fbx/import_fbx_models.h"

#include <algorithm>

namespace limber {

namespace {

// A chain of more models that do not inherit scale as glTF has it is taken as if they did: its cost grows with its
// length.
constexpr std::size_t kLongestCompensated = 256;

bool isUniform(const Vec3& scaling) {
  return scaling.x() == scaling.y() && scaling.x() == scaling.z() && scaling.x() > 0;
}

}  // namespace

FbxPose FbxMotion::at(std::int64_t ticks, bool fromLeft) const {
  std::array<Vec3, 3> values = still;
  for (std::size_t kind = 0; kind < 3; ++kind) {
    for (int axis = 0; axis < 3; ++axis) {
      if (const FbxCurve* curve = curves[kind][static_cast<std::size_t>(axis)]) {
        values[kind][axis] = curve->at(ticks, fromLeft);
      }
    }
  }
  return {values[0], values[1], values[2]};
}

FbxModels::FbxModels(const FbxObjects& objects) : byObject_(objects.count()) {
  const auto parentOf = [&](Index object) -> std::optional<Index> {
    for (const FbxObjects::Link& link : objects.destinations(object)) {
      if (link.property.empty() && objects.is(link.object, "Model")) return link.object;
    }
    return std::nullopt;
  };
  std::vector<Index> stack;
  for (Index o = objects.count(); o-- > 0;) {
    if (objects.is(o, "Model") && !parentOf(o)) stack.push_back(o);
  }
  while (!stack.empty()) {
    const Index object = stack.back();
    stack.pop_back();
    FbxModel model;
    model.object = object;
    if (const std::optional<Index> parent = parentOf(object)) model.parent = byObject_[*parent];
    model.transform = fbxTransform(objects.properties(object));
    byObject_[object] = count();
    if (model.parent) children_[*model.parent].push_back(count());
    models_.push_back(std::move(model));
    children_.emplace_back();
    const std::vector<Index> children = objects.sources(object, "Model");
    for (std::size_t c = children.size(); c-- > 0;) {
      // Of two parents the first counts; a second connection to the same one is the same.
      const bool isNew = !byObject_[children[c]] && parentOf(children[c]) == object &&
                         std::find(children.begin(), children.begin() + static_cast<std::ptrdiff_t>(c), children[c]) ==
                             children.begin() + static_cast<std::ptrdiff_t>(c);
      if (isNew) stack.push_back(children[c]);
    }
  }
}

std::optional<Index> FbxModels::modelOf(Index object) const {
  return byObject_[object];
}

void FbxModels::findCompensated(const std::vector<bool>& curvesScale) {
  std::vector<bool> isUneven(models_.size(), false);  // a model or one of its parents
  std::vector<std::size_t> depth(models_.size(), 1);
  for (Index m = 0; m < count(); ++m) {
    FbxModel& model = models_[m];
    const Vec3& own = model.transform.rest.scaling;
    isUneven[m] = curvesScale[m] || !isUniform(own);
    if (!model.parent) continue;
    const Index parent = *model.parent;
    depth[m] = depth[parent] + 1;
    const bool parentScales = curvesScale[parent] || models_[parent].transform.rest.scaling != Vec3::Ones();
    const bool matters = model.transform.inherit == FbxInherit::kRrSs  ? isUneven[parent]
                         : model.transform.inherit == FbxInherit::kRrs ? parentScales
                                                                       : false;
    model.isCompensated = matters && depth[m] <= kLongestCompensated;
    isUneven[m] = isUneven[m] || isUneven[parent];
  }
}

std::vector<Index> FbxModels::chainOf(Index model) const {
  std::vector<Index> chain;
  for (std::optional<Index> m = model; m; m = models_[*m].parent) chain.push_back(*m);
  std::reverse(chain.begin(), chain.end());
  return chain;
}

Affine FbxModels::restLocal(Index model) const {
  return localOf(model, [&](Index m) { return models_[m].transform.rest; });
}

Affine FbxModels::restWorld(Index model) const {
  const std::vector<Index> chain = chainOf(model);
  return worldOf(chain, chain.size(), [&](Index m) { return models_[m].transform.rest; });
}

}  // namespace limber
