#include "limber/retarget/even_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "limber/limbs/limb_goals.h"
#include "limber/limbs/limb_reach.h"
#include "limber/limbs/roughness.h"
#include "limber/retarget/aligned.h"
#include "limber/retarget/band_matrix.h"

namespace limber {

namespace {

constexpr double kEven = 1.08;  // jerk, times the source's
constexpr std::size_t kPartFrames = 1000;
constexpr std::size_t kJoinedFrames = 3;  // at whose both ends nothing changes: third differences reach no further
constexpr double kLoops = 0.02;           // of a limb's bones, between the directions in the first and the last frame
// Of what has to hold, against changes in hip heights: feet that stand, bounds, and frames that do not change.
constexpr double kFirmWeight = 1e8;
constexpr double kFirmUpTo = 1e6;  // the weight of jerk; it is more for more
// Jerk counts as for changes that come and go in that time, seconds; ever longer until the motion is even.
constexpr double kShortest = 0.007, kLongest = 1, kLonger = 1.2;
constexpr double kFramesApart = 30;  // likewise, frames: weights of any size cannot be told apart
// A foot of the source stands that is as low and as slow, hip heights (a second), seen over the step to a frame.
constexpr double kLow = 0.05, kSlow = 0.15;
constexpr double kProbe = 1e-4;     // hip heights, to see how the bones follow a foot
constexpr double kMissed = 1e-3;    // likewise, by a foot that stands and that its leg does not reach
constexpr double kTooFar = 1e-5;    // likewise
constexpr double kFurthest = 0.3;   // hip heights, of any change
constexpr double kStretch = 0.998;  // of a leg's length
constexpr int kBoundRounds = 6, kHalvings = 4;
constexpr std::array<double, 4> kThird = {-1, 3, -3, 1};

// What has to hold for a foot in one frame.
struct FootFrame {
  bool stands = false;
  double lowest = 0;        // change of its height, at most 0: hip heights
  Vec3 way = Vec3::Zero();  // from the hip, likewise
  double most = 0;          // that its leg reaches, likewise
};

// Which of its bounds keep it.
struct Held {
  bool up = false, near = false;
};

// The frames [begin, end) of a motion that are evened together.
struct Part {
  std::size_t begin = 0, end = 0;
  bool startsJoined = false, endsJoined = false;  // to frames that stay

  std::size_t frames() const { return end - begin; }
};

class Evener {
 public:
  Evener(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup),
        root_(setup),
        goals_(setup, root_),
        reach_(setup, root_),
        legs_(goals_.legs()),
        source_(source),
        target_(target) {
    findBones();
  }

  void run() {
    if (!goals_.active() || legs_.empty() || target_.poses.size() < 5) return;
    traceSource();
    const std::size_t frames = target_.poses.size(), count = (frames + kPartFrames - 1) / kPartFrames;
    for (std::size_t i = 0; i < count; ++i) {
      const bool closes = loops_ && count > 1;
      part_ = {i * frames / count, (i + 1) * frames / count, i > 0 || closes, i + 1 < count || closes};
      changes_.assign(part_.frames() * unknowns(), 0.0);
      held_.assign(part_.frames() * legs_.size(), Held{});
      paths_ = pathsOf(changes_);
      if (ratio(paths_) <= kEven) continue;
      if (feet_.empty()) senseFeet();
      evenPart();
    }
  }

 private:
  // Of each frame: of the pelvis, of each foot, and how far the shoulders rise where the trunk tilts; hip heights.
  using Changes = std::vector<double>;

  using Slope = Eigen::Matrix<double, 3, 4>;  // by the foot's place and by the tilt

  // A leg's two bones among the paths.
  struct Bones {
    std::size_t leg = 0, first = 0;
  };

  std::size_t unknowns() const { return tilt() + (trunk().tilts() ? 1 : 0); }
  std::size_t unknown(std::size_t frame, std::size_t what) const { return frame * unknowns() + 3 * what; }
  std::size_t tilt() const { return 3 * (1 + legs_.size()); }
  const TrunkTilt& trunk() const { return goals_.pelvis().trunk(); }
  bool isTilted(std::size_t leg) const { return trunk().isFore(legs_[leg].upper); }
  Vec3 changeOf(const Changes& changes, std::size_t frame, std::size_t what) const {
    const std::size_t i = unknown(frame, what);
    return setup_.targetHipHeight * Vec3(changes[i], changes[i + 1], changes[i + 2]);
  }

  void findBones() {
    std::size_t path = 1;
    for (const LimbPair& limb : limbPairs(setup_)) {
      for (std::size_t i = 0; i < legs_.size() && limb.target.size() == 3; ++i) {
        if (legs_[i].upper == limb.target.front() && legs_[i].end == limb.target.back()) bones_.push_back({i, path});
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

  // As the methods saw them, and with what comes.
  void senseFeet() {
    AlignedRetargeter aligned(setup_);
    Pose pose = restPose(*setup_.target);
    BodyFrame frame;
    std::vector<Vec3> before(legs_.size());
    for (std::size_t f = 0; f < target_.poses.size(); ++f) {
      const double seconds = f == 0 ? 0 : source_.frameSeconds;
      aligned.next(source_.poses[f], seconds, pose);
      goals_.calm(aligned.sourceFrame(), seconds, pose, aligned.targetFrame());
      setup_.targetKinematics.globals(target_.poses[f], frame);
      for (std::size_t i = 0; i < legs_.size(); ++i) {
        const Leg& leg = legs_[i];
        const Vec3& place = aligned.sourceFrame().positions[leg.sourceEnd];
        const bool slow = f > 0 && (place - before[i]).norm() < kSlow * seconds * setup_.sourceHipHeight;
        const bool low = place.y() - leg.sourceAnkleGround < kLow * setup_.sourceHipHeight;
        feet_.push_back(footIn(frame, leg));
        feet_.back().stands = leg.anchor != FootAnchor::kNone || (slow && low);
        before[i] = place;
      }
    }
  }

  FootFrame footIn(const BodyFrame& frame, const Leg& leg) const {
    const double unit = 1 / setup_.targetHipHeight;
    FootFrame foot;
    foot.lowest = unit * std::min(lowestOf(leg, frame) - frame.positions[leg.end].y(), 0.0);
    foot.way = unit * (frame.positions[leg.end] - frame.positions[leg.upper]);
    foot.most = std::max(unit * kStretch * leg.length, foot.way.norm());
    return foot;
  }

  // Height of the ankle at which one end of the foot is on the ground.
  static double lowestOf(const Leg& leg, const BodyFrame& frame) {
    const auto over = [&](Index toes) { return frame.positions[toes].y() - frame.positions[leg.end].y(); };
    const std::optional<Index> toes = leg.toes ? leg.toes : leg.tip;
    return toes ? std::max(leg.ankleGround, leg.toesGround - over(*toes)) : leg.ankleGround;
  }
  const FootFrame& foot(std::size_t frame, std::size_t leg) const {
    return feet_[(part_.begin + frame) * legs_.size() + leg];
  }

  // One frame of the part, changed.
  void apply(const Changes& changes, std::size_t frame, Pose& pose) {
    setup_.targetKinematics.globals(pose, frame_);
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      legs_[i].goal = frame_.positions[legs_[i].end] + changeOf(changes, frame, i + 1);
      legs_[i].turn = Quat::Identity();
    }
    root_.movePelvis(changeOf(changes, frame, 0), pose, frame_);
    if (trunk().tilts()) {
      const double rise = setup_.targetHipHeight * changes[unknown(frame, 0) + tilt()];
      root_.turnPelvis(trunk().turnFor(rise, frame_), pose, frame_);
    }
    for (std::size_t i = 0; i < legs_.size(); ++i) {
      if (LimbReach::isThere(legs_[i], frame_)) continue;
      reach_.reach(legs_[i], &legs_[i].kneeAhead, frame_, pose);
      const double missed = (legs_[i].goal - frame_.positions[legs_[i].end]).norm() / setup_.targetHipHeight;
      if (foot(frame, i).stands) missed_ = std::max(missed_, missed);
    }
  }

  std::vector<Path> pathsOf(const Changes& changes) {
    BodyPaths body(setup_, MapSide::kTarget);
    missed_ = 0;
    for (std::size_t f = 0; f < part_.frames(); ++f) {
      pose_ = target_.poses[part_.begin + f];
      apply(changes, f, pose_);
      body.add(frame_.positions);
    }
    return body.paths();
  }

  // Of the part's frames but for the first three.
  double ratio(const std::vector<Path>& paths) const {
    const std::vector<bool> cuts(cuts_.begin() + static_cast<std::ptrdiff_t>(part_.begin),
                                 cuts_.begin() + static_cast<std::ptrdiff_t>(part_.end));
    return jerkRatio(squaredJerk(sourcePaths_, cuts_, part_.begin + 3, part_.end),
                     squaredJerk(paths, cuts, 3, cuts.size()), part_.frames());
  }

  void evenPart() {
    double rough = ratio(paths_);
    const double longest = std::min(kLongest, kFramesApart * source_.frameSeconds);
    for (double seconds = kShortest; seconds < longest && rough > kEven; seconds *= kLonger) {
      const Changes aim = smoothest(std::pow(seconds / source_.frameSeconds, 6));
      double step = 1;
      for (int i = 0; i < kHalvings; ++i, step /= 2) {
        Changes trial = changes_;
        for (std::size_t k = 0; k < trial.size(); ++k) trial[k] += step * (aim[k] - trial[k]);
        if (furthest(trial) > kFurthest) continue;
        const std::vector<Path> paths = pathsOf(trial);
        const double now = ratio(paths);
        if (now >= rough || missed_ > kMissed) continue;
        rough = now;
        changes_ = trial;
        paths_ = paths;
        break;
      }
    }
    for (std::size_t f = 0; f < part_.frames(); ++f) apply(changes_, f, target_.poses[part_.begin + f]);
  }

  double furthest(const Changes& changes) const {
    double most = 0;
    for (std::size_t f = 0; f < part_.frames(); ++f) {
      for (std::size_t what = 0; what <= legs_.size(); ++what) {
        most = std::max(most, changeOf(changes, f, what).norm() / setup_.targetHipHeight);
      }
      if (trunk().tilts()) most = std::max(most, std::abs(changes[unknown(f, 0) + tilt()]));
    }
    return most;
  }

  // The changes of the least sum, to first order about those that are.
  Changes smoothest(double jerkWeight) {
    const double firm = kFirmWeight * std::max(1.0, jerkWeight / kFirmUpTo);
    BandLeastSquares free(changes_.size(), 4 * unknowns() - 1);
    holdFeet(firm, free);
    addJerk(jerkWeight, free);
    Changes changes = changes_;
    int round = 0;
    do {
      BandLeastSquares squares = free;
      holdBounds(firm, changes, squares);
      changes = squares.solve();
      if (loops_ && !part_.startsJoined) closeLoop(100 * firm, changes, squares);
    } while (findBounds(changes) && ++round < kBoundRounds);
    return changes;
  }

  void holdFeet(double firm, BandLeastSquares& squares) const {
    using Term = BandLeastSquares::Term;
    for (std::size_t f = 0; f < part_.frames(); ++f) {
      const double weight = isPinned(f) ? firm : 1;
      for (std::size_t i = unknown(f, 0); i < unknown(f + 1, 0); ++i) squares.add(std::array{Term{i, 1}}, 0, weight);
      if (f == 0 || cuts_[part_.begin + f]) continue;
      for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
        if (!foot(f, leg).stands && !foot(f - 1, leg).stands) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::array step = {Term{unknown(f, leg + 1) + axis, 1}, Term{unknown(f - 1, leg + 1) + axis, -1}};
          squares.add(step, 0, firm);
        }
      }
    }
  }

  bool isPinned(std::size_t frame) const {
    return (part_.startsJoined && frame < kJoinedFrames) ||
           (part_.endsJoined && part_.frames() - 1 - frame < kJoinedFrames);
  }

  // The first frame changes as the last one does: both halfway between what they would.
  void closeLoop(double weight, Changes& changes, BandLeastSquares& squares) const {
    const std::size_t last = unknown(part_.frames() - 1, 0);
    for (std::size_t i = 0; i < unknowns(); ++i) {
      const double middle = (changes[i] + changes[last + i]) / 2;
      squares.add(std::array{BandLeastSquares::Term{i, 1}}, middle, weight);
      squares.add(std::array{BandLeastSquares::Term{last + i, 1}}, middle, weight);
    }
    changes = squares.solve();
  }

  // Adds what `changes` do not keep to and what they did not keep to before: feet above their lowest, and within their
  // legs' reach. False where there is nothing new.
  bool findBounds(const Changes& changes) {
    bool more = false;
    for (std::size_t f = 0; f < part_.frames(); ++f) {
      for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
        const FootFrame& bounds = foot(f, leg);
        Held& held = held_[f * legs_.size() + leg];
        const bool under = changes[unknown(f, leg + 1) + 1] < bounds.lowest - kTooFar;
        const bool beyond = wayOf(changes, f, leg).norm() > bounds.most + kTooFar;
        more = more || (under && !held.up) || (beyond && !held.near);
        held.up = held.up || under;
        held.near = held.near || beyond;
      }
    }
    return more;
  }

  void holdBounds(double weight, const Changes& about, BandLeastSquares& squares) const {
    using Term = BandLeastSquares::Term;
    for (std::size_t f = 0; f < part_.frames(); ++f) {
      for (std::size_t leg = 0; leg < legs_.size(); ++leg) {
        const FootFrame& bounds = foot(f, leg);
        const Held& held = held_[f * legs_.size() + leg];
        const std::size_t hip = unknown(f, 0), end = unknown(f, leg + 1);
        if (held.up) squares.add(std::array{Term{end + 1, 1}}, bounds.lowest, weight);
        if (!held.near) continue;
        std::vector<Term> along;
        const Vec3 line = wayOf(about, f, leg).normalized();
        for (std::size_t a = 0; a < 3; ++a) {
          along.push_back({hip + a, -line[static_cast<Eigen::Index>(a)]});
          along.push_back({end + a, line[static_cast<Eigen::Index>(a)]});
        }
        if (isTilted(leg)) along.push_back({hip + tilt(), -line.y()});
        squares.add(along, bounds.most - line.dot(bounds.way), weight);
      }
    }
  }

  // From the hip to the foot: hip heights.
  Vec3 wayOf(const Changes& changes, std::size_t frame, std::size_t leg) const {
    Vec3 way = foot(frame, leg).way +
               (changeOf(changes, frame, leg + 1) - changeOf(changes, frame, 0)) / setup_.targetHipHeight;
    if (isTilted(leg)) way.y() -= changes[unknown(frame, 0) + tilt()];
    return way;
  }

  void addJerk(double weight, BandLeastSquares& squares) {
    const std::vector<std::array<Slope, 2>> slopes = slopesOfBones();
    std::vector<BandLeastSquares::Term> terms;
    for (std::size_t f = 3; f < part_.frames(); ++f) {
      if (!isWhole(cuts_, part_.begin + f)) continue;
      const Vec3 pelvis = thirdDifference(paths_[0], f);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        terms.clear();
        for (std::size_t t = 0; t < 4; ++t) terms.push_back({unknown(f - 3 + t, 0) + axis, kThird[t]});
        addThird(pelvis, axis, terms, weight, squares);
      }
      for (std::size_t b = 0; b < bones_.size(); ++b) {
        for (std::size_t bone = 0; bone < 2; ++bone) {
          const Vec3 rough = thirdDifference(paths_[bones_[b].first + bone], f);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            terms.clear();
            for (std::size_t t = 0; t < 4; ++t) {
              const Slope& slope = slopes[(f - 3 + t) * bones_.size() + b][bone];
              addBone(f - 3 + t, bones_[b].leg, kThird[t] * slope.row(static_cast<Eigen::Index>(axis)), terms);
            }
            addThird(rough, axis, terms, weight, squares);
          }
        }
      }
    }
  }

  // It turns by the foot's way against the hip.
  void addBone(std::size_t frame, std::size_t leg, const Eigen::RowVector4d& slope,
               std::vector<BandLeastSquares::Term>& terms) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double value = slope[static_cast<Eigen::Index>(axis)];
      terms.push_back({unknown(frame, 0) + axis, -value});
      terms.push_back({unknown(frame, leg + 1) + axis, value});
    }
    if (isTilted(leg)) terms.push_back({unknown(frame, 0) + tilt(), slope[3]});
  }

  // One axis of a third difference as the changes would have it; it is `now`.
  void addThird(const Vec3& now, std::size_t axis, const std::vector<BandLeastSquares::Term>& terms, double weight,
                BandLeastSquares& squares) const {
    double changed = -now[static_cast<Eigen::Index>(axis)];
    for (const BandLeastSquares::Term& term : terms) changed += term.factor * changes_[term.unknown];
    squares.add(terms, changed, weight);
  }

  // Of every leg's bones by the place of its foot and by the tilt, frame by frame: hip heights.
  std::vector<std::array<Slope, 2>> slopesOfBones() {
    std::vector<std::array<Slope, 2>> slopes(part_.frames() * bones_.size(), {Slope::Zero(), Slope::Zero()});
    for (std::size_t axis = 0; axis < (trunk().tilts() ? 4 : 3); ++axis) {
      Changes probed = changes_;
      for (std::size_t f = 0; f < part_.frames(); ++f) {
        for (std::size_t leg = 0; leg < legs_.size() && axis < 3; ++leg) probed[unknown(f, leg + 1) + axis] += kProbe;
        if (axis == 3) probed[unknown(f, 0) + tilt()] += kProbe;
      }
      const std::vector<Path> there = pathsOf(probed);
      for (std::size_t i = 0; i < slopes.size(); ++i) {
        const std::size_t f = i / bones_.size(), path = bones_[i % bones_.size()].first;
        for (std::size_t bone = 0; bone < 2; ++bone) {
          slopes[i][bone].col(static_cast<Eigen::Index>(axis)) =
              (there[path + bone][f] - paths_[path + bone][f]) / kProbe;
        }
      }
    }
    return slopes;
  }

  const RetargetSetup& setup_;
  RootPlacer root_;
  LimbGoals goals_;
  LimbReach reach_;
  std::vector<Leg>& legs_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::vector<Bones> bones_;
  std::vector<Path> sourcePaths_;
  std::vector<bool> cuts_;
  bool loops_ = false;
  std::vector<FootFrame> feet_;  // of each frame, of each leg; empty until they are needed
  Part part_;
  Changes changes_;
  std::vector<Held> held_;   // of each frame of the part, of each leg
  std::vector<Path> paths_;  // of the part with these changes
  double missed_ = 0;        // at most in pathsOf(), by a foot that stands
  Pose pose_;
  BodyFrame frame_;
};

}  // namespace

void evenOut(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  if (setup.person || !setup.animalLegs.empty()) Evener(setup, source, target).run();
}

}  // namespace limber
