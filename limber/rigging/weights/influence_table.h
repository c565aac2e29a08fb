// The strongest few influences of each vertex, kept while weights arrive one joint after the other.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "limber/skeleton/skin_weights.h"

namespace limber {

// Rows are sorted: heavier first, then the lower joint. What is kept does not depend on the order of arrival.
class InfluenceTable {
 public:
  InfluenceTable(std::size_t vertexCount, Index slots)
      : slots_(slots), joints_(vertexCount * slots, 0), weights_(vertexCount * slots, 0.0f) {}

  Index slots() const { return slots_; }
  std::size_t vertexCount() const { return slots_ == 0 ? 0 : weights_.size() / slots_; }
  std::span<const Index> jointsOf(std::size_t row) const { return {joints_.data() + row * slots_, slots_}; }
  std::span<const float> weightsOf(std::size_t row) const { return {weights_.data() + row * slots_, slots_}; }

  // Takes the row's influences away.
  void clear(std::size_t row) {
    std::fill_n(joints_.data() + row * slots_, slots_, Index{0});
    std::fill_n(weights_.data() + row * slots_, slots_, 0.0f);
  }

  // Keeps the influence if it is positive and among the strongest. Each joint is offered once for each row.
  void offer(std::size_t row, Index joint, float weight) {
    float* weights = weights_.data() + row * slots_;
    Index* joints = joints_.data() + row * slots_;
    if (!comesBefore(weight, joint, weights[slots_ - 1], joints[slots_ - 1])) return;
    Index at = slots_ - 1;
    for (; at > 0 && comesBefore(weight, joint, weights[at - 1], joints[at - 1]); --at) {
      weights[at] = weights[at - 1];
      joints[at] = joints[at - 1];
    }
    weights[at] = weight;
    joints[at] = joint;
  }

 private:
  static bool comesBefore(float weight, Index joint, float otherWeight, Index otherJoint) {
    return weight > otherWeight || (weight == otherWeight && weight > 0 && joint < otherJoint);
  }

  Index slots_;
  std::vector<Index> joints_;
  std::vector<float> weights_;
};

}  // namespace limber
