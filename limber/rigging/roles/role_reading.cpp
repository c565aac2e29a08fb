#include "limber/rigging/roles/role_reading.h"

#include <algorithm>
#include <cmath>

#include "limber/core/error.h"

namespace limber {

namespace {

// Of the predicted start of a sample's bone from the joint where that bone begins: heights.
constexpr double kNearStart = 0.06;
constexpr double kMinError = 1e-6;   // heights
constexpr double kMinSamples = 1.5;  // sum of weights, 1 for each sample whose bone begins at the joint

std::optional<Index> indexOf(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<Index>(found - names.begin()));
}

}  // namespace

RoleReading::RoleReading(const SurfaceSamples& surface, const ReadingWeights& weights, const AnatomicalFrame& frame,
                         const std::map<std::string, Vec3>& known)
    : weights_(&weights), frame_(frame), origin_(frame.axes * frame.origin) {
  std::vector<KnownJoint> joints;
  for (const auto& [role, position] : known) {
    if (const std::optional<Index> index = indexOf(weights.roles, role)) {
      joints.push_back({*index, frame.height * position + origin_});
    }
  }
  reading_ = readSamples(transformed(surface, frame.axes), weights, joints);
}

Index RoleReading::roleOf(std::string_view role) const {
  const std::optional<Index> index = indexOf(weights_->roles, role);
  if (!index) throw Error(ErrorCode::kBadData, "the networks do not know this joint of a body", std::string(role));
  return *index;
}

bool RoleReading::has(std::string_view role) const {
  const std::optional<Index> index = indexOf(weights_->roles, role);
  return index && reading_.joints[*index].present;
}

double RoleReading::confidence(std::string_view role) const {
  const std::optional<Index> index = indexOf(weights_->roles, role);
  return index ? reading_.joints[*index].confidence : 0;
}

double RoleReading::fractionOf(std::string_view part) const {
  const std::optional<Index> index = indexOf(weights_->parts, part);
  const auto count = std::count_if(reading_.samples.begin(), reading_.samples.end(),
                                   [&](const LearnedSample& sample) { return sample.part == index; });
  return static_cast<double>(count) / static_cast<double>(reading_.samples.size());
}

Vec3 RoleReading::position(const RolePosition& at) const {
  const Vec3 from = toBody(reading_.joints[roleOf(at.from)].position);
  const Vec3 to = at.isRole() ? from : toBody(reading_.joints[roleOf(at.to)].position);
  return from + at.fraction * (to - from);
}

double RoleReading::expectedError(const RolePosition& at) const {
  const double from = reading_.joints[roleOf(at.from)].expectedError, to = reading_.joints[roleOf(at.to)].expectedError;
  return (from + at.fraction * (to - from)) / frame_.height;
}

double RoleReading::meanLogError() const {
  double sum = 0, weight = 0;
  for (const LearnedJoint& joint : reading_.joints) {
    if (joint.known) continue;
    sum += joint.confidence * std::log(std::max(joint.expectedError, kMinError * frame_.height));
    weight += joint.confidence;
  }
  return weight > 0 ? sum / weight : 0;
}

std::optional<Vec3> RoleReading::boneEnd(std::string_view part, const Vec3& start) const {
  const std::optional<Index> index = indexOf(weights_->parts, part);
  Vec3 sum = Vec3::Zero();
  double weight = 0;
  for (const LearnedSample& sample : reading_.samples) {
    if (!index || sample.part != *index) continue;
    const double far = (toBody(sample.boneStart) - start).norm() / kNearStart;
    const double own = std::max(0.0, 1 - 0.25 * far * far);  // 0 from twice the distance on
    sum += own * toBody(sample.boneEnd);
    weight += own;
  }
  return weight < kMinSamples ? std::nullopt : std::optional<Vec3>(sum / weight);
}

std::string_view RoleReading::partOf(std::size_t sample) const {
  return weights_->parts[reading_.samples[sample].part];
}

double RoleReading::probability(std::string_view plan) const {
  const std::optional<Index> index = indexOf(weights_->plans, plan);
  return index ? reading_.planProbabilities[*index] : 0;
}

bool RoleReading::isKnown(std::string_view role) const {
  return reading_.joints[roleOf(role)].known;
}

void RoleReading::move(std::string_view role, const Vec3& displacement) {
  LearnedJoint& joint = reading_.joints[roleOf(role)];
  if (!joint.known) joint.position += frame_.height * displacement;
}

void RoleReading::makeSymmetric() {
  const std::vector<LearnedJoint> before = reading_.joints;
  const double plane = origin_.x();
  const auto mirrored = [&](const Vec3& position) {
    return Vec3(2 * plane - position.x(), position.y(), position.z());
  };
  for (std::size_t role = 0; role < before.size(); ++role) {
    const LearnedJoint& other = before[weights_->mirrorRole[role]];
    if (before[role].known || other.known) continue;
    LearnedJoint& joint = reading_.joints[role];
    joint.position = 0.5 * (before[role].position + mirrored(other.position));
    joint.confidence = 0.5 * (before[role].confidence + other.confidence);
    joint.present = joint.confidence > 0.5;
    joint.expectedError = 0.5 * (before[role].expectedError + other.expectedError);
  }
  const std::vector<LearnedSample> samples = reading_.samples;
  for (LearnedSample sample : samples) {
    sample.part = weights_->mirrorPart[sample.part];
    sample.boneStart = mirrored(sample.boneStart);
    sample.boneEnd = mirrored(sample.boneEnd);
    reading_.samples.push_back(sample);
  }
}

}  // namespace limber
