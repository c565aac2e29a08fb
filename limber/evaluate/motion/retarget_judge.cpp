#include "limber/evaluate/motion/retarget_judge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/motion/limbs/roughness.h"

namespace limber {

namespace {

constexpr double kNear = 0.13;          // heights: a hand's joint this near to a bone or to the other hand may touch
constexpr double kAround = 0.1;         // seconds before and after a contact begins or ends
constexpr double kSlackSeconds = 0.05;  // by which contacts may begin and end elsewhere and still agree
constexpr double kSpeedSeconds = 1.0 / 30;  // to each side of a frame, over which a speed is seen
constexpr double kPeakFraction = 0.999;
constexpr double kStillJerk = 2e-5;  // heights, a third difference: what is smoother counts as this rough

// Of one skeleton, frame by frame.
struct JudgedBody {
  JudgedBody(const RetargetSetup& setup, MapSide side, const PoseSequence& frames)
      : height(standingHeight(setup, side)) {
    const bool isSource = side == MapSide::kSource;
    const BodyKinematics& kinematics = isSource ? setup.sourceKinematics : setup.targetKinematics;
    BodyFrame frame;
    for (const Pose& pose : frames.poses) {
      kinematics.globals(pose, frame);
      positions.push_back(frame.positions);
      for (Vec3& position : positions.back()) position /= height;
    }
  }
  const Vec3& at(std::size_t frame, Index joint) const { return positions[frame][joint]; }

  double height;                             // metres
  std::vector<std::vector<Vec3>> positions;  // of each frame, #J, heights
};

double rootMeanSquare(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return values.empty() ? 0 : std::sqrt(sum / static_cast<double>(values.size()));
}

double exceededBy(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto rank = values.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), rank, values.end());
  return *rank;
}

double overReference(double value, double reference) {
  return std::max(value, kStillJerk) / std::max(reference, kStillJerk);
}

struct FootPoints {
  std::vector<Index> source, target;
};

// The points that feet stand on, pairwise.
FootPoints footPoints(const RetargetSetup& setup) {
  if (setup.person) return {soleJoints(setup.map, MapSide::kSource), soleJoints(setup.map, MapSide::kTarget)};
  FootPoints joints;
  for (const AnimalLeg& leg : setup.animalLegs) {
    joints.source.push_back(leg.source.end);
    joints.target.push_back(leg.target.end);
    if (!leg.source.toes || !leg.target.toes) continue;
    joints.source.push_back(*leg.source.toes);
    joints.target.push_back(*leg.target.toes);
  }
  return joints;
}

class Judge {
 public:
  Judge(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& aligned, const PoseSequence& result)
      : setup_(setup),
        source_(setup, MapSide::kSource, source),
        aligned_(setup, MapSide::kTarget, aligned),
        result_(setup, MapSide::kTarget, result),
        seconds_(source.frameSeconds),
        limbs_(limbPairs(setup)),
        cuts_(source_.positions.size(), false) {
    std::erase_if(limbs_, [](const LimbPair& limb) { return limb.source.size() < 2; });
    for (std::size_t f = 1; f < count(); ++f) {
      cuts_[f] = std::any_of(setup.map.matches.begin(), setup.map.matches.end(), [&](const JointMatch& match) {
        const Index joint = match.source.front();
        return (source_.at(f, joint) - source_.at(f - 1, joint)).norm() > kCut * seconds_;
      });
    }
  }

  RetargetVerdict verdict() {
    RetargetVerdict verdict;
    judgeSmoothness(verdict);
    judgeContacts(verdict);
    judgeBones(verdict);
    return verdict;
  }

 private:
  static constexpr double kCut = 12;  // heights a second: no motion but a cut

  std::size_t count() const { return source_.positions.size(); }
  bool isWhole(std::size_t f, std::size_t back) const {
    for (std::size_t i = 0; i < back; ++i) {
      if (cuts_[f - i]) return false;
    }
    return true;
  }

  std::vector<double> jerks(const JudgedBody& seen) const {
    std::vector<double> jerks;
    for (const LimbPair& limb : limbs_) {
      for (const Index joint : limb.target) {
        for (std::size_t f = 3; f < count(); ++f) {
          if (!isWhole(f, 3)) continue;
          const Vec3 third =
              seen.at(f, joint) - seen.at(f - 3, joint) - 3 * (seen.at(f - 1, joint) - seen.at(f - 2, joint));
          jerks.push_back(third.norm());
        }
      }
    }
    return jerks;
  }

  void judgeSmoothness(RetargetVerdict& verdict) const {
    const std::vector<double> reference = jerks(aligned_), own = jerks(result_);
    verdict.jerk = overReference(rootMeanSquare(own), rootMeanSquare(reference));
    verdict.jerkPeak = overReference(exceededBy(own, kPeakFraction), exceededBy(reference, kPeakFraction));
  }

  // Of a point, seen from where it is when standing.
  std::vector<bool> rests(const JudgedBody& seen, const NeutralPose& neutral, double ground, double lowest,
                          Index joint) const {
    std::vector<Vec3> path;
    std::vector<double> above;
    for (std::size_t f = 0; f < count(); ++f) {
      path.push_back(seen.at(f, joint));
      above.push_back(path.back().y() - (ground + neutral.positions[joint].y() - lowest) / seen.height);
    }
    return restingFrames(path, above, cuts_, seconds_);
  }

  void judgeContacts(RetargetVerdict& verdict) {
    const FootPoints points = footPoints(setup_);
    const auto slack = static_cast<std::size_t>(std::round(kSlackSeconds / seconds_));
    const auto reach = static_cast<std::size_t>(std::max(1.0, std::round(kSpeedSeconds / seconds_)));
    double slid = 0, sourceSlid = 0, frames = 0;
    std::vector<bool> changes(count(), false);
    for (std::size_t i = 0; i < points.source.size(); ++i) {
      const Index s = points.source[i], t = points.target[i];
      const std::vector<bool> meant = rests(source_, setup_.sourceNeutral, setup_.sourceGround, setup_.sourceLowest, s);
      verdict.contacts.count(meant, rests(result_, setup_.targetNeutral, setup_.targetGround, setup_.targetLowest, t),
                             slack);
      for (std::size_t f = 1; f < count(); ++f) changes[f] = changes[f] || meant[f] != meant[f - 1];
      for (std::size_t f = reach; f + reach < count(); ++f) {
        if (!meant[f - reach] || !meant[f] || !meant[f + reach]) continue;
        const auto speed = [&](const JudgedBody& seen, Index joint) {
          const Vec3 displacement = seen.at(f + reach, joint) - seen.at(f - reach, joint);
          return std::hypot(displacement.x(), displacement.z()) / (2 * static_cast<double>(reach) * seconds_);
        };
        slid += speed(result_, t);
        sourceSlid += speed(source_, s);
        ++frames;
      }
      standing_.push_back({s, meant});
    }
    verdict.sliding = frames > 0 ? slid / frames : 0;
    verdict.sourceSliding = frames > 0 ? sourceSlid / frames : 0;
    judgeImpacts(changes, verdict);
  }

  void judgeImpacts(const std::vector<bool>& changes, RetargetVerdict& verdict) const {
    const auto around = static_cast<std::size_t>(std::round(kAround / seconds_));
    std::vector<double> own, reference;
    for (std::size_t f = 2; f < count(); ++f) {
      bool isNear = false;
      for (std::size_t n = f > around ? f - around : 0; n <= std::min(f + around, count() - 1); ++n) {
        isNear = isNear || changes[n];
      }
      if (!isNear || !isWhole(f, 2)) continue;
      for (const LimbPair& limb : limbs_) {
        for (const Index joint : limb.target) {
          const auto second = [&](const JudgedBody& seen) {
            return (seen.at(f, joint) - 2 * seen.at(f - 1, joint) + seen.at(f - 2, joint)).norm();
          };
          own.push_back(second(result_));
          reference.push_back(second(aligned_));
        }
      }
    }
    verdict.impact = overReference(rootMeanSquare(own), rootMeanSquare(reference));
  }

  bool touches(const LimbPair& limb, std::size_t f) const {
    const Index end = limb.source.back();
    for (const auto& [joint, rests] : standing_) {
      if (joint == end && rests[f]) return true;
    }
    if (!setup_.person) return false;
    const auto isLimbs = [&](Index joint) {
      return std::find(limb.source.begin(), limb.source.end(), joint) != limb.source.end();
    };
    const Vec3& hand = source_.at(f, end);
    for (const LimbPair& other : limbs_) {
      for (std::size_t i = 1; i < other.source.size(); ++i) {
        if (isLimbs(other.source[i])) break;
        if (distance(hand, source_.at(f, other.source[i - 1]), source_.at(f, other.source[i])) < kNear) return true;
      }
    }
    const std::array<BodyPart, 3> line = {body_part::kPelvis, body_part::kNeck, body_part::kHead};
    for (std::size_t i = 1; i < line.size(); ++i) {
      const JointMatch *from = setup_.map.find(line[i - 1]), *to = setup_.map.find(line[i]);
      if (from && to && distance(hand, source_.at(f, from->source.front()), source_.at(f, to->source.back())) < kNear) {
        return true;
      }
    }
    return false;
  }

  static double distance(const Vec3& point, const Vec3& from, const Vec3& to) {
    const Vec3 line = to - from;
    const double along =
        line.squaredNorm() > 0 ? std::clamp((point - from).dot(line) / line.squaredNorm(), 0.0, 1.0) : 0;
    return (point - from - along * line).norm();
  }

  void judgeBones(RetargetVerdict& verdict) const {
    std::vector<double> angles;
    for (const LimbPair& limb : limbs_) {
      for (std::size_t f = 0; f < count(); ++f) {
        if (touches(limb, f)) continue;
        for (std::size_t i = 1; i < limb.target.size(); ++i) {
          const Index from = limb.target[i - 1], to = limb.target[i];
          const Vec3 one = aligned_.at(f, to) - aligned_.at(f, from), other = result_.at(f, to) - result_.at(f, from);
          angles.push_back(std::atan2(one.cross(other).norm(), one.dot(other)) * 180 / kPi);
        }
      }
    }
    verdict.bones95 = exceededBy(std::move(angles), 0.95);
  }

  const RetargetSetup& setup_;
  JudgedBody source_, aligned_, result_;
  double seconds_;
  std::vector<LimbPair> limbs_;
  std::vector<bool> cuts_;
  std::vector<std::pair<Index, std::vector<bool>>> standing_;  // the source's points that rest
};

}  // namespace

RetargetVerdict judgeRetargeting(const RetargetSetup& setup, const PoseSequence& source, const PoseSequence& aligned,
                                 const PoseSequence& result) {
  return Judge(setup, source, aligned, result).verdict();
}

}  // namespace limber
