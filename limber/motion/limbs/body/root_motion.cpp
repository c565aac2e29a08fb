#include "limber/motion/limbs/body/root_motion.h"

#include <algorithm>

#include "limber/skeleton/chain.h"

namespace limber {

Vec3 middleOf(std::span<const Index> joints, const std::vector<Vec3>& positions) {
  Vec3 sum = Vec3::Zero();
  for (const Index joint : joints) sum += positions[joint];
  return sum / static_cast<double>(joints.size());
}

RootPositioner::RootPositioner(const RetargetSetup& setup)
    : setup_(setup), movesEachJoint_(setup.sameBody || setup.rootFollows == RootFollows::kEachJoint) {
  findCarrierOfLegs();
  switch (setup.rootFollows) {
    case RootFollows::kPelvis:
      hips_ = setup.map.find(body_part::kPelvis)->target.front();
      findPelvis();
      break;
    case RootFollows::kHindquarters:
      if (!hips_) hips_ = setup.map.find(body_part::kPelvis)->target.front();
      hindquarters_ = hindquartersOf(MapSide::kTarget);
      sourceHindquarters_ = hindquartersOf(MapSide::kSource);
      findTrunk();
      break;
    case RootFollows::kEachJoint:
      findCarried();
      break;
  }
  findLoose();
}

void RootPositioner::findLoose() {
  for (const AnimalLeg& leg : setup_.animalLegs) {
    if (leg.target.carrier) addLoose({leg.target.end, *leg.target.carrier, true});
  }
  // On the same body what is loose moves as its partner does.
  const bool hasLegs = setup_.rootFollows != RootFollows::kPelvis && !setup_.animalLegs.empty();
  if (hasLegs || setup_.sameBody || !setup_.map.find(body_part::kPelvis)) return;
  const std::vector<Vec3>& rest = setup_.targetNeutral.restPositions;
  for (const LooseJoint& loose : looseJoints(*setup_.target, setup_.map, MapSide::kTarget, rest)) {
    if (setup_.rootFollows == RootFollows::kPelvis || isAttached(loose)) addLoose(loose);
  }
}

// Whether the partner of a matched joint is below the source's hips, and so has no path of its own to follow.
bool RootPositioner::isAttached(const LooseJoint& loose) const {
  const Index hips = setup_.map.find(body_part::kPelvis)->source.front();
  const auto follows = [&](const JointMatch& match) {
    return match.target.front() == loose.joint && isAncestorOrSelf(*setup_.source, hips, match.source.front());
  };
  return std::any_of(setup_.map.matches.begin(), setup_.map.matches.end(), follows);
}

void RootPositioner::addLoose(const LooseJoint& joint) {
  const NeutralPose& neutral = setup_.targetNeutral;
  const std::vector<Affine> rest = poseGlobals(*setup_.target, setup_.targetRest);
  const Quat from = (neutral.toBody * decompose(rest[joint.carrier]).rotation).conjugate();
  Loose& loose = loose_.emplace_back();
  loose.joint = joint.joint;
  loose.carrier = joint.carrier;
  loose.offset = from * (neutral.restPositions[joint.joint] - neutral.restPositions[joint.carrier]);
  if (!joint.matched) loose.turn = from * neutral.toBody * decompose(rest[joint.joint]).rotation;
}

void RootPositioner::findCarrierOfLegs() {
  const Skeleton& target = *setup_.target;
  for (const AnimalLeg& leg : setup_.animalLegs) {
    if (!hips_) hips_ = leg.target.upper;
    while (hips_ && !isAncestorOrSelf(target, *hips_, leg.target.upper)) hips_ = target.joints[*hips_].parent;
    if (!hips_) return;
  }
}

std::vector<Index> RootPositioner::hindquartersOf(MapSide side) const {
  const bool isSource = side == MapSide::kSource;
  const Skeleton& skeleton = isSource ? *setup_.source : *setup_.target;
  const std::vector<Index>* trunk = jointsOfPart(setup_.map, side, body_part::kTrunk);
  std::vector<Index> hips;
  bool carriesForelegs = false;
  for (const AnimalLeg& leg : setup_.animalLegs) {
    const Index upper = (isSource ? leg.source : leg.target).upper;
    if (!leg.fore) {
      hips.push_back(upper);
    } else if (trunk) {
      carriesForelegs = carriesForelegs || !isAncestorOrSelf(skeleton, trunk->front(), upper);
    }
  }
  if (carriesForelegs && !hips.empty()) return hips;
  return {jointsOfPart(setup_.map, side, body_part::kPelvis)->front()};
}

void RootPositioner::findCarried() {
  const auto isUnder = [](const Skeleton& skeleton, const std::vector<Index>& matched, Index joint) {
    return std::any_of(matched.begin(), matched.end(),
                       [&](Index above) { return above != joint && isAncestorOrSelf(skeleton, above, joint); });
  };
  const std::vector<Index> from = matchedJoints(setup_.map, MapSide::kSource),
                           to = matchedJoints(setup_.map, MapSide::kTarget);
  for (const JointMatch& match : setup_.map.matches) {
    const Index s = match.source.front();
    const bool isTop = !isUnder(*setup_.source, from, s) && !isUnder(*setup_.target, to, match.target.front());
    carried_.push_back(isTop && setup_.source->joints[s].parent);
  }
}

void RootPositioner::findPelvis() {
  const Skeleton& target = *setup_.target;
  const Index pelvis = setup_.map.find(body_part::kPelvis)->target.back();
  const auto turns = [&](Index j) {
    return j == pelvis || std::find(turnsAlong_.begin(), turnsAlong_.end(), j) != turnsAlong_.end();
  };
  for (const Side side : kSides) {
    const Index leg = setup_.map.find(body_part::leg(side, Segment::kUpper))->target.front();
    if (leg == pelvis || !isAncestorOrSelf(target, pelvis, leg)) return;
    for (Index j = *target.joints[leg].parent; !turns(j); j = *target.joints[j].parent) turnsAlong_.push_back(j);
    hipJoints_.push_back(leg);
  }
  pelvis_ = pelvis;
  for (Index j = 0; j < target.jointCount(); ++j) {
    if (target.joints[j].parent && turns(*target.joints[j].parent) && !turns(j)) pelvisChildren_.push_back(j);
  }
}

void RootPositioner::findTrunk() {
  const Skeleton& target = *setup_.target;
  const Index hindquarters = setup_.map.find(body_part::kPelvis)->target.front();
  std::vector<Index> kept;
  for (const AnimalLeg& leg : setup_.animalLegs) {
    const Index upper = leg.target.upper;
    if (upper == hindquarters || !isAncestorOrSelf(target, hindquarters, upper)) return;
    kept.push_back(upper);
    if (!leg.fore) hipJoints_.push_back(upper);
  }
  if (hipJoints_.empty()) return;
  pelvis_ = hindquarters;
  for (const BodyPart& part : {body_part::kNeck, body_part::kHead, body_part::kTail}) {
    if (const JointMatch* match = setup_.map.find(part)) kept.push_back(match->target.front());
  }
  std::vector<bool> turns(target.jointCount(), false);
  turns[hindquarters] = true;
  for (Index j = 0; j < target.jointCount(); ++j) {
    if (!target.joints[j].parent || !turns[*target.joints[j].parent]) continue;
    turns[j] = std::find(kept.begin(), kept.end(), j) == kept.end();
    (turns[j] ? turnsAlong_ : pelvisChildren_).push_back(j);
  }
}

void RootPositioner::apply(const Pose& source, const BodyFrame& sourceFrame, Pose& target, BodyFrame& frame) const {
  if (setup_.rootFollows == RootFollows::kHindquarters) return placeHindquarters(sourceFrame, target, frame);
  if (movesEachJoint_) {
    placeEach(source, sourceFrame, target, frame);
    setup_.targetKinematics.update(target, frame);
  }
  if (setup_.rootFollows == RootFollows::kEachJoint) {
    if (setup_.animalLegs.empty()) settleLoose(target, frame);
    return;
  }
  const Vec3 there = setup_.positionOf(pelvisOf(setup_.map, MapSide::kSource, sourceFrame.positions));
  movePelvis(there - pelvisOf(setup_.map, MapSide::kTarget, frame.positions), target, frame);
}

void RootPositioner::placeHindquarters(const BodyFrame& sourceFrame, Pose& target, BodyFrame& frame) const {
  const std::vector<Vec3>& sourceRest = setup_.sourceNeutral.restPositions;
  const Vec3 displacement =
      middleOf(sourceHindquarters_, sourceFrame.positions) - middleOf(sourceHindquarters_, sourceRest);
  const Vec3 there = middleOf(hindquarters_, setup_.targetNeutral.restPositions) + setup_.scale * displacement;
  movePelvis(there - middleOf(hindquarters_, frame.positions), target, frame);
}

void RootPositioner::placeEach(const Pose& source, const BodyFrame& sourceFrame, Pose& target,
                               const BodyFrame& frame) const {
  for (std::size_t m = 0; m < setup_.map.matches.size(); ++m) {
    const JointMatch& match = setup_.map.matches[m];
    for (std::size_t i = 0; i < (setup_.sameBody ? match.target.size() : 1); ++i) {
      const Index s = match.source[i], t = match.target[i];
      const Vec3 own = source.locals[s].translation - setup_.source->joints[s].rest.translation;
      Vec3 displacement =
          setup_.sourceKinematics.parentRotation(s, sourceFrame) * (setup_.sourceKinematics.unit(s) * own);
      if (i == 0 && !carried_.empty() && carried_[m]) {
        displacement = sourceFrame.positions[s] - setup_.sourceNeutral.restPositions[s];
      }
      const double unit = setup_.scale / setup_.targetKinematics.unit(t);
      const Quat toParent = setup_.targetKinematics.parentRotation(t, frame).conjugate();
      target.locals[t].translation = setup_.target->joints[t].rest.translation + unit * (toParent * displacement);
    }
  }
}

void RootPositioner::movePelvis(const Vec3& shift, Pose& target, BodyFrame& frame) const {
  if (!hips_) return;
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Quat above = kinematics.parentRotation(*hips_, frame);
  target.locals[*hips_].translation += (above.conjugate() * shift) / kinematics.unit(*hips_);
  settle(target, frame);
}

void RootPositioner::turnPelvis(const Quat& turn, Pose& target, BodyFrame& frame) const {
  if (!pelvis_) return;
  const BodyKinematics& kinematics = setup_.targetKinematics;
  const Vec3 middle = middleOfHips(frame);
  const Quat turned = turn * frame.rotations[*pelvis_];
  target.locals[*pelvis_].rotation = (kinematics.parentRotation(*pelvis_, frame).conjugate() * turned).normalized();
  frame.rotations[*pelvis_] = turned;
  for (const Index joint : turnsAlong_) frame.rotations[joint] = turn * frame.rotations[joint];
  for (const Index child : pelvisChildren_) {
    target.locals[child].rotation =
        (kinematics.parentRotation(child, frame).conjugate() * frame.rotations[child]).normalized();
  }
  kinematics.update(target, frame);
  movePelvis(middle - middleOfHips(frame), target, frame);
}

Vec3 RootPositioner::middleOfHips(const BodyFrame& frame) const {
  return middleOf(hipJoints_, frame.positions);
}

void RootPositioner::settle(Pose& target, BodyFrame& frame) const {
  setup_.targetKinematics.update(target, frame);
  settleLoose(target, frame);
}

Index RootPositioner::carrierOf(Index joint) const {
  for (const Loose& loose : loose_) {
    if (loose.joint == joint) return loose.carrier;
  }
  return joint;
}

void RootPositioner::settleLoose(Pose& target, BodyFrame& frame) const {
  const BodyKinematics& kinematics = setup_.targetKinematics;
  for (const Loose& loose : loose_) {
    const Quat& carrier = frame.rotations[loose.carrier];
    const Quat toParent = kinematics.parentRotation(loose.joint, frame).conjugate();
    const Vec3 there = frame.positions[loose.carrier] + carrier * loose.offset;
    const Vec3 displacement = toParent * Vec3(there - kinematics.parentPosition(loose.joint, frame));
    target.locals[loose.joint].translation = displacement / kinematics.unit(loose.joint);
    if (loose.turn) target.locals[loose.joint].rotation = (toParent * carrier * *loose.turn).normalized();
    // At once: what is below may carry the next one, or be loose itself. A matched joint keeps the rotation that it has
    // in the frame.
    if (loose.turn) {
      kinematics.globalsBelow(loose.joint, target, frame);
    } else {
      kinematics.updateBelow(loose.joint, target, frame);
    }
  }
}

}  // namespace limber
