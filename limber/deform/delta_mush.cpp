#include "limber/deform/delta_mush.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/deform/deform_call.h"
#include "limber/deform/linear_blend.h"
#include "limber/deform/smoothing_surface.h"

namespace limber {

namespace {

constexpr std::size_t kSmoothGrain = 4096, kDetailGrain = 512;  // vertices; some 50 microseconds each
constexpr std::size_t kFloatsPerMushVertex = 3 + 3 + 4;         // displacements before and after, rotation

// State common to the stages of one call.
struct MushFrame {
  const DeltaMushSurface& surface;
  const DeformInput& input;
  const DeformOutput& output;
  Vec3f *from, *to;        // displacements of welded vertices
  float* rotations;        // four for each: x y z w
  const float* motions;    // of joints, as packMotion gives them
  const float* stretches;  // null where no joint has any
};

void smoothRange(const DeltaMushSurface& surface, const Vec3f* from, Vec3f* to, std::size_t begin, std::size_t end) {
  for (std::size_t v = begin; v < end; ++v) {
    Vec3f flow = Vec3f::Zero();
    for (const MushNeighbour& next : surface.neighbours.of(v)) flow += next.flow * (from[next.vertex] - from[v]);
    to[v] = from[v] + surface.step * flow;
  }
}

// What is smoothed is in frame.from again.
void smooth(MushFrame& frame) {
  for (int i = 0; i < frame.surface.smoothings; ++i) {
    parallelFor(frame.surface.positions.size(), kSmoothGrain, [&frame](std::size_t begin, std::size_t end) {
      smoothRange(frame.surface, frame.from, frame.to, begin, end);
    });
    std::swap(frame.from, frame.to);
  }
}

void blendLinearly(MushFrame& frame, std::span<float> scratch) {
  const std::span<const Vec3f> positions = frame.surface.positions;
  linearBlend({positions, {}, frame.surface.weights, frame.input.transforms, {}},
              {std::span(frame.from, positions.size()), {}}, scratch);
  for (std::size_t v = 0; v < positions.size(); ++v) frame.from[v] -= positions[v];
}

Vec4 blendedRotation(const MushFrame& frame, Index vertex) {
  Vec4 sum = Vec4::Zero();
  for (Index slot = 0; slot < frame.surface.weights.slots; ++slot) {
    const float* motion = frame.motions + kFloatsPerMotion * frame.surface.weights.jointsOf(vertex)[slot];
    const Vec4 rotation(motion[0], motion[1], motion[2], motion[3]);
    const double weight = frame.surface.weights.weightsOf(vertex)[slot];
    sum += (sum.dot(rotation) < 0 ? -weight : weight) * rotation;
  }
  return sum.squaredNorm() > 0 ? sum : Vec4(0, 0, 0, 1);
}

Mat3 blendedStretch(const MushFrame& frame, Index vertex) {
  Mat3 sum = Mat3::Identity();
  for (Index slot = 0; slot < frame.surface.weights.slots && frame.stretches; ++slot) {
    const float* stretch = frame.stretches + kFloatsPerColumns * frame.surface.weights.jointsOf(vertex)[slot];
    const double weight = frame.surface.weights.weightsOf(vertex)[slot];
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) sum(row, column) += weight * static_cast<double>(stretch[4 * column + row]);
    }
  }
  return sum;
}

// Newton's method for the rotation nearest to `fit`, of trace about 1 when at rest, from a near one.
Quat nearestFrom(Quat rotation, const Mat3& fit) {
  constexpr int kSteps = 6;
  for (int i = 0; i < kSteps; ++i) {
    const Mat3 turned = rotation.toRotationMatrix().transpose() * fit;
    const Vec3 skew(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0), turned(1, 0) - turned(0, 1));
    if (skew.squaredNorm() == 0) break;
    const Mat3 bend = turned.trace() * Mat3::Identity() - 0.5 * (turned + turned.transpose());
    const bool convex =
        bend(0, 0) > 0 && bend(0, 0) * bend(1, 1) > bend(0, 1) * bend(0, 1) && bend.determinant() > 1e-12;
    const Vec3 turn = 0.5 * (convex ? Vec3(bend.inverse() * skew) : skew);
    rotation = (rotation * Quat(1, turn.x(), turn.y(), turn.z())).normalized();
  }
  return rotation;
}

// Replaces the displacements of smoothed vertices by those with their detail.
void addDetail(const MushFrame& frame, std::size_t begin, std::size_t end) {
  constexpr double kRoundness = 1e-3;  // as direct delta mush has it: tells the rotation where edges are flat or a line
  const DeltaMushSurface& surface = frame.surface;
  for (std::size_t v = begin; v < end; ++v) {
    const Mat3 stretch = blendedStretch(frame, static_cast<Index>(v));
    Mat3 fit = Mat3::Zero();
    double size = 0;
    for (const auto& [k, flow] : surface.neighbours.of(v)) {
      const Vec3 edge = (surface.smoothed[k] - surface.smoothed[v]).cast<double>();
      const Vec3 moved = edge + (frame.from[k] - frame.from[v]).cast<double>(), stretched = stretch * edge;
      fit += static_cast<double>(flow) * moved * stretched.transpose();
      size += static_cast<double>(flow) * stretched.squaredNorm();
    }
    Quat rotation(blendedRotation(frame, static_cast<Index>(v)));
    rotation.normalize();
    if (size > 0) {
      rotation = nearestFrom(rotation, fit / size + kRoundness / 3 * rotation.toRotationMatrix());
    }
    const Vec3 detail = (surface.positions[v] - surface.smoothed[v]).cast<double>();
    const Vec3 grown = stretch * detail;
    const Vec3 shift = (grown - detail) + (rotation.toRotationMatrix() - Mat3::Identity()) * grown;
    frame.to[v] = frame.from[v] + shift.cast<float>();
    for (int i = 0; i < 4; ++i) frame.rotations[4 * v + i] = static_cast<float>(rotation.coeffs()[i]);
  }
}

// v + d, and v itself, sign of zero included, where d is zero.
Vec3f displacedPoint(const Vec3f& v, const Vec3f& d) {
  return {d.x() == 0 ? v.x() : v.x() + d.x(), d.y() == 0 ? v.y() : v.y() + d.y(), d.z() == 0 ? v.z() : v.z() + d.z()};
}

void writeRange(const MushFrame& frame, std::size_t begin, std::size_t end) {
  for (std::size_t v = begin; v < end; ++v) {
    const Index welded = frame.surface.weldedVertex[v];
    frame.output.positions[v] = displacedPoint(frame.input.positions[v], frame.to[welded]);
    if (frame.output.normals.empty()) continue;
    const float* r = frame.rotations + 4 * welded;
    Vec3 normal = frame.input.normals[v].cast<double>();
    if (frame.stretches) {
      const Mat3 stretch = blendedStretch(frame, welded);
      const Vec3 across = stretch.inverse().transpose() * normal;
      if (across.allFinite() && stretch.determinant() != 0) normal = across.normalized();
    }
    const bool turned = r[0] != 0 || r[1] != 0 || r[2] != 0;
    const Vec3 after = turned ? Vec3(Quat(r[3], r[0], r[1], r[2]).normalized() * normal) : normal;
    frame.output.normals[v] = turned || frame.stretches ? Vec3f(after.cast<float>()) : frame.input.normals[v];
  }
}

// Of each vertex its neighbours and how much of it each is.
void connectNeighbours(const SmoothingSurface& smooth, DeltaMushSurface& surface) {
  surface.neighbours = Grouped<MushNeighbour>(smooth.vertexCount(), [&](const auto& visit) {
    for (int column = 0; column < smooth.stiffness.cols(); ++column) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(smooth.stiffness, column); it; ++it) {
        const Index a = static_cast<Index>(column), b = static_cast<Index>(it.row());
        if (a == b || !(it.value() < 0)) continue;
        visit(a, {b, static_cast<float>(-it.value() / smooth.diagonal[column])});
        visit(b, {a, static_cast<float>(-it.value() / smooth.diagonal[it.row()])});
      }
    }
  });
}

}  // namespace

std::shared_ptr<const DeltaMushSurface> deltaMushSurface(const BoundSurface& surface, Index jointCount,
                                                         const DeltaMushOptions& options) {
  if (!(options.reach > 0) || !(options.step > 0) || options.step > 1 || options.maxSmoothings < 1) {
    throw Error(ErrorCode::kBadArgument, "an option of delta mush is out of its range");
  }
  SmoothingSurface smooth = smoothingSurface(surface);
  auto result = std::make_shared<DeltaMushSurface>();
  connectNeighbours(smooth, *result);
  result->step = static_cast<float>(options.step);
  const double wanted = std::ceil(smooth.stepsFor(options.reach) / options.step);
  result->smoothings = static_cast<int>(std::min<double>(wanted, options.maxSmoothings));
  result->jointCount = jointCount;
  result->weldedVertex = std::move(smooth.weldedVertex);
  result->positions = std::move(smooth.positions);
  result->weights = std::move(smooth.weights);
  result->smoothed = result->positions;
  std::vector<Vec3f> next(result->smoothed.size());
  for (int i = 0; i < result->smoothings; ++i) {
    smoothRange(*result, result->smoothed.data(), next.data(), 0, next.size());
    std::swap(result->smoothed, next);
  }
  return result;
}

std::shared_ptr<const DeformPreparation> prepareDeltaMush(const BoundSurface& surface, Index jointCount) {
  return deltaMushSurface(surface, jointCount);
}

std::size_t deltaMushScratch(std::size_t vertexCount, Index jointCount) {
  return linearBlendScratch(vertexCount, jointCount) + (kFloatsPerMotion + kFloatsPerColumns) * jointCount +
         kFloatsPerMushVertex * vertexCount;
}

void deltaMush(const DeformInput& input, const DeformOutput& output, std::span<float> scratch) {
  const Index jointCount = static_cast<Index>(input.transforms.size());
  checkDeformCall(input, output, scratch.size(), deltaMushScratch(input.positions.size(), jointCount));
  const auto& surface = preparationOf<DeltaMushSurface>(input);
  checkPreparedFor(surface.weldedVertex.size(), surface.jointCount, input);

  const std::size_t count = surface.positions.size(), blending = linearBlendScratch(count, jointCount);
  float* motions = scratch.data() + blending;
  float* stretches = motions + kFloatsPerMotion * jointCount;
  float* vertices = stretches + kFloatsPerColumns * jointCount;
  bool stretched = false;
  for (Index j = 0; j < jointCount; ++j) {
    stretched |= packMotion(input.transforms[j], Vec3::Zero(), motions + kFloatsPerMotion * j,
                            stretches + kFloatsPerColumns * j);
  }
  auto* displacements = reinterpret_cast<Vec3f*>(vertices);
  MushFrame frame = {surface,
                     input,
                     output,
                     displacements,
                     displacements + count,
                     vertices + 6 * count,
                     motions,
                     stretched ? stretches : nullptr};
  blendLinearly(frame, scratch.first(blending));
  smooth(frame);
  parallelFor(count, kDetailGrain, [&frame](std::size_t begin, std::size_t end) { addDetail(frame, begin, end); });
  parallelFor(input.positions.size(), kSmoothGrain,
              [&frame](std::size_t begin, std::size_t end) { writeRange(frame, begin, end); });
}

}  // namespace limber
