// What a trained network says of a shape: what kind of body it is, where its joints are, which part each bit of the
// surface belongs to, and how sure it is of each.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "limber/core/types.h"
#include "limber/geometry/mesh/tri_mesh.h"
#include "limber/reading/surface_samples.h"
#include "limber/reading/weights_file.h"

namespace limber {

// A joint whose position is known: what the user has set.
struct KnownJoint {
  Index role = 0;  // of ReadingWeights::roles
  Vec3 position = Vec3::Zero();
};

struct LearnedJoint {
  bool present = false;          // confidence above a half, or known
  double confidence = 0;         // that the body has such a joint, in [0, 1]
  Vec3 position = Vec3::Zero();  // where it would be, even where it is not present
  double expectedError = 0;      // distance from the true position; 0 where it is known
  bool known = false;
};

// Of the sample with the same index.
struct LearnedSample {
  Index part = 0;  // of ReadingWeights::parts
  double partConfidence = 0;
  Vec3 boneStart = Vec3::Zero(), boneEnd = Vec3::Zero();  // of the bone that moves it most
};

struct LearnedFingers {
  int count = 0;  // 0 to 5
  double confidence = 0;
};

// Positions and lengths in the mesh's space.
struct LearnedReading {
  Index plan = 0;  // of ReadingWeights::plans
  double planConfidence = 0;
  bool sure = false;                      // the confidence reaches ReadingCalibration::sureThreshold
  std::vector<double> planProbabilities;  // their sum is 1
  std::vector<LearnedJoint> joints;       // one for each of ReadingWeights::roles
  SurfaceSamples surface;
  std::vector<LearnedSample> samples;
  std::array<LearnedFingers, kHands> fingers;  // left, right
};

// Joints beyond these are not given to the network, which learned with so many at most; they still are in the reading.
inline constexpr std::size_t kMaxKnownJoints = 5;

// The mean of what the network says of the body and of its mirror image, so that mirrored samples have the mirrored
// reading. Raw outputs are averaged (positions, logits, logarithms of errors), then calibrated.
//
// mesh   as for sampleSurface; in the body's frame: up +Y, front +Z, its left +X
// known  each role once at most
// Same bits on every machine, for any number of threads. Throws Error as sampleSurface does; kBadArgument for a role
// that is out of range or twice in `known`; kBadData where the weights give no finite number.
// Cost: that of sampleSurface and two of evaluate's.
LearnedReading readBody(const TriMesh& mesh, const ReadingWeights& weights, std::span<const KnownJoint> known = {});

// The same of samples that are there already, as many as ReadingWeights::sampleCount.
LearnedReading readSamples(const SurfaceSamples& surface, const ReadingWeights& weights,
                           std::span<const KnownJoint> known = {});

struct LearnedStance {
  Mat3 toBody = Mat3::Identity();  // rotation from the mesh's frame to the body's: rows are its left, up and front
  double confidence = 0;
  std::array<double, kStances> probabilities = {};  // of stanceRotations
};

// Which axis is up and which is front: the network scores the body in each of 24 orientations.
// Errors as for readSamples. Cost: 24 of evaluate's, 19 ms on one core.
LearnedStance stanceOf(SurfaceSamples surface, const ReadingWeights& weights);

// The proper rotations of the cube, in the order of the network's outputs: by the axis that is up (+x, -x, +y, -y, +z,
// -z), then by the one that is front, in the same order without the two along the first.
std::array<Mat3, kStances> stanceRotations();

}  // namespace limber
