#include "limber/rigging/sphere_mesh/sphere_mesh_builder.h"

#include <algorithm>
#include <numeric>

#include "limber/core/grouped.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/geometry/surface/border_lengths.h"
#include "limber/geometry/surface/piece_links.h"
#include "limber/geometry/surface/point_tree.h"
#include "limber/geometry/surface/stray_pieces.h"

namespace limber {

namespace {

constexpr double kMaxBorder = 1 << 23;  // of an edge, in units: eight times the model

// Rotations that bring an axis to x by renaming the axes keep coordinates exact.
Mat3 axesFor(const Vec3& normal) {
  for (int axis = 0; axis < 3; ++axis) {
    if (normal != Vec3::Unit(axis)) continue;
    Mat3 axes;
    axes << Vec3::Unit(axis), Vec3::Unit((axis + 1) % 3), Vec3::Unit((axis + 2) % 3);
    return axes;
  }
  const Vec3 y = normal.unitOrthogonal();
  Mat3 axes;
  axes << normal, y, normal.cross(y);
  return axes;
}

class Starter {
 public:
  Starter(const TriMesh& mesh, const std::vector<Vec3f>& points, const SurfaceEdges& surface,
          const std::optional<MirrorMap>& mirror)
      : mesh_(mesh), points_(points), surface_(surface), mirror_(mirror) {}

  CollapseStart run() {
    std::vector<VertexPair> edges = surface_.edges;
    const std::vector<VertexPair> links = pieceLinks(points_, edges);
    measureSurface(links);
    edges.insert(edges.end(), links.begin(), links.end());
    const std::vector<Index> carriers = mirror_ ? placeLoose(edges) : std::vector<Index>{};
    numberNodes(carriers);
    addSurface();
    addEdges(edges);
    return std::move(start_);
  }

 private:
  std::vector<Index> placeLoose(const std::vector<VertexPair>& edges);
  void measureSurface(const std::vector<VertexPair>& links);
  void numberNodes(const std::vector<Index>& carriers);
  void addSurface();
  void addEdges(const std::vector<VertexPair>& edges);

  Index imageOf(Index v) const { return mirror_ ? mirror_->image[v] : v; }
  bool single(Index node) const { return start_.input.single[node] != 0; }

  const TriMesh& mesh_;
  const std::vector<Vec3f>& points_;
  const SurfaceEdges& surface_;
  const std::optional<MirrorMap>& mirror_;
  std::vector<Vec3> normals_;    // #F, as long as a third of the area
  std::vector<double> weights_;  // #F, of one corner; all together weigh 1 where there is a surface
  CollapseStart start_;
};

void Starter::measureSurface(const std::vector<VertexPair>& links) {
  const Index count = mesh_.triangleCount();
  normals_.resize(count);
  weights_.resize(count);
  std::vector<double> areas(points_.size(), 0);
  for (Index t = 0; t < count; ++t) {
    const Triangle& v = mesh_.triangles[t];
    const Vec3 a = points_[v[0]].cast<double>(), b = points_[v[1]].cast<double>(), c = points_[v[2]].cast<double>();
    normals_[t] = (b - a).cross(c - a) * (surface_.facing[t] / 6.0);
    weights_[t] = normals_[t].norm();
    for (const Index corner : v) areas[corner] += weights_[t];
  }
  if (!links.empty()) {
    const std::vector<double> fractions = strayFractions(points_, areas, surface_.edges, links);
    for (Index t = 0; t < count; ++t) weights_[t] *= fractions[mesh_.triangles[t][0]];
  }
  const double total = 3 * std::accumulate(weights_.begin(), weights_.end(), 0.0);
  if (!(total > 0)) return;
  start_.input.area = total;
  for (double& weight : weights_) weight /= total;
}

// Each vertex without an image goes with the vertex with one that is fewest edges away: breadth first from all of
// those. Returns for each vertex the one it goes with.
std::vector<Index> Starter::placeLoose(const std::vector<VertexPair>& edges) {
  const std::size_t count = points_.size();
  const Grouped<Index> neighbors(count, [&](const auto& visit) {
    for (const auto& [a, b] : edges) {
      visit(a, b);
      visit(b, a);
    }
  });
  std::vector<Index> carriers(count, kNoIndex), queue;
  for (Index v = 0; v < count; ++v) {
    if (imageOf(v) == kNoIndex) continue;
    carriers[v] = v;
    queue.push_back(v);
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const Index v = queue[i];
    for (const Index next : neighbors.of(v)) {
      if (carriers[next] != kNoIndex) continue;
      carriers[next] = carriers[v];
      queue.push_back(next);
      start_.loose.push_back({next, 0});
    }
  }
  return carriers;
}

void Starter::numberNodes(const std::vector<Index>& carriers) {
  start_.vertexEnds.assign(points_.size(), 0);
  std::vector<Index> leaders;  // of each node the vertex on the positive side
  std::vector<Vec3f> centers;
  for (Index v = 0; v < points_.size(); ++v) {
    const Index image = imageOf(v);
    if (image == kNoIndex) continue;
    const Vec3f p = points_[v];
    if (image == v) {
      leaders.push_back(v);
      centers.push_back(mirror_ ? Vec3f(0, p.y(), p.z()) : p);
      continue;
    }
    const Vec3f q = points_[image];
    if (p.x() < q.x() || (p.x() == q.x() && v > image)) continue;
    leaders.push_back(v);
    centers.push_back(0.5f * Vec3f(p.x() - q.x(), p.y() + q.y(), p.z() + q.z()));
  }
  const std::vector<Index> order = mortonOrder(centers);
  start_.input.single.reserve(order.size());
  start_.nodeCenters.reserve(order.size());
  for (Index node = 0; node < order.size(); ++node) {
    const Index v = leaders[order[node]], image = imageOf(v);
    start_.input.single.push_back(image == v);
    start_.nodeCenters.push_back(centers[order[node]]);
    start_.vertexEnds[v] = makeEnd(node, false);
    if (image != v) start_.vertexEnds[image] = makeEnd(node, true);
  }
  for (LooseVertex& loose : start_.loose) {
    start_.vertexEnds[loose.vertex] = start_.vertexEnds[carriers[loose.vertex]];
    loose.node = nodeOf(start_.vertexEnds[loose.vertex]);
  }
}

void Starter::addSurface() {
  const std::size_t nodes = start_.nodeCenters.size();
  std::vector<SphereQuadric>& quadrics = start_.input.quadrics;
  quadrics.resize(nodes);
  std::vector<PartMoments>& moments = start_.input.moments;
  moments.resize(nodes);
  // The plane (or, without a normal, the point alone) of one corner: half of it to each of a pair.
  const auto add = [&](Index v, Vec3 normal, double weight) {
    const EdgeEnd end = start_.vertexEnds[v];
    const Index node = nodeOf(end);
    Vec3 p = points_[v].cast<double>();
    if (crossesOf(end)) {
      p.x() = -p.x();
      normal.x() = -normal.x();
    }
    if (!single(node)) weight *= 0.5;
    quadrics[node].addPlane(p, normal, weight);
    moments[node].addPoint(p, weight);
  };
  std::vector<double> weights(points_.size(), 0);
  for (Index t = 0; t < mesh_.triangleCount(); ++t) {
    if (!(weights_[t] > 0)) continue;
    const Vec3 normal = normals_[t].normalized();
    for (const Index v : mesh_.triangles[t]) {
      add(v, normal, weights_[t]);
      weights[v] += weights_[t];
    }
  }
  // Vertices with (next to) no surface weigh a little, so that they have a position; where there is no surface at all
  // they weigh 1 in total. What is far outside the model's box pulls no more than what lies at its border.
  const bool hasSurface = std::any_of(weights_.begin(), weights_.end(), [](double weight) { return weight > 0; });
  const double least = (hasSurface ? 1e-6 : 1) / static_cast<double>(points_.size());
  for (Index v = 0; v < points_.size(); ++v) {
    if (weights[v] < least) {
      add(v, Vec3::Zero(), least / std::max(1.0, points_[v].cast<double>().squaredNorm()));
    }
  }
  if (!mirror_) return;
  for (std::size_t node = 0; node < nodes; ++node) {
    if (!single(static_cast<Index>(node))) continue;
    quadrics[node].clearOdd();
    moments[node].clearOdd();
  }
}

void Starter::addEdges(const std::vector<VertexPair>& edges) {
  struct Found {
    Index from = 0;
    EdgeEnd to = 0;
    double border = 0;
  };
  std::vector<double> borders = borderLengths(points_, mesh_.triangles, surface_.edges);
  borders.resize(edges.size(), 0);  // pieces are apart
  std::vector<Found> found;
  found.reserve(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const EdgeEnd first = start_.vertexEnds[edges[e][0]], second = start_.vertexEnds[edges[e][1]];
    Index a = nodeOf(first), b = nodeOf(second);
    bool crosses = crossesOf(first) != crossesOf(second);
    if (single(a) || single(b)) crosses = false;
    if (a == b && !crosses) continue;
    if (a > b) std::swap(a, b);
    // An edge and its image are one here; a level has both again.
    found.push_back({a, makeEnd(b, crosses), borders[e] / 2});
    if (!crosses || a == b) continue;
    found.push_back({a, makeEnd(a, true)});  // an edge across the plane: both ends are near their images
    found.push_back({b, makeEnd(b, true)});
  }
  // By first node, then by second: counting, then short sorts.
  using End = std::pair<EdgeEnd, double>;
  Grouped<End> ends(start_.nodeCenters.size(), [&](const auto& visit) {
    for (const Found& e : found) visit(e.from, End{e.to, e.border});
  });
  CollapseInput& input = start_.input;
  input.edges.reserve(found.size());
  input.borders.reserve(found.size());
  for (Index node = 0; node < ends.count(); ++node) {
    const std::span<End> of = ends.of(node);
    std::sort(of.begin(), of.end());
    for (auto end = of.begin(); end != of.end();) {
      const EdgeEnd to = end->first;
      double border = 0;
      for (; end != of.end() && end->first == to; ++end) border += end->second;
      input.edges.push_back({node, to});
      input.borders.push_back(static_cast<Border>(std::min(border / kBorderUnit, kMaxBorder)));
    }
  }
}

}  // namespace

CollapseFrame CollapseFrame::of(const TriMesh& mesh, const std::optional<MirrorPlane>& mirror) {
  const Box box = modelBox(mesh);
  CollapseFrame frame;
  frame.origin = box.center();
  if (box.longestSide() > 0) frame.scale = box.longestSide();
  if (mirror) {
    frame.axes = axesFor(mirror->normal);
    frame.origin += (mirror->offset - mirror->normal.dot(frame.origin)) * mirror->normal;
  }
  return frame;
}

Vec3f CollapseFrame::toCollapse(const Vec3f& p) const {
  return (axes.transpose() * ((p.cast<double>() - origin) / scale)).cast<float>();
}

CollapseStart collapseStart(const TriMesh& mesh, const std::vector<Vec3f>& points, const SurfaceEdges& surface,
                            const std::optional<MirrorMap>& mirror) {
  return Starter(mesh, points, surface, mirror).run();
}

}  // namespace limber
