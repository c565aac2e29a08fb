#include "limber/samples/robot.h"

#include <array>
#include <string>
#include <vector>

#include "limber/samples/model_recipe.h"
#include "limber/samples/model_builder.h"

namespace limber {

namespace {

enum Material { kShell, kTrim, kDark, kGlow };

constexpr std::array<SampleMaterial, 4> kMaterials = {{{"shell", {236, 238, 240}, 0.35},
                                                       {"trim", {242, 140, 48}, 0.45},
                                                       {"rubber", {56, 62, 72}, 0.75},
                                                       {"light", {96, 214, 232}, 0.3}}};

// A part in its own space: it hangs down from its joint at the origin, and is symmetric in x.
ModelRecipe part(std::string_view name, double edge) {
  ModelRecipe c;
  c.name = name;
  c.edge = edge;
  c.cube = 0.6 * edge;
  return c;
}

ModelRecipe torso() {
  ModelRecipe c = part("torso", 0.022);
  c.shape.add(ellipsoid({0, 0.13, 0}, {0.175, 0.200, 0.140}), 0.02);
  c.shape.add(ellipsoid({0, 0.23, 0}, {0.180, 0.120, 0.130}), 0.08);
  c.shape.add(ellipsoid({0, -0.03, 0}, {0.120, 0.070, 0.100}), 0.04);  // pelvis
  c.paints = {{ellipsoid({0, 0.21, 0.145}, {0.075, 0.060, 0.060}), kTrim},
              {ellipsoid({0, 0.21, 0.165}, {0.030, 0.030, 0.060}), kGlow},
              {ellipsoid({0, -0.075, 0}, {0.200, 0.075, 0.200}), kDark}};
  return c;
}

ModelRecipe head() {
  ModelRecipe c = part("head", 0.020);
  c.shape.add(ellipsoid({0, 0.13, 0.010}, {0.165, 0.120, 0.135}), 0.02);
  c.shape.add(ellipsoid({0, 0.125, 0.100}, {0.120, 0.075, 0.055}), 0.04);  // visor
  c.shape.add(roundCone({0, 0.235, -0.010}, 0.012, {0, 0.330, -0.030}, 0.009), 0.012);
  c.shape.add(ellipsoid({0, 0.345, -0.032}, {0.024, 0.024, 0.024}), 0.006);
  c.shape.add(roundCone({0.150, 0.130, 0.000}, 0.045, {0.176, 0.130, 0.000}, 0.040), 0.012);  // ears
  c.details = {{ellipsoid({0.052, 0.130, 0.160}, {0.03, 0.03, 0.03}), 0.0065}};
  c.paints = {{ellipsoid({0, 0.130, 0.150}, {0.118, 0.070, 0.085}), kDark},
              {ellipsoid({0.050, 0.132, 0.155}, {0.020, 0.027, 0.030}), kGlow},
              {ellipsoid({0, 0.348, -0.032}, {0.029, 0.029, 0.029}), kTrim},
              {roundCone({0.210, 0.130, 0}, 0.048, {0.230, 0.130, 0}, 0.048), kTrim}};
  return c;
}

// A ball of rubber, 1 m in radius: nodes scale it to the size of each joint.
ModelRecipe ball() {
  ModelRecipe c = part("joint", 0.34);
  c.shape.add(ellipsoid({0, 0, 0}, {1, 1, 1}), 0.02);
  c.paints = {{ellipsoid({0, 0, 0}, {3, 3, 3}), kDark}};
  return c;
}

ModelRecipe limb(std::string_view name, double length, double top, double bottom, bool banded) {
  ModelRecipe c = part(name, 0.018);
  c.shape.add(roundCone({0, -0.035, 0}, top, {0, -length + 0.030, 0}, bottom), 0.02);
  if (banded) c.paints = {{ellipsoid({0, -length + 0.030, 0}, {0.2, 0.022, 0.2}), kTrim}};
  return c;
}

ModelRecipe hand() {
  ModelRecipe c = part("hand", 0.012);
  c.shape.add(ellipsoid({0, -0.040, 0}, {0.046, 0.042, 0.040}), 0.02);
  c.shape.add(roundCone({0.030, -0.060, 0.012}, 0.018, {0.036, -0.118, 0.014}, 0.014), 0.012);
  c.shape.add(roundCone({0, -0.050, -0.026}, 0.018, {0, -0.110, -0.032}, 0.014), 0.012);
  c.paints = {{ellipsoid({0, -0.125, 0}, {0.1, 0.040, 0.1}), kDark}};
  return c;
}

ModelRecipe foot() {
  ModelRecipe c = part("foot", 0.018);
  c.shape.add(ellipsoid({0, -0.050, 0.035}, {0.068, 0.055, 0.105}), 0.02);
  c.shape.cutBelow(-0.085, 0.014);
  c.paints = {{ellipsoid({0, -0.100, 0.03}, {0.3, 0.040, 0.4}), kDark}};
  return c;
}

Transform at(const Vec3& translation, const Quat& rotation = Quat::Identity(), double scale = 1) {
  return {translation, rotation, Vec3::Constant(scale)};
}

class RobotBuilder {
 public:
  RobotBuilder() : model_("robot") {
    for (const SampleMaterial& material : kMaterials) materials_.push_back(model_.addMaterial(material));
  }

  Index mesh(const ModelRecipe& character) {
    return model_.addMesh(character.name, buildCharacter(character), materials_);
  }
  Index node(std::string_view name, std::optional<Index> shown, const Transform& placed, std::optional<Index> parent) {
    return model_.addNode(name, shown, placed, parent);
  }
  Asset take() { return model_.take(); }

 private:
  ModelBuilder model_;
  std::vector<Index> materials_;
};

}  // namespace

Asset makeRobot() {
  RobotBuilder robot;
  const Index root = robot.node("robot", {}, at({0, 0.700, 0}), {});
  const Index body = robot.node("torso", robot.mesh(torso()), {}, root);
  const Index rubber = robot.mesh(ball());
  robot.node("neck", rubber, at({0, 0.345, 0}, Quat::Identity(), 0.055), body);
  robot.node("head", robot.mesh(head()), at({0, 0.375, 0}), body);

  const Index upperArm = robot.mesh(limb("upper arm", 0.210, 0.048, 0.042, false));
  const Index forearm = robot.mesh(limb("forearm", 0.190, 0.044, 0.050, true)), grip = robot.mesh(hand());
  const Index thigh = robot.mesh(limb("thigh", 0.280, 0.064, 0.052, false));
  const Index shin = robot.mesh(limb("shin", 0.270, 0.052, 0.062, true)), sole = robot.mesh(foot());
  for (const double side : {1.0, -1.0}) {
    const auto name = [&](std::string_view what) { return std::string(what) + (side > 0 ? ".L" : ".R"); };
    // Half of the angle has a tangent of 5 / 12: the arms stand some 45 degrees off the body.
    const Quat outward(12.0 / 13, 0, 0, side * 5.0 / 13);
    const Index shoulder = robot.node(name("shoulder"), {}, at({side * 0.185, 0.265, 0}, outward), body);
    robot.node(name("shoulder joint"), rubber, at(Vec3::Zero(), Quat::Identity(), 0.060), shoulder);
    robot.node(name("upper arm"), upperArm, at({0, -0.025, 0}), shoulder);
    const Index elbow = robot.node(name("elbow"), {}, at({0, -0.240, 0}), shoulder);
    robot.node(name("elbow joint"), rubber, at(Vec3::Zero(), Quat::Identity(), 0.042), elbow);
    robot.node(name("forearm"), forearm, at(Vec3::Zero()), elbow);
    robot.node(name("hand"), grip, at({0, -0.195, 0}), elbow);

    const Index hip = robot.node(name("hip"), {}, at({side * 0.085, -0.070, 0}), body);
    robot.node(name("hip joint"), rubber, at(Vec3::Zero(), Quat::Identity(), 0.062), hip);
    robot.node(name("thigh"), thigh, at({0, -0.020, 0}), hip);
    const Index knee = robot.node(name("knee"), {}, at({0, -0.300, 0}), hip);
    robot.node(name("knee joint"), rubber, at(Vec3::Zero(), Quat::Identity(), 0.050), knee);
    robot.node(name("shin"), shin, at(Vec3::Zero()), knee);
    robot.node(name("foot"), sole, at({0, -0.245, 0}), knee);
  }
  return robot.take();
}

}  // namespace limber
