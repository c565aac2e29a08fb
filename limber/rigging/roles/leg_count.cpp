#include "limber/rigging/roles/leg_count.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "limber/rigging/roles/joint_roles.h"

namespace limber {

std::size_t countLegs(const BodyVolume& body, const RoleReading& reading) {
  const std::vector<SurfaceSample>& samples = reading.samples().samples;
  const auto isOfLeg = [&](const LimbTip& tip) {
    const Vec3 position = reading.frame().axes * tip.position;
    const auto nearest = std::min_element(samples.begin(), samples.end(), [&](const auto& a, const auto& b) {
      return (a.position - position).squaredNorm() < (b.position - position).squaredNorm();
    });
    const std::string_view limb = splitName(reading.partOf(static_cast<std::size_t>(nearest - samples.begin()))).limb;
    return limb == "fore" || limb == "hind" || limb == "mid";
  };
  const std::vector<LimbTip> tips = limbTips(body);
  return static_cast<std::size_t>(std::count_if(tips.begin(), tips.end(), isOfLeg));
}

}  // namespace limber
