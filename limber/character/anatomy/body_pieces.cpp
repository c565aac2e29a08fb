#include "limber/character/anatomy/body_pieces.h"

#include <algorithm>
#include <limits>

#include "limber/character/anatomy/names/joint_words.h"

namespace limber {

namespace {

constexpr std::size_t kFingerJoints = 3;  // that a hand's finger has, its metacarpal apart (a thumb with it)

// A metacarpal in the palm is told by its name alone.
void trimFinger(LimbPieces& limb, const Skeleton& skeleton) {
  const auto nameAt = [&](Index joint) { return readNameOf(skeleton.joints[joint]); };
  std::vector<Index>& joints = limb.joints;
  const bool isThumb = limb.part->pair == 0;
  if (!isThumb && joints.size() > 1 && saysMetapodial(nameAt(joints.front()))) joints.erase(joints.begin());
  while (joints.size() > 1 && readJointWords(nameAt(joints.back())).has(NameMark::kEnd)) joints.pop_back();
  if (joints.size() > kFingerJoints) joints.resize(kFingerJoints);
  if (isThumb && joints.size() == 2) limb.firstPiece = 1;
}

LimbPieces piecesOf(const Part& part, const Skeleton& skeleton, const std::vector<Vec3>& rest, const JointTree& tree) {
  LimbPieces limb;
  limb.part = &part;
  limb.joints = part.joints;
  if (part.kind == PartKind::kFinger) trimFinger(limb, skeleton);
  double length = 0;
  for (std::size_t i = 0; i < limb.joints.size(); ++i) {
    const Index joint = limb.joints[i];
    if (i > 0) length += (rest[joint] - rest[limb.joints[i - 1]]).norm();
    limb.along.push_back(length);
    const auto mark = [&](const std::optional<Index>& landmark, Segment segment) {
      if (landmark == joint) limb.marks.emplace_back(segment, i);
    };
    if (i == 0 && part.upper && part.upper != joint) limb.marks.emplace_back(Segment::kBase, 0);
    mark(part.upper, Segment::kUpper);
    mark(part.middle, Segment::kMiddle);
    // A foot on a root of its own goes with the hock: the leg above ends there.
    const bool endsAtHock = part.hock && part.end && !tree.isAboveOrSelf(*part.hock, *part.end);
    mark(part.hock, endsAtHock ? Segment::kEnd : Segment::kHock);
    mark(part.end, endsAtHock ? Segment::kToes : Segment::kEnd);
    if (!endsAtHock) mark(part.toes, Segment::kToes);
  }
  for (double& along : limb.along) along = length > 0 ? along / length : 0;
  return limb;
}

}  // namespace

BodyPieces::BodyPieces(const Skeleton& given, const AnatomyOptions& options) : anatomy(readAnatomy(given, options)) {
  const Skeleton skeleton = believedSkeleton(given, anatomy);
  const JointTree tree(skeleton);
  findCenter(skeleton, tree);
  const std::vector<Vec3> rest = restPositions(skeleton);
  for (const Part& part : anatomy.parts) {
    const bool isCenter = part.kind == PartKind::kTrunk || part.kind == PartKind::kNeck || part.kind == PartKind::kHead;
    if (!isCenter) limbs.push_back(piecesOf(part, skeleton, rest, tree));
  }
}

void BodyPieces::findCenter(const Skeleton& skeleton, const JointTree& tree) {
  const Part* trunkPart = anatomy.find(PartKind::kTrunk);
  const Part *neckPart = anatomy.find(PartKind::kNeck), *headPart = anatomy.find(PartKind::kHead);
  for (const Part* part : {trunkPart, neckPart, headPart}) {
    if (part) centerConfidence = std::min(centerConfidence, part->confidence);
  }
  if (headPart) head = headPart->joints.front();
  const std::optional<Index> above = neckPart ? std::optional(neckPart->joints.front()) : head;
  // Up the spine, or to where it ends.
  std::optional<Index> spine = above;
  if (!spine && trunkPart) spine = trunkPart->joints.back();
  const Index hindmost = anatomy.pairsOf(PartKind::kLeg);
  if (spine && hindmost > 0) {
    std::optional<Index> fork;
    for (const Side side : kSides) {
      const Part* leg = anatomy.find(PartKind::kLeg, side, hindmost - 1);
      if (!leg) continue;
      fork = fork ? tree.meeting(*fork, leg->joints.front()) : std::optional(leg->joints.front());
      if (!fork) break;
    }
    if (fork) fork = tree.meeting(*fork, *spine);
    const bool isLimb = fork && anatomy.partOf[*fork] && anatomy.parts[*anatomy.partOf[*fork]].kind == PartKind::kLeg;
    if (fork && !isLimb && fork != above) pelvis = fork;
    pelvisIsInferred = pelvis && trunkPart && tree.isAboveOrSelf(trunkPart->joints.front(), *pelvis) &&
                       trunkPart->joints.front() != *pelvis;
    // A joint called hips that carries them all is believed.
    for (std::optional<Index> up = pelvis; up; up = tree.parent(*up)) {
      const bool isHips = up == anatomy.declaredHips || saysHips(readNameOf(skeleton.joints[*up]));
      if (!isHips) continue;
      pelvis = up;
      pelvisIsInferred = false;
      break;
    }
  }
  if (!pelvis && trunkPart) pelvis = trunkPart->joints.front();
  // A body that is all head and tail hangs on what carries both.
  const Part* tail = anatomy.find(PartKind::kTail);
  if (!pelvis && headPart && tail) {
    const Index front = headPart->joints.front(), back = tail->joints.front();
    pelvis = tree.parent(tree.isAboveOrSelf(front, back) ? front : back);
  }
  if (!pelvis) return;
  if (above) {
    trunk = tree.pathBelow(*pelvis, *above);
    if (!trunk.empty()) trunk.pop_back();
  }
  if (trunk.empty() && trunkPart) {
    for (const Index joint : trunkPart->joints) {
      if (joint != *pelvis && !tree.isAboveOrSelf(joint, *pelvis)) trunk.push_back(joint);
    }
  }
  if (splitAtForelegs(tree)) return;
  if (neckPart) {
    neck = {neckPart->joints.front()};
    if (head && tree.isAboveOrSelf(neck[0], *head)) {
      neck = tree.pathBelow(neck[0], *head);
      neck.insert(neck.begin(), neckPart->joints.front());
      neck.pop_back();
    }
  }
}

void BodyPieces::cutLegsWhereTheyStand(const Skeleton& skeleton) {
  const std::vector<Vec3> rest = restPositions(skeleton);
  // Of the legs' height: a foot's joint is lower (a shin's of the shared animals 0.3 and more).
  constexpr double kFootHeight = 0.2;
  const auto height = [&](Index joint) { return anatomy.axes.up.dot(rest[joint]); };
  double lowest = std::numeric_limits<double>::infinity(), tops = 0, legs = 0;
  for (const LimbPieces& limb : limbs) {
    if (limb.part->kind != PartKind::kLeg) continue;
    tops += height(limb.joints.front());
    ++legs;
    for (const Index joint : limb.joints) lowest = std::min(lowest, height(joint));
  }
  for (LimbPieces& limb : limbs) {
    if (limb.part->kind != PartKind::kLeg) continue;
    const auto low = std::find_if(limb.joints.begin(), limb.joints.end(), [&](Index joint) {
      return height(joint) - lowest < kFootHeight * (tops / legs - lowest);
    });
    std::size_t upper = 0;
    for (const auto& [segment, at] : limb.marks) {
      if (segment == Segment::kUpper) upper = at;
    }
    const auto end = static_cast<std::size_t>(low - limb.joints.begin());
    if (end >= limb.joints.size() || end < upper + 2) continue;
    limb.marks.clear();
    if (upper > 0) limb.marks.emplace_back(Segment::kBase, 0);
    limb.marks.emplace_back(Segment::kUpper, upper);
    limb.marks.emplace_back(Segment::kEnd, end);
    if (end + 1 < limb.joints.size()) limb.marks.emplace_back(Segment::kToes, end + 1);
  }
}

bool BodyPieces::isAnimal() const {
  return anatomy.pairsOf(PartKind::kLeg) > 1 || anatomy.pairsOf(PartKind::kWing) > 0 || anatomy.find(PartKind::kTail);
}

// The trunk of those on four legs ends where the forelegs hang, and the neck begins: how many of the spine's joints
// makers call a neck differs.
bool BodyPieces::splitAtForelegs(const JointTree& tree) {
  const Part *left = anatomy.find(PartKind::kLeg, Side::kLeft), *right = anatomy.find(PartKind::kLeg, Side::kRight);
  if (anatomy.pairsOf(PartKind::kLeg) < 2 || !left || !right || !head || !pelvis) return false;
  const std::optional<Index> chest = tree.meeting(left->joints.front(), right->joints.front());
  if (!chest || chest == pelvis || !tree.isAboveOrSelf(*pelvis, *chest) || !tree.isAboveOrSelf(*chest, *head))
    return false;
  trunk = tree.pathBelow(*pelvis, *chest);
  neck = tree.pathBelow(*chest, *head);
  if (!neck.empty()) neck.pop_back();
  return true;
}

const LimbPieces* BodyPieces::find(PartKind kind, Side side, Index pair) const {
  const auto found = std::find_if(limbs.begin(), limbs.end(), [&](const LimbPieces& limb) {
    return limb.part->kind == kind && limb.part->side == side && limb.part->pair == pair;
  });
  return found == limbs.end() ? nullptr : &*found;
}

std::vector<Index> BodyPieces::lineOfLimbless(const Skeleton& skeleton) const {
  const JointTree tree(skeleton);
  std::vector<Index> body, fronts;
  for (const Part& part : anatomy.parts) {
    switch (part.kind) {
      case PartKind::kLeg:
      case PartKind::kArm:
      case PartKind::kWing:
      case PartKind::kFin:
        return {};
      case PartKind::kTrunk:
      case PartKind::kTail:
        body.insert(body.end(), part.joints.begin(), part.joints.end());
        break;
      case PartKind::kHead:
        fronts.push_back(part.joints.front());
        break;
      default:
        break;
    }
  }
  if (body.empty()) return {};
  if (fronts.empty()) fronts.push_back(body.front());
  std::vector<Index> longest;
  for (const Index front : fronts) {
    for (const Index end : body) {
      const std::optional<Index> meeting = tree.meeting(front, end);
      if (!meeting) continue;
      std::vector<Index> line = tree.pathBelow(*meeting, front);
      std::reverse(line.begin(), line.end());
      line.push_back(*meeting);
      for (const Index joint : tree.pathBelow(*meeting, end)) line.push_back(joint);
      if (line.size() > longest.size()) longest = std::move(line);
    }
  }
  return longest;
}

}  // namespace limber
