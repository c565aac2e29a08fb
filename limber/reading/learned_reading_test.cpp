#include "limber/reading/learned_reading.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/reading/testing/made_weights.h"

namespace limber {
namespace {

const Vec3 kMirror(-1, 1, 1);

// Alike on neither side.
TriMesh lopsidedBody() {
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0, 0}, {0.1, 1, 0}, 0.2);
  testing::addCapsule(mesh, {0.5, 0.9, 0.1}, {1, 0.7, 0.4}, 0.08);
  testing::addCapsule(mesh, {-0.5, 0.8, 0}, {-0.8, 0.2, 0}, 0.1);
  return mesh;
}

ReadingWeights weightsFor(std::uint64_t seed = 1) {
  return readReadingWeights(testing::madeWeights(seed).file());
}

void expectSameJoint(const LearnedJoint& joint, const LearnedJoint& expected, const Vec3& factor) {
  EXPECT_EQ(joint.present, expected.present);
  EXPECT_EQ(joint.confidence, expected.confidence);
  EXPECT_EQ(joint.position, expected.position.cwiseProduct(factor).eval());
  EXPECT_EQ(joint.expectedError, expected.expectedError);
  EXPECT_EQ(joint.known, expected.known);
}

TEST(LearnedReading, OfAMirrorImageIsTheMirrorImage) {
  const ReadingWeights weights = weightsFor();
  const SurfaceSamples surface = sampleSurface(lopsidedBody(), weights.sampleCount());
  const std::vector<KnownJoint> known = {{1, {0.9, 0.7, 0.3}}, {4, {0.1, 1.2, 0}}};
  std::vector<KnownJoint> mirroredKnown;
  for (const KnownJoint& joint : known) {
    mirroredKnown.push_back({weights.mirrorRole[joint.role], joint.position.cwiseProduct(kMirror)});
  }
  const LearnedReading reading = readSamples(surface, weights, known);
  const LearnedReading mirror = readSamples(mirrored(surface), weights, mirroredKnown);
  EXPECT_EQ(reading.planProbabilities, mirror.planProbabilities);
  for (std::size_t role = 0; role < weights.roles.size(); ++role) {
    expectSameJoint(mirror.joints[weights.mirrorRole[role]], reading.joints[role], kMirror);
  }
  for (std::size_t i = 0; i < reading.samples.size(); ++i) {
    const LearnedSample &sample = reading.samples[i], &other = mirror.samples[i];
    EXPECT_EQ(other.part, weights.mirrorPart[sample.part]);
    EXPECT_NEAR(other.partConfidence, sample.partConfidence, 1e-12);  // summed in another order
    EXPECT_EQ(other.boneStart, sample.boneStart.cwiseProduct(kMirror).eval());
    EXPECT_EQ(other.boneEnd, sample.boneEnd.cwiseProduct(kMirror).eval());
  }
  for (const int hand : {0, 1}) {
    EXPECT_EQ(reading.fingers[hand].count, mirror.fingers[1 - hand].count);
    EXPECT_EQ(reading.fingers[hand].confidence, mirror.fingers[1 - hand].confidence);
  }
}

// One without mirror images, from what the network says of both.
TEST(LearnedReading, IsTheMeanOfBothSidesCalibrated) {
  const ReadingWeights weights = weightsFor(2);
  const SurfaceSamples surface = sampleSurface(lopsidedBody(), weights.sampleCount());
  const LearnedReading reading = readSamples(surface, weights);
  const ReadingOutput direct = evaluate(weights.reading, sampleFeatures(surface), {});
  const ReadingOutput mirror = evaluate(weights.reading, sampleFeatures(mirrored(surface)), {});
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += std::exp((direct.plan[k] + mirror.plan[k]) / 2 / 1.5);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(reading.planProbabilities[k], std::exp((direct.plan[k] + mirror.plan[k]) / 2 / 1.5) / sum, 1e-6);
  }
  EXPECT_EQ(reading.planConfidence, reading.planProbabilities[reading.plan]);
  EXPECT_EQ(reading.sure, reading.planConfidence >= 0.4);
  const float *left = direct.positions.row(1), *right = mirror.positions.row(2);  // fore_end.L and .R
  const Vec3 position(0.5 * (left[0] - right[0]), 0.5 * (left[1] + right[1]), 0.5 * (left[2] + right[2]));
  EXPECT_NEAR((reading.joints[1].position - surface.toMesh(position)).norm(), 0, 1e-6);
  const double expectedError = 1.25 * surface.scale * std::exp((direct.logError[1] + mirror.logError[2]) / 2);
  EXPECT_NEAR(reading.joints[1].expectedError / expectedError, 1, 1e-6);
  const double has = 1 / (1 + std::exp(-(direct.has[1] + mirror.has[2]) / 2));
  EXPECT_NEAR(reading.joints[1].confidence, has, 1e-6);
  EXPECT_EQ(reading.joints[1].present, has > 0.5);
}

TEST(LearnedReading, HasTheMeshesSize) {
  const ReadingWeights weights = weightsFor();
  const TriMesh mesh = lopsidedBody();
  TriMesh large = mesh;
  for (Vec3f& p : large.positions) p = 4 * p;
  const LearnedReading one = readBody(mesh, weights), other = readBody(large, weights);
  for (std::size_t role = 0; role < one.joints.size(); ++role) {
    EXPECT_NEAR((other.joints[role].position - 4 * one.joints[role].position).norm(), 0, 1e-6);
    EXPECT_NEAR(other.joints[role].expectedError, 4 * one.joints[role].expectedError, 1e-6);
  }
}

TEST(LearnedReading, KeepsKnownJoints) {
  const ReadingWeights weights = weightsFor();
  const std::vector<KnownJoint> known = {{2, {-0.75, 0.25, 0}}};
  const LearnedReading reading = readBody(lopsidedBody(), weights, known), free = readBody(lopsidedBody(), weights);
  EXPECT_EQ(reading.joints[2].position, known[0].position);
  EXPECT_EQ(reading.joints[2].expectedError, 0);
  EXPECT_TRUE(reading.joints[2].present && reading.joints[2].known);
  EXPECT_NE(reading.joints[1].position, free.joints[1].position);
  const auto read = [&](const std::vector<KnownJoint>& joints) { readBody(lopsidedBody(), weights, joints); };
  EXPECT_THROW(read({{2, {0, 0, 0}}, {2, {1, 0, 0}}}), Error);
  EXPECT_THROW(read({{5, {0, 0, 0}}}), Error);
  EXPECT_THROW(read({{0, {std::nan(""), 0, 0}}}), Error);
}

TEST(LearnedReading, IsTheSameForAnyNumberOfThreads) {
  const ReadingWeights weights = weightsFor();
  setThreadCount(1);
  const LearnedReading one = readBody(lopsidedBody(), weights);
  setThreadCount(4);
  const LearnedReading four = readBody(lopsidedBody(), weights);
  setThreadCount(0);
  EXPECT_EQ(one.planProbabilities, four.planProbabilities);
  for (std::size_t role = 0; role < one.joints.size(); ++role) {
    expectSameJoint(four.joints[role], one.joints[role], Vec3(1, 1, 1));
  }
}

TEST(Stance, RotationsAreThoseOfTheCube) {
  const std::array<Mat3, kStances> rotations = stanceRotations();
  for (std::size_t i = 0; i < kStances; ++i) {
    EXPECT_NEAR(rotations[i].determinant(), 1, 1e-12);
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(rotations[i], rotations[k]);
  }
  const auto rowOf = [&](std::size_t i, int row) { return Vec3(rotations[i].row(row).transpose()); };
  EXPECT_EQ(rowOf(0, 1), Vec3(1, 0, 0));
  EXPECT_EQ(rowOf(0, 2), Vec3(0, 1, 0));
  EXPECT_EQ(rowOf(1, 2), Vec3(0, -1, 0));
  EXPECT_EQ(rotations[10], Mat3(Mat3::Identity()));
}

TEST(Stance, OfATurnedBodyIsTurnedBack) {
  const ReadingWeights weights = weightsFor();
  const SurfaceSamples surface = sampleSurface(lopsidedBody(), weights.sampleCount());
  const LearnedStance stance = stanceOf(surface, weights);
  double sum = 0;
  for (const double probability : stance.probabilities) sum += probability;
  EXPECT_NEAR(sum, 1, 1e-12);
  for (const Mat3& turn : stanceRotations()) {
    const LearnedStance turned = stanceOf(transformed(surface, turn), weights);
    EXPECT_EQ(turned.toBody * turn, stance.toBody);
    EXPECT_NEAR(turned.confidence, stance.confidence, 1e-6);
  }
}

}  // namespace
}  // namespace limber
