#include "limber/rigging/weights/weight_steps.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "limber/core/known_error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/components.h"

namespace limber {

namespace {

// Joints of the three corners with their weights interpolated.
void interpolate(const InfluenceTable& table, const Triangle& triangle, const Vec3& barycentric, std::size_t row,
                 InfluenceTable& result) {
  struct Influence {
    Index joint;
    double weight;
  };
  std::array<Influence, 3 * kMaxSlots> all;
  std::size_t count = 0;
  for (int corner = 0; corner < 3; ++corner) {
    for (Index k = 0; k < table.slots(); ++k) {
      const double weight = barycentric[corner] * table.weightsOf(triangle[corner])[k];
      if (!(weight > 0)) continue;
      const Index joint = table.jointsOf(triangle[corner])[k];
      const auto same =
          std::find_if(all.begin(), all.begin() + count, [&](const Influence& i) { return i.joint == joint; });
      if (same != all.begin() + count) {
        same->weight += weight;
      } else {
        all[count++] = {joint, weight};
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) result.offer(row, all[i].joint, static_cast<float>(all[i].weight));
}

}  // namespace

void checkWeightArguments(const TriMesh& mesh, std::span<const Bone> bones, const WeightOptions& options) {
  if (bones.empty()) throw Error(ErrorCode::kBadArgument, "there is no bone to take weights from");
  if (mesh.triangles.empty()) {
    throw KnownError(ErrorKind::kNoSurface, {ErrorCode::kBadArgument, "the mesh has no triangle"});
  }
  if (options.maxInfluences < 1 || options.maxInfluences > kMaxSlots) {
    throw Error(ErrorCode::kBadArgument, "a vertex can keep 1 to 8 influences", {}, "choose `max-influences` 1 to 8");
  }
  if (!options.jointOf.empty() && options.jointOf.size() != mesh.positions.size()) {
    throw Error(ErrorCode::kBadArgument, "not every vertex has a joint");
  }
}

double distanceToBone(const Bone& bone, const Vec3& point) {
  const Vec3 displacement = bone.b - bone.a;
  const double squared = displacement.squaredNorm();
  const double fraction = squared > 0 ? std::clamp((point - bone.a).dot(displacement) / squared, 0.0, 1.0) : 0;
  return std::max(0.0, (point - bone.a - fraction * displacement).norm() - bone.radius);
}

std::vector<Index> bridgeBare(const TriMesh& mesh, InfluenceTable& table) {
  std::vector<Index> bare;
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    if (!(table.weightsOf(v)[0] > 0)) bare.push_back(v);
  }
  if (bare.empty()) return bare;
  std::vector<Index> clothed;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    if (std::all_of(triangle.begin(), triangle.end(), [&](Index v) { return table.weightsOf(v)[0] > 0; })) {
      clothed.push_back(t);
    }
  }
  if (clothed.empty()) return {};
  const Bvh bvh(mesh, clothed);
  const InfluenceTable source = table;
  parallelFor(bare.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const SurfacePoint nearest = bvh.nearestPoint(mesh.position(bare[i]));
      interpolate(source, mesh.triangles[nearest.triangle], nearest.weights, bare[i], table);
    }
  });
  return bare;
}

void bindWholePieces(const TriMesh& mesh, WeightResult& result) {
  Index count = 0;
  const std::vector<Index> piece = vertexComponents(mesh, &count);
  std::vector<std::map<Index, double>> weightByJoint(count);  // by joint
  for (Index v = 0; v < mesh.vertexCount(); ++v) {
    for (Index k = 0; k < result.weights.slots; ++k) {
      weightByJoint[piece[v]][result.weights.jointsOf(v)[k]] += result.weights.weightsOf(v)[k];
    }
  }
  std::vector<Index> most;
  for (const std::map<Index, double>& joints : weightByJoint) {
    most.push_back(std::max_element(joints.begin(), joints.end(), [](const auto& a, const auto& b) {
                     return a.second < b.second;
                   })->first);
  }
  for (Index v = 0; v < mesh.vertexCount(); ++v) bindTo(most[piece[v]], v, result.weights);
  std::set<Index> solid;
  for (const Triangle& t : mesh.triangles) solid.insert(piece[t[0]]);
  result.warnings.add("rigid-pieces", "pieces follow one joint each, as hard parts", {}, solid.size());
}

SkinWeights normalizedWeights(const InfluenceTable& table) {
  SkinWeights result;
  result.slots = table.slots();
  result.joints.assign(table.vertexCount() * table.slots(), 0);
  result.weights.assign(table.vertexCount() * table.slots(), 0.0f);
  for (std::size_t v = 0; v < table.vertexCount(); ++v) {
    double sum = 0;
    for (const float weight : table.weightsOf(v)) sum += weight;
    if (!(sum > 0)) continue;
    for (Index k = 0; k < table.slots() && table.weightsOf(v)[k] > 0; ++k) {
      result.joints[v * table.slots() + k] = table.jointsOf(v)[k];
      result.weights[v * table.slots() + k] = static_cast<float>(table.weightsOf(v)[k] / sum);
    }
  }
  return result;
}

}  // namespace limber
