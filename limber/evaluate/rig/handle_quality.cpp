#include "limber/evaluate/rig/handle_quality.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "limber/document/read.h"
#include "limber/evaluate/model_files.h"
#include "limber/evaluate/rig/joint_placement.h"
#include "limber/evaluate/skin/weight_quality.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/surface/piece_links.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

namespace {

constexpr double kMinReach = 0.15;       // longest sides
constexpr double kMinSlenderness = 2.5;  // the reach of a limb's end over the greatest depth along the path to it
constexpr float kVisibleWeight = 0.1f;   // a weight by which a handle visibly moves a vertex

Index strongestOf(const SkinWeights& weights, Index v) {
  const auto of = weights.weightsOf(v);
  return weights.jointsOf(v)[std::max_element(of.begin(), of.end()) - of.begin()];
}

Index countIdle(const SkinnedModel& model) {
  std::vector<bool> moves(model.skeleton.jointCount(), false);
  for (std::size_t i = 0; i < model.weights.weights.size(); ++i) {
    if (model.weights.weights[i] >= kVisibleWeight) moves[model.weights.joints[i]] = true;
  }
  return static_cast<Index>(std::count(moves.begin(), moves.end(), false));
}

Index nearestVertex(const TriMesh& mesh, const Vec3& position) {
  Index nearest = 0;
  for (Index v = 1; v < mesh.vertexCount(); ++v) {
    if ((mesh.position(v) - position).squaredNorm() < (mesh.position(nearest) - position).squaredNorm()) nearest = v;
  }
  return nearest;
}

Index countCovered(const SkinnedModel& model, std::span<const Vec3> ends) {
  std::map<Index, int> endsOf;  // by handle
  for (const Vec3& end : ends) ++endsOf[strongestOf(model.weights, nearestVertex(model.mesh, end))];
  return static_cast<Index>(std::count_if(endsOf.begin(), endsOf.end(), [&](const auto& entry) {
    return entry.second == 1 && model.skeleton.joints[entry.first].parent.has_value();
  }));
}

Index countStrayParents(const SkinnedModel& model) {
  std::vector<VertexPair> edges = surfaceEdges(model.mesh).edges;
  const std::vector<VertexPair> links = pieceLinks(model.mesh.positions, edges);
  edges.insert(edges.end(), links.begin(), links.end());
  std::set<VertexPair> touching;
  for (const auto& [a, b] : edges) {
    const Index first = strongestOf(model.weights, a), second = strongestOf(model.weights, b);
    touching.insert({std::min(first, second), std::max(first, second)});
  }
  Index strays = 0;
  for (Index j = 0; j < model.skeleton.jointCount(); ++j) {
    const std::optional<Index> parent = model.skeleton.joints[j].parent;
    strays += parent && !touching.contains({std::min(j, *parent), std::max(j, *parent)});
  }
  return strays;
}

}  // namespace

std::vector<Vec3> limbEndsOf(const TriMesh& mesh) {
  const PreparedMesh prepared = prepareMesh(mesh.positions, mesh.triangles);
  std::vector<Vec3> ends;
  try {
    for (const LimbTip& tip : limbTips(measureBody(prepared.mesh))) {
      const bool isLimb = tip.reach > std::max(kMinReach, kMinSlenderness * tip.depth);
      if (isLimb) ends.push_back(prepared.frame.toSource(tip.position));
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kUnsupported) throw;  // nothing lies inside
  }
  return ends;
}

HandleQuality measureHandles(const SkinnedModel& model, std::span<const Vec3> ends) {
  HandleQuality quality;
  quality.handles = model.skeleton.jointCount();
  quality.idle = countIdle(model);
  quality.ends = static_cast<Index>(ends.size());
  quality.coveredEnds = countCovered(model, ends);
  quality.strayParents = countStrayParents(model);
  quality.inside = measureJointPlacement(model, std::vector<bool>(quality.handles, true)).inside;
  quality.overAir = measureWeights(model).islands;
  return quality;
}

std::vector<HandleTableRow> evaluateHandles(std::span<const std::filesystem::path> files, std::span<const Index> counts,
                                            const HandleRigger& rig, const HandlesSeen& seen, Progress& progress,
                                            Warnings& skipped) {
  std::vector<HandleTableRow> rows;
  forEachFile(files.size(), "handles", kNotCompared, progress, skipped, [&](std::size_t i) {
    const Asset read = readAsset(files[i]);
    std::optional<std::vector<Vec3>> ends;
    for (const Index count : counts) {
      Asset asset = read.clone();
      try {
        rig(asset, count);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::kBadArgument) throw;
        skipped.add("few-vertices", "models with fewer vertices than handles are asked for",
                    files[i].filename().string());
        break;
      }
      const SkinnedModel model = weldedModel(readSkinnedModel(Character(asset)));
      if (!ends) ends = limbEndsOf(model.mesh);
      rows.push_back({files[i].stem().string(), measureHandles(model, *ends)});
      if (seen) seen(asset);
    }
  });
  return rows;
}

Table handleTable(std::span<const HandleTableRow> rows) {
  Table table;
  table.columns = {words("model"),    number("handles", 0),       number("inside %", 0),      number("idle", 0),
                   number("ends", 0), number("with a handle", 0), number("stray parents", 0), number("over air %", 2)};
  HandleQuality sum;
  for (const auto& [file, quality] : rows) {
    table.add({foreign(file), quality.handles, 100 * quality.inside, quality.idle, quality.ends, quality.coveredEnds,
               quality.strayParents, 100 * quality.overAir});
    sum.handles += quality.handles;
    sum.idle += quality.idle;
    sum.ends += quality.ends;
    sum.coveredEnds += quality.coveredEnds;
    sum.strayParents += quality.strayParents;
    sum.inside += quality.inside * quality.handles;
    sum.overAir += quality.overAir / static_cast<double>(rows.size());
  }
  if (sum.handles > 0) {
    table.add({fmt::format("**all {}**", rows.size()), sum.handles, 100 * sum.inside / sum.handles, sum.idle, sum.ends,
               sum.coveredEnds, sum.strayParents, 100 * sum.overAir});
  }
  return table;
}

}  // namespace limber
