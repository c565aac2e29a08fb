// How near skin weights come to those that an artist made.
#pragma once

#include <vector>

#include "limber/evaluate/skin/skinned_model.h"

namespace limber {

// vertices       of the truth, each paired with one of the result (pairVertices); unpaired ones are left out of every
// mean l1             mean over vertices of the sum over joints of |w - w truth|, 0 to 2 (RigNet: Xu et al. 2020)
// precision      part of the result's influences above 1/256 that the truth has too; 1 where the result has none
// recall         part of the truth's influences above 1/256 that the result has too; 1 where the truth has none
// deformMean     the truth's skeleton in 20 random poses (seed 1; every joint turned about a random axis by 0 to 30
//                degrees), linear blend by both weights: distance of the two results in percent of the bounding box's
//                diagonal, mean over vertices and poses
// deformP95      mean over the poses of the 95th percentile of that distance
// smoothness     mean over the edges of the welded mesh of the sum over joints of |w_a - w_b|, of the result
// unweighted     vertices that no joint holds; they stay where they are in every pose
struct WeightComparison {
  Index vertices = 0;
  Index unpairedVertices = 0;
  bool orderKept = false;    // vertices are paired by their order
  Index joints = 0;          // of the truth
  Index usedJoints = 0;      // of them those that hold a vertex
  Index unpairedJoints = 0;  // joints of the result that hold a vertex and have no counterpart in the truth
  double l1 = 0;
  double precision = 1, recall = 1;
  double deformMean = 0, deformP95 = 0;
  double smoothness = 0, truthSmoothness = 0;
  Index unweighted = 0, truthUnweighted = 0;
};

// Weights of both are cut to the four strongest of each vertex, to a sum of 1, as glTF readers do. Throws Error
// kUnsupported where one of the two has no rig, kBadData where no vertex of the one lies on a vertex of the other.
WeightComparison compareWeights(const SkinnedModel& result, const SkinnedModel& truth);
WeightComparison compareWeights(const Character& result, const Character& truth);

// Which of the joints have a weight above 0 on some vertex, and how many they are.
std::vector<bool> weightedJoints(const SkinWeights& weights, Index jointCount);
Index countWeightedJoints(const SkinWeights& weights, Index jointCount);

// The four strongest influences of each vertex, strongest first, to a sum of 1; all 0 where there was none.
SkinWeights strongestFour(const SkinWeights& weights);

// Of a vertex of one and a vertex of the other: the sum over joints of |a - b|, 0 to 2. No joint occurs twice among a
// vertex's used slots.
double weightDifference(const SkinWeights& a, Index vertexOfA, const SkinWeights& b, Index vertexOfB);

}  // namespace limber
