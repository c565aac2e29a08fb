#include "limber/pipeline/transfer_colors.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "limber/asset/texture_coordinates.h"
#include "limber/core/parallel.h"
#include "limber/mesh/normals.h"
#include "limber/pipeline/texture_bake.h"
#include "limber/transfer/facing_surface.h"
#include "limber/transfer/weight_projection.h"

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
      const Triangle& next = kept[triangles_.size()];  // two corners may have changed places
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

// Triangles of one material, which share a picture.
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

// Each texel as a point of the target, projected onto the source.
std::vector<Vec3f> colorsOf(const Pictured& pictured, const LaidColors& colors, const SurfaceProjector& projector,
                            const PreparedMesh& prepared, std::span<const Vec3> normals) {
  std::vector<Vec3f> result(pictured.texels.size());
  parallelFor(result.size(), kTexelGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const Index v = prepared.weldedVertex[pictured.triangles[pictured.texels[i].triangle][k]];
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

void transferColors(const LaidSource& source, const ColorTransfer& colors, Asset& target, const Geometry& geometry,
                    const PreparedMesh& prepared) {
  const LaidColors laid(source, colors.at);
  addMissingMaterials(target, geometry);
  std::map<Index, Pictured> pictures;
  if (colors.picture) pictures = picturesOf(target, geometry, colors.pictureSize);
  std::set<Index> pictured;
  for (const auto& [material, picture] : pictures) pictured.insert(material);

  std::vector<Vec3f> ofWelded, ofVertices;
  for (const SurfacePoint& point : source.rig.points) ofWelded.push_back(laid.at(point));
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
    const std::vector<Vec3f> ofTexels = colorsOf(picture, laid, projector, prepared, normals);
    const std::vector<Vec3f> pixels = pictureOf(picture.texels, ofTexels, colors.pictureSize);
    setBaseColorPicture(target, material, colors.picture(colors.pictureSize, pixels));
  }
}

}  // namespace limber
