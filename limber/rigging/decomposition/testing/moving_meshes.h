// Meshes with known motions, made in code for tests. Not installed.
#pragma once

#include <cmath>

#include "limber/core/random.h"
#include "limber/rigging/decomposition/skin_decomposition.h"

namespace limber::testing {

struct KnownMotion {
  std::vector<Vec3f> rest;
  std::vector<std::vector<double>> weights;  // #points x #bones
  BoneMotions motions;
  std::vector<Vec3> joints;  // between bones b and b + 1

  VertexSequence sequence() const {
    VertexSequence result(static_cast<Index>(rest.size()), motions.frameCount);
    result.rest = rest;
    for (Index v = 0; v < rest.size(); ++v) {
      for (Index f = 0; f < motions.frameCount; ++f) {
        Vec3 moved = Vec3::Zero();
        for (Index b = 0; b < motions.boneCount(); ++b) {
          moved += weights[v][b] * (motions.of(b)[f] * rest[v].cast<double>().homogeneous());
        }
        result.set(v, f, moved.cast<float>());
      }
    }
    return result;
  }
};

inline RigidMotion rigidMotion(const Affine& affine) {
  return affine.matrix().topRows<3>();
}

// A chain of bones along X that turn about `joints` against each other by angles that waver, the first through space.
inline BoneMotions chainMotions(const std::vector<Vec3>& joints, Index frames, double reach) {
  BoneMotions result{frames, {}};
  result.motions.resize((joints.size() + 1) * frames);
  for (Index f = 0; f < frames; ++f) {
    Affine global = Eigen::Translation3d(0.1 * f, std::sin(0.3 * f), 0) *
                    Affine(Eigen::AngleAxisd(0.2 * std::sin(0.5 * f), Vec3(1, 2, 3).normalized()));
    result.of(0)[f] = rigidMotion(global);
    for (Index b = 0; b < joints.size(); ++b) {
      // About two axes, so that the joint is a point.
      const Quat turn = Quat(Eigen::AngleAxisd(reach * std::sin(0.4 * f + 2 * b), Vec3::UnitY())) *
                        Quat(Eigen::AngleAxisd(reach * std::cos(0.7 * f + b), Vec3::UnitZ()));
      global = global * Eigen::Translation3d(joints[b]) * Affine(turn) * Eigen::Translation3d(-joints[b]);
      result.of(b + 1)[f] = rigidMotion(global);
    }
  }
  return result;
}

// Three boxes of 27 points in a row, each 1 long, hinged at x = 1 and x = 2.
inline KnownMotion hingedBoxes(Index frames = 30) {
  KnownMotion known;
  known.joints = {Vec3(1.05, 0, 0), Vec3(2.15, 0, 0)};
  known.motions = chainMotions(known.joints, frames, 0.6);
  for (int b = 0; b < 3; ++b) {
    for (int i = 0; i < 27; ++i) {
      known.rest.emplace_back(1.1f * b + 0.5f * (i % 3), 0.2f * (i / 3 % 3 - 1), 0.2f * (i / 9 - 1));
      std::vector<double> weights(3, 0.0);
      weights[b] = 1;
      known.weights.push_back(weights);
    }
  }
  return known;
}

// A tube along X from 0 to 2 of rings of twelve points, whose weights pass smoothly from one bone to the other.
inline KnownMotion bentTube(Index frames = 30) {
  KnownMotion known;
  known.joints = {Vec3(1, 0, 0)};
  known.motions = chainMotions(known.joints, frames, 0.5);
  for (int ring = 0; ring <= 20; ++ring) {
    for (int i = 0; i < 12; ++i) {
      const double angle = 0.5235987755982988 * i, x = 0.1 * ring;
      known.rest.emplace_back(x, 0.2 * std::cos(angle), 0.2 * std::sin(angle));
      const double w = 1 / (1 + std::exp(8 * (1 - x)));
      known.weights.push_back({1 - w, w});
    }
  }
  return known;
}

// Pieces of four to nine points each, strewn about, every one with a rigid motion of its own.
inline KnownMotion scatteredPieces(Index pieces, Index frames = 12) {
  Random random(pieces);
  const auto anywhere = [&](double reach) {
    const double x = random.uniform(-reach, reach), y = random.uniform(-reach, reach);
    return Vec3(x, y, random.uniform(-reach, reach));
  };
  KnownMotion known;
  known.motions.frameCount = frames;
  for (Index b = 0; b < pieces; ++b) {
    const Vec3 middle = anywhere(1);
    const std::uint64_t points = 4 + random.below(6);
    for (std::uint64_t i = 0; i < points; ++i) {
      known.rest.push_back((middle + anywhere(0.1)).cast<float>());
      known.weights.emplace_back(pieces, 0.0);
      known.weights.back()[b] = 1;
    }
    for (Index f = 0; f < frames; ++f) {
      const Quat turn = Quat(Eigen::AngleAxisd(random.uniform(-1, 1), anywhere(1).normalized()));
      const Vec3 position = middle + anywhere(0.3);
      known.motions.motions.push_back(
          rigidMotion(Eigen::Translation3d(position) * Affine(turn) * Eigen::Translation3d(-middle)));
    }
  }
  return known;
}

}  // namespace limber::testing
