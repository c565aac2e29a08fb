#include "limber/motion/mix/plant_mixed_feet.h"

#include <algorithm>
#include <cmath>

#include "limber/motion/retarget/displacement_curve.h"
#include "limber/motion/retarget/foot_planting.h"

namespace limber {

namespace {

// Hip heights, and radians; 1e-7 to 1e-4; a frame with smaller changes stays as it is, bit for bit; below what is seen.
constexpr double kUnseen = 1e-5;

double levelLength(const Vec3& v) {
  return std::hypot(v.x(), v.z());
}

class FootPlanter {
 public:
  FootPlanter(const MixBody& body, const MixedRange& range, MixedFrames& mixed)
      : body_(body), range_(range), mixed_(mixed), legs_(body.legs().size()) {}

  void run() {
    const std::size_t frames = range_.end - range_.begin;
    if (legs_ == 0 || frames < 5) return;
    readFeet();
    twistFeet();
    FootPlanting planting;
    planting.begin = range_.begin;
    planting.end = range_.end;
    planting.frameSeconds = mixed_.frames.frameSeconds;
    planting.ends = {range_.begin > 0, range_.end < mixed_.frames.poses.size(), range_.loops};
    planting.cuts.assign(frames, false);
    planting.frameAt = [&](std::size_t f) -> const BodyFrame& { return frames_[f - range_.begin]; };
    planting.askedOf = [&](std::size_t f, std::size_t leg, const BodyFrame& frame) { return askedOf(f, leg, frame); };
    planting.change = [&](MovedLegs& moved, const ChangeLayout& layout, const Changes& changes, std::size_t index,
                          std::size_t f) {
      if (!isSeen(layout, changes, index) && !isTwisted(f)) return;
      moved.pose(layout, changes, index, mixed_.frames.poses[f], twists_[f - range_.begin]);
    };
    plantFeet(MovedLegs(body_.setup(), body_.root(), body_.trunk(), body_.legs()), planting);
  }

 private:
  // A foot before any changes.
  struct FreeFoot {
    Vec3 ankle = Vec3::Zero(), roll = Vec3::Zero();  // and the displacement from there to the toes
    Quat turn = Quat::Identity();
  };

  const MixedFoot& mixedFoot(std::size_t f, std::size_t leg) const { return mixed_.feet[f * legs_ + leg]; }
  const FreeFoot& foot(std::size_t f, std::size_t leg) const { return feet_[(f - range_.begin) * legs_ + leg]; }
  double& twist(std::size_t f, std::size_t leg) { return twists_[f - range_.begin][leg]; }
  bool staysPlanted(std::size_t f, std::size_t leg) const {
    return f > range_.begin && mixedFoot(f, leg).planted && mixedFoot(f - 1, leg).planted;
  }

  void readFeet() {
    frames_.resize(range_.end - range_.begin);
    for (std::size_t f = range_.begin; f < range_.end; ++f) {
      BodyFrame& frame = frames_[f - range_.begin];
      body_.globals(mixed_.frames.poses[f], frame);
      for (const LegSpec& leg : body_.legs()) {
        FreeFoot& free = feet_.emplace_back();
        free.ankle = frame.positions[leg.end];
        if (leg.toes) free.roll = frame.positions[*leg.toes] - free.ankle;
        free.turn = frame.rotations[leg.end];
      }
    }
  }

  // A planted foot turns about the vertical as it does in its motions.
  void twistFeet() {
    twists_.assign(range_.end - range_.begin, std::vector<double>(legs_, 0.0));
    for (std::size_t leg = 0; leg < legs_; ++leg) {
      std::vector<CurveGoal> goals(twists_.size());
      for (std::size_t f = range_.begin + 1; f < range_.end; ++f) {
        if (!staysPlanted(f, leg)) continue;
        CurveGoal& goal = goals[f - range_.begin];
        goal.step = mixedFoot(f, leg).turn - turnAboutVertical(foot(f, leg).turn * foot(f - 1, leg).turn.conjugate());
        goal.stepWeight = planting::kTwistHold;
      }
      const std::vector<double> turns = displacementCurve(goals, mixed_.frames.frameSeconds, {planting::kTwistSeconds});
      for (std::size_t f = range_.begin; f < range_.end; ++f) twist(f, leg) = turns[f - range_.begin];
    }
  }

  Vec3 rollOf(std::size_t f, std::size_t leg) {
    return Eigen::AngleAxisd(twist(f, leg), Vec3::UnitY()) * foot(f, leg).roll;
  }

  FootFrame askedOf(std::size_t f, std::size_t i, const BodyFrame& frame) {
    const double unit = 1 / body_.setup().targetHipHeight;
    const LegSpec& leg = body_.legs()[i];
    const FreeFoot& now = foot(f, i);
    double ground = leg.ankleGround;
    if (leg.toes) ground = std::max(ground, leg.toesGround - now.roll.y());
    FootFrame asked;
    asked.lowest = unit * std::min(ground - now.ankle.y(), 0.0);
    asked.displacement = unit * (now.ankle - frame.positions[leg.upper]);
    asked.most = std::max(unit * planting::kStretched * leg.length, asked.displacement.norm());
    if (leg.fore) asked.lift = TrunkTilt::liftOf(body_.trunk().trunkOf(frame));
    if (!staysPlanted(f, i)) return asked;
    const MixedFoot& own = mixedFoot(f, i);
    asked.hold = 1;
    asked.step = own.ankleStep - (now.ankle - foot(f - 1, i).ankle);
    if (leg.toes && levelLength(own.toesStep) <= levelLength(own.ankleStep)) {
      const Vec3 before = foot(f - 1, i).ankle + rollOf(f - 1, i);
      asked.step = own.toesStep - (now.ankle + rollOf(f, i) - before);
    }
    asked.step *= unit;
    return asked;
  }

  static bool isSeen(const ChangeLayout& layout, const Changes& changes, std::size_t frame) {
    const auto first = changes.begin() + static_cast<std::ptrdiff_t>(layout.pelvis(frame));
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(layout.perFrame()),
                       [](double change) { return std::abs(change) > kUnseen; });
  }
  bool isTwisted(std::size_t f) const {
    const std::vector<double>& turns = twists_[f - range_.begin];
    return std::any_of(turns.begin(), turns.end(), [](double turn) { return std::abs(turn) > kUnseen; });
  }

  const MixBody& body_;
  const MixedRange& range_;
  MixedFrames& mixed_;
  std::size_t legs_;
  std::vector<BodyFrame> frames_;            // of the range, as they were
  std::vector<FreeFoot> feet_;               // likewise, of each leg
  std::vector<std::vector<double>> twists_;  // of each frame, of each leg's foot: radians about +Y
};

}  // namespace

void plantMixedFeet(const MixBody& body, const MixedRange& range, MixedFrames& mixed) {
  FootPlanter(body, range, mixed).run();
}

}  // namespace limber
