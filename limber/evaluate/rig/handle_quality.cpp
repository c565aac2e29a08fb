#include "limber/evaluate/rig/handle_quality.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/document/read.h"
#include "limber/evaluate/model_files.h"
#include "limber/evaluate/rig/joint_placement.h"
#include "limber/evaluate/skin/weight_quality.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/geometry/surface/piece_links.h"
#include "limber/geometry/surface/surface_edges.h"
#include "limber/rigging/body/body_volume.h"

namespace limber {

namespace {

constexpr double kMinReach = 0.15;       // longest sides
constexpr double kMinSlenderness = 2.5;  // the reach of a limb's end over the greatest depth along the path to it
constexpr double kEqual = 0.1;           // within that fraction two lengths are equal
constexpr float kVisibleWeight = 0.1f;   // a weight by which a handle visibly moves a vertex

Index strongestOf(const SkinWeights& weights, Index v) {
  const auto of = weights.weightsOf(v);
  return weights.jointsOf(v)[std::max_element(of.begin(), of.end()) - of.begin()];
}

Index nearestVertex(const TriMesh& mesh, const Vec3& position) {
  Index nearest = 0;
  for (Index v = 1; v < mesh.vertexCount(); ++v) {
    if ((mesh.position(v) - position).squaredNorm() < (mesh.position(nearest) - position).squaredNorm()) nearest = v;
  }
  return nearest;
}

bool areEqual(const LimbEndOnModel& a, const LimbEndOnModel& b) {
  const auto isNear = [](double x, double y) { return std::abs(x - y) <= kEqual * std::max(x, y); };
  return isNear(a.reach, b.reach) && isNear(a.depth, b.depth);
}

class HandleMeasures {
 public:
  explicit HandleMeasures(const SkinnedModel& model)
      : model_(model), handles_(model.skeleton.jointCount()), areas_(vertexAreas(model.mesh)) {
    for (Index v = 0; v < model.mesh.vertexCount(); ++v) regionOf_.push_back(strongestOf(model.weights, v));
    std::vector<VertexPair> edges = surfaceEdges(model.mesh).edges;
    const std::vector<VertexPair> links = pieceLinks(model.mesh.positions, edges);
    edges.insert(edges.end(), links.begin(), links.end());
    for (const auto& [a, b] : edges) {
      touching_.insert({regionOf_[a], regionOf_[b]});
      touching_.insert({regionOf_[b], regionOf_[a]});
    }
  }

  Index idle() const {
    std::vector<bool> moves(handles_, false);
    for (std::size_t i = 0; i < model_.weights.weights.size(); ++i) {
      if (model_.weights.weights[i] >= kVisibleWeight) moves[model_.weights.joints[i]] = true;
    }
    return static_cast<Index>(std::count(moves.begin(), moves.end(), false));
  }

  void countEnds(std::span<const LimbEndOnModel> ends, HandleQuality& quality) const {
    std::vector<Index> handleOf;
    std::vector<int> endsOf(handles_, 0);
    for (const LimbEndOnModel& end : ends) {
      handleOf.push_back(regionOf_[nearestVertex(model_.mesh, end.position)]);
      ++endsOf[handleOf.back()];
    }
    const auto isCovered = [&](std::size_t end) {
      return endsOf[handleOf[end]] == 1 && parentOf(handleOf[end]).has_value();
    };
    for (std::size_t end = 0; end < ends.size(); ++end) {
      ++quality.ends;
      if (isCovered(end)) {
        ++quality.coveredEnds;
        continue;
      }
      bool hasCoveredEqual = false;
      for (std::size_t other = 0; other < ends.size(); ++other) {
        hasCoveredEqual |= isCovered(other) && areEqual(ends[end], ends[other]);
      }
      quality.unequalEnds += hasCoveredEqual;
    }
  }

  Index strayParents() const {
    Index strays = 0;
    for (Index j = 0; j < handles_; ++j) strays += parentOf(j) && !touching_.contains({j, *parentOf(j)});
    return strays;
  }

  double movedBeside() const {
    if (handles_ < 2) return 0;
    double beside = 0;
    for (Index j = 0; j < handles_; ++j) {
      if (parentOf(j)) beside += movedBeside(j);
    }
    const double whole = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    return whole > 0 ? beside / whole / (handles_ - 1) : 0;
  }

 private:
  std::optional<Index> parentOf(Index j) const { return model_.skeleton.joints[j].parent; }

  // The area that moving one handle, and its children with it, should not move.
  double movedBeside(Index handle) const {
    std::vector<bool> isMoved(handles_, false), isNear(handles_, false);
    for (Index j = handle; j < handles_; ++j) {  // parents come before their children
      isMoved[j] = j == handle || (parentOf(j) && isMoved[*parentOf(j)]);
    }
    for (const auto& [a, b] : touching_) isNear[b] = isNear[b] || isMoved[a];
    double beside = 0;
    for (Index v = 0; v < areas_.size(); ++v) {
      if (isMoved[regionOf_[v]] || isNear[regionOf_[v]]) continue;
      float moved = 0;
      for (Index slot = 0; slot < model_.weights.jointsOf(v).size(); ++slot) {
        if (isMoved[model_.weights.jointsOf(v)[slot]]) moved += model_.weights.weightsOf(v)[slot];
      }
      if (moved >= kVisibleWeight) beside += areas_[v];
    }
    return beside;
  }

  const SkinnedModel& model_;
  Index handles_;
  std::vector<double> areas_;                   // per vertex
  std::vector<Index> regionOf_;                 // per vertex: the handle that it follows most
  std::set<std::pair<Index, Index>> touching_;  // regions, in both orders
};

}  // namespace

std::vector<LimbEndOnModel> limbEndsOf(const TriMesh& mesh) {
  const PreparedMesh prepared = prepareMesh(mesh.positions, mesh.triangles);
  std::vector<LimbEndOnModel> ends;
  try {
    for (const LimbTip& tip : limbTips(measureBody(prepared.mesh))) {
      const bool isLimb = tip.reach > std::max(kMinReach, kMinSlenderness * tip.depth);
      if (isLimb) ends.push_back({prepared.frame.toSource(tip.position), tip.reach, tip.depth});
    }
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kUnsupported) throw;  // nothing lies inside
  }
  return ends;
}

HandleQuality measureHandles(const SkinnedModel& model, std::span<const LimbEndOnModel> ends) {
  const HandleMeasures measures(model);
  HandleQuality quality;
  quality.handles = model.skeleton.jointCount();
  quality.idle = measures.idle();
  measures.countEnds(ends, quality);
  quality.strayParents = measures.strayParents();
  quality.inside = measureJointPlacement(model, std::vector<bool>(quality.handles, true)).inside;
  quality.overAir = measureWeights(model).islands;
  quality.movedBeside = measures.movedBeside();
  return quality;
}

std::vector<HandleTableRow> evaluateHandles(std::span<const std::filesystem::path> files, std::span<const Index> counts,
                                            const HandleRigger& rig, const HandlesSeen& seen, Progress& progress,
                                            Warnings& skipped) {
  std::vector<HandleTableRow> rows;
  forEachFile(files.size(), "handles", kNotCompared, progress, skipped, [&](std::size_t i) {
    const Asset read = readAsset(files[i]);
    std::optional<std::vector<LimbEndOnModel>> ends;
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
  table.columns = {
      words("model"),          number("handles", 0),       number("inside %", 0),       number("idle", 0),
      number("ends", 0),       number("with a handle", 0), number("equals without", 0), number("stray parents", 0),
      number("over air %", 2), number("moved beside %", 2)};
  HandleQuality sum;
  const auto line = [&](Cell name, const HandleQuality& q) {
    table.add({std::move(name), q.handles, 100 * q.inside, q.idle, q.ends, q.coveredEnds, q.unequalEnds, q.strayParents,
               100 * q.overAir, 100 * q.movedBeside});
  };
  for (const auto& [file, quality] : rows) {
    line(foreign(file), quality);
    sum.handles += quality.handles;
    sum.idle += quality.idle;
    sum.ends += quality.ends;
    sum.coveredEnds += quality.coveredEnds;
    sum.unequalEnds += quality.unequalEnds;
    sum.strayParents += quality.strayParents;
    sum.inside += quality.inside * quality.handles;
    sum.overAir += quality.overAir / static_cast<double>(rows.size());
    sum.movedBeside += quality.movedBeside / static_cast<double>(rows.size());
  }
  if (sum.handles > 0) {
    sum.inside /= sum.handles;
    line(fmt::format("**all {}**", rows.size()), sum);
  }
  return table;
}

}  // namespace limber
