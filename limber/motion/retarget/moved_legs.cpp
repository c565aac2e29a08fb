#include "limber/motion/retarget/moved_legs.h"

#include <utility>

namespace limber {

namespace {

constexpr double kMissed = 1e-3;  // hip heights; 1e-4 to 5e-3; by which a leg may miss its planted foot; set by hand

}  // namespace

MovedLegs::MovedLegs(const RetargetSetup& setup, const RootPositioner& root, const TrunkTilt& trunk,
                     std::vector<LegSpec> legs)
    : setup_(setup), root_(root), trunk_(trunk), reach_(setup, root), legs_(std::move(legs)) {
  const std::vector<Vec3>& rest = setup.targetNeutral.restPositions;
  for (const LegSpec& leg : legs_) {
    lengths_.push_back({(rest[leg.lower] - rest[leg.upper]).norm(), (rest[leg.end] - rest[leg.lower]).norm()});
  }
  findWeights();
}

// Not all that has legs carries them on one joint.
void MovedLegs::findWeights() {
  Pose pose = restPose(*setup_.target);
  BodyFrame before, after;
  setup_.targetKinematics.globals(pose, before);
  after = before;
  const Vec3 displacement = setup_.targetHipHeight * Vec3::UnitY();
  root_.movePelvis(displacement, pose, after);
  const auto weight = [&](const Vec3& from, const Vec3& to) {
    return (to - from).dot(displacement) / displacement.squaredNorm();
  };
  pelvisWeight_ = weight(pelvisOf(setup_.map, MapSide::kTarget, before.positions),
                         pelvisOf(setup_.map, MapSide::kTarget, after.positions));
  for (const LegSpec& leg : legs_)
    hipWeights_.push_back(weight(before.positions[leg.upper], after.positions[leg.upper]));
}

ChangeLayout MovedLegs::layoutOf(std::size_t frames) const {
  std::vector<bool> tilted;
  for (const LegSpec& leg : legs_) tilted.push_back(leg.fore);
  return ChangeLayout(frames, std::move(tilted));
}

void MovedLegs::add(const BodyFrame& frame) {
  Frame& seen = frames_.emplace_back();
  seen.pelvis = pelvisOf(setup_.map, MapSide::kTarget, frame.positions);
  if (trunk_.tilts()) {
    seen.middle = root_.middleOfHips(frame);
    seen.trunk = trunk_.trunkOf(frame);
  }
  for (const LegSpec& leg : legs_) {
    seen.legs.push_back({reach_.shapeOf(leg, frame), frame.positions[leg.upper]});
  }
}

MovedLegs::Move MovedLegs::moveAt(const ChangeLayout& layout, const Changes& changes, std::size_t frame,
                                  double furtherUp) const {
  const double unit = setup_.targetHipHeight;
  Move move{unit * displacementAt(changes, layout.pelvis(frame))};
  if (layout.tilts()) {
    move.tilt = TrunkTilt::turnFor(unit * (changes[layout.shoulders(frame)] + furtherUp), frames_[frame].trunk);
  }
  return move;
}

Vec3 MovedLegs::displacementOf(const Vec3& point, double weight, const Frame& frame, const Move& move) const {
  const Vec3 shift = weight * move.shift;
  if (!trunk_.tilts()) return shift;
  const Vec3 fromMiddle = point - frame.middle;
  return shift + move.tilt * fromMiddle - fromMiddle;
}

MovedLegs::Reached MovedLegs::reached(std::size_t frame, std::size_t leg, const Move& move,
                                      const Vec3& footDisplacement) const {
  const LegFrame& seen = frames_[frame].legs[leg];
  const Vec3 further = footDisplacement - displacementOf(seen.hip, hipWeights_[leg], frames_[frame], move);
  TwoBonePositions positions{seen.shape.middle, seen.shape.end};
  const Vec3 there = seen.shape.end + further;
  if (solvesAll_ || further.norm() > 1e-9 * legs_[leg].length) {
    LimbShape shape = seen.shape;
    if (trunk_.tilts()) {
      shape.neutralEnd = move.tilt * shape.neutralEnd;
      shape.neutralAhead = move.tilt * shape.neutralAhead;
      shape.findBend(legs_[leg]);
    }
    positions = LimbReach::positionsFor(legs_[leg], shape, there);
  }
  return {{positions.middle / lengths_[leg][0], (positions.end - positions.middle) / lengths_[leg][1]},
          (there - positions.end).norm()};
}

bool MovedLegs::follow(const ChangeLayout& layout, const Changes& changes, std::span<const FootFrame> feet,
                       std::vector<Path>& paths) const {
  const double unit = setup_.targetHipHeight;
  paths.assign(1 + 2 * legs_.size(), Path(layout.frames()));
  for (std::size_t f = 0; f < layout.frames(); ++f) {
    const Move move = moveAt(layout, changes, f);
    const Vec3& pelvis = frames_[f].pelvis;
    paths[0][f] = (pelvis + displacementOf(pelvis, pelvisWeight_, frames_[f], move)) / unit;
    for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
      const Reached to = reached(f, leg, move, unit * displacementAt(changes, layout.foot(f, leg)));
      if (feet[f * legs_.size() + leg].planted && to.missed > kMissed * unit) return false;
      for (std::size_t bone = 0; bone < 2; ++bone) paths[1 + 2 * leg + bone][f] = to.bones[bone];
    }
  }
  return true;
}

void MovedLegs::findSlopes(const ChangeLayout& layout, double probe, ChangedMotion& motion) const {
  const double unit = setup_.targetHipHeight;
  motion.slopes.resize(legs_.size());
  for (BoneSlopes& bones : motion.slopes) bones.fill(std::vector<Slope>(layout.frames(), Slope(Slope::Zero())));
  for (std::size_t f = 0; f < layout.frames(); ++f) {
    const Move move = moveAt(layout, motion.changes, f);
    for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
      const Vec3 footDisplacement = unit * displacementAt(motion.changes, layout.foot(f, leg));
      const auto set = [&](Eigen::Index column, const Reached& before, const Reached& behind) {
        for (std::size_t bone = 0; bone < 2; ++bone) {
          motion.slopes[leg][bone][f].col(column) = (behind.bones[bone] - before.bones[bone]) / (2 * probe);
        }
      };
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        const Vec3 displacement = probe * unit * Vec3::Unit(axis);
        set(axis, reached(f, leg, move, footDisplacement - displacement),
            reached(f, leg, move, footDisplacement + displacement));
      }
      if (!layout.isTilted(leg)) continue;
      set(3, reached(f, leg, moveAt(layout, motion.changes, f, -probe), footDisplacement),
          reached(f, leg, moveAt(layout, motion.changes, f, probe), footDisplacement));
    }
  }
}

void MovedLegs::pose(const ChangeLayout& layout, const Changes& changes, std::size_t frame, Pose& target,
                     std::span<const double> twists) {
  const double unit = setup_.targetHipHeight;
  setup_.targetKinematics.globals(target, posed_);
  std::vector<LimbGoal> goals(legs_.size());
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    goals[i].position = posed_.positions[legs_[i].end] + unit * displacementAt(changes, layout.foot(frame, i));
    goals[i].turn = Eigen::AngleAxisd(twists.empty() ? 0 : twists[i], Vec3::UnitY());
  }
  const Move move = moveAt(layout, changes, frame);
  root_.movePelvis(move.shift, target, posed_);
  if (layout.tilts()) root_.turnPelvis(move.tilt, target, posed_);
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    if (solvesAll_ || !LimbReach::isThere(legs_[i], goals[i], posed_)) reach_.reach(legs_[i], goals[i], posed_, target);
  }
}

}  // namespace limber
