#include "limber/retarget/even_out.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "limber/limbs/limb_goals.h"
#include "limber/limbs/limb_reach.h"
#include "limber/retarget/aligned.h"
#include "limber/retarget/even_changes.h"

namespace limber {

namespace {

constexpr double kEven = 1.08;  // jerk, times the source's
constexpr std::size_t kPartFrames = 1000;
constexpr double kLoops = 0.02;  // of a limb's bones, between the directions in the first and the last frame
// Jerk counts as for changes that come and go in that time, seconds; ever longer until the motion is even. And that
// many frames: longer ones leave sums whose weights cannot be told apart.
constexpr double kShortest = 0.007, kLongest = 1, kLonger = 1.2, kMostFrames = 30;
// A foot of the source stands that is as low and as slow, hip heights (a second), seen over the step to a frame.
constexpr double kLow = 0.05, kSlow = 0.15;
// Hip heights: to see how the bones follow a foot; of a foot that stands and that its leg does not reach; of any
// change.
constexpr double kProbe = 1e-4, kMissed = 1e-3, kFurthest = 0.3;
constexpr double kStretch = 0.998;  // of a leg's length
constexpr int kHalvings = 4;

class Evener {
 public:
  Evener(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup),
        root_(setup),
        goals_(setup, root_),
        reach_(setup, root_),
        legs_(goals_.legs()),
        trunk_(goals_.pelvis().trunk()),
        source_(source),
        target_(target) {}

  void run() {
    const std::size_t frames = target_.poses.size(), parts = (frames + kPartFrames - 1) / kPartFrames;
    if (!goals_.active() || legs_.empty() || frames < 5) return;
    for (const Leg& leg : legs_) layout_.tilted.push_back(trunk_.isFore(leg.upper));
    findBones();
    traceSource();
    for (std::size_t i = 0; i < parts; ++i) {
      const std::size_t end = (i + 1) * frames / parts;
      begin_ = i * frames / parts;
      layout_.frames = end - begin_;
      solvesAll_ = false;
      now_.changes.assign(layout_.frames * layout_.perFrame(), 0.0);
      now_.paths = pathsOf(now_.changes);
      if (ratio(now_.paths) <= kEven) continue;
      const bool closes = loops_ && parts > 1;
      evenPart({i > 0 || closes, i + 1 < parts || closes, loops_ && parts == 1});
    }
  }

 private:
  void findBones() {
    std::size_t path = 1;
    for (const LimbPair& limb : limbPairs(setup_)) {
      for (std::size_t i = 0; i < legs_.size() && limb.target.size() == 3; ++i) {
        if (legs_[i].upper != limb.target.front() || legs_[i].end != limb.target.back()) continue;
        now_.bones.push_back({i, path, {}});
      }
      path += limb.target.empty() ? 0 : limb.target.size() - 1;
    }
  }

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
                         [](const Path& path) { return (path.back() - path.front()).norm() < kLoops; });
  }

  // Of the whole motion, as the methods saw them, and with what comes.
  void senseFeet() {
    AlignedRetargeter aligned(setup_);
    Pose pose = restPose(*setup_.target);
    std::vector<Vec3> before(legs_.size());
    for (std::size_t f = 0; f < target_.poses.size(); ++f) {
      const double seconds = f == 0 ? 0 : source_.frameSeconds;
      aligned.next(source_.poses[f], seconds, pose);
      goals_.calm(aligned.sourceFrame(), seconds, pose, aligned.targetFrame());
      setup_.targetKinematics.globals(target_.poses[f], frame_);
      for (std::size_t i = 0; i < legs_.size(); ++i) {
        const Leg& leg = legs_[i];
        const Vec3& place = aligned.sourceFrame().positions[leg.sourceEnd];
        const bool slow = f > 0 && (place - before[i]).norm() < kSlow * seconds * setup_.sourceHipHeight;
        const bool low = place.y() - leg.sourceAnkleGround < kLow * setup_.sourceHipHeight;
        feet_.push_back(boundsOf(leg));
        feet_.back().stands = leg.anchor != FootAnchor::kNone || (slow && low);
        before[i] = place;
      }
    }
  }

  FootFrame boundsOf(const Leg& leg) const {
    const double unit = 1 / setup_.targetHipHeight;
    const Vec3& end = frame_.positions[leg.end];
    const std::optional<Index> toes = leg.toes ? leg.toes : leg.tip;
    double ground = leg.ankleGround;
    if (toes) ground = std::max(ground, leg.toesGround - (frame_.positions[*toes] - end).y());
    FootFrame foot;
    foot.lowest = unit * std::min(ground - end.y(), 0.0);
    foot.way = unit * (end - frame_.positions[leg.upper]);
    foot.most = std::max(unit * kStretch * leg.length, foot.way.norm());
    return foot;
  }

  // One frame of the part, changed. Returns how far the feet that stand are from where they have to be, hip heights.
  double apply(const Changes& changes, std::size_t frame, Pose& pose) {
    const double unit = setup_.targetHipHeight;
    setup_.targetKinematics.globals(pose, frame_);
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      legs_[i].goal = frame_.positions[legs_[i].end] + unit * wayAt(changes, layout_.foot(frame, i));
      legs_[i].turn = Quat::Identity();
    }
    root_.movePelvis(unit * wayAt(changes, layout_.pelvis(frame)), pose, frame_);
    if (layout_.tilts()) {
      root_.turnPelvis(trunk_.turnFor(unit * changes[layout_.shoulders(frame)], frame_), pose, frame_);
    }
    double missed = 0;
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      if (!solvesAll_ && LimbReach::isThere(legs_[i], frame_)) continue;
      reach_.reach(legs_[i], &legs_[i].kneeAhead, frame_, pose);
      if (feet_.empty() || !feet_[(begin_ + frame) * legs_.size() + i].stands) continue;
      missed = std::max(missed, (legs_[i].goal - frame_.positions[legs_[i].end]).norm() / unit);
    }
    return missed;
  }

  // None where feet that stand do not reach their places.
  std::vector<Path> pathsOf(const Changes& changes) {
    BodyPaths body(setup_, MapSide::kTarget);
    for (std::size_t f = 0; f < layout_.frames; ++f) {
      pose_ = target_.poses[begin_ + f];
      if (apply(changes, f, pose_) > kMissed) return {};
      body.add(frame_.positions);
    }
    return body.paths();
  }

  std::vector<bool> partsCuts() const {
    const auto begin = cuts_.begin() + static_cast<std::ptrdiff_t>(begin_);
    return {begin, begin + static_cast<std::ptrdiff_t>(layout_.frames)};
  }

  // Of the part's frames but for the first three.
  double ratio(const std::vector<Path>& paths) const {
    return jerkRatio(squaredJerk(sourcePaths_, cuts_, begin_ + 3, begin_ + layout_.frames),
                     squaredJerk(paths, partsCuts(), 3, layout_.frames), layout_.frames);
  }

  void evenPart(const MotionEnds& ends) {
    if (feet_.empty()) senseFeet();
    const auto first = feet_.begin() + static_cast<std::ptrdiff_t>(begin_ * legs_.size());
    LeastChanges least(layout_, {first, first + static_cast<std::ptrdiff_t>(layout_.frames * legs_.size())},
                       partsCuts(), ends);
    const double before = ratio(now_.paths);
    if (!ends.startsJoined && !ends.endsJoined) solveAll();
    double rough = ratio(now_.paths);
    const double longest = std::min(kLongest, kMostFrames * source_.frameSeconds);
    for (double seconds = kShortest; seconds < longest && rough > kEven; seconds *= kLonger) {
      findSlopes();
      goTowards(least.find(now_, std::pow(seconds / source_.frameSeconds, 6)), rough);
    }
    if (!(rough < before)) return;
    for (std::size_t f = 0; f < layout_.frames; ++f) apply(now_.changes, f, target_.poses[begin_ + f]);
  }

  // A leg that is solved once more may bend a little elsewhere, whatever its change: all are, so that changes alone
  // make the difference. Not where other parts follow, which may stay as they are.
  void solveAll() {
    solvesAll_ = true;
    std::vector<Path> paths = pathsOf(now_.changes);
    solvesAll_ = !paths.empty();
    if (solvesAll_) now_.paths = std::move(paths);
  }

  // As far as it gets less rough.
  void goTowards(const Changes& aim, double& rough) {
    double step = 1;
    for (int i = 0; i < kHalvings; ++i, step /= 2) {
      Changes trial = now_.changes;
      for (std::size_t k = 0; k < trial.size(); ++k) trial[k] += step * (aim[k] - trial[k]);
      if (!(furthest(trial) <= kFurthest)) continue;
      std::vector<Path> paths = pathsOf(trial);
      const double now = paths.empty() ? rough : ratio(paths);
      if (!(now < rough)) continue;
      rough = now;
      now_.changes = std::move(trial);
      now_.paths = std::move(paths);
      return;
    }
  }

  double furthest(const Changes& changes) const {
    if (!std::all_of(changes.begin(), changes.end(), [](double change) { return std::isfinite(change); }))
      return HUGE_VAL;
    double most = 0;
    for (std::size_t f = 0; f < layout_.frames; ++f) {
      most = std::max(most, wayAt(changes, layout_.pelvis(f)).norm());
      for (std::size_t i = 0; i < legs_.size(); ++i) most = std::max(most, wayAt(changes, layout_.foot(f, i)).norm());
      if (layout_.tilts()) most = std::max(most, std::abs(changes[layout_.shoulders(f)]));
    }
    return most;
  }

  void findSlopes() {
    for (BonePair& pair : now_.bones)
      pair.slopes.fill(std::vector(layout_.frames, BonePair::Slope(BonePair::Slope::Zero())));
    for (std::size_t column = 0; column < (layout_.tilts() ? 4 : 3); ++column) {
      Changes probed = now_.changes;
      for (std::size_t f = 0; f < layout_.frames; ++f) {
        for (std::size_t i = 0; i < legs_.size() && column < 3; ++i) probed[layout_.foot(f, i) + column] += kProbe;
        if (column == 3) probed[layout_.shoulders(f)] += kProbe;
      }
      const std::vector<Path> there = pathsOf(probed);
      if (there.empty()) continue;
      for (BonePair& pair : now_.bones) {
        for (std::size_t bone = 0; bone < 2; ++bone) {
          const Path &from = now_.paths[pair.firstPath + bone], &to = there[pair.firstPath + bone];
          for (std::size_t f = 0; f < layout_.frames; ++f) {
            pair.slopes[bone][f].col(static_cast<Eigen::Index>(column)) = (to[f] - from[f]) / kProbe;
          }
        }
      }
    }
  }

  const RetargetSetup& setup_;
  RootPlacer root_;
  LimbGoals goals_;
  LimbReach reach_;
  std::vector<Leg>& legs_;
  const TrunkTilt& trunk_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::vector<Path> sourcePaths_;
  std::vector<bool> cuts_;
  bool loops_ = false;
  std::vector<FootFrame> feet_;  // of each frame, of each leg; empty until they are needed
  // Of the part that is evened.
  std::size_t begin_ = 0;
  bool solvesAll_ = false;
  ChangeLayout layout_;
  ChangedMotion now_;
  Pose pose_;
  BodyFrame frame_;
};

}  // namespace

void evenOut(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  if (hasLegs(setup)) Evener(setup, source, target).run();
}

}  // namespace limber
