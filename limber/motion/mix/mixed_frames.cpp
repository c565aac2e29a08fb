#include "limber/motion/mix/mixed_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limber/core/rotation.h"
#include "limber/motion/limbs/limb_reach.h"
#include "limber/skeleton/clip/clip_edit.h"

namespace limber {

namespace {

struct FootMixing {
  // Fraction of the longer of two spans; 0.2 to 0.55; by which they overlap where they are one contact: a walk's and a
  // run's do by 0.56 (measured).
  double together = 0.4;
  double counts = 0.2;        // weight; 0 to 0.5; from there on a motion says what is planted; set by hand
  double samePosition = 0.2;  // hip heights; 0.1 to 0.5; between a foot's positions, planted in both; set by hand
  double sameDirection = 1 - 1e-13;  // cosine of half an angle; 1 - 1e-10 to below 1; rounding only
};
constexpr FootMixing kFootMixing;

// One of the motions in one frame.
struct PartFrame {
  Pose pose;  // in the body's own frame
  GroundFrame ground;
  struct Foot {
    Vec3 knee = Vec3::Zero(), ankle = Vec3::Zero(), toes = Vec3::Zero();
    Quat turn = Quat::Identity();
    bool planted = false;
  };
  std::vector<Foot> feet;
};

struct PhaseSpan {
  double from = 0, to = 0;
};

// Planted spans of a leg's foot in both motions that belong together.
struct PairedSpan {
  PhaseSpan a, b;
};

std::vector<PhaseSpan> phasesOf(const std::vector<TimeSpan>& spans, const GaitPhase& phase) {
  std::vector<PhaseSpan> phases;
  for (const TimeSpan& span : spans) phases.push_back({phase.at(span.from), phase.at(span.to)});
  return phases;
}

double overlapOf(const PhaseSpan& a, const PhaseSpan& b) {
  return std::min(a.to, b.to) - std::max(a.from, b.from);
}

// Each with what it overlaps most, if that is so for both, and for most of what they last.
std::vector<PairedSpan> paired(const std::vector<PhaseSpan>& ofA, const std::vector<PhaseSpan>& ofB) {
  const auto best = [](const PhaseSpan& span, const std::vector<PhaseSpan>& others) -> std::optional<std::size_t> {
    std::optional<std::size_t> most;
    for (std::size_t i = 0; i < others.size(); ++i) {
      if (overlapOf(span, others[i]) > (most ? overlapOf(span, others[*most]) : 0)) most = i;
    }
    return most;
  };
  std::vector<PairedSpan> pairs;
  for (std::size_t i = 0; i < ofA.size(); ++i) {
    const std::optional<std::size_t> other = best(ofA[i], ofB);
    if (!other || best(ofB[*other], ofA) != i) continue;
    const PhaseSpan &a = ofA[i], &b = ofB[*other];
    if (overlapOf(a, b) >= kFootMixing.together * std::max(a.to - a.from, b.to - b.from)) pairs.push_back({a, b});
  }
  return pairs;
}

bool isWithin(const PairedSpan& pair, double phase, double weight) {
  return std::lerp(pair.a.from, pair.b.from, weight) <= phase && phase <= std::lerp(pair.a.to, pair.b.to, weight);
}

bool isDuring(const std::vector<TimeSpan>& spans, double seconds) {
  return std::any_of(spans.begin(), spans.end(),
                     [&](const TimeSpan& span) { return span.from <= seconds && seconds <= span.to; });
}

class Mixer {
 public:
  Mixer(const MixBody& body, const MixMotion& a, const MixMotion& b, const StridePhases& phases)
      : body_(body), a_(a), b_(b), phases_(phases), reach_(body.setup(), body.root()) {
    for (const LegSpec& leg : body.legs()) {
      spansOfA_.push_back(a.planted(leg.end));
      spansOfB_.push_back(b.planted(leg.end));
      pairs_.push_back(paired(phasesOf(spansOfA_.back(), phases.a), phasesOf(spansOfB_.back(), phases.b)));
    }
  }

  MixedFrames mix(std::span<const MixMoment> moments, double frameSeconds, const std::optional<GroundFrame>& start) {
    MixedFrames result;
    result.frames.frameSeconds = frameSeconds;
    std::optional<PartFrame> aBefore, bBefore;
    double weightBefore = 0;
    GroundFrame ground;
    for (const MixMoment& moment : moments) {
      std::optional<PartFrame> a, b;
      if (moment.a) a = partAt(a_, spansOfA_, *moment.a);
      if (moment.b) b = partAt(b_, spansOfB_, *moment.b);
      const double weight = (moment.weight + weightBefore) / 2;
      const bool first = result.frames.poses.empty();
      if (first) {
        ground = a && b ? between(a->ground, b->ground, moment.weight) : (a ? a : b)->ground;
        if (start) ground = *start;
      } else {
        ground = moved(ground, stepOf(aBefore, a, bBefore, b, weight));
      }
      Pose pose = a && b ? blendPoses(a->pose, b->pose, moment.weight) : (a ? a : b)->pose;
      leaveFrame(body_, ground, pose);
      if (a && b) blendLegs(*a, *b, moment.weight, ground, pose);
      result.frames.poses.push_back(std::move(pose));
      for (std::size_t leg = 0; leg < body_.legs().size(); ++leg) {
        MixedFoot foot;
        foot.planted = isPlanted(moment, leg, a, b);
        if (!first) {
          addSteps(aBefore, a, leg, 1 - weight, ground.turn(), foot);
          addSteps(bBefore, b, leg, weight, ground.turn(), foot);
          addCommon(aBefore, a, bBefore, b, leg, weight, foot);
        }
        result.feet.push_back(foot);
      }
      aBefore = std::move(a);
      bBefore = std::move(b);
      weightBefore = moment.weight;
    }
    return result;
  }

 private:
  using MaybePart = std::optional<PartFrame>;

  PartFrame partAt(const MixMotion& motion, const std::vector<std::vector<TimeSpan>>& spans, double seconds) {
    PartFrame part;
    motion.sample(seconds, part.pose);
    body_.globals(part.pose, frame_);
    part.ground = motion.groundAt(seconds, frame_);
    for (std::size_t i = 0; i < body_.legs().size(); ++i) {
      const LegSpec& leg = body_.legs()[i];
      PartFrame::Foot& foot = part.feet.emplace_back();
      foot.knee = frame_.positions[leg.lower];
      foot.ankle = foot.toes = frame_.positions[leg.end];
      if (leg.toes) foot.toes = frame_.positions[*leg.toes];
      foot.turn = frame_.rotations[leg.end];
      foot.planted = isDuring(spans[i], seconds);
    }
    enterFrame(body_, part.ground, part.pose);
    return part;
  }

  static Vec3 inFrame(const Vec3& point, const PartFrame& part) {
    return part.ground.turn().conjugate() * (point - part.ground.position());
  }

  // The pose is blended by its joint angles.
  void blendLegs(const PartFrame& a, const PartFrame& b, double weight, const GroundFrame& ground, Pose& pose) {
    body_.globals(pose, frame_);
    const auto blended = [&](const Vec3& ofA, const Vec3& ofB) {
      const Vec3 inA = inFrame(ofA, a), inB = inFrame(ofB, b);
      return Vec3(ground.position() + ground.turn() * (inA + weight * (inB - inA)));
    };
    for (std::size_t i = 0; i < body_.legs().size(); ++i) {
      const LegSpec& leg = body_.legs()[i];
      const PartFrame::Foot &ofA = a.feet[i], &ofB = b.feet[i];
      const Quat inA = a.ground.turn().conjugate() * ofA.turn, inB = b.ground.turn().conjugate() * ofB.turn;
      const Quat orientation = ground.turn() * inA.slerp(weight, inB);
      LimbGoal goal{blended(ofA.ankle, ofB.ankle), {}};
      pointAt(leg.upper, leg.lower, blended(ofA.knee, ofB.knee), pose);
      pointAt(leg.lower, leg.end, goal.position, pose);
      goal.turn = orientation * frame_.rotations[leg.end].conjugate();
      if (!LimbReach::isThere(leg, goal, frame_)) reach_.reach(leg, goal, frame_, pose);
    }
  }

  // Turns a joint so that the next one lies in the direction of a position.
  void pointAt(Index joint, Index next, const Vec3& position, Pose& pose) {
    const Vec3 now = frame_.positions[next] - frame_.positions[joint], goal = position - frame_.positions[joint];
    const Quat turn = shortestRotation(now, goal);
    if (!(now.norm() > 0 && goal.norm() > 0) || std::abs(turn.w()) > kFootMixing.sameDirection) return;
    const BodyKinematics& kinematics = body_.setup().targetKinematics;
    pose.locals[joint].rotation =
        kinematics.parentRotation(joint, frame_).conjugate() * (turn * frame_.rotations[joint]);
    kinematics.globalsBelow(joint, pose, frame_);
    body_.root().settleLoose(pose, frame_);
  }

  static GroundStep stepOf(const MaybePart& aBefore, const MaybePart& a, const MaybePart& bBefore, const MaybePart& b,
                           double weight) {
    const bool hasA = aBefore && a, hasB = bBefore && b;
    const GroundStep ofA = hasA ? stepBetween(aBefore->ground, a->ground) : GroundStep{};
    const GroundStep ofB = hasB ? stepBetween(bBefore->ground, b->ground) : GroundStep{};
    return hasA && hasB ? mixOf(ofA, ofB, weight) : hasA ? ofA : ofB;
  }

  bool isPlanted(const MixMoment& moment, std::size_t leg, const MaybePart& a, const MaybePart& b) const {
    if (!moment.b) return isDuring(spansOfA_[leg], *moment.a);
    if (!moment.a) return isDuring(spansOfB_[leg], *moment.b);
    const double phase = std::lerp(phases_.a.at(*moment.a), phases_.b.at(*moment.b), moment.weight);
    if (std::any_of(pairs_[leg].begin(), pairs_[leg].end(),
                    [&](const PairedSpan& pair) { return isWithin(pair, phase, moment.weight); })) {
      return true;
    }
    const bool aCounts = 1 - moment.weight >= kFootMixing.counts, bCounts = moment.weight >= kFootMixing.counts;
    if ((aCounts && !a->feet[leg].planted) || (bCounts && !b->feet[leg].planted)) return false;
    if (!aCounts || !bCounts) return true;
    const Vec3 apart = inFrame(a->feet[leg].ankle, *a) - inFrame(b->feet[leg].ankle, *b);
    return apart.norm() < kFootMixing.samePosition * body_.setup().targetHipHeight;
  }

  static double countOf(const MaybePart& before, const MaybePart& now, std::size_t leg, double weight) {
    return before && now && before->feet[leg].planted && now->feet[leg].planted ? weight : 0;
  }

  // Sums, each so often as it counts.
  static void addSteps(const MaybePart& before, const MaybePart& now, std::size_t leg, double weight,
                       const Quat& heading, MixedFoot& foot) {
    const double count = countOf(before, now, leg, weight);
    if (count == 0) return;
    const PartFrame::Foot &from = before->feet[leg], &to = now->feet[leg];
    const Quat turn = heading * now->ground.turn().conjugate();
    foot.ankleStep += count * (turn * (to.ankle - from.ankle));
    foot.toesStep += count * (turn * (to.toes - from.toes));
    foot.turn += count * turnAboutVertical(to.turn * from.turn.conjugate());
  }

  static void addCommon(const MaybePart& aBefore, const MaybePart& a, const MaybePart& bBefore, const MaybePart& b,
                        std::size_t leg, double weight, MixedFoot& foot) {
    const double sum = countOf(aBefore, a, leg, 1 - weight) + countOf(bBefore, b, leg, weight);
    if (sum == 0) return;
    foot.ankleStep /= sum;
    foot.toesStep /= sum;
    foot.turn /= sum;
  }

  const MixBody& body_;
  const MixMotion &a_, &b_;
  const StridePhases& phases_;
  LimbReach reach_;
  std::vector<std::vector<TimeSpan>> spansOfA_, spansOfB_;  // of each leg
  std::vector<std::vector<PairedSpan>> pairs_;              // likewise
  BodyFrame frame_;
};

}  // namespace

std::vector<FootSpans> MixedFrames::plantedFeet(const MixBody& body) const {
  std::vector<FootSpans> spans;
  const std::size_t legs = body.legs().size();
  for (std::size_t leg = 0; leg < legs; ++leg) {
    FootSpans& of = spans.emplace_back(FootSpans{body.legs()[leg].end, {}});
    for (std::size_t f = 0; f < frames.poses.size(); ++f) {
      if (!feet[f * legs + leg].planted) continue;
      const double now = static_cast<double>(f) * frames.frameSeconds;
      const bool goesOn = f > 0 && feet[(f - 1) * legs + leg].planted;
      if (!goesOn) of.planted.push_back({now, now});
      of.planted.back().to = now;
    }
  }
  return spans;
}

MixedFrames mixFrames(const MixBody& body, const MixMotion& a, const MixMotion& b, const StridePhases& phases,
                      std::span<const MixMoment> moments, double frameSeconds,
                      const std::optional<GroundFrame>& start) {
  return Mixer(body, a, b, phases).mix(moments, frameSeconds, start);
}

}  // namespace limber
