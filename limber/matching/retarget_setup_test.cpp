#include "limber/matching/retarget_setup.h"

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/matching/testing/test_motion.h"

namespace limber {
namespace {

// What is said of a map of these parts alone; nothing where it serves.
std::string refusal(const Skeleton& source, const Skeleton& target, const std::vector<std::string>& parts) {
  SkeletonMap map;
  for (const std::string& part : parts) {
    map.matches.push_back({part, {source.find(part).value()}, {target.find(part).value()}});
  }
  try {
    const RetargetSetup setup(source, target, map, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RetargetSetup, AMapThatTellsNoSizeSaysWhatIsMissing) {
  const Skeleton person = practiceHumanoid();
  EXPECT_EQ(refusal(person, person, {"hips"}),
            "hips: the matched joints do not tell how large the motion's body is (match parts that lie further apart, "
            "such as hips, head and feet)");
  EXPECT_EQ(refusal(person, person, {"hips", "head"}), "");
  Skeleton folded = person;
  for (Joint& joint : folded.joints) joint.rest.translation = Vec3::Zero();
  EXPECT_EQ(refusal(person, folded, {"hips", "head"}),
            "the matched joints do not tell how large the character's body is (match parts that lie further apart, "
            "such as hips, head and feet)");
}

}  // namespace
}  // namespace limber
