#include "limber/preview/part_scene.h"

#include <map>
#include <utility>

#include "limber/preview/image/palette.h"

namespace limber {

Scene coloredByParts(const Scene& scene, std::span<const Index> partOf) {
  if (partOf.size() != scene.triangles.size()) {
    throw Error(ErrorCode::kBadArgument, "the parts to show are not those of the model's triangles");
  }
  Scene colored;
  colored.joints = scene.joints;
  colored.bones = scene.bones;
  colored.warnings = scene.warnings;
  colored.positions = scene.positions;
  colored.triangles = scene.triangles;
  colored.colors.assign(scene.positions.size(), linearFromSrgb(150, 150, 150));
  std::vector<Index> ownPart(scene.positions.size(), kNoIndex);
  std::map<std::pair<Index, Index>, Index> copies;  // vertex and part -> its copy
  for (std::size_t t = 0; t < partOf.size(); ++t) {
    for (Index& v : colored.triangles[t]) {
      if (ownPart[v] == kNoIndex) {
        ownPart[v] = partOf[t];
        colored.colors[v] = jointColor(partOf[t]);
      }
      if (ownPart[v] == partOf[t]) continue;
      const auto [copy, fresh] = copies.try_emplace({v, partOf[t]}, static_cast<Index>(colored.positions.size()));
      if (fresh) {
        colored.positions.push_back(scene.positions[v]);
        colored.colors.push_back(jointColor(partOf[t]));
      }
      v = copy->second;
    }
  }
  return colored;
}

}  // namespace limber
