#include "limber/document/usd/usd_motion.h"

#include <algorithm>
#include <cmath>

#include "limber/core/sort_unique.h"
#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr int kDecimals = 6;  // of rotations and weights

// Moments at which something over time is sampled: its keys, and between them where it bends; a step just before its
// key.
void addMoments(const std::vector<float>& times, Interpolation interpolation, std::vector<double>& moments) {
  constexpr double kRate = 60, kBeforeStep = 1e-4;  // a second, seconds
  for (std::size_t k = 0; k < times.size(); ++k) {
    moments.push_back(times[k]);
    if (k == 0) continue;
    const double from = times[k - 1], to = times[k];
    if (interpolation == Interpolation::kStep && to - kBeforeStep > from) moments.push_back(to - kBeforeStep);
    if (interpolation != Interpolation::kCubic) continue;
    for (double t = from + 1 / kRate; t < to - 0.5 / kRate; t += 1 / kRate) moments.push_back(t);
  }
}

// Empty where all tracks stand still.
template <typename Value>
std::vector<double> momentsOf(const std::vector<Track<Value>>& tracks) {
  std::vector<double> moments;
  for (const Track<Value>& track : tracks) {
    if (track.times.size() > 1) addMoments(track.times, track.interpolation, moments);
  }
  sortUnique(moments);
  return moments;
}

// A shape's weight at each of the moments.
std::vector<float> weightsAt(const Track<float>& track, const std::vector<double>& moments) {
  Track<Vec3f> widened{0, track.interpolation, track.times, {}};  // of the type that sampleTrack knows
  for (const float value : track.values) widened.values.emplace_back(value, 0, 0);
  std::vector<float> weights;
  for (const double moment : moments) weights.push_back(static_cast<float>(sampleTrack(widened, moment).x()));
  return weights;
}

// Is a value what a reader makes of its neighbours, to within `error` in each part?
bool isBetween(float value, float from, float to, float part, float error) {
  return std::abs(from + (to - from) * part - value) <= error;
}
bool isBetween(const Vec3f& value, const Vec3f& from, const Vec3f& to, float part, float error) {
  return ((from + (to - from) * part - value).array().abs() <= error).all();
}
bool isBetween(const Eigen::Quaternionf& value, const Eigen::Quaternionf& from, const Eigen::Quaternionf& to,
               float part, float error) {
  constexpr float kCosine = 0.99875f;  // of 0.05: up to there a normalised sum is within a millionth of the arc
  const float cosine = from.dot(to);
  if (std::abs(cosine) < kCosine) return false;
  const Vec4f sum = (1 - part) * from.coeffs() + (cosine < 0 ? -part : part) * to.coeffs();
  const Vec4f between = sum.normalized(), turned = -between;
  return ((between - value.coeffs()).array().abs() <= error).all() ||
         ((turned - value.coeffs()).array().abs() <= error).all();
}

// The moments to be written: all that their neighbours do not give by interpolation. At most kLongestRun in a row are
// left out, so that cost stays linear.
template <typename Value>
std::vector<std::size_t> neededMoments(const std::vector<double>& moments,
                                       const std::vector<std::vector<Value>>& values, float error) {
  constexpr std::size_t kLongestRun = 64;
  const auto givesAllBetween = [&](std::size_t from, std::size_t to) {
    for (std::size_t m = from + 1; m < to; ++m) {
      const auto part = static_cast<float>((moments[m] - moments[from]) / (moments[to] - moments[from]));
      for (std::size_t i = 0; i < values[m].size(); ++i) {
        if (!isBetween(values[m][i], values[from][i], values[to][i], part, error)) return false;
      }
    }
    return true;
  };
  std::vector<std::size_t> needed = {0};
  for (std::size_t m = 1; m < moments.size(); ++m) {
    const bool isLast = m + 1 == moments.size();
    if (isLast || m + 1 - needed.back() > kLongestRun || !givesAllBetween(needed.back(), m + 1)) needed.push_back(m);
  }
  return needed;
}

// As a reader of half3 has them.
Vec3f halves(const Vec3& values) {
  return values.cast<float>().unaryExpr([](float value) { return static_cast<float>(Eigen::half(value)); });
}

// One value for each of the moments, of which there is one at least; a single one where all are the same. That is a
// sample too where the model has a clip: three.js passes over what has none when it plays one.
template <typename Value>
void addOverTime(UsdProperty& property, const std::vector<double>& moments,
                 const std::vector<std::vector<Value>>& values, bool hasClip, double timeCodesPerSecond) {
  float error = 0.5f;  // as rounding of text
  for (int digit = 0; digit < *property.decimals; ++digit) error /= 10;
  constexpr double kSteps = 1e5;  // of a time code: less than a microsecond
  const bool isStationary = std::all_of(values.begin(), values.end(), [&](const std::vector<Value>& now) {
    return std::equal(now.begin(), now.end(), values[0].begin(),
                      [error](const Value& a, const Value& b) { return isBetween(a, b, b, 0, error); });
  });
  if (isStationary) {
    if (hasClip) {
      property.samples.emplace_back(0, values[0]);
    } else {
      property.value = values[0];
    }
    return;
  }
  for (const std::size_t m : neededMoments(moments, values, error)) {
    const double code = std::round(moments[m] * timeCodesPerSecond * kSteps) / kSteps;
    if (!property.samples.empty() && !(code > property.samples.back().first)) continue;
    property.samples.emplace_back(code, values[m]);
  }
}

template <typename Act>
void forEachShape(const UsdModel& model, const Act& act) {
  for (const UsdMesh& mesh : model.meshes) {
    for (const UsdShape& shape : mesh.shapes) act(shape);
  }
}

}  // namespace

UsdMotion::UsdMotion(const UsdModel& model) : model_(model) {
  if (!model.clip) return;
  const double rate = frameRateOf(*model.clip);
  if (rate >= 1 && rate <= 240 && std::abs(rate - std::round(rate)) < 1e-2) timeCodesPerSecond_ = std::round(rate);
}

bool UsdMotion::isNeeded() const {
  return !model_.joints.empty() || std::any_of(model_.meshes.begin(), model_.meshes.end(),
                                               [](const UsdMesh& mesh) { return !mesh.shapes.empty(); });
}

double UsdMotion::duration() const {
  double last = model_.clip ? model_.clip->duration() : 0;
  forEachShape(model_, [&](const UsdShape& shape) { last = std::max<double>(last, shape.weight.times.back()); });
  return last;
}

UsdPrim UsdMotion::prim() const {
  UsdPrim prim{"SkelAnimation", "Motion", {}, {}, {}};
  if (!model_.joints.empty()) addJoints(prim);
  addShapes(prim);
  return prim;
}

Pose UsdMotion::poseAt(double seconds) const {
  if (!model_.clip) return model_.stance;
  Pose pose = restPose(model_.skeleton);
  sampleClip(*model_.clip, seconds, pose);
  return pose;
}

void UsdMotion::addJoints(UsdPrim& prim) const {
  static const Clip kNone;
  const Clip& clip = model_.clip ? *model_.clip : kNone;
  prim.addUniform("token[]", "joints", model_.joints);
  const auto add = [&](const char* type, const char* name, int decimals, std::vector<double> moments,
                       const auto& part) {
    if (moments.empty()) moments = {0};
    std::vector<std::vector<std::decay_t<decltype(part(Transform()))>>> values;
    for (const double moment : moments) {
      auto& now = values.emplace_back();
      for (const Transform& local : poseAt(moment).locals) now.push_back(part(local));
    }
    UsdProperty& property = prim.add(type, name);
    property.decimals = decimals;
    addOverTime(property, moments, values, duration() > 0, timeCodesPerSecond_);
  };
  add("float3[]", "translations", model_.moveDecimals, momentsOf(clip.translations),
      [](const Transform& t) { return Vec3f(t.translation.cast<float>()); });
  add("quatf[]", "rotations", kDecimals, momentsOf(clip.rotations),
      [](const Transform& t) { return Eigen::Quaternionf(t.rotation.cast<float>()); });
  add("half3[]", "scales", kDecimals, momentsOf(clip.scales), [](const Transform& t) { return halves(t.scale); });
}

void UsdMotion::addShapes(UsdPrim& prim) const {
  std::vector<std::string> names;
  std::vector<double> moments;
  forEachShape(model_, [&](const UsdShape& shape) {
    names.push_back(shape.label);
    if (shape.weight.times.size() > 1) addMoments(shape.weight.times, shape.weight.interpolation, moments);
  });
  if (names.empty()) return;
  sortUnique(moments);
  if (moments.empty()) moments = {0};
  std::vector<std::vector<float>> values(moments.size());
  forEachShape(model_, [&](const UsdShape& shape) {
    const std::vector<float> weights = weightsAt(shape.weight, moments);
    for (std::size_t m = 0; m < moments.size(); ++m) values[m].push_back(weights[m]);
  });
  prim.addUniform("token[]", "blendShapes", names);
  UsdProperty& weights = prim.add("float[]", "blendShapeWeights");
  weights.decimals = kDecimals;
  addOverTime(weights, moments, values, duration() > 0, timeCodesPerSecond_);
  weights.value = values[0];  // beside the samples: tinyusdz takes no shapes without
}

}  // namespace limber
