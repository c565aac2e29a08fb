#include "limber/evaluate/skin/self_penetration.h"

#include <algorithm>
#include <span>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/evaluate/skin/model_poser.h"
#include "limber/geometry/mesh/normals.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

constexpr double kOffSurface = 0.001;  // of the longest side in bind pose
constexpr double kInside = 0.5;        // winding number
constexpr std::size_t kGrain = 64;

// At most `most` of the numbers below `count`, evenly, the first and the last among them.
std::vector<std::size_t> evenly(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t number = std::min(count, std::max<std::size_t>(most, 1));
  for (std::size_t i = 0; i < number; ++i) chosen.push_back(number > 1 ? i * (count - 1) / (number - 1) : 0);
  return chosen;
}

// How often the surface winds round the points just off those vertices; nothing is off a vertex without a triangle.
std::vector<double> windingOff(const TriMesh& mesh, std::span<const Index> vertices, double offset) {
  const WindingNumber winding(mesh);
  const std::vector<Vec3> normals = areaNormals<Vec3f>(mesh.positions, mesh.triangles);
  std::vector<double> numbers(vertices.size());
  parallelFor(vertices.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Index v = vertices[i];
      numbers[i] = winding.at(mesh.position(v) + offset * normals[v].normalized());
    }
  });
  return numbers;
}

}  // namespace

SelfPenetration measureSelfPenetration(const SkinnedModel& model, const std::vector<Pose>& poses,
                                       const SelfPenetrationOptions& options) {
  if (poses.empty()) throw Error(ErrorCode::kBadArgument, "there is no frame to look for self-penetration in");
  const SkinnedModel skin = weldedModel(model);
  const double size = longestSide(skin.mesh);
  ModelPoser poser(skin, *options.deformer);

  std::vector<Index> sampled, outside;
  for (const std::size_t v : evenly(skin.mesh.positions.size(), options.maxVertices)) {
    sampled.push_back(static_cast<Index>(v));
  }
  std::vector<double> bound;  // winding numbers in bind pose of those outside
  const std::vector<double> rest = windingOff(skin.mesh, sampled, kOffSurface * size);
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    if (rest[i] > kInside) continue;
    outside.push_back(sampled[i]);
    bound.push_back(rest[i]);
  }

  SelfPenetration result;
  TriMesh posed = skin.mesh;
  const std::vector<std::size_t> frames = evenly(poses.size(), options.maxFrames);
  for (const std::size_t f : frames) {
    poser.pose(poses[f], posed.positions);
    const std::vector<double> winding = windingOff(posed, outside, kOffSurface * size);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < outside.size(); ++i) inside += winding[i] > kInside && winding[i] - bound[i] > kInside;
    const double fraction = static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(outside.size(), 1));
    result.mean += fraction / static_cast<double>(frames.size());
    if (fraction <= result.worst) continue;
    result.worst = fraction;
    result.worstFrame = f;
  }
  return result;
}

}  // namespace limber
