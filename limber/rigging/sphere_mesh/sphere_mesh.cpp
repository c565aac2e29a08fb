#include "limber/rigging/sphere_mesh/sphere_mesh.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include <fmt/format.h>

#include "limber/core/parallel.h"
#include "limber/rigging/sphere_mesh/handle_count.h"

namespace limber {

struct SphereMesh::BorderedEdge {
  VertexPair ends;  // handles
  Border border = 0;
};

// The collapse stopped at a count.
struct SphereMesh::Cut {
  Index merges = 0;                       // so many of them are done
  const CountBetween* between = nullptr;  // but for what this says
  Index loose = 0;                        // so many loose vertices are merged

  bool done(Index merge) const { return merge < merges && (!between || merge != between->undone); }

  // Living nodes by index, each with its sphere and its first handle; a pair has two.
  struct Node {
    Index node = 0;
    bool single = false;
    Vec3f center = Vec3f::Zero();
    float radius = 0;
    float weight = 0;
    Index handle = 0;
  };
  std::vector<Node> nodes;

  const Node& find(Index node) const {
    if (between && node == between->gone) node = between->node;
    return *std::lower_bound(nodes.begin(), nodes.end(), node,
                             [](const Node& a, Index sought) { return a.node < sought; });
  }
  Index handleOf(EdgeEnd end) const {
    const Node& node = find(nodeOf(end));
    return node.handle + (crossesOf(end) && !node.single ? 1 : 0);
  }
};

SphereMesh SphereMesh::build(const TriMesh& mesh, Progress& progress, Index maxStartNodes) {
  if (mesh.positions.empty()) throw Error(ErrorCode::kBadData, "the model has no vertex");
  if (mesh.positions.size() > kMaxNodes / 2) {
    throw Error(ErrorCode::kLimit,
                fmt::format("the model has {} vertices; at most 2^30 can be rigged", mesh.positions.size()));
  }
  SphereMesh result;
  std::optional<MirrorMap> mirror;
  SurfaceEdges surface;
  parallelInvoke([&] { mirror = findMirror(mesh, &progress); }, [&] { surface = surfaceEdges(mesh); });
  progress.update(0);
  if (mirror) result.mirror_ = mirror->plane;
  result.frame_ = CollapseFrame::of(mesh, result.mirror_);
  std::vector<Vec3f> points(mesh.positions.size());
  parallelFor(points.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = result.frame_.toCollapse(mesh.positions[i]);
  });
  CollapseStart start = joinNearNodes(collapseStart(mesh, points, surface, mirror), maxStartNodes);
  result.sequence_ = collapse(start.input, progress);
  result.vertexEnds_ = std::move(start.vertexEnds);
  result.nodeCenters_ = std::move(start.nodeCenters);
  result.loose_ = std::move(start.loose);
  for (const LooseVertex& loose : result.loose_) result.loosePositions_.push_back(mesh.positions[loose.vertex]);
  for (const SphereQuadric& q : start.input.quadrics) result.nodeWeights_.push_back(static_cast<float>(q.weight()));
  return result;
}

SphereMesh::Cut SphereMesh::cutAt(Index count) const {
  if (count < 1 || count > maxSpheres()) refuseHandleCount(count, maxSpheres());
  Cut cut;
  const auto& merges = sequence_.merges;
  if (count >= sequence_.initialCount) {
    cut.loose = static_cast<Index>(loose_.size()) - (count - sequence_.initialCount);
  } else {
    cut.loose = static_cast<Index>(loose_.size());
    const auto last =
        std::partition_point(merges.begin(), merges.end(), [count](const Merge& m) { return m.countAfter > count; });
    cut.merges = static_cast<Index>(last - merges.begin()) + (last->countAfter == count ? 1 : 0);
    if (last->countAfter < count) {
      cut.between = &sequence_.between[last->between];
      if (cut.between->undone != kNoIndex) ++cut.merges;
    }
  }
  listNodes(cut);
  return cut;
}

// Undoes merges from the last one back: what each was made of is alive unless it has been undone itself.
void SphereMesh::listNodes(Cut& cut) const {
  const auto& merges = sequence_.merges;
  const auto add = [&](Index node, Index madeBy) {
    if (madeBy == kNoIndex) {
      cut.nodes.push_back({node, sequence_.single[node] != 0, nodeCenters_[node], 0, nodeWeights_[node]});
    } else if (madeBy < cut.merges) {
      const Merge& m = merges[madeBy];
      cut.nodes.push_back({node, m.single, m.center, m.radius, m.weight});
    }
  };
  if (merges.empty()) {
    add(0, kNoIndex);
  } else {
    add(merges.back().kept, static_cast<Index>(merges.size() - 1));
  }
  for (std::size_t i = merges.size(); i > cut.merges; --i) {
    const Merge& m = merges[i - 1];
    add(m.kept, m.keptBefore);
    if (m.gone != m.kept) add(m.gone, m.goneBefore);
  }
  if (cut.between && cut.between->undone != kNoIndex) {
    const Merge& undone = merges[cut.between->undone];
    add(undone.gone, undone.goneBefore);
  }
  std::erase_if(cut.nodes, [&](const Cut::Node& node) { return cut.between && node.node == cut.between->gone; });
  std::sort(cut.nodes.begin(), cut.nodes.end(), [](const auto& a, const auto& b) { return a.node < b.node; });
  Index handle = 0;
  for (Cut::Node& node : cut.nodes) {
    if (const CountBetween* b = cut.between; b && b->node == node.node) {
      node = {node.node, true, b->center, b->radius, b->weight};
    }
    node.handle = handle;
    handle += node.single ? 1 : 2;
  }
}

SphereMeshLevel SphereMesh::level(Index count) const {
  const Cut cut = cutAt(count);
  SphereMeshLevel level;
  for (const Cut::Node& node : cut.nodes) {
    for (int side = 0; side < (node.single ? 1 : 2); ++side) {
      level.spheres.push_back(toMesh(node.center, node.radius, side == 1));
      level.weights.push_back(node.weight);
      if (mirror_) level.images.push_back(node.handle + (node.single ? 0 : 1 - side));
    }
  }
  std::vector<BorderedEdge> edges = edgesOf(cut);
  if (cut.loose < loose_.size()) appendLoose(cut, level, edges);
  std::sort(edges.begin(), edges.end(), [](const auto& a, const auto& b) { return a.ends < b.ends; });
  for (const BorderedEdge& edge : edges) {
    if (level.edges.empty() || level.edges.back() != edge.ends) {
      level.edges.push_back(edge.ends);
      level.borders.push_back(0);
    }
    level.borders.back() += static_cast<double>(edge.border) * kBorderUnit * frame_.scale;
  }
  return level;
}

// All edges that went after the cut, or after the merge that it leaves undone, were alive then; what has joined them
// since is not yet of their borders.
std::vector<SphereMesh::BorderedEdge> SphereMesh::edgesOf(const Cut& cut) const {
  std::vector<BorderedEdge> edges;
  const Index since = cut.between ? std::min(cut.between->undone, cut.merges) : cut.merges;
  if (since == sequence_.merges.size()) return edges;
  const std::span<const DeadEdge> alive = std::span(sequence_.deadEdges).subspan(sequence_.merges[since].deadBegin);
  std::unordered_map<Index, Border> joinedSince;
  for (const DeadEdge& edge : alive) {
    if (edge.joined != kNoIndex && edge.border > 0) joinedSince[edge.joined] += edge.border;
  }
  const auto add = [&](Index a, Index b, Border border) {
    if (a != b) edges.push_back({{std::min(a, b), std::max(a, b)}, border});
  };
  for (const DeadEdge& edge : alive) {
    const GraphEdge& e = sequence_.edges[edge.edge];
    const auto joined = joinedSince.find(edge.edge);
    const Border border = edge.border - (joined == joinedSince.end() ? 0 : joined->second);
    const EdgeEnd from = climb(makeEnd(e.from, false), cut), to = climb(e.to, cut);
    add(cut.handleOf(from), cut.handleOf(to), border);
    add(cut.handleOf(from ^ 1), cut.handleOf(to ^ 1), border);
  }
  return edges;
}

// The node that represents `end`, crossing where the path there leads to its image.
EdgeEnd SphereMesh::climb(EdgeEnd end, const Cut& cut) const {
  Index node = nodeOf(end);
  bool crosses = crossesOf(end);
  for (Index by = sequence_.absorbedBy[node]; cut.done(by); by = sequence_.absorbedBy[node]) {
    crosses = crosses != sequence_.merges[by].crosses;
    node = sequence_.merges[by].kept;
  }
  return makeEnd(node, crosses);
}

void SphereMesh::appendLoose(const Cut& cut, SphereMeshLevel& level, std::vector<BorderedEdge>& edges) const {
  for (std::size_t i = cut.loose; i < loose_.size(); ++i) {
    const Index handle = static_cast<Index>(level.spheres.size());
    edges.push_back({{cut.handleOf(vertexEnds_[loose_[i].vertex]), handle}, 0});
    level.spheres.push_back({loosePositions_[i].cast<double>(), 0});
    level.weights.push_back(0);
    level.images.push_back(kNoIndex);
  }
}

std::vector<Index> SphereMesh::vertexHandles(Index count) const {
  const Cut cut = cutAt(count);
  // From the last merge back, the node that went is where the one that stayed is by then.
  std::vector<EdgeEnd> ends(nodeCenters_.size());
  for (Index node = 0; node < ends.size(); ++node) ends[node] = makeEnd(node, false);
  const auto follow = [&](Index merge) {
    const Merge& m = sequence_.merges[merge];
    if (m.gone != m.kept && cut.done(merge)) ends[m.gone] = ends[m.kept] ^ static_cast<EdgeEnd>(m.crosses);
  };
  for (Index merge = cut.merges; merge > 0; --merge) follow(merge - 1);
  std::vector<Index> nodeHandles(2 * ends.size(), kNoIndex);  // per living end
  const auto number = [&](Index node) {
    for (const EdgeEnd end : {makeEnd(node, false), makeEnd(node, true)}) nodeHandles[end] = cut.handleOf(end);
  };
  for (const Cut::Node& node : cut.nodes) number(node.node);
  if (cut.between && cut.between->gone != kNoIndex) number(cut.between->gone);
  std::vector<Index> handles(vertexEnds_.size());
  for (std::size_t v = 0; v < handles.size(); ++v) {
    handles[v] = nodeHandles[ends[nodeOf(vertexEnds_[v])] ^ (vertexEnds_[v] & 1)];
  }
  const Index looseBegin = cut.nodes.back().handle + (cut.nodes.back().single ? 1 : 2);
  for (std::size_t i = cut.loose; i < loose_.size(); ++i) {
    handles[loose_[i].vertex] = looseBegin + static_cast<Index>(i - cut.loose);
  }
  return handles;
}

std::vector<double> SphereMesh::errors(Index maxCount) const {
  maxCount = std::min(maxCount, maxSpheres());
  const auto& merges = sequence_.merges;
  const auto errorOf = [&](Index madeBy) { return madeBy == kNoIndex ? 0.0 : merges[madeBy].planeErrorOfAll(); };
  const auto errorOfParts = [&](const Merge& m) {
    return errorOf(m.keptBefore) + (m.gone == m.kept ? 0 : errorOf(m.goneBefore));
  };
  std::vector<double> errors(std::size_t{maxCount} + 1, 0);
  errors[0] = std::numeric_limits<double>::infinity();
  double after = merges.empty() ? 0 : errorOf(static_cast<Index>(merges.size() - 1));
  if (maxCount >= 1) errors[1] = after;
  for (Index i = static_cast<Index>(merges.size()); i > 0; --i) {
    const Merge& m = merges[i - 1];
    if (m.countAfter + 1 > maxCount) break;
    double before = after - errorOf(i - 1) + errorOfParts(m);
    if (i == 1) before = 0;  // nothing is merged: what is left is rounding
    const Index countBefore = i > 1 ? merges[i - 2].countAfter : sequence_.initialCount;
    if (countBefore <= maxCount) errors[countBefore] = std::max(before, 0.0);
    if (m.between != kNoIndex) {
      const CountBetween& between = sequence_.between[m.between];
      const double from = between.undone == kNoIndex ? before : after + errorOf(merges[between.undone].goneBefore);
      errors[m.countAfter + 1] = std::max(from + between.planeErrorChange, 0.0);
    }
    after = before;
  }
  for (std::size_t count = 1; count < errors.size(); ++count) {
    errors[count] = std::min(errors[count - 1], std::sqrt(errors[count]) * frame_.scale);
  }
  return errors;
}

LimbCount SphereMesh::limbs() const {
  constexpr float kLong = 0.5f, kCounted = 0.25f;  // of the longest limb
  float longest = 0;
  for (const LostEnd& end : sequence_.lostEnds) longest = std::max(longest, end.length);
  LimbCount count;
  for (const LostEnd& end : sequence_.lostEnds) {
    if (end.length >= kCounted * longest) count.limbs += end.limbs;
    if (end.length >= kLong * longest) count.fewestHandles = std::max(count.fewestHandles, end.countBefore);
  }
  return count;
}

Sphere SphereMesh::toMesh(const Vec3f& center, float radius, bool image) const {
  Vec3 c = center.cast<double>();
  if (image) c.x() = -c.x();
  return {frame_.axes * (frame_.scale * c) + frame_.origin, frame_.scale * radius};
}

}  // namespace limber
