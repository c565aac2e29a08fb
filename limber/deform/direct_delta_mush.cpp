#include "limber/deform/direct_delta_mush.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/deform/deform_call.h"
#include "limber/deform/implicit_smoother.h"

namespace limber {

namespace {

// Moments of weighted points up to the first order.
struct PointMoments {
  double weight = 0;
  Vec3 first = Vec3::Zero();

  PointMoments& operator+=(const PointMoments& other) {
    weight += other.weight;
    first += other.first;
    return *this;
  }
  bool isFinite() const { return std::isfinite(weight) && first.allFinite(); }
};

PointMoments operator*(double factor, const PointMoments& m) {
  return {factor * m.weight, factor * m.first};
}

PointMoments operator-(const PointMoments& a, const PointMoments& b) {
  return {a.weight - b.weight, a.first - b.first};
}

struct VertexWeight {
  Index vertex = 0;
  double weight = 0;
};

// A joint's part in a vertex' row.
struct JointPart {
  Index vertex = 0, joint = 0;
  PointMoments moments;
};

// Every joint's parts in the rows of all vertices.
class MomentTable {
 public:
  MomentTable(const SmoothingSurface& surface, Index jointCount, const DirectDeltaMushOptions& options)
      : surface_(surface),
        options_(options),
        rotation_(surface, surface.stepsFor(options.rotationReach) / options.smoothings, options.smoothings),
        translation_(surface, surface.stepsFor(options.translationReach) / options.smoothings, options.smoothings),
        boundTo_(jointCount) {
    gatherWeights();
    makePositions();
  }

  // Calls addRow(vertex, parts) of each vertex in order: its joints' parts, strongest first.
  template <class AddRow>
  void forEachRow(const AddRow& addRow) const {
    constexpr double kRounding = 1e-6;
    const std::vector<PointMoments> whole = momentsOf(everything_), bound = momentsOf(bound_);
    std::vector<std::vector<JointPart>> ofVertex = partsOfVertices();
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      std::vector<JointPart>& parts = ofVertex[v];
      std::stable_sort(parts.begin(), parts.end(),
                       [](const JointPart& a, const JointPart& b) { return a.moments.weight > b.moments.weight; });
      dropWeakest(parts);
      PointMoments all = bound[v];
      if (std::abs(all.weight - 1) < kRounding) all = whole[v], all.weight = 1;
      completeParts(parts, all);
      addRow(v, parts);
    }
  }

  const Vec3& smoothedPosition(Index vertex) const { return positions_[vertex]; }

 private:
  void gatherWeights() {
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      everything_.push_back({v, 1});
      double sum = 0;
      for (Index slot = 0; slot < surface_.weights.slots; ++slot) {
        const double weight = surface_.weights.weightsOf(v)[slot];
        if (!(weight > 0)) continue;
        boundTo_[surface_.weights.jointsOf(v)[slot]].push_back({v, weight});
        sum += weight;
      }
      if (sum > 0) bound_.push_back({v, sum});
    }
  }

  Vec3 position(Index vertex) const { return surface_.positions[vertex].cast<double>(); }

  // p = B u.
  void makePositions() {
    std::vector<double> x(std::size_t{ImplicitSmoother::kColumns} * surface_.vertexCount());
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      for (int i = 0; i < 3; ++i) x[rotation_.rowOf(v) + i] = position(v)[i];
    }
    rotation_.smooth(x, 3);
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      const double* at = x.data() + rotation_.rowOf(v);
      Vec3 point(at[0], at[1], at[2]);
      const bool alone = surface_.stiffness.coeff(v, v) == 0;
      positions_.push_back(alone || !point.allFinite() ? position(v) : point);
    }
  }

  // Moments of the smoothed weights about each vertex's smoothed position; the paper's Psi and w' (equations 15 and
  // 18).
  std::vector<PointMoments> momentsOf(const std::vector<VertexWeight>& weights) const {
    // About their middle, so that little is lost by taking differences.
    Vec3 middle = Vec3::Zero();
    for (const VertexWeight& w : weights) middle += position(w.vertex) / static_cast<double>(weights.size());
    const std::size_t size = std::size_t{ImplicitSmoother::kColumns} * surface_.vertexCount();
    std::vector<double> moments(size, 0.0), translation(size, 0.0);
    for (const VertexWeight& w : weights) {
      const Vec3 arm = position(w.vertex) - middle;
      double* row = moments.data() + rotation_.rowOf(w.vertex);
      row[0] += w.weight;
      translation[translation_.rowOf(w.vertex)] += w.weight;
      for (int i = 0; i < 3; ++i) row[1 + i] += w.weight * arm[i];
    }
    rotation_.smooth(moments, 4);
    translation_.smooth(translation, 1);
    std::vector<PointMoments> result;
    for (Index v = 0; v < surface_.vertexCount(); ++v) {
      const double* row = moments.data() + rotation_.rowOf(v);
      // About the smoothed position.
      PointMoments m = {row[0], Vec3(row[1], row[2], row[3]) - row[0] * (positions_[v] - middle)};
      m = (1 - options_.translationWeight) * m;
      m.weight += options_.translationWeight * translation[translation_.rowOf(v)];
      if (surface_.stiffness.coeff(v, v) == 0 || !m.isFinite()) m = {row[0], Vec3::Zero()};
      result.push_back(m);
    }
    return result;
  }

  std::vector<JointPart> partsOf(Index joint) const {
    std::vector<JointPart> parts;
    const std::vector<PointMoments> moments = momentsOf(boundTo_[joint]);
    for (Index v = 0; v < moments.size(); ++v) {
      if (moments[v].weight >= options_.minWeight) parts.push_back({v, joint, moments[v]});
    }
    return parts;
  }

  // Strongest first; a whole entry of four is left out where it costs more than it changes.
  void dropWeakest(std::vector<JointPart>& parts) const {
    if (parts.size() > options_.maxJoints) parts.resize(options_.maxJoints);
    while (parts.size() > 4) {
      const std::size_t first = (parts.size() - 1) / 4 * 4;
      double totalWeight = 0;
      for (std::size_t i = first; i < parts.size(); ++i) totalWeight += parts[i].moments.weight;
      if (totalWeight >= options_.minEntry) return;
      parts.resize(first);
    }
  }

  // What small parts had is given to the others, so that one motion of all joints stays one motion.
  static void completeParts(std::vector<JointPart>& parts, const PointMoments& bound) {
    PointMoments kept;
    for (const JointPart& part : parts) kept += part.moments;
    const PointMoments missing = bound - kept;
    for (JointPart& part : parts) part.moments += part.moments.weight / kept.weight * missing;
  }

  std::vector<std::vector<JointPart>> partsOfVertices() const {
    std::vector<std::vector<JointPart>> ofJoint(boundTo_.size());
    parallelFor(boundTo_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t joint = begin; joint < end; ++joint) {
        if (!boundTo_[joint].empty()) ofJoint[joint] = partsOf(static_cast<Index>(joint));
      }
    });
    std::vector<std::vector<JointPart>> ofVertex(surface_.vertexCount());
    for (std::vector<JointPart>& parts : ofJoint) {
      for (const JointPart& part : parts) ofVertex[part.vertex].push_back(part);
      parts = {};
    }
    return ofVertex;
  }

  const SmoothingSurface& surface_;
  const DirectDeltaMushOptions& options_;
  ImplicitSmoother rotation_, translation_;
  std::vector<std::vector<VertexWeight>> boundTo_;  // by joint
  std::vector<VertexWeight> everything_, bound_;
  std::vector<Vec3> positions_;
};

// Four joints from `first` on.
void addEntry(const std::vector<JointPart>& parts, std::size_t first, const Vec3& position, DirectDeltaMushRows& rows) {
  const std::size_t begin = rows.moments.size();
  rows.moments.resize(begin + kFloatsPerMoments, 0.0f);
  for (std::size_t i = 0; i < 4; ++i) {
    const bool there = first + i < parts.size();
    rows.joints.push_back(there ? parts[first + i].joint : parts.front().joint);
    if (!there) continue;
    const PointMoments& moments = parts[first + i].moments;
    const Vec3 sum = moments.first + moments.weight * position;
    for (std::size_t axis = 0; axis < 3; ++axis) rows.moments[begin + 4 * axis + i] = static_cast<float>(sum[axis]);
    rows.moments[begin + 12 + i] = static_cast<float>(moments.weight);
  }
}

// About the origin: only the linear part of the stretch and the rotation of the motion are used. Whether any stretches.
bool packJoints(std::span<const Affine> transforms, float* columns, float* stretches, float* motions) {
  bool stretched = false;
  for (std::size_t j = 0; j < transforms.size(); ++j) {
    packColumns(transforms[j], columns + kFloatsPerColumns * j);
    stretched |=
        packMotion(transforms[j], Vec3::Zero(), motions + kFloatsPerMotion * j, stretches + kFloatsPerColumns * j);
  }
  return stretched;
}

void checkOptions(const DirectDeltaMushOptions& options) {
  const bool right = options.rotationReach > 0 && options.translationReach > 0 && options.smoothings > 0 &&
                     options.translationWeight >= 0 && options.translationWeight < 1 && options.minWeight >= 0 &&
                     options.minWeight <= 0.1 && options.maxJoints > 0 && options.minEntry >= 0 &&
                     options.minEntry <= 0.5;
  if (!right) throw Error(ErrorCode::kBadArgument, "an option of direct delta mush is out of its range");
}

}  // namespace

std::shared_ptr<const DirectDeltaMushRows> directDeltaMushRows(const BoundSurface& surface, Index jointCount,
                                                               const DirectDeltaMushOptions& options) {
  checkOptions(options);
  const SmoothingSurface smooth = smoothingSurface(surface);
  const MomentTable table(smooth, jointCount, options);
  auto rows = std::make_shared<DirectDeltaMushRows>();
  rows->rowOf = smooth.weldedVertex;
  rows->jointCount = jointCount;
  rows->begin.push_back(0);
  table.forEachRow([&](Index v, const std::vector<JointPart>& parts) {
    const Vec3& position = table.smoothedPosition(v);
    for (std::size_t first = 0; first < parts.size(); first += 4) addEntry(parts, first, position, *rows);
    rows->begin.push_back(static_cast<Index>(rows->joints.size() / 4));
    for (int axis = 0; axis < 3; ++axis) rows->positions.push_back(static_cast<float>(position[axis]));
    rows->positions.push_back(0);
  });
  return rows;
}

std::shared_ptr<const DeformPreparation> prepareDirectDeltaMush(const BoundSurface& surface, Index jointCount) {
  return directDeltaMushRows(surface, jointCount);
}

std::shared_ptr<const DeformRows> directDeltaMushDrawRows(const BoundSurface& surface,
                                                          const std::shared_ptr<const DeformPreparation>& preparation) {
  auto rows = std::dynamic_pointer_cast<const DirectDeltaMushRows>(preparation);
  if (!rows || rows->rowOf.size() != surface.positions.size()) refusePreparation();
  return rows;
}

std::size_t directDeltaMushScratch(std::size_t /*vertexCount*/, Index jointCount) {
  return (kFloatsPerMotion + 2 * kFloatsPerColumns) * jointCount + kScratchAlignment;
}

void directDeltaMush(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), directDeltaMushScratch(input.positions.size(), jointCount));
  const auto& rows = preparationOf<DirectDeltaMushRows>(input);
  checkPreparedFor(rows.rowOf.size(), rows.jointCount, input);
  float* columns = alignedScratch(scratch);
  float* stretches = columns + kFloatsPerColumns * jointCount;
  float* motions = stretches + kFloatsPerColumns * jointCount;
  const bool stretched = packJoints(input.transforms, columns, stretches, motions);

  DeformJob job = deformJob(input, output);
  job.rowOf = rows.rowOf.data();
  job.rowBegin = rows.begin.data();
  job.rowJoints = rows.joints.data();
  job.rowMoments = rows.moments.data();
  job.columns = columns;
  job.stretches = stretches;
  job.motions = motions;
  job.rowPositions = rows.positions.data();
  runDeformJob(directKernels().direct[job.outNormals != nullptr][stretched], job, input.positions.size());
}

}  // namespace limber
