#include "limber/actions/transfer/transfer_colors.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "limber/actions/transfer/texture_bake.h"
#include "limber/core/parallel.h"
#include "limber/document/scene/texture_coordinates.h"
#include "limber/geometry/mesh/normals.h"
#include "limber/rigging/transfer/facing_surface.h"
#include "limber/rigging/transfer/weight_projection.h"

namespace limber {

namespace {

constexpr std::size_t kTexelGrain = 1024;

// The colour of points of the source's welded surface, facing outwards.
class LaidColors {
 public:
  // Welding and leaving out what is worn keep the order of the triangles that stay.
  LaidColors(const LaidSource& source, const SurfaceColor& color) : source_(source), color_(color) {
    const std::vector<Index>& welded = source.prepared.weldedVertex;
    const std::vector<Triangle>& kept = source.rig.source.triangles;
    for (Index t = 0; t < source.geometry.triangles.size() && triangles_.size() < kept.size(); ++t) {
      const auto& [a, b, c] = source.geometry.triangles[t];
      const Triangle& next = kept[triangles_.size()];  // two corners may have been swapped
      if (std::is_permutation(next.begin(), next.end(), Triangle{welded[a], welded[b], welded[c]}.begin())) {
        triangles_.push_back(t);
      }
    }
  }

  Vec3f at(const SurfacePoint& point) const {
    const Triangle& turned = source_.rig.source.triangles[point.triangle];
    const Index triangle = triangles_[point.triangle];
    Vec3 weights = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      const Index corner = source_.prepared.weldedVertex[source_.geometry.triangles[triangle][k]];
      const auto at = std::find(turned.begin(), turned.end(), corner) - turned.begin();
      weights[static_cast<Eigen::Index>(k)] = point.weights[at];
    }
    return color_(triangle, weights);
  }

 private:
  const LaidSource& source_;
  const SurfaceColor& color_;
  std::vector<Index> triangles_;
};

// Triangles of one material, which have one texture.
struct Pictured {
  std::vector<Triangle> triangles;
  std::vector<Texel> texels;
};

// By material; those whose primitives all have texture coordinates that fit one picture.
std::map<Index, Pictured> picturesOf(const Asset& target, const Geometry& geometry, int size) {
  std::vector<Vec2f> uvs(geometry.positions.size(), Vec2f::Constant(-1));  // none: beyond the picture
  std::vector<Index> materialOf(geometry.positions.size(), kNoIndex);
  std::set<std::pair<Index, Index>> done;
  for (const PrimitiveInstance& instance : geometry.instances) {
    if (!done.insert({instance.mesh, instance.primitive}).second) continue;
    const std::vector<Vec2f> own = readUvs(target, instance);
    std::copy(own.begin(), own.end(), uvs.begin() + instance.firstVertex);
    const gltf::Primitive& primitive = target.document.meshes[instance.mesh].primitives[instance.primitive];
    std::fill_n(materialOf.begin() + instance.firstVertex, instance.vertexCount, *primitive.material);
  }
  std::map<Index, Pictured> pictures;
  for (const Triangle& t : geometry.triangles) {
    if (materialOf[t[0]] != kNoIndex) pictures[materialOf[t[0]]].triangles.push_back(t);
  }
  for (auto it = pictures.begin(); it != pictures.end();) {
    std::optional<std::vector<Texel>> texels = texelsOf(it->second.triangles, uvs, size);
    if (texels && !texels->empty()) it->second.texels = std::move(*texels);
    it = it->second.texels.empty() ? pictures.erase(it) : std::next(it);
  }
  return pictures;
}

// By vertex of the target's Geometry.
std::vector<bool> isSurroundings(const FigureSurface& figure) {
  std::vector<bool> ofWelded(figure.prepared.mesh.positions.size(), false), ofVertices;
  for (const Index v : figure.surroundings) ofWelded[v] = true;
  for (const Index v : figure.prepared.weldedVertex) ofVertices.push_back(ofWelded[v]);
  return ofVertices;
}

// The geometry with those primitives alone that are to be coloured: all but the surroundings'. One of these that has
// its material in common with the others gets a copy for itself.
Geometry withoutSurroundings(Asset& target, const Geometry& geometry, const std::vector<bool>& isAround) {
  Geometry result{geometry.positions, geometry.triangles, {}};
  std::set<std::pair<Index, Index>> colored;
  std::set<Index> materials;
  const auto primitiveOf = [&](const PrimitiveInstance& instance) -> gltf::Primitive& {
    return target.document.meshes[instance.mesh].primitives[instance.primitive];
  };
  for (const PrimitiveInstance& instance : geometry.instances) {
    const auto first = isAround.begin() + instance.firstVertex, end = first + instance.vertexCount;
    if (first != end && std::find(first, end, false) == end) continue;
    colored.insert({instance.mesh, instance.primitive});
    if (const std::optional<Index>& material = primitiveOf(instance).material) materials.insert(*material);
  }
  std::map<Index, Index> copies;
  for (const PrimitiveInstance& instance : geometry.instances) {
    if (colored.count({instance.mesh, instance.primitive}) > 0) {
      result.instances.push_back(instance);
      continue;
    }
    std::optional<Index>& material = primitiveOf(instance).material;
    if (!material || materials.count(*material) == 0) continue;
    const auto [copy, isNew] = copies.try_emplace(*material, 0);
    if (isNew) {
      gltf::Material same = target.document.materials[*material];
      copy->second = addElement(target.document.materials, std::move(same));
    }
    material = copy->second;
  }
  return result;
}

// Each texel as a point of the target, projected onto the source; white for surroundings.
std::vector<Vec3f> colorsOf(const Pictured& pictured, const LaidColors& colors, const SurfaceProjector& projector,
                            const PreparedMesh& prepared, std::span<const Vec3> normals,
                            const std::vector<bool>& isAround) {
  std::vector<Vec3f> result(pictured.texels.size());
  parallelFor(result.size(), kTexelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& corners = pictured.triangles[pictured.texels[i].triangle];
      if (isAround[corners[0]]) {
        result[i].setOnes();
        continue;
      }
      Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = prepared.weldedVertex[corners[k]];
        const double weight = pictured.texels[i].weights[static_cast<Eigen::Index>(k)];
        position += weight * prepared.mesh.position(v);
        normal += weight * normals[v].normalized();
      }
      result[i] = colors.at(projector.at(position, normal));
    }
  });
  return result;
}

}  // namespace

void transferColors(const LaidSource& source, const ColorTransfer& colors, Asset& target, const Geometry& whole,
                    const FigureSurface& figure) {
  const PreparedMesh& prepared = figure.prepared;
  const LaidColors laid(source, colors.at);
  const std::vector<bool> isAround = isSurroundings(figure);
  const Geometry geometry = withoutSurroundings(target, whole, isAround);
  addMissingMaterials(target, geometry);
  std::map<Index, Pictured> pictures;
  if (colors.picture) pictures = picturesOf(target, geometry, colors.pictureSize);
  std::set<Index> pictured;
  for (const auto& [material, picture] : pictures) pictured.insert(material);

  std::vector<Vec3f> ofWelded, ofVertices;
  for (const SurfacePoint& point : source.rig.points) ofWelded.push_back(laid.at(point));
  for (const Index v : figure.surroundings) ofWelded[v].setOnes();
  for (const Index v : prepared.weldedVertex) ofVertices.push_back(ofWelded[v]);
  setVertexColors(target, geometry, ofVertices, pictured);
  if (pictures.empty()) return;

  TriMesh registered = source.rig.source;
  for (std::size_t v = 0; v < source.rig.registered.size(); ++v) {
    registered.positions[v] = source.rig.registered[v].cast<float>();
  }
  const SurfaceProjector projector(registered);
  const TriMesh facing = facingOutwards(prepared.mesh);
  const std::vector<Vec3> normals = areaNormals<Vec3f>(facing.positions, facing.triangles);
  for (const auto& [material, picture] : pictures) {
    const std::vector<Vec3f> ofTexels = colorsOf(picture, laid, projector, prepared, normals, isAround);
    const std::vector<Vec3f> pixels = pictureOf(picture.texels, ofTexels, colors.pictureSize);
    setBaseColorPicture(target, material, colors.picture(colors.pictureSize, pixels));
  }
}

}  // namespace limber
