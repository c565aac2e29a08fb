#include "limber/character/anatomy/body_reading.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr double kMaxOutOfPlane = 0.5;  // cosine between up and the lateral axis: 60 degrees off

std::vector<Vec3> finitePositions(const Skeleton& skeleton, const Pose& pose) {
  std::vector<Vec3> positions = posePositions(skeleton, pose);
  for (Index j = 0; j < positions.size(); ++j) {
    if (positions[j].allFinite() && positions[j].cwiseAbs().maxCoeff() < 1e100) continue;
    throw Error(ErrorCode::kBadData, "lies nowhere: its place is not a finite number", skeleton.joints[j].name);
  }
  return positions;
}

// The axes that lie in the plane, or the one that is nearest to it where all lie askew.
std::vector<Axes> hypothesesFor(const Vec3& lateral) {
  const double nearest = lateral.cwiseAbs().minCoeff();
  std::vector<Axes> hypotheses;
  for (const double sign : {1.0, -1.0}) {
    for (const Eigen::Index axis : {1, 2, 0}) {
      Vec3 up = sign * Vec3::Unit(axis);
      const double outOfPlane = std::abs(up.dot(lateral));
      if (outOfPlane > kMaxOutOfPlane && outOfPlane > nearest) continue;
      up = (up - up.dot(lateral) * lateral).normalized();
      for (const double left : {1.0, -1.0}) hypotheses.push_back({up, (left * lateral).cross(up)});
    }
  }
  return hypotheses;
}

// What a bone of VRM is; a joint of the spine where it is one of these.
NamedRole roleOfBone(std::string_view bone) {
  const BodyPart part = bodyPartNamed(bone).value_or(body_part::kTrunk);
  const auto role = [&]() -> JointRole {
    switch (part.kind) {
      case PartKind::kNeck:
        return JointRole::kNeck;
      case PartKind::kHead:
        return JointRole::kHead;
      case PartKind::kJaw:
        return JointRole::kJaw;
      case PartKind::kEye:
        return JointRole::kEye;
      case PartKind::kFinger:
        return static_cast<JointRole>(static_cast<int>(JointRole::kThumb) + static_cast<int>(part.pair));
      case PartKind::kArm:
        return part.segment == Segment::kBase     ? JointRole::kCollar
               : part.segment == Segment::kUpper  ? JointRole::kUpperArm
               : part.segment == Segment::kMiddle ? JointRole::kLowerArm
                                                  : JointRole::kHand;
      case PartKind::kLeg:
        return part.segment == Segment::kUpper    ? JointRole::kUpperLeg
               : part.segment == Segment::kMiddle ? JointRole::kLowerLeg
               : part.segment == Segment::kEnd    ? JointRole::kFoot
                                                  : JointRole::kToes;
      default:
        return part.segment == Segment::kBase ? JointRole::kHips : JointRole::kTrunk;
    }
  };
  return {role(), part.side, 0};
}

// #J what is certain of each joint: the bone that its file declares it to be, else what its convention calls it.
std::vector<std::optional<NamedRole>> declaredRoles(const Skeleton& skeleton,
                                                    const std::optional<ConventionMatch>& convention) {
  std::vector<std::optional<NamedRole>> roles(skeleton.joints.size());
  if (convention) roles = convention->roles;
  for (std::size_t j = 0; j < roles.size(); ++j) {
    if (!skeleton.joints[j].declaredBone.empty()) roles[j] = roleOfBone(skeleton.joints[j].declaredBone);
  }
  return roles;
}

std::vector<JointWords> wordsOf(const Skeleton& skeleton, std::span<const std::optional<NamedRole>> declared) {
  std::vector<JointWords> words = wordsOfJoints(skeleton);
  for (std::size_t j = 0; j < words.size(); ++j) {
    if (declared[j]) words[j] = wordsOfRole(*declared[j]);
  }
  return words;
}

std::vector<std::optional<NamedPartner>> partnersOf(const Skeleton& skeleton, std::span<const JointWords> words,
                                                    const std::optional<ConventionMatch>& convention) {
  std::vector<std::optional<NamedPartner>> partners = partnersByName(skeleton, words);
  if (!convention) return partners;
  for (std::size_t j = 0; j < partners.size(); ++j) {
    const std::optional<Index>& partner = convention->partners[j];
    if (!partner) continue;
    for (const Index old : {static_cast<Index>(j), *partner}) {
      if (partners[old]) partners[partners[old]->partner].reset();
      partners[old].reset();
    }
    partners[j] = NamedPartner{*partner, convention->roles[j]->side == Side::kLeft};
    partners[*partner] = NamedPartner{static_cast<Index>(j), !partners[j]->isLeft};
  }
  return partners;
}

// Positive where most bones of the side that `lateral` points to are left ones as the file declares them, negative
// where most are right ones, 0 where no pair is declared. The sides of a convention's names are evidence, no more: a
// model that was mirrored has the names of before.
int declaredLeft(const Skeleton& skeleton, const HalfBody& body, std::span<const std::optional<NamedRole>> declared) {
  int votes = 0;
  for (const HalfJoint& half : body.joints) {
    if (!half.partner) continue;
    for (const auto& [joint, sign] : {std::pair(half.joint, 1), std::pair(*half.partner, -1)}) {
      if (skeleton.joints[joint].declaredBone.empty() || !declared[joint]) continue;
      if (declared[joint]->side == Side::kCenter) continue;
      votes += declared[joint]->side == Side::kLeft ? sign : -sign;
    }
  }
  return votes;
}

}  // namespace

BodyReading::BodyReading(const Skeleton& read, const Pose& pose, bool names, bool conventions)
    : skeleton(read),
      convention(names && conventions ? findConvention(skeleton) : std::nullopt),
      declared(names ? declaredRoles(skeleton, convention)
                     : std::vector<std::optional<NamedRole>>(skeleton.joints.size())),
      words(names ? wordsOf(skeleton, declared) : std::vector<JointWords>()),
      positions(finitePositions(skeleton, pose)),
      tree(withLooseFeetJoined(skeleton, positions, Vec3::UnitY())),
      body(foldBody(tree, positions,
                    names ? partnersOf(skeleton, words, convention) : std::vector<std::optional<NamedPartner>>())),
      measures(body, words),
      hypotheses(hypothesesFor(body.lateral)) {
  const int left = body.sidesByName ? 1 : declaredLeft(skeleton, body, declared);
  std::erase_if(hypotheses, [&](const Axes& hypothesis) { return left * hypothesis.left().dot(body.lateral) < 0; });
  if (body.hasPairs) return;
  const std::vector<Axes> across = hypothesesFor(Vec3::UnitZ());
  hypotheses.insert(hypotheses.end(), across.begin(), across.end());
}

double axesScore(const BodyMeasures& measures, const Axes& hypothesis, const PartField& field,
                 const PartWeights& weights) {
  double score = kAxesByLabels * field.logSum();
  for (const ActiveFeature& feature : measures.axesFeatures(hypothesis)) {
    score += static_cast<double>(feature.value * weights.axes[feature.number]);
  }
  return score;
}

}  // namespace limber
