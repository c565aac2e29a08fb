#include "limber/rigging/templates/quadruped_landmarks.h"

#include <algorithm>
#include <array>
#include <string>

#include "limber/rigging/body/leg_finder.h"
#include "limber/rigging/body/medial_path.h"
#include "limber/rigging/templates/joints_between.h"

namespace limber {

namespace {

// Heights.
constexpr double kThinnestTrunk = 0.04;
constexpr double kTailAside = 0.08;  // of a tail's end from the middle
constexpr double kLowestTail = 0.1;
constexpr double kShortestTail = 0.1;

// Where the joints of an animal are relative to the shapes that show them. Lengths in body heights; fractions of the
// trunk are of the height from its underside to its back; fractions of a leg are of the height of its upper joint.
constexpr struct QuadrupedProportions {
  double hipUp = 0.49;                     // hind legs' upper joints: fraction, from where the legs part to the back
  double shoulderUp = 0.24;                // front legs' upper joints, likewise
  double knee = 0.71, kneeForward = 0.09;  // fractions of the leg; the knee lies before the middle of it
  double hock = 0.39;
  double hindToes = 0.1;
  double elbow = 0.54;
  double frontFoot = 0.15;
  double frontToes = 0.05;
  double hipsUp = 0.62, hipsForward = -0.02;  // fraction of the trunk; from the hind legs' upper joints
  double tailUp = 0.68, tailForward = -0.11;
  double spineUp = 0.55;
  double chestUp = 0.52, chestForward = -0.06;  // from the front legs' upper joints
  double neckUp = 0.48, neckForward = 0.08;
} kProportions = {};

struct LegJoints {
  Index upper = 0, lower = 0, foot = 0, toes = 0;
};
struct QuadrupedJoints {
  std::array<LegJoints, 2> front, hind;  // left and right
  Index hips = 0, chest = 0, neck = 0, tail = 0;
  std::array<Index, 2> spine = {};
  std::array<Index, 3> onTail = {};  // below its root, with the tip
};

std::optional<QuadrupedJoints> quadrupedJointsOf(const TemplateSkeleton& skeleton) {
  QuadrupedJoints joints;
  bool all = true;
  const auto set = [&](Index& joint, const std::string& name) {
    const std::optional<Index> found = skeleton.find(name);
    all = all && found;
    joint = found.value_or(0);
  };
  const char* sides[2] = {"left", "right"};
  for (int side = 0; side < 2; ++side) {
    for (const bool front : {true, false}) {
      LegJoints& leg = front ? joints.front[side] : joints.hind[side];
      const std::string of = std::string(sides[side]) + (front ? "Front" : "Hind");
      set(leg.upper, of + "UpperLeg");
      set(leg.lower, of + "LowerLeg");
      set(leg.foot, of + "Foot");
      set(leg.toes, of + "Toes");
    }
  }
  set(joints.hips, "hips");
  set(joints.spine[0], "spine");
  set(joints.spine[1], "spine1");
  set(joints.chest, "chest");
  set(joints.neck, "neck");
  set(joints.tail, "tail");
  set(joints.onTail[0], "tail1");
  set(joints.onTail[1], "tail2");
  set(joints.onTail[2], "tailTip");
  return all ? std::optional(joints) : std::nullopt;
}

struct Column {
  double low = 0, high = 0;
};

class QuadrupedMover {
 public:
  QuadrupedMover(const BodyVolume& body, const AnatomicalFrame& frame, const std::vector<std::optional<Vec3>>& pins,
                 std::vector<Vec3>& positions)
      : body_(body), frame_(frame), pins_(pins), positions_(positions) {}

  // Fractions of the height of a leg's upper joint, but for `upper`.
  struct LegProportions {
    double upper = 0;  // from where the legs part to the back
    double lower = 0, lowerForward = 0, foot = 0, toes = 0;
  };

  bool frontLegs(const std::array<LegJoints, 2>& joints) {
    const QuadrupedProportions& p = kProportions;
    return legs(joints, {p.shoulderUp, p.elbow, 0, p.frontFoot, p.frontToes}, toes_[0]);
  }

  bool hindLegs(const std::array<LegJoints, 2>& joints) {
    const QuadrupedProportions& p = kProportions;
    return legs(joints, {p.hipUp, p.knee, p.kneeForward, p.hock, p.hindToes}, toes_[1]);
  }

  void rear(const QuadrupedJoints& joints) {
    const double legs = 0.5 * (positions_[joints.hind[0].upper].z() + positions_[joints.hind[1].upper].z());
    moveInto(joints.hips, legs + kProportions.hipsForward, kProportions.hipsUp);
    moveInto(joints.tail, legs + kProportions.tailForward, kProportions.tailUp);
  }

  void fore(const QuadrupedJoints& joints) {
    const double legs = 0.5 * (positions_[joints.front[0].upper].z() + positions_[joints.front[1].upper].z());
    moveInto(joints.chest, legs + kProportions.chestForward, kProportions.chestUp);
    moveInto(joints.neck, legs + kProportions.neckForward, kProportions.neckUp);
  }

  // Along the tail from its root to the end of the body that lies farthest behind it in the middle.
  void tail(const QuadrupedJoints& joints) {
    const Vec3 root = positions_[joints.tail];
    std::optional<Vec3> end;
    for (const LimbTip& tip : limbTips(body_)) {
      const Vec3 position = frame_.toBody(tip.position);
      if (std::abs(position.x()) > kTailAside || position.y() < kLowestTail || position.z() > root.z()) continue;
      if (!end || (position - root).norm() > (*end - root).norm()) end = position;
    }
    if (!end || (*end - root).norm() < kShortestTail) return;
    std::vector<Vec3> path = medialPath(body_, frame_.fromBody(root), frame_.fromBody(*end));
    if (path.empty()) return;
    path.front() = frame_.fromBody(root);
    path.push_back(frame_.fromBody(*end));
    for (std::size_t i = 0; i < joints.onTail.size(); ++i) {
      const double fraction = static_cast<double>(i + 1) / static_cast<double>(joints.onTail.size());
      Vec3 position = frame_.toBody(alongPath(path, fraction));
      if (frame_.symmetric()) position.x() = 0;
      moveTo(joints.onTail[i], position);
    }
  }

  // What lies between placed joints, but is seen.
  void between(const QuadrupedJoints& joints, bool front, bool hind) {
    for (int side = 0; side < 2; ++side) {
      if (front) moveTo(joints.front[side].toes, toes_[0][side]);
      if (hind) moveTo(joints.hind[side].toes, toes_[1][side]);
    }
    if (!front || !hind) return;
    const double from = positions_[joints.hips].z(), to = positions_[joints.chest].z();
    moveInto(joints.spine[0], from + (to - from) / 3, kProportions.spineUp);
    moveInto(joints.spine[1], from + 2 * (to - from) / 3, kProportions.spineUp);
  }

 private:
  bool legs(const std::array<LegJoints, 2>& joints, const LegProportions& proportions, std::array<Vec3, 2>& toes) {
    const auto chain = [](const LegJoints& of) { return LegChain{of.upper, of.lower, of.toes}; };
    LegFinder finder(body_, frame_, positions_, chain(joints[0]), chain(joints[1]));
    if (!finder.findParting()) return false;
    for (int side = 0; side < 2; ++side) {
      const Vec3 upper = upperJoint(finder, side, proportions.upper);
      Vec3 lower = finder.middle(side, proportions.lower * upper.y());
      lower.z() += proportions.lowerForward * upper.y();
      moveTo(joints[side].upper, upper);
      moveTo(joints[side].lower, lower);
      moveTo(joints[side].foot, finder.middle(side, proportions.foot * upper.y()));
      toes[side] = finder.middle(side, proportions.toes * upper.y());
    }
    return true;
  }

  // The tallest part of the inside in the column at (x, z).
  std::optional<Column> columnAt(double x, double z) const {
    const double step = 0.5 * body_.distance->spacing() / frame_.height;
    std::optional<Column> tallest;
    double low = 0;
    bool inside = false;
    for (double y = 0; y < 1 + 2 * step; y += step) {
      const bool now = body_.distance->at(frame_.fromBody({x, y, z})) < 0;
      if (now && !inside) low = y;
      if (inside && !now && y - low > (tallest ? tallest->high - tallest->low : kThinnestTrunk)) tallest = {low, y};
      inside = now;
    }
    return tallest;
  }

  // Of a leg, at `fraction` of the height from where it parts to the back above it.
  Vec3 upperJoint(const LegFinder& finder, int side, double fraction) const {
    Vec3 position = finder.middle(side, finder.parting());
    const std::optional<Column> trunk = columnAt(0, position.z());
    const double back = trunk ? std::max(trunk->high, finder.parting()) : finder.parting();
    position.y() += fraction * (back - finder.parting());
    return position;
  }

  void moveTo(Index joint, const Vec3& position) {
    if (!pins_[joint]) positions_[joint] = position;
  }

  void moveInto(Index joint, double z, double fraction) {
    const std::optional<Column> trunk = columnAt(0, z);
    if (trunk) moveTo(joint, {0, trunk->low + fraction * (trunk->high - trunk->low), z});
  }

  const BodyVolume& body_;
  const AnatomicalFrame& frame_;
  const std::vector<std::optional<Vec3>>& pins_;
  std::vector<Vec3>& positions_;
  std::array<std::array<Vec3, 2>, 2> toes_ = {};  // front and hind, left and right
};

}  // namespace

void refineQuadruped(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                     const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& positions) {
  const std::optional<QuadrupedJoints> joints = quadrupedJointsOf(skeleton);
  if (!joints) return;
  QuadrupedMover mover(body, frame, pins, positions);
  const bool fore = mover.frontLegs(joints->front), rear = mover.hindLegs(joints->hind);
  if (fore) mover.fore(*joints);
  if (rear) mover.rear(*joints);
  placeBetween(skeleton, positions);
  mover.between(*joints, fore, rear);
  mover.tail(*joints);
}

}  // namespace limber
