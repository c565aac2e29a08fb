#include "limber/rigging/curve_skeleton/curve_skeleton.h"

#include <algorithm>

#include "limber/core/error.h"
#include "limber/geometry/surface/piece_links.h"
#include "limber/geometry/surface/stray_pieces.h"
#include "limber/rigging/curve_skeleton/connectivity_surgery.h"
#include "limber/rigging/curve_skeleton/contraction.h"
#include "limber/rigging/curve_skeleton/even_surface.h"
#include "limber/rigging/sphere_mesh/handle_tree.h"
#include "limber/rigging/sphere_mesh/part_moments.h"

namespace limber {

namespace {

constexpr double kFlat = 1e-6;  // longest sides: less is no thickness

// The nodes of the half, or of all where there is no symmetry.
struct CurveNodes {
  std::vector<Vec3> points;
  std::vector<double> radii, weights;
  std::vector<char> isPaired;
  std::vector<VertexPair> edges;  // they connect all nodes
};

void refuseWithoutInside(const TriMesh& mesh, const CollapseFrame& frame) {
  constexpr const char* kRemedy = "the rigger sphere-mesh takes such models";
  if (mesh.triangles.empty()) {
    throw Error(ErrorCode::kUnsupported, "the model has no triangle, so that no surface can be contracted", {},
                kRemedy);
  }
  PartMoments moments;
  for (const Vec3f& p : mesh.positions) moments.addPoint(frame.toCollapse(p).cast<double>(), 1);
  if (!(moments.radiusBound() > kFlat)) {
    throw Error(ErrorCode::kUnsupported, "the model is flat, so that no curve runs through its inside", {}, kRemedy);
  }
}

std::vector<Vec3> contractedPoints(const EvenSurface& surface, Progress& progress) {
  const UnfoldedSurface whole = unfolded(surface);
  std::vector<Vec3> contracted = contractSurface(whole.mesh, progress);
  for (Index p = 0; p < whole.image.size(); ++p) {
    const Vec3 image = contracted[whole.image[p]];
    contracted[p] = 0.5 * (contracted[p] + Vec3(-image.x(), image.y(), image.z()));
  }
  contracted.resize(surface.points.size());
  return contracted;
}

// Each node moves to the middle of its part of the surface.
CurveNodes refinedNodes(const EvenSurface& surface, const CurveGraph& graph) {
  CurveNodes nodes;
  nodes.edges = graph.edges;
  double total = 0;
  const std::vector<NodePlacement> placements = nodePlacements(surface, graph);
  const auto sides = [&](const NodePlacement& node) { return surface.isHalf && !node.isPaired ? 2 : 1; };
  for (const NodePlacement& node : placements) total += (surface.isHalf ? 2 : 1) * node.area;
  for (const NodePlacement& node : placements) {
    nodes.points.push_back(node.point);
    nodes.radii.push_back(node.radius);
    nodes.weights.push_back(sides(node) * node.area / total);
    nodes.isPaired.push_back(node.isPaired);
  }
  return nodes;
}

void joinPieces(const EvenSurface& surface, const CurveGraph& graph, CurveNodes& nodes) {
  std::vector<Vec3f> points;
  for (const Vec3& p : surface.points) points.push_back(p.cast<float>());
  for (const auto& [a, b] : pieceLinks(points, surface.edges)) {
    const auto [low, high] = std::minmax(graph.nodeOf[a], graph.nodeOf[b]);
    if (low != high) nodes.edges.push_back({low, high});
  }
  std::sort(nodes.edges.begin(), nodes.edges.end());
  nodes.edges.erase(std::unique(nodes.edges.begin(), nodes.edges.end()), nodes.edges.end());
}

// nodeOf  per handle of the level
SphereMeshLevel wholeCurves(const CurveNodes& nodes, bool isHalf, std::vector<Index>& nodeOf) {
  SphereMeshLevel level;
  std::vector<Index> handles;
  for (Index n = 0; n < nodes.points.size(); ++n) {
    const Index handle = static_cast<Index>(level.spheres.size());
    handles.push_back(handle);
    for (int side = 0; side <= nodes.isPaired[n]; ++side) {
      const Vec3& p = nodes.points[n];
      level.spheres.push_back({side ? Vec3(-p.x(), p.y(), p.z()) : p, nodes.radii[n]});
      level.weights.push_back(nodes.weights[n]);
      if (isHalf) level.images.push_back(handle + (nodes.isPaired[n] && !side ? 1 : 0));
      nodeOf.push_back(n);
    }
  }
  for (const auto& [a, b] : nodes.edges) {
    level.edges.push_back({handles[a], handles[b]});
    if (!nodes.isPaired[a] && !nodes.isPaired[b]) continue;
    level.edges.push_back({handles[a] + (nodes.isPaired[a] ? 1 : 0), handles[b] + (nodes.isPaired[b] ? 1 : 0)});
  }
  std::sort(level.edges.begin(), level.edges.end());
  return level;
}

// The spanning tree that sphere meshes have, too, folded into the half.
CurveTree treeOf(const CurveNodes& nodes, const SphereMeshLevel& curves, const std::vector<Index>& nodeOf) {
  const HandleTree whole = handleTree(curves);
  CurveTree tree;
  tree.isMirrored = !curves.images.empty();
  std::vector<Index> positionOf(nodes.points.size(), kNoIndex);
  for (std::size_t j = 0; j < whole.order.size(); ++j) {
    const Index n = nodeOf[whole.order[j]];
    if (positionOf[n] != kNoIndex) continue;
    positionOf[n] = static_cast<Index>(tree.points.size());
    tree.points.push_back(nodes.points[n]);
    tree.radii.push_back(nodes.radii[n]);
    tree.weights.push_back(nodes.weights[n]);
    tree.isPaired.push_back(nodes.isPaired[n]);
    tree.parents.push_back(whole.parents[j] ? positionOf[nodeOf[whole.order[*whole.parents[j]]]] : kNoIndex);
  }
  return tree;
}

}  // namespace

CurveSkeleton CurveSkeleton::build(const TriMesh& mesh, Progress& progress) {
  CurveSkeleton skeleton;
  skeleton.vertexCount_ = mesh.vertexCount();
  refuseWithoutInside(mesh, CollapseFrame::of(mesh, std::nullopt));
  const std::optional<TriMesh> tidy = withoutStrays(mesh);
  if (const std::optional<MirrorMap> mirror = findMirror(mesh, &progress)) skeleton.mirror_ = mirror->plane;
  progress.update(0);
  skeleton.frame_ = CollapseFrame::of(mesh, skeleton.mirror_);
  const EvenSurface surface = evenSurface(tidy ? *tidy : mesh, skeleton.frame_, skeleton.mirror_.has_value());

  CurveGraph graph = curveGraph(surface, contractedPoints(surface, progress));
  absorbStubs(surface, graph);
  CurveNodes nodes = refinedNodes(surface, graph);
  joinPieces(surface, graph, nodes);
  std::vector<Index> nodeOf;
  const SphereMeshLevel curves = wholeCurves(nodes, surface.isHalf, nodeOf);
  skeleton.tree_ = treeOf(nodes, curves, nodeOf);
  skeleton.curves_ = skeleton.toMesh(curves);
  return skeleton;
}

SphereMeshLevel CurveSkeleton::level(Index count) const {
  return toMesh(chooseJoints(tree_, count));
}

SphereMeshLevel CurveSkeleton::toMesh(SphereMeshLevel level) const {
  for (Sphere& sphere : level.spheres) {
    sphere.center = frame_.axes * (frame_.scale * sphere.center) + frame_.origin;
    sphere.radius *= frame_.scale;
  }
  return level;
}

}  // namespace limber
