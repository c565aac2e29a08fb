#include "limber/motion/retarget/motion_smoothing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "limber/motion/limbs/limb_goals.h"
#include "limber/motion/retarget/least_changes.h"
#include "limber/motion/retarget/moved_legs.h"

namespace limber {

namespace {

struct Smoothing {
  // Times the source's jerk; 1 to 1.1; set just below 1.1, which every shared pair of a motion and a person keeps to.
  double jerkLimit = 1.08;
  // Bone lengths; 0.005 to 0.05; between a bone's directions in the first and the last frame of a loop; set by hand.
  double loops = 0.02;
  // Jerk counts as for changes that come and go in that time: the shortest (seconds; 0.003 to 0.02), each longer times
  // the one before (1.05 to 1.5) until the motion is smooth, and up to so many frames (10 to 40): longer ones leave
  // sums whose weights are lost in rounding. Set by hand.
  double shortest = 0.007, longer = 1.2, maxFrames = 30;
  // Hip heights; 0.05 to 0.3; of any change; by the judge on half of the shared motions (0.3 before: flattened what is
  // meant).
  double furthest = 0.15;
  double probe = 1e-4;  // hip heights; 1e-6 to 1e-3; to each side, for the slopes of bones; rounding only
  int halvings = 4;     // 2 to 8; of a step that made the motion rougher; set by hand
};
constexpr Smoothing kSmoothing;

class MotionSmoother {
 public:
  MotionSmoother(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup),
        root_(setup),
        goals_(setup, root_),
        legs_(goals_.specs()),
        trunk_(goals_.pelvis().trunk()),
        moved_(setup, root_, trunk_, legs_),
        source_(source),
        target_(target) {}

  void run() {
    const std::size_t frames = target_.poses.size(), parts = (frames + kPartFrames - 1) / kPartFrames;
    if (!goals_.active() || legs_.empty() || frames < 5) return;
    traceSource();
    for (std::size_t i = 0; i < parts; ++i) {
      const std::size_t end = (i + 1) * frames / parts;
      begin_ = i * frames / parts;
      layout_ = moved_.layoutOf(end - begin_);
      if (partsRatio() <= kSmoothing.jerkLimit) continue;
      const bool closes = loops_ && parts > 1;
      smoothPart({i > 0 || closes, i + 1 < parts || closes, loops_ && parts == 1});
    }
  }

 private:
  void traceSource() {
    BodyPaths body(setup_, MapSide::kSource);
    cuts_.assign(target_.poses.size(), false);
    BodyFrame before, now;
    for (std::size_t f = 0; f < cuts_.size(); ++f, std::swap(before, now)) {
      setup_.sourceKinematics.globals(source_.poses[f], now);
      cuts_[f] = f > 0 && isCut(setup_, before.positions, now.positions, source_.frameSeconds);
      body.add(now.positions);
    }
    sourcePaths_ = body.paths();
    loops_ = std::all_of(sourcePaths_.begin() + 1, sourcePaths_.end(),
                         [](const Path& path) { return (path.back() - path.front()).norm() < kSmoothing.loops; });
  }

  // What has to hold for the feet of the whole motion.
  void boundFeet() {
    const ContactTrack contacts(setup_, goals_.watchedFeet(), source_);
    for (std::size_t f = 0; f < target_.poses.size(); ++f) {
      setup_.targetKinematics.globals(target_.poses[f], frame_);
      for (std::size_t i = 0; i < legs_.size(); ++i) {
        feet_.push_back(boundsOf(legs_[i]));
        feet_.back().planted = contacts.at(f, i).isPlanted();
      }
    }
  }

  FootFrame boundsOf(const LegSpec& leg) const {
    const double unit = 1 / setup_.targetHipHeight;
    const Vec3& end = frame_.positions[leg.end];
    const std::optional<Index> toes = leg.toes ? leg.toes : leg.tip;
    double ground = leg.ankleGround;
    if (toes) ground = std::max(ground, leg.toesGround - (frame_.positions[*toes] - end).y());
    FootFrame foot;
    foot.lowest = unit * std::min(ground - end.y(), 0.0);
    foot.displacement = unit * (end - frame_.positions[leg.upper]);
    foot.most = std::max(unit * kMaxStretch * leg.length, foot.displacement.norm());
    if (leg.fore) foot.lift = TrunkTilt::liftOf(trunk_.trunkOf(frame_));
    return foot;
  }

  // Before any changes.
  double partsRatio() {
    BodyPaths body(setup_, MapSide::kTarget);
    for (std::size_t f = begin_; f < begin_ + layout_.frames(); ++f) body.add(globalsAt(f).positions);
    sourceJerk_ = squaredJerk(sourcePaths_, cuts_, begin_ + 3, begin_ + layout_.frames());
    partsJerk_ = squaredJerk(body.paths(), partsCuts(), 3, layout_.frames());
    return jerkRatio(sourceJerk_, partsJerk_, layout_.frames());
  }

  // Of the target as it is, with its loose joints settled.
  const BodyFrame& globalsAt(std::size_t frame) {
    pose_ = target_.poses[frame];
    setup_.targetKinematics.globals(pose_, frame_);
    root_.settle(pose_, frame_);
    return frame_;
  }

  std::vector<bool> partsCuts() const {
    const auto begin = cuts_.begin() + static_cast<std::ptrdiff_t>(begin_);
    return {begin, begin + static_cast<std::ptrdiff_t>(layout_.frames())};
  }

  // Of the part's frames but for the first three.
  double ratio(const std::vector<Path>& paths) const {
    const double moved = squaredJerk(paths, cutsHere_, 3, layout_.frames());
    return jerkRatio(sourceJerk_, stillJerk_ + moved, layout_.frames());
  }

  void smoothPart(const MotionEnds& ends) {
    if (feet_.empty()) boundFeet();
    feetHere_ = std::span(feet_).subspan(begin_ * legs_.size(), layout_.frames() * legs_.size());
    cutsHere_ = partsCuts();
    startFrom();
    LeastChanges least(layout_, {feetHere_.begin(), feetHere_.end()}, cutsHere_, ends);
    const double before = ratio(now_.paths);
    if (!ends.startsJoined && !ends.endsJoined) solveAll();
    double rough = ratio(now_.paths);
    const double longest = kSmoothing.maxFrames * source_.frameSeconds;
    Step step = Step::kTaken;
    for (double seconds = kSmoothing.shortest;
         seconds < longest && rough > kSmoothing.jerkLimit && step != Step::kTooFar; seconds *= kSmoothing.longer) {
      if (step == Step::kTaken) {
        moved_.findSlopes(layout_, kSmoothing.probe, now_);
        least.start(now_);
      }
      step = goTowards(least.find(smoothnessWeight(seconds, source_.frameSeconds)), rough);
    }
    if (!(rough < before)) return;
    for (std::size_t f = 0; f < layout_.frames(); ++f) moved_.pose(layout_, now_.changes, f, target_.poses[begin_ + f]);
  }

  void startFrom() {
    moved_.clear();
    moved_.solveAll(false);
    for (std::size_t f = begin_; f < begin_ + layout_.frames(); ++f) moved_.add(globalsAt(f));
    now_.changes.assign(layout_.frames() * layout_.perFrame(), 0.0);
    moved_.follow(layout_, now_.changes, feetHere_, now_.paths);
    stillJerk_ = std::max(partsJerk_ - squaredJerk(now_.paths, cutsHere_, 3, layout_.frames()), 0.0);
  }

  // A leg that is solved once more may bend a little elsewhere, whatever its change: all are, so that changes alone
  // make the difference. Not where other parts follow, which may stay as they are.
  void solveAll() {
    moved_.solveAll(true);
    if (moved_.follow(layout_, now_.changes, feetHere_, trialPaths_)) {
      now_.paths.swap(trialPaths_);
    } else {
      moved_.solveAll(false);
    }
  }

  // kTooFar: even a small fraction of the step. With a greater weight of jerk it is further.
  enum class Step { kTaken, kRefused, kTooFar };

  // As far as it gets less rough.
  Step goTowards(const Changes& aim, double& rough) {
    double fraction = 1;
    bool isNear = false;
    for (int i = 0; i < kSmoothing.halvings; ++i, fraction /= 2) {
      Changes trial = now_.changes;
      for (std::size_t k = 0; k < trial.size(); ++k) trial[k] += fraction * (aim[k] - trial[k]);
      isNear = furthest(trial) <= kSmoothing.furthest;
      if (!isNear) continue;
      if (!moved_.follow(layout_, trial, feetHere_, trialPaths_)) continue;
      const double now = ratio(trialPaths_);
      if (!(now < rough)) continue;
      rough = now;
      now_.changes = std::move(trial);
      now_.paths.swap(trialPaths_);
      return Step::kTaken;
    }
    return isNear ? Step::kRefused : Step::kTooFar;
  }

  double furthest(const Changes& changes) const {
    if (!std::all_of(changes.begin(), changes.end(), [](double change) { return std::isfinite(change); }))
      return HUGE_VAL;
    double most = 0;
    for (std::size_t f = 0; f < layout_.frames(); ++f) {
      most = std::max(most, displacementAt(changes, layout_.pelvis(f)).norm());
      for (std::size_t i = 0; i < legs_.size(); ++i)
        most = std::max(most, displacementAt(changes, layout_.foot(f, i)).norm());
      if (layout_.tilts()) most = std::max(most, std::abs(changes[layout_.shoulders(f)]));
    }
    return most;
  }

  const RetargetSetup& setup_;
  RootPositioner root_;
  LimbGoals goals_;
  const std::vector<LegSpec> legs_;
  const TrunkTilt& trunk_;
  MovedLegs moved_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::vector<Path> sourcePaths_;
  std::vector<bool> cuts_;
  bool loops_ = false;
  std::vector<FootFrame> feet_;  // of each frame, of each leg; empty until they are needed
  // Of the part that is smoothed.
  std::size_t begin_ = 0;
  ChangeLayout layout_;
  std::span<const FootFrame> feetHere_;
  std::vector<bool> cutsHere_;
  double sourceJerk_ = 0, partsJerk_ = 0;  // squared, before any changes
  double stillJerk_ = 0;                   // of what changes do not move
  ChangedMotion now_;
  std::vector<Path> trialPaths_;
  Pose pose_;
  BodyFrame frame_;
};

}  // namespace

void smoothMotion(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  if (hasLegs(setup)) MotionSmoother(setup, source, target).run();
}

}  // namespace limber
