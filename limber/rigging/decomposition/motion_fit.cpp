#include "limber/rigging/decomposition/motion_fit.h"

#include <algorithm>

#include "limber/core/parallel.h"
#include "limber/core/rotation_fit.h"

namespace limber {

namespace {

constexpr std::size_t kFramesAtOnce = 4;

// Sum of w_a * w_b * p * p' over points p = (x, y, z, 1) that two bones share; symmetric in everything.
struct SharedMoment {
  Index a = 0, b = 0;
  Mat4 moment = Mat4::Zero();
};

// For each bone the moments with the bones that it shares points with, its own among them.
class SharedMoments {
 public:
  SharedMoments(const VertexSequence& sequence, const SkinWeights& weights, Index boneCount)
      : boneCount_(boneCount), slot_(std::size_t{boneCount} * boneCount, kNoIndex) {
    for (Index v = 0; v < sequence.pointCount(); ++v) {
      const Vec4 p = sequence.rest[v].cast<double>().homogeneous();
      const auto joints = weights.jointsOf(v);
      const auto w = weights.weightsOf(v);
      for (std::size_t i = 0; i < joints.size(); ++i) {
        for (std::size_t j = 0; j < joints.size(); ++j) {
          if (w[i] > 0 && w[j] > 0) between(joints[i], joints[j]) += double{w[i]} * double{w[j]} * p * p.transpose();
        }
      }
    }
    std::sort(moments_.begin(), moments_.end(),
              [](const SharedMoment& x, const SharedMoment& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; });
  }

  const std::vector<SharedMoment>& all() const { return moments_; }

 private:
  Mat4& between(Index a, Index b) {
    Index& slot = slot_[std::size_t{a} * boneCount_ + b];
    if (slot == kNoIndex) {
      slot = static_cast<Index>(moments_.size());
      moments_.push_back({a, b});
    }
    return moments_[slot].moment;
  }

  Index boneCount_;
  std::vector<Index> slot_;
  std::vector<SharedMoment> moments_;
};

// Rotation and translation that minimise |T p - q| over weighted pairs of points.
//   crossed  sum of weight * q * (p, 1)'
//   moment   sum of weight * (p, 1) * (p, 1)'
RigidMotion bestMotion(const RigidMotion& crossed, const Mat4& moment, const RigidMotion& before) {
  const double weight = moment(3, 3);
  const Mat3 correlation = crossed.leftCols<3>() - crossed.col(3) * moment.row(3).head<3>() / weight;
  const Mat3 turned = before.leftCols<3>();
  RigidMotion result;
  result.leftCols<3>() = bestRotation(correlation * turned.transpose()).toRotationMatrix() * turned;
  result.col(3) = (crossed.col(3) - result.leftCols<3>() * moment.col(3).head<3>()) / weight;
  return result;
}

// #bones sums of w * v * (p, 1)' in one frame.
void crossedMoments(const VertexSequence& sequence, const SkinWeights& weights, Index frame,
                    std::vector<RigidMotion>& crossed) {
  std::fill(crossed.begin(), crossed.end(), RigidMotion(RigidMotion::Zero()));
  for (Index v = 0; v < sequence.pointCount(); ++v) {
    const Vec4 p = sequence.rest[v].cast<double>().homogeneous();
    const RigidMotion product = sequence.at(v, frame).cast<double>() * p.transpose();
    const auto joints = weights.jointsOf(v);
    const auto w = weights.weightsOf(v);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (w[i] > 0) crossed[joints[i]] += double{w[i]} * product;
    }
  }
}

}  // namespace

void fitMotions(const VertexSequence& sequence, const SkinWeights& weights, BoneMotions& motions) {
  const Index bones = motions.boneCount();
  const SharedMoments shared(sequence, weights, bones);
  parallelFor(sequence.frameCount(), kFramesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<RigidMotion> crossed(bones);
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      crossedMoments(sequence, weights, f, crossed);
      auto next = shared.all().begin();
      while (next != shared.all().end()) {
        const Index bone = next->a;
        RigidMotion left = crossed[bone];
        const Mat4* own = nullptr;
        for (; next != shared.all().end() && next->a == bone; ++next) {
          if (next->b == bone) {
            own = &next->moment;
          } else {
            left -= motions.of(next->b)[f] * next->moment;
          }
        }
        RigidMotion& motion = motions.of(bone)[f];
        motion = bestMotion(left, *own, motion);
      }
    }
  });
}

void appendMotionOf(const VertexSequence& sequence, const std::vector<Index>& points, BoneMotions& motions) {
  Mat4 moment = Mat4::Zero();
  for (const Index v : points) {
    const Vec4 p = sequence.rest[v].cast<double>().homogeneous();
    moment += p * p.transpose();
  }
  RigidMotion motion = RigidMotion::Identity();
  for (Index f = 0; f < sequence.frameCount(); ++f) {
    RigidMotion crossed = RigidMotion::Zero();
    for (const Index v : points) {
      crossed += sequence.at(v, f).cast<double>() * sequence.rest[v].cast<double>().homogeneous().transpose();
    }
    motion = bestMotion(crossed, moment, motion);
    motions.motions.push_back(motion);
  }
}

}  // namespace limber
