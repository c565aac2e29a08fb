#include "limber/rigging/humanoid_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace limber {

namespace {

// Heights, but for shares.
constexpr double kSeedReach = 0.04;
constexpr double kLowestParting = 0.3;  // of the way from ankle to hip as embedded: legs that part lower are no legs
constexpr int kStaysTogether = 3;       // cuts

constexpr double kWidestArm = 0.03;  // square heights of a cut
constexpr double kMostMoved = 0.06;

struct Leg {
  Index hip = 0, knee = 0, ankle = 0;
};
struct Arm {
  Index shoulder = 0, elbow = 0, hand = 0;
};

class LegFinder {
 public:
  LegFinder(const BodyVolume& body, const BodyFrame& frame, const std::vector<Vec3>& places, const Leg& left,
            const Leg& right)
      : body_(body), frame_(frame), places_(places), legs_{left, right} {}

  // Cuts both legs at rising heights until they have grown together.
  bool findParting() {
    const double step = body_.distance->spacing() / frame_.height;
    const double ankle = std::max(places_[legs_[0].ankle].y(), places_[legs_[1].ankle].y()) + 0.02;
    const double hip = std::max(places_[legs_[0].hip].y(), places_[legs_[1].hip].y());
    int together = 0;
    for (double y = ankle; y < hip + 0.15; y += step) {
      std::array<BodySection, 2> cut;
      for (int side = 0; side < 2; ++side)
        cut[side] = sectionAt(body_, frame_, seed(side, y), Vec3::UnitY(), kSeedReach);
      if (cut[0].empty() || cut[1].empty()) continue;
      if (cut[0].contains(cut[1].center) || cut[0].center.x() <= cut[1].center.x()) {
        if (++together == kStaysTogether) {
          parting_ = y - (kStaysTogether - 1) * step;
          return known() && parting_ > ankle + kLowestParting * (hip - ankle);
        }
        continue;
      }
      together = 0;
      for (int side = 0; side < 2; ++side) sections_[side].push_back(cut[side]);
    }
    return false;
  }

  double parting() const { return parting_; }
  bool known() const { return sections_[0].size() > 3; }

  // Of the leg just below where it parts from the other one.
  double halfWidth(int side) const {
    double sum = 0;
    const std::size_t count = std::min<std::size_t>(4, sections_[side].size());
    for (std::size_t i = 0; i < count; ++i) {
      const BodySection& section = sections_[side][sections_[side].size() - 1 - i];
      sum += 0.5 * (section.high - section.low) / static_cast<double>(count);
    }
    return sum;
  }

  // The middle of the leg at a height; above where it parts as just below.
  Vec3 middle(int side, double y) const {
    const std::vector<BodySection>& cuts = sections_[side];
    Vec3 sum = Vec3::Zero();
    double weights = 0;
    for (const BodySection& cut : cuts) {
      const double off = (cut.center.y() - std::min(y, cuts.back().center.y() - 0.01)) / 0.02;
      const double weight = std::exp(-off * off);
      sum += weight * cut.center;
      weights += weight;
    }
    return weights > 1e-6 ? Vec3(sum.x() / weights, y, sum.z() / weights)
                          : Vec3(cuts.front().center.x(), y, cuts.front().center.z());
  }

 private:
  // Upwards from the last cut; first on the embedded shin.
  Vec3 seed(int side, double y) const {
    if (!sections_[side].empty()) {
      const Vec3& last = sections_[side].back().center;
      return {last.x(), y, last.z()};
    }
    const Vec3 &knee = places_[legs_[side].knee], &ankle = places_[legs_[side].ankle];
    const double part = std::clamp((y - ankle.y()) / std::max(knee.y() - ankle.y(), 1e-3), 0.0, 1.0);
    Vec3 place = ankle + part * (knee - ankle);
    place.y() = y;
    return place;
  }

  const BodyVolume& body_;
  const BodyFrame& frame_;
  const std::vector<Vec3>& places_;
  std::array<Leg, 2> legs_;
  std::array<std::vector<BodySection>, 2> sections_;  // upwards
  double parting_ = 0;
};

}  // namespace

bool BodySection::contains(const Vec3& place) const {
  const std::array<int, 2> at = {static_cast<int>(std::lround((place - origin).dot(across) / cell)),
                                 static_cast<int>(std::lround((place - origin).dot(along) / cell))};
  return std::binary_search(cells.begin(), cells.end(), at);
}

BodySection sectionAt(const BodyVolume& body, const BodyFrame& frame, const Vec3& seed, const Vec3& normal,
                      double reach) {
  using Cell = std::array<int, 2>;
  BodySection section;
  section.origin = seed;
  section.across = std::abs(normal.x()) < 0.9 ? Vec3((Vec3::UnitX() - normal.x() * normal).normalized())
                                              : Vec3((Vec3::UnitY() - normal.y() * normal).normalized());
  section.along = section.across.cross(normal);
  section.cell = 0.5 * body.distance->spacing() / frame.height;
  const auto placeOf = [&](double across, double along) {
    return Vec3(seed + section.cell * (across * section.across + along * section.along));
  };
  const auto inside = [&](const Cell& at) { return body.distance->at(frame.fromBody(placeOf(at[0], at[1]))) < 0; };
  const int around = static_cast<int>(reach / section.cell);
  Cell nearest = {};
  int best = std::numeric_limits<int>::max();
  for (int i = -around; i <= around; ++i) {
    for (int k = -around; k <= around; ++k) {
      if (i * i + k * k >= best || !inside({i, k})) continue;
      best = i * i + k * k;
      nearest = {i, k};
    }
  }
  if (best == std::numeric_limits<int>::max()) return section;

  std::set<Cell> seen = {nearest};
  std::vector<Cell> waiting = {nearest};
  Vec3 sum = Vec3::Zero();
  while (!waiting.empty()) {
    const Cell at = waiting.back();
    waiting.pop_back();
    section.cells.push_back(at);
    sum += placeOf(at[0], at[1]);
    for (const auto& [di, dk] : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next = {at[0] + di, at[1] + dk};
      if (seen.count(next) == 0 && inside(next)) {
        seen.insert(next);
        waiting.push_back(next);
      }
    }
  }
  std::sort(section.cells.begin(), section.cells.end());
  section.low = section.cells.front()[0] * section.cell;
  section.high = section.cells.back()[0] * section.cell;
  section.area = static_cast<double>(section.cells.size()) * section.cell * section.cell;
  section.center = sum / static_cast<double>(section.cells.size());
  return section;
}

namespace {

struct HumanoidJoints {
  std::array<Leg, 2> legs;
  std::array<Arm, 2> arms;
  Index hips = 0, upperChest = 0, neck = 0, head = 0;
};

std::optional<HumanoidJoints> humanoidJointsOf(const TemplateSkeleton& skeleton) {
  HumanoidJoints joints;
  bool all = true;
  const auto set = [&](Index& joint, const std::string& name) {
    const std::optional<Index> found = skeleton.find(name);
    all = all && found;
    joint = found.value_or(0);
  };
  const char* sides[2] = {"left", "right"};
  for (int side = 0; side < 2; ++side) {
    const std::string of = sides[side];
    set(joints.legs[side].hip, of + "UpperLeg");
    set(joints.legs[side].knee, of + "LowerLeg");
    set(joints.legs[side].ankle, of + "Foot");
    set(joints.arms[side].shoulder, of + "UpperArm");
    set(joints.arms[side].elbow, of + "LowerArm");
    set(joints.arms[side].hand, of + "Hand");
  }
  set(joints.hips, "hips");
  set(joints.upperChest, "upperChest");
  set(joints.neck, "neck");
  set(joints.head, "head");
  return all ? std::optional(joints) : std::nullopt;
}

// Moves what may be moved.
class Mover {
 public:
  Mover(const BodyVolume& body, const BodyFrame& frame, const std::vector<std::optional<Vec3>>& pins,
        std::vector<Vec3>& places, const HumanoidProportions& proportions)
      : body_(body), frame_(frame), pins_(pins), places_(places), proportions_(proportions) {}

  void legs(const HumanoidJoints& joints) {
    LegFinder finder(body_, frame_, places_, joints.legs[0], joints.legs[1]);
    const bool parted = finder.findParting();
    if (!finder.known()) return;
    for (int side = 0; side < 2; ++side) {
      const Leg& leg = joints.legs[side];
      double hipY = places_[leg.hip].y();
      if (parted) {
        hipY = finder.parting() + proportions_.hipAboveParting * finder.halfWidth(side);
        moveTo(leg.hip, finder.middle(side, hipY));
      }
      const double ankleY = proportions_.ankle + proportions_.ankleShare * hipY;
      moveTo(leg.ankle, finder.middle(side, ankleY));
      moveTo(leg.knee, finder.middle(side, hipY + proportions_.knee * (ankleY - hipY)));
    }
    const Vec3 between = 0.5 * (places_[joints.legs[0].hip] + places_[joints.legs[1].hip]);
    if (parted) moveTo(joints.hips, {places_[joints.hips].x(), between.y() - proportions_.hipsBelow, between.z()});
  }

  // Elbow and hand to the middle of the arm; the shoulder on in the direction from the elbow to the middle of the upper
  // arm, as far as it was.
  void arm(const Arm& arm) {
    const Vec3 shoulder = places_[arm.shoulder], elbow = places_[arm.elbow], hand = places_[arm.hand];
    const double upper = (elbow - shoulder).norm();
    if (upper < 1e-3 || (hand - elbow).norm() < 1e-3) return;
    const Vec3 along = (elbow - shoulder).normalized(), below = (hand - elbow).normalized();
    const std::optional<Vec3> middle = middleAt(0.45 * shoulder + 0.55 * elbow, along);
    const std::optional<Vec3> atElbow = middleAt(elbow, (along + below).normalized());
    const std::optional<Vec3> atHand = middleAt(hand, below);
    if (atHand) moveTo(arm.hand, *atHand);
    if (!atElbow) return;
    moveTo(arm.elbow, *atElbow);
    if (!middle || (*middle - *atElbow).norm() < 0.3 * upper) return;
    moveTo(arm.shoulder, *atElbow + upper * (*middle - *atElbow).normalized());
  }

  void trunk(const HumanoidJoints& joints) {
    const double shoulders = 0.5 * (places_[joints.arms[0].shoulder].y() + places_[joints.arms[1].shoulder].y());
    Vec3 neck = places_[joints.neck], head = places_[joints.head], chest = places_[joints.upperChest];
    const double hips = places_[joints.hips].y();
    neck.y() = shoulders + proportions_.neckAboveShoulders;
    head.y() = neck.y() + proportions_.headAboveNeck;
    chest.y() = hips + proportions_.upperChest * (neck.y() - hips);
    for (Vec3* place : {&chest, &neck}) {
      const BodySection section = sectionAt(body_, frame_, *place, Vec3::UnitY(), kSeedReach);
      if (!section.empty()) place->z() = section.center.z();
    }
    head.z() = 0.5 * (head.z() + neck.z());
    moveTo(joints.upperChest, chest);
    moveTo(joints.neck, neck);
    moveTo(joints.head, head);
  }

 private:
  void moveTo(Index joint, const Vec3& place) {
    if (!pins_[joint]) places_[joint] = place;
  }

  // None where the cut goes through more than an arm.
  std::optional<Vec3> middleAt(const Vec3& place, const Vec3& normal) const {
    const BodySection section = sectionAt(body_, frame_, place, normal, kSeedReach);
    if (section.empty() || section.area > kWidestArm || (section.center - place).norm() > kMostMoved)
      return std::nullopt;
    return section.center;
  }

  const BodyVolume& body_;
  const BodyFrame& frame_;
  const std::vector<std::optional<Vec3>>& pins_;
  std::vector<Vec3>& places_;
  const HumanoidProportions& proportions_;
};

}  // namespace

void refineHumanoid(const TemplateSkeleton& skeleton, const BodyVolume& body, const BodyFrame& frame,
                    const std::vector<std::optional<Vec3>>& pins, std::vector<Vec3>& places,
                    const HumanoidProportions& proportions) {
  const std::optional<HumanoidJoints> joints = humanoidJointsOf(skeleton);
  if (!joints) return;
  Mover mover(body, frame, pins, places, proportions);
  mover.legs(*joints);
  for (const Arm& arm : joints->arms) mover.arm(arm);
  mover.trunk(*joints);
}

}  // namespace limber
