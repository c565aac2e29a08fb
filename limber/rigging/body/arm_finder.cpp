#include "limber/rigging/body/arm_finder.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"

namespace limber {

namespace {

constexpr int kCuts = 30;               // along the arm from shoulder to hand
constexpr double kInwards = 0.35;       // of the arm's length that is looked at beyond the shoulder
constexpr double kOutwards = 0.45;      // and beyond the hand
constexpr double kArmSeedReach = 0.03;  // heights
constexpr double kWider = 3.5;          // the trunk's cut, against the upper arm's
constexpr double kJump = 2.5;           // over two cuts: sleeves widen little by little
constexpr double kNarrower = 1.2;       // the arm beside its narrowest cut, against that
constexpr double kThickerWithin = 8;    // cuts from the narrowest one

}  // namespace

ArmFinder::ArmFinder(const BodyVolume& body, const AnatomicalFrame& frame, const Vec3& shoulder, const Vec3& elbow,
                     const Vec3& hand)
    : upper_((elbow - shoulder).norm()), lower_((hand - elbow).norm()), step_((upper_ + lower_) / kCuts) {
  if (!(upper_ > 1e-3) || !(lower_ > 1e-3)) return;
  const Vec3 upperArm = (elbow - shoulder) / upper_, forearm = (hand - elbow) / lower_;
  const double length = upper_ + lower_;
  for (double offset = -kInwards * length; offset < (1 + kOutwards) * length; offset += step_) {
    const Vec3& along = offset < upper_ ? upperArm : forearm;
    const BodySection section = sectionAt(body, frame, elbow + (offset - upper_) * along, along, kArmSeedReach);
    cuts_.push_back({offset, section.area, section.center});
  }
  findArmpit();
}

void ArmFinder::findArmpit() {
  std::vector<double> areas;
  for (const Cut& cut : cuts_) {
    if (cut.offset > 0.5 * upper_ && cut.offset < upper_ + 0.5 * lower_ && cut.area > 0) areas.push_back(cut.area);
  }
  if (areas.empty()) return;
  std::nth_element(areas.begin(), areas.begin() + areas.size() / 2, areas.end());
  const double usual = areas[areas.size() / 2];
  radius_ = std::sqrt(usual / kPi);
  for (std::size_t i = cuts_.size() - 1; i-- > 1;) {
    const bool trunk = cuts_[i - 1].area > std::max(kWider * usual, kJump * cuts_[i + 1].area);
    if (cuts_[i].offset > upper_ || !trunk) continue;
    armpit_ = 0.5 * (cuts_[i].offset + cuts_[i - 1].offset);
    return;
  }
}

std::optional<double> ArmFinder::narrowest(double from, double to) const {
  std::vector<double> areas(cuts_.size());
  for (std::size_t i = 0; i < cuts_.size(); ++i) {
    const double before = cuts_[i > 0 ? i - 1 : 0].area, after = cuts_[std::min(i + 1, cuts_.size() - 1)].area;
    areas[i] = 0.25 * (before + 2 * cuts_[i].area + after);
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < cuts_.size(); ++i) {
    if (cuts_[i].offset < from || cuts_[i].offset > to || !(cuts_[i].area > 0)) continue;
    double inside = 0, outside = 0;
    for (std::size_t k = 0; k < cuts_.size(); ++k) {
      if (std::abs(static_cast<double>(k) - static_cast<double>(i)) > kThickerWithin) continue;
      double& side = k < i ? inside : outside;
      side = std::max(side, areas[k]);
    }
    if (std::min(inside, outside) < kNarrower * areas[i]) continue;
    if (!best || areas[i] < areas[*best]) best = i;
  }
  return best ? std::optional(cuts_[*best].offset) : std::nullopt;
}

std::optional<Vec3> ArmFinder::middle(double offset) const {
  Vec3 sum = Vec3::Zero();
  double weights = 0;
  for (const Cut& cut : cuts_) {
    if (!(cut.area > 0) || (armpit_ && cut.offset < *armpit_)) continue;
    const double off = (cut.offset - offset) / (1.5 * step_);
    if (off * off > 9) continue;
    sum += std::exp(-off * off) * cut.center;
    weights += std::exp(-off * off);
  }
  return weights > 0.05 ? std::optional<Vec3>(sum / weights) : std::nullopt;
}

}  // namespace limber
