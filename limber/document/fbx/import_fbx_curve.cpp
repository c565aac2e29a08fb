// What the flags of keys mean is in the FBX SDK's documentation of FbxAnimCurveDef.
#include "limber/document/fbx/import_fbx_curve.h"

#include <algorithm>
#include <cmath>

#include "limber/core/file/bits.h"
#include "limber/document/fbx/records/fbx_values.h"

namespace limber {

namespace {

enum KeyFlags : std::int64_t {
  kConstant = 0x2,
  kLinearFlag = 0x4,
  kCubicFlag = 0x8,
  kConstantNext = 0x100,  // of constant keys
  kAuto = 0x100,          // of cubic ones, as all below
  kTcb = 0x200,
  kUser = 0x400,
  kClamp = 0x1000,
  kClampProgressively = 0x4000,
  kWeightedRight = 0x1000000,
  kWeightedNextLeft = 0x2000000,
};

constexpr std::size_t kDataPerKey = 4;      // slope, next slope, two weights in one word, two velocities in one word
constexpr double kWeightUnit = 1.0 / 9999;  // weights are 16 bit integers

double secondsBetween(const FbxKey& a, const FbxKey& b) {
  return (static_cast<double>(b.ticks) - static_cast<double>(a.ticks)) / static_cast<double>(kFbxTicksPerSecond);
}

double secant(const FbxKey& a, const FbxKey& b) {
  return (b.value - a.value) / secondsBetween(a, b);
}

// Runs of keys share their flags and data.
struct KeyRuns {
  std::vector<std::int64_t> flags, counts;
  std::vector<double> numbers;  // kDataPerKey each
};

KeyRuns keyRuns(const FbxNode& node) {
  KeyRuns runs{fbxIntegers(node, "KeyAttrFlags"), fbxIntegers(node, "KeyAttrRefCount"),
               fbxNumbers(node, "KeyAttrDataFloat")};
  // Text files since 7.2 have the bits of these floats as integers, older ones and binary files the floats themselves:
  // whole numbers then, but smaller ones than the bits of any float but zero and what is next to it.
  constexpr std::int64_t kMinBits = 1 << 23;
  const FbxNode* data = node.find("KeyAttrDataFloat");
  const auto* bits = data && !data->values.empty() ? std::get_if<std::vector<std::int64_t>>(&data->values[0]) : nullptr;
  const bool areBits = bits && std::any_of(bits->begin(), bits->end(), [](std::int64_t number) {
                         return number >= kMinBits || number <= -kMinBits;
                       });
  for (std::size_t i = 0; areBits && i < bits->size(); ++i) {
    runs.numbers[i] = bitCast<float>(static_cast<std::uint32_t>((*bits)[i]));
  }
  return runs;
}

// Does it go on beyond its keys other than by standing still? The letter is a number in binary files.
bool isExtrapolated(const FbxNode& node) {
  constexpr std::string_view kModes = "AKMR";  // repeats on top of itself, at its slope, mirrored, repeats
  for (const char* end : {"Pre-Extrapolation", "Post-Extrapolation"}) {
    const FbxNode* beyond = node.find(end);
    const FbxNode* type = beyond ? beyond->find("Type") : nullptr;
    if (!type) continue;
    const std::string_view text = fbxText(*type, 0).value_or("");
    const std::int64_t letter = text.empty() ? fbxInteger(*type, 0).value_or(0) : text[0];
    if (std::any_of(kModes.begin(), kModes.end(), [&](char mode) { return mode == letter; })) return true;
  }
  return false;
}

void setShape(FbxKey& key, std::int64_t flags, const KeyRuns& runs, std::size_t run) {
  using Shape = FbxKey::Shape;
  if (flags & kConstant) {
    key.shape = flags & kConstantNext ? Shape::kStepToNext : Shape::kStep;
  } else {
    key.shape = flags & kCubicFlag ? Shape::kCubic : Shape::kLinear;
  }
  if (key.shape != Shape::kCubic || kDataPerKey * run + 1 >= runs.numbers.size()) return;
  key.slope = runs.numbers[kDataPerKey * run];
  key.nextSlope = runs.numbers[kDataPerKey * run + 1];
  if (kDataPerKey * run + 2 >= runs.numbers.size()) return;
  const auto bits = bitCast<std::uint32_t>(static_cast<float>(runs.numbers[kDataPerKey * run + 2]));
  const auto weightOf = [](std::uint32_t word) {
    return std::clamp(kWeightUnit * static_cast<std::int16_t>(word & 0xffff), 0.0, 1.0);
  };
  if (flags & kWeightedRight) key.weight = weightOf(bits);
  if (flags & kWeightedNextLeft) key.nextWeight = weightOf(bits >> 16);
}

bool hasAutomaticSlope(std::int64_t flags) {
  return (flags & kCubicFlag) && !(flags & kConstant) && (flags & (kAuto | kTcb)) && !(flags & kUser);
}

// The slope through a key that has none of its own: that of its neighbours. Clamped keys do not overshoot: flat at
// extremes, and elsewhere below three times what leads to either neighbour (Fritsch and Carlson 1980).
double automaticSlope(const std::vector<FbxKey>& keys, std::size_t k, std::int64_t flags) {
  if (k == 0 || k + 1 == keys.size()) return 0;
  const double before = secant(keys[k - 1], keys[k]), after = secant(keys[k], keys[k + 1]);
  const double slope = secant(keys[k - 1], keys[k + 1]);
  if (flags & kTcb) return slope;
  if ((flags & kClamp) && (before == 0 || after == 0)) return 0;
  if (!(flags & kClampProgressively)) return slope;
  if (before * after <= 0) return 0;
  const double most = 3 * std::min(std::abs(before), std::abs(after));
  return std::clamp(slope, -most, most);
}

void setAutomaticSlopes(std::vector<FbxKey>& keys, const std::vector<std::int64_t>& flags) {
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (!hasAutomaticSlope(flags[k])) continue;
    const double slope = automaticSlope(keys, k, flags[k]);
    keys[k].slope = slope;
    if (k > 0) keys[k - 1].nextSlope = slope;
  }
}

// The parameter on [0, 1] where a Bezier curve of inner ordinates a and 1 - b reaches x.
double bezierParameter(double x, double a, double b) {
  double low = 0, high = 1;
  for (int i = 0; i < 52; ++i) {  // bits of a double
    const double s = 0.5 * (low + high), r = 1 - s;
    (3 * r * r * s * a + 3 * r * s * s * (1 - b) + s * s * s < x ? low : high) = s;
  }
  return 0.5 * (low + high);
}

double cubicBetween(const FbxKey& a, const FbxKey& b, double x) {
  constexpr double kThird = 1.0 / 3;
  const double span = secondsBetween(a, b);
  const bool isWeighted = a.weight != kThird || a.nextWeight != kThird;
  const double s = isWeighted ? bezierParameter(x, a.weight, a.nextWeight) : x, r = 1 - s;
  const double first = a.value + a.weight * span * a.slope, second = b.value - a.nextWeight * span * a.nextSlope;
  return r * r * r * a.value + 3 * r * r * s * first + 3 * r * s * s * second + s * s * s * b.value;
}

}  // namespace

std::optional<FbxCurve> FbxCurve::read(const FbxNode& node, Warnings& warnings) {
  const std::vector<std::int64_t> times = fbxIntegers(node, "KeyTime");
  const std::vector<double> values = fbxNumbers(node, "KeyValueFloat");
  const KeyRuns runs = keyRuns(node);
  std::vector<FbxKey> keys;
  std::vector<std::int64_t> flags;  // #keys
  std::size_t run = 0, inRun = 0, left = times.size() - std::min(times.size(), values.size());
  for (std::size_t k = 0; k < std::min(times.size(), values.size()); ++k) {
    while (run < runs.counts.size() && inRun >= static_cast<std::size_t>(std::max<std::int64_t>(runs.counts[run], 0))) {
      ++run;
      inRun = 0;
    }
    ++inRun;
    if (!std::isfinite(static_cast<float>(values[k])) || !isFbxTime(times[k])) {
      ++left;
      continue;
    }
    FbxKey key;
    key.ticks = times[k];
    key.value = values[k];
    const std::int64_t keyFlags = run < runs.flags.size() ? runs.flags[run] : std::int64_t{kLinearFlag};
    setShape(key, keyFlags, runs, run);
    if (!std::isfinite(key.slope) || !std::isfinite(key.nextSlope)) key.slope = key.nextSlope = 0;
    while (!keys.empty() && keys.back().ticks >= key.ticks) {
      keys.pop_back();
      flags.pop_back();
      ++left;
    }
    keys.push_back(key);
    flags.push_back(keyFlags);
  }
  warnings.add("invalid-keys", "animation keys that are not finite or not in order are left out", {}, left);
  if (keys.empty()) return std::nullopt;
  if (keys.size() > 1 && isExtrapolated(node)) {
    warnings.add("extrapolated-curves", "curves that go on beyond their keys (cycles, slopes) stand still there");
  }
  setAutomaticSlopes(keys, flags);
  return FbxCurve(std::move(keys));
}

bool FbxCurve::isStill() const {
  return std::all_of(keys_.begin(), keys_.end(), [&](const FbxKey& key) {
    const bool isStraight = key.shape != FbxKey::Shape::kCubic || (key.slope == 0 && key.nextSlope == 0);
    return key.value == keys_.front().value && (isStraight || keys_.size() == 1);
  });
}

double FbxCurve::at(std::int64_t ticks, bool fromLeft) const {
  using Shape = FbxKey::Shape;
  const auto next = fromLeft ? std::lower_bound(keys_.begin(), keys_.end(), ticks,
                                                [](const FbxKey& key, std::int64_t t) { return key.ticks < t; })
                             : std::upper_bound(keys_.begin(), keys_.end(), ticks,
                                                [](std::int64_t t, const FbxKey& key) { return t < key.ticks; });
  if (next == keys_.begin()) return keys_.front().value;
  if (next == keys_.end()) return keys_.back().value;
  const FbxKey &a = *std::prev(next), &b = *next;
  if (ticks == b.ticks && a.shape != Shape::kStep) return b.value;
  const double x = (static_cast<double>(ticks - a.ticks)) / static_cast<double>(b.ticks - a.ticks);
  switch (a.shape) {
    case Shape::kStep:
      return a.value;
    case Shape::kStepToNext:
      return b.value;
    case Shape::kLinear:
      return a.value + x * (b.value - a.value);
    case Shape::kCubic:
      return cubicBetween(a, b, x);
  }
  return a.value;
}

}  // namespace limber
