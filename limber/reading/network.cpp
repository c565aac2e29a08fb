#include "limber/reading/network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "limber/core/error.h"
#include "limber/reading/surface_samples.h"

namespace limber {

namespace {

float squaredDistance(const float* a, const float* b) {
  const float x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return x * x + y * y + z * z;
}

// What is known of samples and anchors before heads look at it.
struct TrunkOutput {
  FloatMatrix embedded;  // a row for each sample
  FloatMatrix anchors;
  FloatMatrix whole;  // one row
};

// Indices of the `count` samples nearest to an anchor; of equally near ones the lowest.
std::vector<std::size_t> nearestSamples(const FloatMatrix& features, std::size_t anchor, std::size_t count) {
  std::vector<std::pair<float, std::size_t>> distances(features.rows);
  for (std::size_t i = 0; i < features.rows; ++i) {
    distances[i] = {squaredDistance(features.row(i), features.row(anchor)), i};
  }
  std::partial_sort(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(count), distances.end());
  std::vector<std::size_t> nearest(count);
  for (std::size_t k = 0; k < count; ++k) nearest[k] = distances[k].second;
  return nearest;
}

// For each anchor the largest, number by number, of what samples near it say of themselves and of where they are.
FloatMatrix gatherAtAnchors(const NetworkTrunk& trunk, const FloatMatrix& features, const FloatMatrix& embedded) {
  const FloatMatrix said = apply(trunk.gatherFeature, rectified(embedded));
  FloatMatrix result(trunk.sizes.anchors, said.columns);
  FloatMatrix offsets(trunk.sizes.near, 4);  // displacement from the anchor, and its length
  for (std::size_t anchor = 0; anchor < trunk.sizes.anchors; ++anchor) {
    const std::vector<std::size_t> nearest = nearestSamples(features, anchor, trunk.sizes.near);
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        offsets.row(k)[axis] = features.row(nearest[k])[axis] - features.row(anchor)[axis];
      }
      offsets.row(k)[3] = std::sqrt(squaredDistance(features.row(nearest[k]), features.row(anchor)));
    }
    const FloatMatrix placed = apply(trunk.gatherOffset, offsets);
    float* largest = result.row(anchor);  // zeros, below which nothing rectified is
    for (std::size_t k = 0; k < nearest.size(); ++k) {
      const float* feature = said.row(nearest[k]);
      for (std::size_t c = 0; c < result.columns; ++c) {
        const float value = feature[c] + placed.row(k)[c];
        largest[c] = value > largest[c] ? value : largest[c];
      }
    }
  }
  return result;
}

// Scaled dot-product attention (Vaswani et al. 2017), head by head.
FloatMatrix attend(const FloatMatrix& queryKeyValue, std::size_t heads) {
  const std::size_t tokens = queryKeyValue.rows, width = queryKeyValue.columns / 3, headWidth = width / heads;
  const float scale = 1.0f / std::sqrt(static_cast<float>(headWidth));
  FloatMatrix result(tokens, width), keys(headWidth, tokens), weights(tokens, tokens);
  for (std::size_t head = 0; head < heads; ++head) {
    const float* query = queryKeyValue.values.data() + head * headWidth;
    const float* key = query + width;
    const float* value = key + width;
    for (std::size_t t = 0; t < tokens; ++t) {
      for (std::size_t c = 0; c < headWidth; ++c) keys.row(c)[t] = key[t * queryKeyValue.columns + c];
    }
    multiply({query, queryKeyValue.columns}, tokens, headWidth, {keys.values.data(), tokens}, tokens, nullptr,
             weights.values.data(), tokens);
    for (float& weight : weights.values) weight = weight * scale;
    for (std::size_t t = 0; t < tokens; ++t) softmax({weights.row(t), tokens});
    multiply({weights.values.data(), tokens}, tokens, tokens, {value, queryKeyValue.columns}, headWidth, nullptr,
             result.values.data() + head * headWidth, width);
  }
  return result;
}

void applyLayer(const AttentionLayer& layer, std::size_t heads, FloatMatrix& tokens) {
  const FloatMatrix queryKeyValue = apply(layer.queryKeyValue, apply(layer.attentionNorm, tokens));
  add(apply(layer.attended, attend(queryKeyValue, heads)), tokens);
  add(apply(layer.contract, rectified(apply(layer.expand, apply(layer.innerNorm, tokens)))), tokens);
}

FloatMatrix rowsOf(const FloatMatrix& matrix, std::size_t first, std::size_t count) {
  FloatMatrix result(count, matrix.columns);
  std::copy_n(matrix.row(first), result.values.size(), result.values.begin());
  return result;
}

void append(const FloatMatrix& rows, FloatMatrix& matrix) {
  matrix.values.insert(matrix.values.end(), rows.values.begin(), rows.values.end());
  matrix.rows += rows.rows;
}

TrunkOutput evaluateTrunk(const NetworkTrunk& trunk, const FloatMatrix& features, const FloatMatrix& furtherTokens) {
  const NetworkSizes& sizes = trunk.sizes;
  if (features.rows != sizes.samples || features.columns != kSampleFeatures) {
    throw Error(ErrorCode::kBadArgument, "the network reads another number of samples");
  }
  TrunkOutput result;
  result.embedded = apply(trunk.embedSecond, rectified(apply(trunk.embedFirst, features)));
  FloatMatrix anchors = rowsOf(result.embedded, 0, sizes.anchors);
  add(apply(trunk.gathered, gatherAtAnchors(trunk, features, result.embedded)), anchors);

  FloatMatrix tokens = trunk.globalTokens;
  append(anchors, tokens);
  append(furtherTokens, tokens);
  for (const AttentionLayer& layer : trunk.layers) applyLayer(layer, sizes.heads, tokens);
  tokens = apply(trunk.norm, tokens);

  FloatMatrix globals(1, sizes.globals * sizes.width);
  std::copy_n(tokens.values.begin(), globals.values.size(), globals.values.begin());
  result.whole = rectified(apply(trunk.whole, globals));
  result.anchors = rowsOf(tokens, sizes.globals, sizes.anchors);
  return result;
}

FloatMatrix pinTokens(const ReadingNetwork& network, std::span<const RolePin> pins) {
  FloatMatrix positions(pins.size(), 3);
  for (std::size_t i = 0; i < pins.size(); ++i) {
    if (pins[i].role >= network.roleTokens.rows) throw Error(ErrorCode::kBadArgument, "a pin's role is out of range");
    std::copy_n(pins[i].position.data(), 3, positions.row(i));
  }
  FloatMatrix tokens = apply(network.pinPosition, positions);
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const float* role = network.roleTokens.row(pins[i].role);
    for (std::size_t c = 0; c < tokens.columns; ++c) {
      tokens.row(i)[c] = role[c] + tokens.row(i)[c] + network.pinToken[c];
    }
  }
  return tokens;
}

// Where each role is: the mean of what anchors say, weighted by their votes.
FloatMatrix votedPositions(const ReadingNetwork& network, const FloatMatrix& features, const FloatMatrix& anchors) {
  const FloatMatrix votes = apply(network.vote, anchors), offsets = apply(network.voteOffset, anchors);
  FloatMatrix positions(votes.columns, 3);
  std::vector<float> weights(anchors.rows);
  for (std::size_t role = 0; role < positions.rows; ++role) {
    for (std::size_t a = 0; a < anchors.rows; ++a) weights[a] = votes.row(a)[role];
    softmax(weights);
    for (std::size_t a = 0; a < anchors.rows; ++a) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float said = features.row(a)[axis] + offsets.row(a)[3 * role + axis];
        positions.row(role)[axis] = positions.row(role)[axis] + weights[a] * said;
      }
    }
  }
  return positions;
}

std::size_t nearestAnchor(const FloatMatrix& features, std::size_t sample, std::size_t anchors) {
  std::size_t nearest = 0;
  float least = std::numeric_limits<float>::infinity();
  for (std::size_t a = 0; a < anchors; ++a) {
    const float distance = squaredDistance(features.row(sample), features.row(a));
    if (distance < least) {
      least = distance;
      nearest = a;
    }
  }
  return nearest;
}

// A row for each sample: its own embedding beside what its nearest anchor came to know.
FloatMatrix besideAnchors(const FloatMatrix& features, const TrunkOutput& trunk) {
  const std::size_t width = trunk.embedded.columns;
  FloatMatrix result(features.rows, 2 * width);
  for (std::size_t i = 0; i < features.rows; ++i) {
    const float* anchor = trunk.anchors.row(nearestAnchor(features, i, trunk.anchors.rows));
    for (std::size_t c = 0; c < width; ++c) {
      const float own = trunk.embedded.row(i)[c];
      result.row(i)[c] = own > 0 ? own : 0;
      result.row(i)[width + c] = anchor[c];
    }
  }
  return result;
}

}  // namespace

ReadingOutput evaluate(const ReadingNetwork& network, const FloatMatrix& features, std::span<const RolePin> pins) {
  const TrunkOutput trunk = evaluateTrunk(network.trunk, features, pinTokens(network, pins));
  ReadingOutput result;
  result.positions = votedPositions(network, features, trunk.anchors);
  result.has = apply(network.has, trunk.whole).values;
  result.logError = apply(network.logError, trunk.whole).values;
  for (float& value : result.logError) value = std::clamp(value, kMinLogError, kMaxLogError);
  result.plan = apply(network.plan, trunk.whole).values;
  result.fingers = apply(network.fingers, trunk.whole);
  result.fingers.rows = kHands;
  result.fingers.columns = kFingerCounts;
  const FloatMatrix inner = rectified(apply(network.sampleInner, besideAnchors(features, trunk)));
  result.parts = apply(network.samplePart, inner);
  result.bones = apply(network.sampleBone, inner);
  return result;
}

float evaluate(const StanceNetwork& network, const FloatMatrix& features) {
  const FloatMatrix noPins(0, network.trunk.sizes.width);
  return apply(network.score, evaluateTrunk(network.trunk, features, noPins).whole).values.front();
}

}  // namespace limber
