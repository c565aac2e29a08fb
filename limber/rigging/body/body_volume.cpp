#include "limber/rigging/body/body_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/turned_pieces.h"
#include "limber/geometry/mesh/winding_number.h"
#include "limber/rigging/body/inside_graph.h"

namespace limber {

namespace {

constexpr double kMinCells = 32, kMaxCells = 96;  // along the longest side
constexpr double kMaxNodes = 250000;              // of the grid: fewer cells for what fills its box
constexpr double kSphereSpacing = 0.45;           // radii that the centres of two spheres are apart, at least
constexpr std::size_t kMaxSpheres = 700;
constexpr std::size_t kMaxTips = 16;
constexpr double kMinReach = 0.05;  // longest sides

std::vector<MedialSphere> medialSpheres(const SignedDistance& distance, const InsideGraph& graph,
                                        const std::vector<std::size_t>& inside) {
  std::vector<std::size_t> middle;
  for (const std::size_t node : inside) {
    if (graph.medial(node)) middle.push_back(node);
  }
  std::stable_sort(middle.begin(), middle.end(),
                   [&](std::size_t a, std::size_t b) { return graph.depth(a) > graph.depth(b); });
  std::vector<MedialSphere> spheres;
  for (const std::size_t node : middle) {
    const Vec3 center = distance.position(node);
    const bool covered = std::any_of(spheres.begin(), spheres.end(), [&](const MedialSphere& known) {
      const double apart = std::max(kSphereSpacing * known.radius, 1.5 * distance.spacing());
      return (known.center - center).squaredNorm() < apart * apart;
    });
    if (!covered) spheres.push_back({center, graph.depth(node)});
    if (spheres.size() == kMaxSpheres) break;
  }
  return spheres;
}

}  // namespace

BodyVolume measureBody(const TriMesh& mesh) {
  std::unique_ptr<Bvh> surface;
  std::unique_ptr<WindingNumber> winding;
  parallelInvoke([&] { surface = std::make_unique<Bvh>(mesh); },
                 [&] { winding = std::make_unique<WindingNumber>(mesh, turnedPieces(mesh)); });
  BodyVolume body;
  body.distance = std::make_unique<const SignedDistance>(mesh, *surface, *winding,
                                                         cellsForNodes(mesh, kMaxNodes, kMinCells, kMaxCells));
  const SignedDistance& distance = *body.distance;
  const InsideGraph graph(distance);
  const std::vector<std::size_t> inside = graph.insideNodes();
  if (inside.empty()) {
    throw Error(ErrorCode::kUnsupported, "nothing lies inside the model, so that no skeleton fits into it", {},
                "it is flat or too thin; the rigger sphere-mesh takes such models");
  }
  body.spheres = medialSpheres(distance, graph, inside);
  if (body.spheres.empty()) {
    throw Error(ErrorCode::kUnsupported, "the model's inside cannot be told from its outside", {},
                "faces may lie on each other many times: merge them; the rigger sphere-mesh takes such models");
  }
  return body;
}

// One end after the other: the node farthest from the middle, then the one farthest from the paths to all ends so far.
std::vector<LimbTip> limbTips(const BodyVolume& body) {
  const SignedDistance& distance = *body.distance;
  InsideGraph graph(distance);
  const std::vector<std::size_t> inside = graph.insideNodes();
  Vec3 middle = Vec3::Zero();
  for (const std::size_t node : inside) middle += distance.position(node) / static_cast<double>(inside.size());
  const std::size_t root = *std::min_element(inside.begin(), inside.end(), [&](std::size_t a, std::size_t b) {
    return (distance.position(a) - middle).squaredNorm() < (distance.position(b) - middle).squaredNorm();
  });
  std::vector<float> distances;
  std::vector<std::size_t> from;
  graph.spreadToAll(root, inside, distances, from);
  std::vector<std::size_t> sources = {root};
  std::vector<LimbTip> tips;
  while (tips.size() < kMaxTips) {
    graph.spread(sources, distances, from);
    std::size_t tip = root;
    for (const std::size_t node : inside) {
      if (std::isfinite(distances[node]) && distances[node] > distances[tip]) tip = node;
    }
    if (distances[tip] < kMinReach) break;
    tips.push_back({distance.position(tip), distances[tip], 0});
    sources.clear();
    std::size_t node = tip;
    for (; distances[node] > 0; node = from[node]) {
      sources.push_back(node);
      tips.back().depth = std::max(tips.back().depth, graph.depth(node));
    }
    tips.back().depth = std::max(tips.back().depth, graph.depth(node));
  }
  return tips;
}

}  // namespace limber
