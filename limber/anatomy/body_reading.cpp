#include "limber/anatomy/body_reading.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr double kMostOutOfPlane = 0.5;  // cosine between up and the lateral axis: 60 degrees off

std::vector<Vec3> finitePositions(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Vec3> positions = posePositions(skeleton, pose);
  for (Index j = 0; j < positions.size(); ++j) {
    if (positions[j].allFinite() && positions[j].cwiseAbs().maxCoeff() < 1e100) continue;
    throw Error(ErrorCode::kBadData, "lies nowhere: its place is not a finite number", skeleton.joints[j].name);
  }
  return positions;
}

std::vector<Axes> guessesFor(const Vec3& lateral) {
  std::vector<Axes> guesses;
  for (const double sign : {1.0, -1.0}) {
    for (const Eigen::Index axis : {1, 2, 0}) {
      Vec3 up = sign * Vec3::Unit(axis);
      if (std::abs(up.dot(lateral)) > kMostOutOfPlane) continue;
      up = (up - up.dot(lateral) * lateral).normalized();
      for (const double left : {1.0, -1.0}) guesses.push_back({up, (left * lateral).cross(up)});
    }
  }
  return guesses;
}

// Positive where most declared bones of the side that `lateral` points to are left ones, negative where most are right
// ones, 0 where no pair is declared.
int declaredLeft(const Skeleton& skeleton, const HalfBody& body, std::span<const JointWords> words) {
  int votes = 0;
  for (const HalfJoint& half : body.joints) {
    if (!half.partner) continue;
    for (const auto& [joint, sign] : {std::pair(half.joint, 1), std::pair(*half.partner, -1)}) {
      if (skeleton.joints[joint].declaredBone.empty() || words[joint].side == Side::kCenter) continue;
      votes += words[joint].side == Side::kLeft ? sign : -sign;
    }
  }
  return votes;
}

}  // namespace

BodyReading::BodyReading(const Skeleton& read, const Pose& pose, bool names)
    : skeleton(read),
      words(names ? wordsOfJoints(skeleton) : std::vector<JointWords>()),
      positions(finitePositions(skeleton, pose)),
      tree(withLooseFeetJoined(skeleton, positions, Vec3::UnitY())),
      body(foldBody(tree, positions,
                    names ? partnersByName(skeleton, words) : std::vector<std::optional<NamedPartner>>())),
      measures(body, words),
      guesses(guessesFor(body.lateral)) {
  const int left = body.sidesByName ? 1 : names ? declaredLeft(skeleton, body, words) : 0;
  std::erase_if(guesses, [&](const Axes& guess) { return left * guess.left().dot(body.lateral) < 0; });
  if (body.hasPairs) return;
  const std::vector<Axes> across = guessesFor(Vec3::UnitZ());
  guesses.insert(guesses.end(), across.begin(), across.end());
}

double axesScore(const BodyMeasures& measures, const Axes& guess, const PartField& field, const PartWeights& weights) {
  double score = kAxesByLabels * field.logSum();
  for (const ActiveFeature& feature : measures.axesFeatures(guess)) {
    score += static_cast<double>(feature.value * weights.axes[feature.number]);
  }
  return score;
}

}  // namespace limber
