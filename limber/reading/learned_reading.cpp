#include "limber/reading/learned_reading.h"

#include <algorithm>
#include <cmath>

#include "limber/core/error.h"
#include "limber/core/parallel.h"

namespace limber {

namespace {

// ---- the mirror image of what a network says

FloatMatrix withRowsOf(const FloatMatrix& matrix, const std::vector<Index>& rows) {
  FloatMatrix result(rows.size(), matrix.columns);
  for (std::size_t r = 0; r < rows.size(); ++r) std::copy_n(matrix.row(rows[r]), matrix.columns, result.row(r));
  return result;
}

FloatMatrix withColumnsOf(const FloatMatrix& matrix, const std::vector<Index>& columns) {
  FloatMatrix result(matrix.rows, columns.size());
  for (std::size_t r = 0; r < matrix.rows; ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) result.row(r)[c] = matrix.row(r)[columns[c]];
  }
  return result;
}

std::vector<float> permuted(const std::vector<float>& values, const std::vector<Index>& from) {
  std::vector<float> result;
  for (const Index i : from) result.push_back(values[i]);
  return result;
}

// Every third number changes its sign, from the first on: rows of positions or offsets.
void mirrorVectors(FloatMatrix& vectors) {
  for (std::size_t i = 0; i < vectors.values.size(); i += 3) vectors.values[i] = -vectors.values[i];
}

ReadingOutput mirroredOutput(const ReadingOutput& output, const ReadingWeights& weights) {
  ReadingOutput result;
  result.positions = withRowsOf(output.positions, weights.mirrorRole);
  mirrorVectors(result.positions);
  result.has = permuted(output.has, weights.mirrorRole);
  result.logError = permuted(output.logError, weights.mirrorRole);
  result.plan = output.plan;
  result.parts = withColumnsOf(output.parts, weights.mirrorPart);
  result.bones = output.bones;
  mirrorVectors(result.bones);
  result.fingers = withRowsOf(output.fingers, {1, 0});
  return result;
}

// ---- the mean of two

void checkFinite(float value) {
  if (!std::isfinite(value)) throw Error(ErrorCode::kBadData, "the weights of the reading give no finite number");
}

void averageInto(std::vector<float>& values, const std::vector<float>& others) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 0.5f * (values[i] + others[i]);
    checkFinite(values[i]);
  }
}

void averageInto(ReadingOutput& output, const ReadingOutput& other) {
  averageInto(output.positions.values, other.positions.values);
  averageInto(output.has, other.has);
  averageInto(output.logError, other.logError);
  averageInto(output.plan, other.plan);
  averageInto(output.parts.values, other.parts.values);
  averageInto(output.bones.values, other.bones.values);
  averageInto(output.fingers.values, other.fingers.values);
}

void checkKnown(std::span<const KnownJoint> known, const ReadingWeights& weights) {
  std::vector<bool> seen(weights.roles.size(), false);
  for (const KnownJoint& joint : known) {
    if (joint.role >= seen.size()) throw Error(ErrorCode::kBadArgument, "a known joint's role is out of range");
    if (seen[joint.role]) throw Error(ErrorCode::kBadArgument, "a joint is known twice", weights.roles[joint.role]);
    if (!joint.position.allFinite()) {
      throw Error(ErrorCode::kBadArgument, "a known position is not finite", weights.roles[joint.role]);
    }
    seen[joint.role] = true;
  }
}

ReadingOutput evaluateBothSides(const SurfaceSamples& surface, const ReadingWeights& weights,
                                std::span<const KnownJoint> known) {
  std::vector<RolePin> pins, mirroredPins;
  for (const KnownJoint& joint : known.first(std::min(known.size(), kMaxKnownJoints))) {
    const Vec3f position = surface.toNetwork(joint.position).cast<float>();
    pins.push_back({joint.role, position});
    mirroredPins.push_back({weights.mirrorRole[joint.role], {-position.x(), position.y(), position.z()}});
  }
  ReadingOutput output, mirror;
  parallelInvoke([&] { output = evaluate(weights.reading, sampleFeatures(surface), pins); },
                 [&] { mirror = evaluate(weights.reading, sampleFeatures(mirrored(surface)), mirroredPins); });
  averageInto(output, mirroredOutput(mirror, weights));
  return output;
}

// ---- what it means

std::vector<double> probabilities(std::span<const float> logits, double temperature = 1) {
  const double largest = *std::max_element(logits.begin(), logits.end());
  std::vector<double> result;
  double sum = 0;
  for (const float logit : logits) {
    result.push_back(portableExp(static_cast<float>((logit - largest) / temperature)));
    sum += result.back();
  }
  for (double& value : result) value /= sum;
  return result;
}

std::size_t likeliest(std::span<const double> values) {
  return static_cast<std::size_t>(std::max_element(values.begin(), values.end()) - values.begin());
}

std::vector<LearnedJoint> decodeJoints(const ReadingOutput& output, const SurfaceSamples& surface,
                                       const ReadingCalibration& calibration, std::span<const KnownJoint> known) {
  std::vector<LearnedJoint> joints(output.has.size());
  for (std::size_t role = 0; role < joints.size(); ++role) {
    const float* position = output.positions.row(role);
    LearnedJoint& joint = joints[role];
    joint.confidence = sigmoid(output.has[role]);
    joint.present = joint.confidence > 0.5;
    joint.position = surface.toMesh(Vec3(position[0], position[1], position[2]));
    joint.expectedError = surface.scale * calibration.errorFactor * portableExp(output.logError[role]);
  }
  for (const KnownJoint& joint : known) joints[joint.role] = {true, 1, joint.position, 0, true};
  return joints;
}

std::vector<LearnedSample> decodeSamples(const ReadingOutput& output, const SurfaceSamples& surface) {
  std::vector<LearnedSample> samples;
  for (std::size_t i = 0; i < surface.samples.size(); ++i) {
    const std::vector<double> parts = probabilities({output.parts.row(i), output.parts.columns});
    const float* bone = output.bones.row(i);
    const Vec3& position = surface.samples[i].position;
    LearnedSample sample;
    sample.part = static_cast<Index>(likeliest(parts));
    sample.partConfidence = parts[sample.part];
    sample.boneStart = position + surface.scale * Vec3(bone[0], bone[1], bone[2]);
    sample.boneEnd = position + surface.scale * Vec3(bone[3], bone[4], bone[5]);
    samples.push_back(sample);
  }
  return samples;
}

LearnedFingers decodeFingers(const ReadingOutput& output, std::size_t hand) {
  const std::vector<double> counts = probabilities({output.fingers.row(hand), output.fingers.columns});
  const std::size_t count = likeliest(counts);
  return {static_cast<int>(count), counts[count]};
}

}  // namespace

LearnedReading readBody(const TriMesh& mesh, const ReadingWeights& weights, std::span<const KnownJoint> known) {
  return readSamples(sampleSurface(mesh, weights.sampleCount()), weights, known);
}

LearnedReading readSamples(const SurfaceSamples& surface, const ReadingWeights& weights,
                           std::span<const KnownJoint> known) {
  checkKnown(known, weights);
  const ReadingOutput output = evaluateBothSides(surface, weights, known);
  LearnedReading reading;
  reading.planProbabilities = probabilities(output.plan, weights.calibration.planTemperature);
  reading.plan = static_cast<Index>(likeliest(reading.planProbabilities));
  reading.planConfidence = reading.planProbabilities[reading.plan];
  reading.sure = reading.planConfidence >= weights.calibration.sureThreshold;
  reading.joints = decodeJoints(output, surface, weights.calibration, known);
  reading.surface = surface;
  reading.samples = decodeSamples(output, surface);
  for (std::size_t hand = 0; hand < kHands; ++hand) reading.fingers[hand] = decodeFingers(output, hand);
  return reading;
}

LearnedStance stanceOf(SurfaceSamples surface, const ReadingWeights& weights) {
  surface.samples.resize(std::min(surface.samples.size(), weights.stance.trunk.sizes.samples));
  const std::array<Mat3, kStances> rotations = stanceRotations();
  std::vector<float> scores(kStances);
  parallelFor(kStances, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      scores[i] = evaluate(weights.stance, sampleFeatures(transformed(surface, rotations[i])));
    }
  });
  for (const float score : scores) checkFinite(score);
  const std::vector<double> values = probabilities(scores);
  LearnedStance stance;
  std::copy(values.begin(), values.end(), stance.probabilities.begin());
  const std::size_t best = likeliest(values);
  stance.toBody = rotations[best];
  stance.confidence = values[best];
  return stance;
}

std::array<Mat3, kStances> stanceRotations() {
  std::array<Vec3, 6> axes;
  for (int i = 0; i < 6; ++i) axes[i] = (i % 2 == 0 ? 1.0 : -1.0) * Vec3::Unit(i / 2);
  std::array<Mat3, kStances> rotations;
  std::size_t count = 0;
  for (const Vec3& up : axes) {
    for (const Vec3& front : axes) {
      if (up.dot(front) != 0) continue;
      rotations[count].row(0) = up.cross(front).transpose();
      rotations[count].row(1) = up.transpose();
      rotations[count].row(2) = front.transpose();
      ++count;
    }
  }
  return rotations;
}

}  // namespace limber
