#include "limber/asset/mesh_asset.h"

#include <nlohmann/json.hpp>

#include "limber/asset/accessor.h"

namespace limber {

Asset meshAsset(const TriMesh& mesh) {
  Asset asset;
  std::vector<float> places;
  std::vector<Index> corners;
  for (const Vec3f& p : mesh.positions) places.insert(places.end(), {p.x(), p.y(), p.z()});
  for (const Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  Json& json = asset.json();
  json["asset"] = {{"version", "2.0"}, {"generator", "limber"}};
  json["scene"] = 0;
  json["scenes"] = Json::array({{{"nodes", {0}}}});
  json["nodes"] = Json::array({{{"name", "model"}, {"mesh", 0}}});
  const Index positions = addFloatAccessor(asset, places, 3, kVertexTarget, true);
  const Index indices = addAccessor(
      asset, {static_cast<Index>(corners.size()), 1, ComponentType::kU32, false},
      {reinterpret_cast<const std::uint8_t*>(corners.data()), corners.size() * sizeof(Index)}, kIndexTarget);
  json["meshes"] =
      Json::array({{{"name", "model"},
                    {"primitives", Json::array({{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}})}}});
  asset.name = "model.glb";
  asset.format = "glb";
  return asset;
}

}  // namespace limber
