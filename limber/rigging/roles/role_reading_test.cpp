#include "limber/rigging/roles/role_reading.h"

#include <cmath>

#include <gtest/gtest.h>

#include "limber/core/error.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/body/testing/measured_person.h"

namespace limber {

namespace {

const ReadingWeights& networks() {
  static const std::shared_ptr<const ReadingWeights> loaded = shapeWeights();
  return *loaded;
}

const SurfaceSamples& samples() {
  static const SurfaceSamples sampled = sampleSurface(testing::measuredPerson().shape.mesh, networks().sampleCount());
  return sampled;
}

RoleReading personReading(const std::map<std::string, Vec3>& known = {}) {
  static const RoleReading bare(samples(), networks(), testing::measuredPerson().frame);
  return known.empty() ? bare : RoleReading(samples(), networks(), testing::measuredPerson().frame, known);
}

RolePosition at(const std::string& role) {
  return {role, role, 0};
}

Vec3 imageOf(const Vec3& position) {
  return {-position.x(), position.y(), position.z()};
}

}  // namespace

// What the network says of a body does not depend on where, how large and which way round its mesh is.
TEST(RoleReading, PositionsAreOfTheBodyNotOfItsMesh) {
  const RoleReading usual = personReading();
  Mat3 rotation;  // +Z up, facing -Y
  rotation << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const double scale = 150;
  const Vec3 shift(3, -20, 800);
  SurfaceSamples moved = transformed(samples(), rotation);
  for (SurfaceSample& sample : moved.samples) {
    sample.position = scale * sample.position + shift;
    sample.innerRadius *= scale;
  }
  moved.center = scale * moved.center + shift;
  moved.scale *= scale;
  AnatomicalFrame frame = testing::measuredPerson().frame;
  frame.axes *= rotation.transpose();
  frame.origin = scale * (rotation * frame.origin) + shift;
  frame.height *= scale;
  const RoleReading reading(moved, networks(), frame);
  for (const std::string& role : networks().roles) {
    SCOPED_TRACE(role);
    EXPECT_LT((reading.position(at(role)) - usual.position(at(role))).norm(), 1e-3);
    EXPECT_NEAR(reading.expectedError(at(role)), usual.expectedError(at(role)), 1e-3);
  }
  for (const std::string& plan : networks().plans) {
    EXPECT_NEAR(reading.probability(plan), usual.probability(plan), 1e-3) << plan;
  }
}

TEST(RoleReading, PositionsBetweenRolesLieOnTheLine) {
  const RoleReading reading = personReading();
  const Vec3 from = reading.position(at("trunk_0")), to = reading.position(at("trunk_1"));
  EXPECT_LT((reading.position({"trunk_0", "trunk_1", 0.25}) - (0.75 * from + 0.25 * to)).norm(), 1e-9);
  EXPECT_NEAR(reading.expectedError({"trunk_0", "trunk_1", 0.25}),
              0.75 * reading.expectedError(at("trunk_0")) + 0.25 * reading.expectedError(at("trunk_1")), 1e-9);
}

TEST(RoleReading, UnknownNamesAreNoneOfTheBody) {
  const RoleReading reading = personReading();
  EXPECT_FALSE(reading.has("trunk_9"));
  EXPECT_FALSE(reading.has(""));
  EXPECT_EQ(reading.probability("centaur"), 0);
  EXPECT_FALSE(reading.boneEnd("trunk_9", reading.position(at("trunk_0"))));
  EXPECT_THROW(reading.position(at("trunk_9")), Error);
  EXPECT_THROW(reading.expectedError(at("trunk_9")), Error);
  const Vec3 hand = reading.position(at("fore_end.L"));
  EXPECT_LT((personReading({{"trunk_9", Vec3::Zero()}}).position(at("fore_end.L")) - hand).norm(), 1e-9);
}

TEST(RoleReading, APersonIsRead) {
  const RoleReading reading = personReading();
  double sum = 0;
  for (const std::string& plan : networks().plans) sum += reading.probability(plan);
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_GT(reading.probability("upright"), 0.5);
  for (const std::string& role : networks().roles) {
    EXPECT_TRUE(reading.position(at(role)).allFinite()) << role;
    EXPECT_GT(reading.expectedError(at(role)), 0) << role;
  }
  for (const char* role : {"trunk_0", "trunk_3", "head", "fore_upper.L", "fore_end.R", "hind_upper.L", "hind_end.R"}) {
    EXPECT_TRUE(reading.has(role)) << role;
  }
  for (const char* role : {"tail_0", "wing_0.L", "mida_upper.L", "fin0_0.R"}) EXPECT_FALSE(reading.has(role)) << role;
}

TEST(RoleReading, BonesEndWhereTheirSamplesSay) {
  const RoleReading reading = personReading();
  EXPECT_FALSE(reading.boneEnd("fore_lower.L", Vec3(0, 5, 0))) << "no bone begins there";
  std::size_t found = 0;
  for (const std::string& part : networks().parts) {
    for (const std::string& role : networks().roles) {
      const std::optional<Vec3> end = reading.boneEnd(part, reading.position(at(role)));
      if (!end) continue;
      ++found;
      EXPECT_LT((*end - Vec3(0, 0.5, 0)).norm(), 2) << part << " " << role;
    }
  }
  EXPECT_GT(found, 0u);
}

TEST(RoleReading, KnownJointsAreKept) {
  const std::map<std::string, Vec3> known = {{"fore_end.L", {0.36, 0.66, 0.02}}, {"tail_0", {0, 0.5, -0.1}}};
  RoleReading reading = personReading(known);
  for (const bool symmetric : {false, true}) {
    if (symmetric) reading.makeSymmetric();
    for (const auto& [role, position] : known) {
      EXPECT_LT((reading.position(at(role)) - position).norm(), 1e-9) << role << symmetric;
      EXPECT_NEAR(reading.expectedError(at(role)), 0, 1e-12) << role << symmetric;
      EXPECT_TRUE(reading.has(role)) << role << symmetric;
    }
    EXPECT_LT(reading.position(at("fore_end.R")).x(), 0) << symmetric;
  }
}

TEST(RoleReading, SidesAreMirrorImagesOnceSymmetric) {
  // A body that is like its mirror image, read from samples that are not, and in a plane that is not theirs.
  AnatomicalFrame frame = testing::measuredPerson().frame;
  frame.origin += 0.01 * frame.axes.row(0).transpose();
  RoleReading reading(samples(), networks(), frame);
  reading.makeSymmetric();
  for (std::size_t role = 0; role < networks().roles.size(); ++role) {
    const std::string& name = networks().roles[role];
    const std::string& other = networks().roles[networks().mirrorRole[role]];
    EXPECT_LT((reading.position(at(name)) - imageOf(reading.position(at(other)))).norm(), 1e-9) << name;
    EXPECT_NEAR(reading.expectedError(at(name)), reading.expectedError(at(other)), 1e-12) << name;
    EXPECT_EQ(reading.has(name), reading.has(other)) << name;
  }
  for (std::size_t part = 0; part < networks().parts.size(); ++part) {
    const std::string& other = networks().parts[networks().mirrorPart[part]];
    for (const std::string& role : networks().roles) {
      const Vec3 start = reading.position(at(role));
      const std::optional<Vec3> end = reading.boneEnd(networks().parts[part], start);
      const std::optional<Vec3> image = reading.boneEnd(other, imageOf(start));
      ASSERT_EQ(end.has_value(), image.has_value()) << role;
      if (end) {
        EXPECT_LT((*end - imageOf(*image)).norm(), 1e-9) << role;
      }
    }
  }
}

}  // namespace limber
