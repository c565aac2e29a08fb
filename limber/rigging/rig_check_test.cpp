#include "limber/rigging/rig_check.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/rigging/body/testing/capsule_person.h"
#include "limber/rigging/measured_model.h"
#include "limber/rigging/testing/chair.h"
#include "limber/samples/half_mesh.h"

namespace limber {

namespace {

using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::StartsWith;

RigCheck check(const TriMesh& mesh) {
  return checkRigging(mesh, {});
}

// Arms lowered from level by so many degrees.
TriMesh personWithArms(double degrees) {
  return testing::capsulePerson(degrees * M_PI / 180).mesh;
}

// In one piece, 1.73 high, with hands that are free or melted into the hips.
TriMesh sculptedPerson(bool handsOnHips) {
  Sculpture s;
  const auto add = [&](const Vec3& a, double ra, const Vec3& b, double rb) { s.add(roundCone(a, ra, b, rb), 0.03); };
  add({0, 0.95, 0}, 0.13, {0, 1.3, 0}, 0.13);
  add({0, 1.3, 0}, 0.05, {0, 1.5, 0}, 0.05);
  add({0, 1.58, 0.01}, 0.095, {0, 1.64, 0.01}, 0.095);
  add({0.02, 1.38, 0}, 0.055, {0.13, 1.38, 0}, 0.055);
  add({0.09, 0.9, 0}, 0.085, {0.1, 0.5, 0.01}, 0.055);
  add({0.1, 0.5, 0.01}, 0.055, {0.1, 0.08, -0.02}, 0.04);
  add({0.1, 0.045, -0.03}, 0.045, {0.11, 0.04, 0.13}, 0.035);
  const Vec3 elbow(0.36, 1.16, -0.02);
  const Vec3 wrist = handsOnHips ? Vec3(0.26, 0.97, 0.02) : Vec3(0.54, 0.99, 0.01);
  const Vec3 tips = handsOnHips ? Vec3(0.16, 0.9, 0.03) : Vec3(0.66, 0.88, 0.02);
  add({0.16, 1.38, 0}, 0.05, elbow, 0.042);
  add(elbow, 0.04, wrist, 0.03);
  add(wrist, 0.035, tips, 0.028);
  s.prepare();
  const SymmetricMesh mesh = mirrorHalf(polygonize(s, 0.02), s);
  TriMesh person;
  person.positions = mesh.positions;
  person.triangles = mesh.triangles;
  return person;
}

bool isOfLowerArm(const std::string& part) {
  return part.starts_with("fore_lower") || part.starts_with("fore_end");
}

}  // namespace

TEST(RigCheck, PosesOfPeopleAreToldByTheirArms) {
  for (const auto& [degrees, pose] : {std::pair(0.0, BodyPose::kT), std::pair(40.0, BodyPose::kA),
                                      std::pair(76.0, BodyPose::kHanging), std::pair(-57.0, BodyPose::kOther)}) {
    const RigCheck result = check(personWithArms(degrees));
    ASSERT_TRUE(result.pose) << degrees;
    EXPECT_EQ(nameOf(*result.pose), nameOf(pose)) << degrees;
  }
}

TEST(RigCheck, APersonInAPoseCanBeRigged) {
  const RigCheck result = check(personWithArms(40));
  EXPECT_THAT(result.kinds.front().name, StartsWith("humanoid"));
  EXPECT_TRUE(result.isSure);
  EXPECT_TRUE(result.isUpright);
  EXPECT_TRUE(result.missing.empty());
  EXPECT_TRUE(result.grownTogether.empty());
}

TEST(RigCheck, APersonWhoLiesIsNotUpright) {
  TriMesh lying = personWithArms(17);
  for (Vec3f& p : lying.positions) p = Vec3f(p.x(), -p.z(), p.y());
  EXPECT_FALSE(check(lying).isUpright);
}

TEST(RigCheck, HandsOnHipsAreGrownTogetherWithThem) {
  const std::vector<PartContact> contacts = check(sculptedPerson(true)).grownTogether;
  EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [](const PartContact& contact) {
    return isOfLowerArm(contact.one) != isOfLowerArm(contact.other);
  }));
  for (const PartContact& contact : check(sculptedPerson(false)).grownTogether) {
    EXPECT_FALSE(isOfLowerArm(contact.one) || isOfLowerArm(contact.other)) << contact.one << ", " << contact.other;
  }
}

TEST(RigCheck, ArmsThatAreCutOffAreMissing) {
  TriMesh mesh = personWithArms(17);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](Index v) { return std::abs(mesh.positions[v].x()) > 0.15f; });
  });
  EXPECT_THAT(check(mesh).missing, Contains(AnyOf(HasSubstr("leftHand"), HasSubstr("rightHand"))));
}

TEST(RigCheck, AChairIsNoBody) {
  const RigCheck result = check(testing::chair());
  ASSERT_FALSE(result.kinds.empty());
  EXPECT_LT(result.kinds.front().confidence, kLikelyTemplate);
  EXPECT_FALSE(result.isSure);
  EXPECT_FALSE(result.pose);
}

// With a loose vertex, too, which riggers leave out.
TEST(RigCheck, TheRiggerReadsTheBodyNoSecondTime) {
  TriMesh mesh = personWithArms(40);
  mesh.positions.emplace_back(5, 5, 5);
  RigOptions options;
  options.memory = std::make_shared<RigMemory>();
  const RigCheck result = checkRigging(mesh, options);
  const std::shared_ptr<const MeasuredModel> measured = options.memory->measured;
  ASSERT_TRUE(measured);
  Progress progress;
  const AutoRig rig = findRigger("template").rig(mesh, options, progress);
  EXPECT_EQ(options.memory->measured, measured);
  EXPECT_EQ(rig.matches.front().name, result.kinds.front().name);
  EXPECT_EQ(rig.matches.front().confidence, result.kinds.front().confidence);
}

}  // namespace limber
