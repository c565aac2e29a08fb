#include "limber/rigging/weights/weight_edit.h"

#include <gtest/gtest.h>

namespace limber {
namespace {

SkinWeights oneVertex(std::vector<Influence> influences, Index slots = 4) {
  SkinWeights weights;
  weights.slots = slots;
  weights.joints.assign(slots, 0);
  weights.weights.assign(slots, 0.0f);
  for (std::size_t k = 0; k < influences.size(); ++k) {
    weights.joints[k] = influences[k].joint;
    weights.weights[k] = static_cast<float>(influences[k].weight);
  }
  return weights;
}

double sum(const SkinWeights& weights) {
  double total = 0;
  for (const float weight : weights.weights) total += weight;
  return total;
}

const std::vector<bool> kFree(8, false);

std::vector<bool> lock(std::initializer_list<Index> joints) {
  std::vector<bool> locked(kFree);
  for (const Index joint : joints) locked[joint] = true;
  return locked;
}

TEST(WeightEdit, OthersGiveInProportion) {
  SkinWeights weights = oneVertex({{1, 0.6}, {2, 0.3}, {3, 0.1}});
  WeightRow row(weights, 0, kFree);
  row.set(std::vector<Influence>{{3, 0.55}});
  EXPECT_NEAR(row.of(3), 0.55, 1e-6);
  EXPECT_NEAR(row.of(1), 0.3, 1e-6);
  EXPECT_NEAR(row.of(2), 0.15, 1e-6);
  EXPECT_NEAR(sum(weights), 1, 1e-6);
  EXPECT_EQ(weights.joints[0], Index{3}) << "strongest first";
}

TEST(WeightEdit, LockedJointsKeepEveryBit) {
  SkinWeights weights = oneVertex({{1, 0.6}, {2, 0.3}, {3, 0.1}});
  const float kept = weights.weights[1];
  const std::vector<bool> locked = lock({2});
  WeightRow row(weights, 0, locked);
  row.set(std::vector<Influence>{{4, 5.0}});
  EXPECT_EQ(static_cast<float>(row.of(2)), kept);
  EXPECT_NEAR(row.of(4), 0.7, 1e-6);
  EXPECT_EQ(row.of(1), 0);
}

TEST(WeightEdit, NothingChangesWhereNobodyCanGive) {
  SkinWeights weights = oneVertex({{1, 0.6}, {2, 0.4}});
  const SkinWeights before = weights;
  const std::vector<bool> all = lock({1, 2});
  WeightRow(weights, 0, all).set(std::vector<Influence>{{3, 0.5}});
  EXPECT_EQ(weights.weights, before.weights);
  WeightRow(weights, 0, kFree).set(std::vector<Influence>{});
  EXPECT_EQ(weights.weights, before.weights);
  SkinWeights whole = oneVertex({{1, 1.0}});
  WeightRow(whole, 0, kFree).set(std::vector<Influence>{{1, 0.4}});
  EXPECT_EQ(whole.weights[0], 1.0f) << "nobody to take it";
}

TEST(WeightEdit, WhatTheOnlyJointLosesGoesToItsHeir) {
  SkinWeights weights = oneVertex({{3, 1.0}});
  WeightRow row(weights, 0, kFree);
  row.set(std::vector<Influence>{{3, 0.25}}, Index{2});
  EXPECT_NEAR(row.of(2), 0.75, 1e-6);
  EXPECT_NEAR(row.of(3), 0.25, 1e-6);
}

TEST(WeightEdit, OnlyTheStrongestHaveRoom) {
  SkinWeights weights = oneVertex({{1, 0.6}, {2, 0.4}}, 2);
  WeightRow row(weights, 0, kFree);
  row.set(std::vector<Influence>{{3, 0.5}});
  EXPECT_EQ(row.of(2), 0);
  EXPECT_NEAR(sum(weights), 1, 1e-6);
}

TEST(WeightEdit, SmoothingSpreadsAStepAndKeepsTheSum) {
  SkinWeights weights;
  weights.slots = 2;
  constexpr Index kCount = 20;
  for (Index v = 0; v < kCount; ++v) {
    weights.joints.insert(weights.joints.end(), {v < kCount / 2 ? Index{1} : Index{2}, 0});
    weights.weights.insert(weights.weights.end(), {1.0f, 0.0f});
  }
  std::vector<SmoothAmount> amounts;
  for (Index v = 1; v + 1 < kCount; ++v) amounts.push_back({v, 1, {v - 1, v + 1}});
  smoothWeights(weights, amounts, kFree);
  double last = 0;
  for (Index v = 0; v < kCount; ++v) {
    const double second = WeightRow(weights, v, kFree).of(2);
    EXPECT_GE(second, last - 0.02);
    EXPECT_NEAR(second + WeightRow(weights, v, kFree).of(1), 1, 1e-6);
    last = second;
  }
  EXPECT_GT(WeightRow(weights, kCount / 2 - 2, kFree).of(2), 0.1);
  EXPECT_EQ(WeightRow(weights, 0, kFree).of(1), 1);
}

}  // namespace
}  // namespace limber
