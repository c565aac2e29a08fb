#include "limber/actions/parts/model_parts.h"

#include <array>

#include "limber/core/text/names.h"
#include "limber/geometry/mesh/prepare.h"

namespace limber {

namespace {

struct MethodName {
  std::string_view name;
  PartMethod method;
};
struct DetailName {
  std::string_view name;
  PartDetail detail;
};

constexpr std::array<MethodName, 3> kMethods = {
    {{"auto", PartMethod::kAuto}, {"weights", PartMethod::kWeights}, {"shape", PartMethod::kShape}}};
constexpr std::array<DetailName, 2> kDetails = {{{"limbs", PartDetail::kLimbs}, {"joints", PartDetail::kJoints}}};

// The triangles of the geometry that prepareMesh kept, in its order.
std::vector<Index> keptTriangles(const Geometry& geometry, const PreparedMesh& prepared) {
  std::vector<Index> kept;
  kept.reserve(prepared.mesh.triangles.size());
  for (Index t = 0; t < geometry.triangles.size(); ++t) {
    const Triangle& v = geometry.triangles[t];
    const Index a = prepared.weldedVertex[v[0]], b = prepared.weldedVertex[v[1]], c = prepared.weldedVertex[v[2]];
    if (a != b && b != c && c != a) kept.push_back(t);
  }
  return kept;
}

// The surface as the methods take it, and which of its triangles that are.
struct KeptSurface {
  PreparedMesh prepared;
  std::vector<Index> kept;
  FaceGraph graph;
};

KeptSurface keptSurface(const Geometry& geometry) {
  KeptSurface surface;
  surface.prepared = prepareGeometry(geometry, geometry.triangles);
  surface.kept = keptTriangles(geometry, surface.prepared);
  surface.graph = faceGraph(surface.prepared.mesh);
  return surface;
}

SurfaceParts byWeights(const Geometry& geometry, const KeptSurface& surface, const Skeleton& skeleton,
                       const SkinWeights& weights, PartDetail detail, Progress& progress) {
  std::vector<Triangle> triangles;
  triangles.reserve(surface.kept.size());
  for (const Index t : surface.kept) triangles.push_back(geometry.triangles[t]);
  SurfaceParts parts = partsByWeights(surface.graph, triangles, weights, jointGroups(skeleton, detail), progress);
  if (detail == PartDetail::kLimbs && parts.partCount() == 1) {
    parts = partsByWeights(surface.graph, triangles, weights, jointGroups(skeleton, PartDetail::kJoints), progress);
  }
  return parts;
}

// From the kept triangles to all of the geometry.
std::vector<Index> expand(const Geometry& geometry, const KeptSurface& surface, std::span<const Index> partOf) {
  const PreparedMesh& prepared = surface.prepared;
  std::vector<Index> all(geometry.triangles.size(), kNoIndex), partAt(prepared.mesh.vertexCount(), kNoIndex);
  for (std::size_t i = surface.kept.size(); i-- > 0;) {
    all[surface.kept[i]] = partOf[i];
    for (const Index v : prepared.mesh.triangles[i]) partAt[v] = partOf[i];
  }
  for (std::size_t t = 0; t < all.size(); ++t) {
    for (const Index v : geometry.triangles[t]) {
      if (all[t] == kNoIndex) all[t] = partAt[prepared.weldedVertex[v]];
    }
    if (all[t] == kNoIndex) all[t] = 0;
  }
  return all;
}

}  // namespace

PartMethod parsePartMethod(std::string_view name) {
  return findByName(kMethods, "segmentation method", name).method;
}

PartDetail parsePartDetail(std::string_view name) {
  return findByName(kDetails, "detail of parts", name).detail;
}

SurfaceParts modelParts(const Character& character, const PartOptions& options, Progress& progress) {
  const Geometry& geometry = character.surface();
  const bool rigged = character.hasRig();
  if (options.method == PartMethod::kWeights && !rigged) {
    throw Error(ErrorCode::kBadArgument, "has no rig whose weights could tell parts", character.document().name,
                "make one with limber rig, or take the parts by shape");
  }
  const KeptSurface surface = keptSurface(geometry);
  SurfaceParts parts;
  if (rigged && options.method != PartMethod::kShape) {
    parts = byWeights(geometry, surface, character.binding().skeleton, character.weights(), options.detail, progress);
  } else {
    parts = partsByShape(surface.graph, {options.count}, progress);
  }
  parts.partOf = expand(geometry, surface, parts.partOf);
  return parts;
}

SurfaceParts riggedParts(const Geometry& geometry, const Skeleton& skeleton, const SkinWeights& weights,
                         PartDetail detail) {
  const KeptSurface surface = keptSurface(geometry);
  Progress ignored;
  SurfaceParts parts = byWeights(geometry, surface, skeleton, weights, detail, ignored);
  parts.partOf = expand(geometry, surface, parts.partOf);
  return parts;
}

}  // namespace limber
