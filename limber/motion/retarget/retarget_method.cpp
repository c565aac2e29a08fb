#include "limber/motion/retarget/retarget_method.h"

#include <array>
#include <string>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/motion/retarget/aligned.h"
#include "limber/motion/retarget/copy_rotations.h"
#include "limber/motion/retarget/limb_ik.h"
#include "limber/motion/retarget/spacetime.h"

namespace limber {

std::span<const RetargetMethod> retargetMethods() {
  static constexpr std::array<RetargetMethod, 4> kMethods = {{
      {"limb-ik", "joints turn as the source's; feet stay planted, hands touch what they touched",
       "Koerner; Feng et al.: Automating the Transfer of a Generic Set "
       "of Behaviors onto a Virtual Character, 2012",
       &makeLimbIk, nullptr, true, true},
      {"spacetime", "the smallest smooth change over the whole motion that keeps feet planted and hands touching",
       "Gleicher: Retargetting motion to new characters, 1998", &makeAligned, &refineSpacetime, true, false},
      {"aligned", "joints turn in the world as the source's, against a neutral pose that both share",
       "Tang et al. 2012; Feng et al. 2012", &makeAligned, nullptr, false, false},
      {"copy", "local rotations as they are; right for like skeletons only", "", &makeCopy, nullptr, false, false},
  }};
  return kMethods;
}

const RetargetMethod& findRetargetMethod(std::string_view name) {
  std::string names;
  for (const RetargetMethod& method : retargetMethods()) {
    if (method.name == name) return method;
    names += names.empty() ? "" : ", ";
    names += method.name;
  }
  throw Error(ErrorCode::kBadArgument, fmt::format("there is no retargeting method '{}'", name), "",
              fmt::format("there are: {}", names));
}

std::string retargetMethodsWithSolver() {
  std::string names;
  for (const RetargetMethod& method : retargetMethods()) {
    if (method.usesSolver) names += (names.empty() ? "" : ", ") + std::string(method.name);
  }
  return names;
}

}  // namespace limber
