#include "limber/motion_mix/plant_mixed_feet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/retarget/displacement_curve.h"
#include "limber/retarget/moved_legs.h"

namespace limber {

namespace {

// As of the method "spacetime", whose feet are planted by the same least squares.
constexpr double kChangeSeconds = 0.06, kTwistSeconds = 0.05;  // in which changes come and go
constexpr double kHold = 1e5;       // of a planted foot's speed along the ground (hip heights a second), squared
constexpr double kTwistHold = 1e8;  // of its turn from frame to frame, radians, squared
constexpr double kPelvisLevel = 10, kPelvisUp = 0.02, kFeet = 0.02, kBones = 1;
constexpr int kRounds = 8;
constexpr double kBoneProbe = 0.2;     // hip heights, over which it is seen how bones follow a foot
constexpr double kStretched = 0.995;   // of its length to which a leg stretches
constexpr double kAheadSeconds = 0.5;  // that each part sees of the next
constexpr double kUnseen = 1e-5;       // hip heights: a frame with changes below that stays as it is, bit for bit
constexpr double kUnseenTwist = 1e-5;  // radians

ChangeWeights weightsFor(double frameSeconds) {
  ChangeWeights weights;
  weights.pelvisLevel = kPelvisLevel;
  weights.pelvisUp = kPelvisUp;
  weights.feet = kFeet;
  weights.bones = kBones;
  weights.hold = kHold / (frameSeconds * frameSeconds);
  weights.rounds = kRounds;
  return weights;
}

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
    const auto ahead = static_cast<std::size_t>(std::round(kAheadSeconds / mixed_.frames.frameSeconds));
    const std::size_t parts = (frames + kPartFrames - 1) / kPartFrames;
    Part before;
    for (std::size_t i = 0; i < parts; ++i) {
      Part part;
      part.first = range_.begin + i * frames / parts;
      part.begin = i == 0 ? part.first : part.first - kJoinedFrames;
      part.end = range_.begin + (i + 1) * frames / parts;
      part.seen = std::min(range_.end, part.end + ahead);
      plantPart(before, part, parts == 1);
      before = std::move(part);
    }
  }

 private:
  // A foot before any changes.
  struct FreeFoot {
    Vec3 ankle = Vec3::Zero(), roll = Vec3::Zero();  // and the way from there to the toes
    Quat turn = Quat::Identity();
  };
  // Frames [first, end), seen with those from `begin` up to `seen`; the changes of all these.
  struct Part {
    std::size_t begin = 0, first = 0, end = 0, seen = 0;
    Changes changes;
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
      for (const Leg& leg : body_.legs()) {
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
        goal.stepWeight = kTwistHold;
      }
      const std::vector<double> turns = displacementCurve(goals, mixed_.frames.frameSeconds, {kTwistSeconds});
      for (std::size_t f = range_.begin; f < range_.end; ++f) twist(f, leg) = turns[f - range_.begin];
    }
  }

  Vec3 rollOf(std::size_t f, std::size_t leg) {
    return Eigen::AngleAxisd(twist(f, leg), Vec3::UnitY()) * foot(f, leg).roll;
  }

  FootFrame askedOf(std::size_t f, std::size_t i) {
    const double unit = 1 / body_.setup().targetHipHeight;
    const Leg& leg = body_.legs()[i];
    const BodyFrame& frame = frames_[f - range_.begin];
    const FreeFoot& now = foot(f, i);
    double ground = leg.ankleGround;
    if (leg.toes) ground = std::max(ground, leg.toesGround - now.roll.y());
    FootFrame asked;
    asked.lowest = unit * std::min(ground - now.ankle.y(), 0.0);
    asked.way = unit * (now.ankle - frame.positions[leg.upper]);
    asked.most = std::max(unit * kStretched * leg.length, asked.way.norm());
    if (body_.trunk().isFore(leg.upper)) asked.lift = TrunkTilt::liftOf(body_.trunk().trunkOf(frame));
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

  void plantPart(const Part& before, Part& part, bool alone) {
    MovedLegs moved(body_.setup(), body_.root(), body_.trunk(), body_.legs());
    const ChangeLayout layout = moved.layoutOf(part.seen - part.begin);
    std::vector<FootFrame> asked;
    for (std::size_t f = part.begin; f < part.seen; ++f) {
      moved.add(frames_[f - range_.begin]);
      for (std::size_t i = 0; i < legs_; ++i) asked.push_back(askedOf(f, i));
    }
    MotionEnds ends;
    ends.startsJoined = part.first > 0;
    ends.endsJoined = part.seen < mixed_.frames.poses.size() && part.seen == range_.end;
    ends.loops = range_.loops && alone;
    if (part.begin < part.first) {
      const auto known =
          before.changes.begin() + static_cast<std::ptrdiff_t>((part.begin - before.begin) * layout.perFrame());
      ends.start.assign(known, known + static_cast<std::ptrdiff_t>(kJoinedFrames * layout.perFrame()));
    }
    // Paths of nothing: what counts is what the changes make of them.
    ChangedMotion now;
    now.changes.assign(layout.frames() * layout.perFrame(), 0.0);
    now.paths.assign(1 + 2 * legs_, Path(layout.frames(), Vec3(Vec3::Zero())));
    moved.findSlopes(layout, kBoneProbe, now);
    const double frameSeconds = mixed_.frames.frameSeconds;
    LeastChanges least(layout, std::move(asked), std::vector<bool>(layout.frames(), false), ends,
                       weightsFor(frameSeconds));
    least.start(now);
    part.changes = least.find(smoothnessWeight(kChangeSeconds, frameSeconds));
    for (std::size_t f = part.first; f < part.end; ++f) {
      if (isSeen(layout, part.changes, f - part.begin) || isTwisted(f)) {
        moved.pose(layout, part.changes, f - part.begin, mixed_.frames.poses[f], twists_[f - range_.begin]);
      }
    }
  }

  static bool isSeen(const ChangeLayout& layout, const Changes& changes, std::size_t frame) {
    const auto first = changes.begin() + static_cast<std::ptrdiff_t>(layout.pelvis(frame));
    return std::any_of(first, first + static_cast<std::ptrdiff_t>(layout.perFrame()),
                       [](double change) { return std::abs(change) > kUnseen; });
  }
  bool isTwisted(std::size_t f) const {
    const std::vector<double>& turns = twists_[f - range_.begin];
    return std::any_of(turns.begin(), turns.end(), [](double turn) { return std::abs(turn) > kUnseenTwist; });
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
