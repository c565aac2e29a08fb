// One number over time, as an FBX animation curve has it.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "limber/core/error.h"
#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

inline constexpr std::int64_t kFbxTicksPerSecond = 46186158000;

// Within nine days of 0: differences stay within 64 bits. The SDK writes times without end as the largest integers.
inline bool isFbxTime(std::int64_t ticks) {
  constexpr std::int64_t kMaxTicks = std::int64_t{1} << 55;
  return ticks >= -kMaxTicks && ticks <= kMaxTicks;
}

struct FbxKey {
  enum class Shape { kStep, kStepToNext, kLinear, kCubic };  // until the next key; kStepToNext has its value at once

  std::int64_t ticks = 0;
  double value = 0;
  Shape shape = Shape::kLinear;
  double slope = 0, nextSlope = 0;                // a second: here to the right, at the next key from the left
  double weight = 1.0 / 3, nextWeight = 1.0 / 3;  // of the handles, in lengths of the span
};

class FbxCurve {
 public:
  // Keys in ascending order, at least one, values finite.
  explicit FbxCurve(std::vector<FbxKey> keys) : keys_(std::move(keys)) {}

  // Of a node "AnimationCurve"; none where it has no usable key. Keys that are not finite, and of keys at one time all
  // but the last, are left out and counted. One that repeats or goes on beyond its keys is a warning.
  static std::optional<FbxCurve> read(const FbxNode& node, Warnings& warnings);

  const std::vector<FbxKey>& keys() const { return keys_; }

  // Before the first and after the last key the curve is constant. `fromLeft`: the limit from earlier times, which
  // differs where a step ends.
  double at(std::int64_t ticks, bool fromLeft = false) const;

  // Does it have one value at all times?
  bool isStill() const;

 private:
  std::vector<FbxKey> keys_;
};

}  // namespace limber
