#include "limber/adapters/returned_rig.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/adapters/rignet_text.h"
#include "limber/adapters/space_check.h"
#include "limber/character/character.h"
#include "limber/core/counted.h"
#include "limber/core/known_error.h"
#include "limber/core/parallel.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/rigging/transfer/weight_projection.h"

namespace limber {

namespace {

// Of the model's longest side: rounding of a file's floats in other units.
constexpr double kSamePosition = 1e-5;
// Programs that take triangles away move the surface by less; of another surface most lies farther. A hundredth of the
// vertices may: small parts go first.
constexpr double kNearSurface = 0.01, kMayBeFar = 0.01;
constexpr std::size_t kMatchGrain = 256;  // vertices

// As the file has it; then moved to the working space.
struct RigWithSurface {
  Skeleton skeleton;
  SkinWeights weights;  // of the surface's vertices; no slots: none
  TriMesh surface;
  bool keepsOrder = false;  // its vertices are those handed over, one by one
  Warnings warnings;
};

RigWithSurface rigOfText(const ProgramOutput& output, const HandedModel& handed) {
  const std::string_view text(reinterpret_cast<const char*>(output.bytes.data()), output.bytes.size());
  RignetRig rig = readRignetText(text, output.name, handed.mesh.vertexCount());
  return {std::move(rig.skeleton), std::move(rig.weights), handed.mesh, true, std::move(rig.warnings)};
}

RigWithSurface rigOfDocument(const ProgramOutput& output) {
  const Character character(readAsset(ByteSpan(output.bytes), output.name));
  if (!character.hasRig()) throw Error(ErrorCode::kBadData, "has no skeleton with a skin", output.name);
  RigWithSurface rig;
  rig.skeleton = character.binding().skeleton;
  rig.weights = character.weights();
  rig.surface = {character.surface().positions, character.surface().triangles};
  return rig;
}

void moveSurface(TriMesh& surface, const Affine& map) {
  for (Vec3f& p : surface.positions) p = (map * Vec3(p.cast<double>())).cast<float>();
}

// The even scale and the move that take one box to another of its shape.
Affine boxMap(const Box& from, const Box& to) {
  Affine map = Affine::Identity();
  const double longest = from.longestSide();
  if (!(longest > 0)) return map;
  map.linear() *= to.longestSide() / longest;
  map.translation() = to.center() - map.linear() * from.center();
  return map;
}

// From the file's space to the working space, with all checks that the spaces are what the adapter says.
void bringHome(RigWithSurface& rig, const Adapter& adapter, const TriMesh& working, const std::string& name) {
  // The text's surface is ours, as it was handed over.
  const AdapterUp surfaceUp = rig.keepsOrder ? adapter.inputUp : adapter.outputUp;
  moveSurface(rig.surface, toHandedSpace(surfaceUp, adapter.inputSize).inverse());
  Affine toWorking = toHandedSpace(adapter.outputUp, adapter.inputSize).inverse();
  if (!rig.keepsOrder) {
    const Box own = surfaceBox(working);
    if (adapter.mayRescale) {
      const Affine fit = boxMap(surfaceBox(rig.surface), own);
      moveSurface(rig.surface, fit);
      toWorking = fit * toWorking;
    }
    checkSameBox(surfaceBox(rig.surface), own, name);
  }
  rig.skeleton = movedSkeleton(rig.skeleton, toWorking);
  if (rig.keepsOrder) checkJointSpace(rig.skeleton, rig.surface, rig.weights.slots > 0 ? &rig.weights : nullptr, name);
}

// Corners of triangles by vertex, so that a vertex can be told as a point of the surface.
class VertexCorners {
 public:
  explicit VertexCorners(const TriMesh& mesh) : corner_(mesh.positions.size(), {kNoIndex, 0}) {
    for (Index t = 0; t < mesh.triangleCount(); ++t) {
      for (int k = 0; k < 3; ++k) {
        auto& corner = corner_[mesh.triangles[t][k]];
        if (corner.first == kNoIndex) corner = {t, k};
      }
    }
  }

  bool has(Index vertex) const { return corner_[vertex].first != kNoIndex; }
  SurfacePoint at(const TriMesh& mesh, Index vertex, double distance) const {
    return {corner_[vertex].first, Vec3::Unit(corner_[vertex].second), mesh.position(vertex), distance};
  }

 private:
  std::vector<std::pair<Index, int>> corner_;
};

// Each vertex that has a triangle, as a triangle without area: the nearest of these is the nearest vertex.
TriMesh vertexPoints(const TriMesh& mesh, const VertexCorners& corners) {
  TriMesh points;
  points.positions = mesh.positions;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (corners.has(v)) points.triangles.push_back({v, v, v});
  }
  return points;
}

// What each vertex of the model takes after.
std::vector<SurfacePoint> matchingPoints(const RigWithSurface& rig, const TriMesh& working, const HandedModel& handed) {
  const VertexCorners corners(rig.surface);
  const Bvh surface(rig.surface);
  const TriMesh vertices = vertexPoints(rig.surface, corners);
  const Bvh vertexTree(vertices);
  std::vector<SurfacePoint> points(working.positions.size());
  parallelFor(points.size(), kMatchGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto& same = handed.vertexOf[v];
      if (rig.keepsOrder && same) {
        points[v] = corners.at(rig.surface, *same, 0);
        continue;
      }
      const Vec3 position = working.position(static_cast<Index>(v));
      const SurfacePoint vertex = vertexTree.nearestPoint(position);
      points[v] = vertex.distance <= kSamePosition
                      ? corners.at(rig.surface, vertices.triangles[vertex.triangle][0], vertex.distance)
                      : surface.nearestPoint(position);
    }
  });
  return points;
}

void checkSameSurface(const std::vector<SurfacePoint>& points, const HandedModel& handed, const std::string& name) {
  std::size_t far = 0;
  double farthest = 0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (!handed.vertexOf[v]) continue;
    far += points[v].distance > kNearSurface ? 1 : 0;
    farthest = std::max(farthest, points[v].distance);
  }
  if (static_cast<double>(far) <= kMayBeFar * handed.mesh.vertexCount()) return;
  throw Error(
      ErrorCode::kBadData,
      fmt::format("the surface is not the model's: {} of {} lie farther from it than {:g} % of the longest side, "
                  "up to {:.3g} %",
                  far, counted(handed.mesh.vertexCount(), "vertex", "vertices"), 100 * kNearSurface, 100 * farthest),
      name, "the program turns, mirrors or remakes what it is given: set \"up\" in the adapter");
}

// Those that take after corners of which none has weights.
std::size_t countUnbound(const RigWithSurface& rig, const std::vector<SurfacePoint>& points) {
  std::vector<bool> isBound(rig.surface.positions.size(), false);
  for (Index v = 0; v < rig.surface.vertexCount(); ++v) {
    const auto weights = rig.weights.weightsOf(v);
    isBound[v] = std::any_of(weights.begin(), weights.end(), [](float w) { return w > 0; });
  }
  std::size_t count = 0;
  for (const SurfacePoint& point : points) {
    bool finds = false;
    for (int k = 0; k < 3; ++k) {
      finds = finds || (point.weights[k] > 0 && isBound[rig.surface.triangles[point.triangle][k]]);
    }
    count += finds ? 0 : 1;
  }
  return count;
}

bool bindsAnything(const SkinWeights& weights) {
  return std::any_of(weights.weights.begin(), weights.weights.end(), [](float w) { return w > 0; });
}

}  // namespace

ReturnedRig readReturnedRig(const ProgramOutput& output, const Adapter& adapter, const TriMesh& working,
                            const HandedModel& handed, Index slots) {
  try {
    RigWithSurface rig =
        adapter.outputFormat == AdapterFormat::kRignetText ? rigOfText(output, handed) : rigOfDocument(output);
    if (adapter.ignoresWeights || !bindsAnything(rig.weights)) rig.weights = {};
    bringHome(rig, adapter, working, output.name);
    ReturnedRig result;
    result.warnings = std::move(rig.warnings);
    const std::vector<SurfacePoint> points = matchingPoints(rig, working, handed);
    if (!rig.keepsOrder) checkSameSurface(points, handed, output.name);
    if (rig.weights.slots > 0) {
      if (const std::size_t unbound = countUnbound(rig, points); unbound > 0) {
        result.warnings.add("unbound-vertices",
                            "vertices for which the program gave no weights took those of what is nearest", {},
                            unbound);
      }
      result.weights = projectWeights(rig.surface, rig.weights, points, slots);
    }
    result.skeleton = std::move(rig.skeleton);
    return result;
  } catch (const Error& error) {
    throwWithin(error, adapter.name);
  }
}

}  // namespace limber
