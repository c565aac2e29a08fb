#include "limber/usd/usd_motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/skeleton/motion.h"

namespace limber {

namespace {

constexpr int kMotionDigits = 6;  // of values over time: a millionth of their size

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

void sortUnique(std::vector<double>& moments) {
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
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

// A shape's weight at each of the moments; once where there are none.
std::vector<float> weightsAt(const Track<float>& track, std::vector<double> moments) {
  Track<Vec3f> widened{0, track.interpolation, track.times, {}};  // of the type that sampleTrack knows
  for (const float value : track.values) widened.values.emplace_back(value, 0, 0);
  if (moments.empty()) moments = {0};
  std::vector<float> weights;
  for (const double moment : moments) weights.push_back(static_cast<float>(sampleTrack(widened, moment).x()));
  return weights;
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

void UsdMotion::write(UsdText& text) const {
  text.open("SkelAnimation", "Motion");
  if (!model_.joints.empty()) writeJoints(text);
  writeShapes(text);
  text.close();
}

Pose UsdMotion::poseAt(double seconds) const {
  if (!model_.clip) return model_.stance;
  Pose pose = restPose(model_.skeleton);
  sampleClip(*model_.clip, seconds, pose);
  return pose;
}

void UsdMotion::writeJoints(UsdText& text) const {
  static const Clip kNone;
  const Clip& clip = model_.clip ? *model_.clip : kNone;
  text.tokens("uniform token[] joints", model_.joints);
  const auto samples = [&](std::string_view name, const std::vector<double>& moments, const auto& part) {
    const auto values = [&](std::size_t moment, std::string& out) {
      const char* between = "";
      for (const Transform& local : poseAt(moments.empty() ? 0 : moments[moment]).locals) {
        out += between;
        appendUsd(out, part(local), kMotionDigits);
        between = ",";
      }
    };
    valuesOverTime(name, moments, values, text);
  };
  samples("float3[] translations", momentsOf(clip.translations),
          [](const Transform& t) { return Vec3f(t.translation.cast<float>()); });
  samples("quatf[] rotations", momentsOf(clip.rotations),
          [](const Transform& t) { return Eigen::Quaternionf(t.rotation.cast<float>()); });
  samples("half3[] scales", momentsOf(clip.scales), [](const Transform& t) { return Vec3f(t.scale.cast<float>()); });
}

void UsdMotion::writeShapes(UsdText& text) const {
  std::vector<std::string> names;
  std::vector<double> moments;
  forEachShape(model_, [&](const UsdShape& shape) {
    names.push_back(shape.name);
    if (shape.weight.times.size() > 1) addMoments(shape.weight.times, shape.weight.interpolation, moments);
  });
  if (names.empty()) return;
  sortUnique(moments);
  std::vector<std::vector<float>> weights;  // of each shape, at each moment
  forEachShape(model_, [&](const UsdShape& shape) { weights.push_back(weightsAt(shape.weight, moments)); });
  text.tokens("uniform token[] blendShapes", names);
  valuesOverTime(
      "float[] blendShapeWeights", moments,
      [&](std::size_t moment, std::string& out) {
        const char* between = "";
        for (const std::vector<float>& ofShape : weights) {
          out += between;
          appendUsd(out, ofShape[moment], kMotionDigits);
          between = ",";
        }
      },
      text);
}

// One list of values, or one for each moment.
void UsdMotion::valuesOverTime(std::string_view name, const std::vector<double>& moments, const UsdText::Values& values,
                               UsdText& text) const {
  if (moments.empty()) return text.list(fmt::format("{} = [", name), 0, values, "]");
  text.line(fmt::format("{}.timeSamples = {{", name));
  for (std::size_t m = 0; m < moments.size(); ++m) {
    text.list(fmt::format("  {}: [", usdNumber(moments[m] * timeCodesPerSecond_)), m, values, "],");
  }
  text.line("}");
}

}  // namespace limber
