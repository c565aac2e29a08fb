#include "limber/document/fbx/export_fbx_curves.h"

#include <algorithm>

#include "limber/core/text/numbers.h"
#include "limber/document/fbx/export_fbx_angles.h"

namespace limber {

namespace {

constexpr int kMaxFbxHalvings = 8;       // halvings between two keys
constexpr double kFbxBeforeStep = 1e-4;  // seconds
constexpr double kMaxDegrees = 90;       // between two keys: readers that blend rotations take the same path

// Adds keys to a list, each after the one before.
template <typename ValueAt, typename IsStraight>
class FbxKeyAdder {
 public:
  FbxKeyAdder(FbxKeys& keys, const ValueAt& valueAt, const IsStraight& isStraight)
      : keys_(keys), valueAt_(valueAt), isStraight_(isStraight) {}

  void add(double time) {
    keys_.values.push_back(valueAt_(time, keys_.values.empty() ? nullptr : &keys_.values.back()));
    keys_.times.push_back(time);
  }

  // What is needed between the last key and `to`, and that.
  void addUpTo(double to, int depth = 0) {
    const double from = keys_.times.back();
    if (depth < kMaxFbxHalvings && !isStraight_(from, keys_.values.back(), to)) {
      addUpTo(from + 0.5 * (to - from), depth + 1);
      addUpTo(to, depth + 1);
    } else {
      add(to);
    }
  }

 private:
  FbxKeys& keys_;
  const ValueAt& valueAt_;
  const IsStraight& isStraight_;
};

template <typename Value, typename ValueAt, typename IsStraight>
FbxKeys fbxKeysOf(const Track<Value>& track, const ValueAt& valueAt, const IsStraight& isStraight) {
  FbxKeys keys;
  keys.isStepped = track.interpolation == Interpolation::kStep;
  FbxKeyAdder<ValueAt, IsStraight> adder(keys, valueAt, isStraight);
  adder.add(track.times[0]);
  for (std::size_t k = 1; k < track.times.size(); ++k) {
    const double to = track.times[k];
    if (!keys.isStepped) {
      adder.addUpTo(to);
      continue;
    }
    if (to - kFbxBeforeStep > keys.times.back()) adder.add(to - kFbxBeforeStep);
    adder.add(to);
  }
  return keys;
}

}  // namespace

FbxKeys fbxKeys(const Track<Vec3f>& track) {
  const bool isCubic = track.interpolation == Interpolation::kCubic;
  Vec3f low = track.values[isCubic ? 1 : 0], high = low;
  for (std::size_t v = isCubic ? 1 : 0; v < track.values.size(); v += isCubic ? 3 : 1) {
    low = low.cwiseMin(track.values[v]);
    high = high.cwiseMax(track.values[v]);
  }
  const double tolerance = kFbxTolerance * (high - low).cast<double>().norm();
  const auto valueAt = [&](double time, const Vec3*) { return sampleTrack(track, time); };
  const auto isStraight = [&](double from, const Vec3& start, double to) {
    if (!isCubic) return true;
    const Vec3 end = sampleTrack(track, to);
    for (const double u : {0.25, 0.5, 0.75}) {
      const Vec3 line = start + u * (end - start);
      if ((sampleTrack(track, from + u * (to - from)) - line).norm() > tolerance) return false;
    }
    return true;
  };
  return fbxKeysOf(track, valueAt, isStraight);
}

FbxKeys fbxKeys(const Track<Eigen::Quaternionf>& track, const Quat& turn) {
  const auto rotationAt = [&](double time) { return Quat(turn * sampleTrack(track, time)); };
  const auto valueAt = [&](double time, const Vec3* before) {
    const Quat rotation = rotationAt(time);
    return before != nullptr ? eulerDegreesNear(rotation, *before) : eulerDegrees(rotation);
  };
  const auto isStraight = [&](double from, const Vec3& start, double to) {
    const Vec3 end = eulerDegreesNear(rotationAt(to), start);
    if ((end - start).cwiseAbs().maxCoeff() > kMaxDegrees) return false;
    for (const double u : {0.25, 0.5, 0.75}) {
      const Quat line = eulerRotation(start + u * (end - start));
      if (line.angularDistance(rotationAt(from + u * (to - from))) > kFbxAngleTolerance * kDegree) return false;
    }
    return true;
  };
  return fbxKeysOf(track, valueAt, isStraight);
}

}  // namespace limber
