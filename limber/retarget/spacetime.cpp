#include "limber/retarget/spacetime.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/ik/rotation.h"
#include "limber/retarget/band_matrix.h"
#include "limber/retarget/limb_goals.h"

namespace limber {

namespace {

constexpr double kKnotSeconds = 0.08;    // between control points
constexpr int kSteps = 5;                // of Gauss-Newton
constexpr double kTurnWeight = 2e-4;     // of a radian of displacement, against a hip height off the goal
constexpr double kShiftWeight = 4e-3;    // of a hip height that the pelvis is moved, likewise
constexpr double kTornPlant = 0.1;       // hip heights: a planted point that jumps by more is another plant
constexpr double kStandingSpeed = 0.12;  // hip heights a second: of a planted point that counts half
constexpr std::size_t kPerLimb = 6;      // unknowns: the turns of both bones; 3 more for the pelvis

// Where the ends have to be in one frame, and how much that counts.
struct FrameGoals {
  std::vector<Vec3> places;   // #limbs
  std::vector<Vec3> weights;  // #limbs, of each coordinate
};

class Spacetime {
 public:
  Spacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target)
      : setup_(setup), root_(setup), goals_(setup, root_), source_(source), target_(target) {}

  void run() {
    if (!goals_.active() || target_.poses.empty()) return;
    gatherGoals();
    unknowns_ = 3 + kPerLimb * limbs_.size();
    spacing_ = std::max(1.0, std::round(kKnotSeconds / target_.frameSeconds));
    const std::size_t controls = static_cast<std::size_t>(static_cast<double>(frames() - 1) / spacing_) + 4;
    values_.assign(controls * unknowns_, 0.0);
    for (int step = 0; step < kSteps; ++step) improve();
    for (std::size_t f = 0; f < frames(); ++f) displace(f, target_.poses[f]);
  }

 private:
  std::size_t frames() const { return target_.poses.size(); }

  // The goals of all frames, plants made constant from their first to their last frame.
  void gatherGoals() {
    for (const Leg& leg : goals_.legs()) limbs_.push_back(leg);
    for (const Limb& arm : goals_.arms()) limbs_.push_back(arm);
    const std::size_t legs = goals_.legs().size();
    std::vector<std::vector<FootAnchor>> anchors(legs);
    std::vector<std::vector<Vec3>> points(legs), rolls(legs), sources(legs);
    BodyFrame from, to;
    for (std::size_t f = 0; f < frames(); ++f) {
      setup_.sourceKinematics.globals(source_.poses[f], from);
      setup_.targetKinematics.globals(target_.poses[f], to);
      FrameGoals& goals = wanted_.emplace_back();
      if (setup_.options.contacts) goals_.setFeet(from, to, f == 0 ? 0 : target_.frameSeconds);
      goals_.setHands(from, to, f == 0 ? 0 : target_.frameSeconds);
      for (std::size_t i = 0; i < legs; ++i) {
        const Leg& leg = goals_.legs()[i];
        const Vec3 ankle = to.positions[leg.end], toes = leg.toes ? to.positions[*leg.toes] : ankle;
        rolls[i].push_back(leg.anchor == FootAnchor::kToes ? Vec3(toes - ankle) : Vec3(Vec3::Zero()));
        points[i].push_back(ankle + rolls[i].back());
        anchors[i].push_back(leg.anchor);
        sources[i].push_back(from.positions[leg.anchor == FootAnchor::kToes ? *leg.sourceToes : leg.sourceEnd]);
        const bool below = leg.wanted && leg.goal.y() > ankle.y();
        goals.places.push_back(below ? Vec3(ankle.x(), leg.goal.y(), ankle.z()) : ankle);
        goals.weights.push_back(below ? Vec3(0, 1, 0) : Vec3(Vec3::Zero()));
      }
      for (const Limb& arm : goals_.arms()) {
        goals.places.push_back(arm.goal);
        goals.weights.push_back(arm.wanted ? Vec3(0.3, 0.3, 0.3) : Vec3(Vec3::Zero()));
      }
    }
    for (std::size_t i = 0; i < legs; ++i) holdPlants(i, anchors[i], points[i], rolls[i], stillness(sources[i]));
  }

  // How much each frame of a plant counts: the less, the more the source's foot still or already moves.
  std::vector<double> stillness(const std::vector<Vec3>& places) const {
    std::vector<double> weights;
    const double standing = kStandingSpeed * setup_.sourceHipHeight * target_.frameSeconds;
    for (std::size_t f = 0; f < places.size(); ++f) {
      const std::size_t before = f > 0 ? f - 1 : 0, after = std::min(f + 1, places.size() - 1);
      const double speed = std::max((places[f] - places[before]).norm(), (places[after] - places[f]).norm()) / standing;
      weights.push_back(1 / (1 + speed * speed * speed * speed));
    }
    return weights;
  }

  void holdPlants(std::size_t leg, const std::vector<FootAnchor>& anchors, const std::vector<Vec3>& points,
                  const std::vector<Vec3>& rolls, const std::vector<double>& still) {
    const Leg& limb = goals_.legs()[leg];
    const double torn = kTornPlant * setup_.targetHipHeight;
    for (std::size_t begin = 0; begin < points.size();) {
      std::size_t end = begin + 1;
      Vec3 sum = still[begin] * points[begin];
      double weight = still[begin];
      for (; end < points.size() && anchors[end] == anchors[begin]; ++end) {
        if ((points[end] - points[end - 1]).norm() > torn) break;
        sum += still[end] * points[end];
        weight += still[end];
      }
      if (anchors[begin] != FootAnchor::kNone) {
        // A foot that rolls from its heel onto its toes goes on standing where it stands.
        const bool goesOn = begin > 0 && anchors[begin - 1] != FootAnchor::kNone &&
                            (points[begin] - rolls[begin] - points[begin - 1] + rolls[begin - 1]).norm() <= torn;
        Vec3 place = goesOn ? Vec3(wanted_[begin - 1].places[leg] + rolls[begin]) : Vec3(sum / weight);
        place.y() = anchors[begin] == FootAnchor::kToes ? limb.toesGround : limb.ankleGround;
        for (std::size_t f = begin; f < end; ++f) {
          wanted_[f].places[leg] = place - rolls[f];
          wanted_[f].weights[leg] = Vec3(still[f], std::max(still[f], 0.2), still[f]);
        }
      }
      begin = end;
    }
  }

  // The four control points that reach a frame, from the first on, and how much each counts.
  std::size_t basis(std::size_t frame, std::array<double, 4>& weights) const {
    const double place = static_cast<double>(frame) / spacing_, first = std::floor(place), t = place - first;
    const double t2 = t * t, t3 = t2 * t;
    weights = {(1 - 3 * t + 3 * t2 - t3) / 6, (4 - 6 * t2 + 3 * t3) / 6, (1 + 3 * t + 3 * t2 - 3 * t3) / 6, t3 / 6};
    return static_cast<std::size_t>(first);
  }

  Vec3 displacement(std::size_t frame, std::size_t unknown) const {
    std::array<double, 4> weights;
    const std::size_t first = basis(frame, weights);
    Vec3 sum = Vec3::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
      const double* value = &values_[(first + c) * unknowns_ + unknown];
      sum += weights[c] * Vec3(value[0], value[1], value[2]);
    }
    return sum;
  }

  // Pelvis, upper and lower limbs of one frame; hands and feet keep how they are turned.
  void displace(std::size_t f, Pose& pose) {
    const BodyKinematics& kinematics = setup_.targetKinematics;
    kinematics.globals(pose, frame_);
    std::vector<Quat>& ends = ends_;
    ends.clear();
    for (const Limb& limb : limbs_) ends.push_back(frame_.rotations[limb.end]);
    for (std::size_t i = 0; i < limbs_.size(); ++i) {
      turn(limbs_[i].upper, displacement(f, 3 + kPerLimb * i), pose);
      turn(limbs_[i].lower, displacement(f, 6 + kPerLimb * i), pose);
      pose.locals[limbs_[i].end].rotation =
          (kinematics.parentRotation(limbs_[i].end, frame_).conjugate() * ends[i]).normalized();
    }
    kinematics.globals(pose, frame_);
    root_.movePelvis(setup_.targetHipHeight * displacement(f, 0), pose, frame_);
  }

  void turn(Index joint, const Vec3& by, Pose& pose) {
    const Quat above = setup_.targetKinematics.parentRotation(joint, frame_);
    const Quat turned = fromRotationVector(by) * frame_.rotations[joint];
    pose.locals[joint].rotation = (above.conjugate() * turned).normalized();
    setup_.targetKinematics.globals(pose, frame_);
  }

  // One step: what is left to go, linear in the displacements.
  void improve() {
    BandMatrix matrix(values_.size(), 4 * unknowns_);
    std::vector<double> right(values_.size(), 0.0);
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const double weight = i % unknowns_ < 3 ? kShiftWeight : kTurnWeight;
      matrix.at(i, i) += weight * spacing_;
      right[i] -= weight * spacing_ * values_[i];
    }
    Pose pose;
    for (std::size_t f = 0; f < frames(); ++f) {
      pose = target_.poses[f];
      displace(f, pose);
      for (std::size_t i = 0; i < limbs_.size(); ++i) addGoal(f, i, matrix, right);
    }
    matrix.solve(right);
    for (std::size_t i = 0; i < values_.size(); ++i) values_[i] += right[i];
  }

  void addGoal(std::size_t f, std::size_t limb, BandMatrix& matrix, std::vector<double>& right) const {
    const Vec3& weight = wanted_[f].weights[limb];
    if (weight.isZero()) return;
    const double per = 1 / setup_.targetHipHeight;
    const Vec3 end = frame_.positions[limbs_[limb].end];
    const Vec3 left = per * (wanted_[f].places[limb] - end);
    std::array<double, 4> basisWeights;
    const std::size_t first = basis(f, basisWeights);
    const std::array<Vec3, 2> arms = {Vec3(per * (end - frame_.positions[limbs_[limb].upper])),
                                      Vec3(per * (end - frame_.positions[limbs_[limb].lower]))};
    for (int axis = 0; axis < 3; ++axis) {
      if (weight[axis] == 0) continue;
      // d end / d (pelvis, upper turn, lower turn): a turn w moves it by w x arm.
      std::array<double, 9> row{};
      row[static_cast<std::size_t>(axis)] = 1;
      for (std::size_t bone = 0; bone < 2; ++bone) {
        const Vec3 gradient = arms[bone].cross(Vec3::Unit(axis));
        for (std::size_t k = 0; k < 3; ++k) row[3 + 3 * bone + k] = gradient[static_cast<Eigen::Index>(k)];
      }
      addRow(first, limb, row, basisWeights, weight[axis], left[axis], matrix, right);
    }
  }

  void addRow(std::size_t first, std::size_t limb, const std::array<double, 9>& row,
              const std::array<double, 4>& basisWeights, double weight, double left, BandMatrix& matrix,
              std::vector<double>& right) const {
    const auto column = [&](std::size_t c, std::size_t k) {
      return (first + c) * unknowns_ + (k < 3 ? k : kPerLimb * limb + k);
    };
    for (std::size_t c = 0; c < 4; ++c) {
      for (std::size_t k = 0; k < 9; ++k) {
        const double value = weight * basisWeights[c] * row[k];
        if (value == 0) continue;
        const std::size_t at = column(c, k);
        right[at] += value * left;
        for (std::size_t d = 0; d <= c; ++d) {
          for (std::size_t m = 0; m < 9; ++m) {
            const std::size_t other = column(d, m);
            if (other <= at) matrix.at(at, other) += value * basisWeights[d] * row[m];
          }
        }
      }
    }
  }

  const RetargetSetup& setup_;
  RootPlacer root_;
  LimbGoals goals_;
  const PoseSequence& source_;
  PoseSequence& target_;
  std::vector<Limb> limbs_;  // legs first
  std::vector<FrameGoals> wanted_;
  std::size_t unknowns_ = 0;    // of one control point
  double spacing_ = 1;          // frames between control points
  std::vector<double> values_;  // #controls x #unknowns
  BodyFrame frame_;
  std::vector<Quat> ends_;
};

}  // namespace

void refineSpacetime(const RetargetSetup& setup, const PoseSequence& source, PoseSequence& target) {
  Spacetime(setup, source, target).run();
}

}  // namespace limber
