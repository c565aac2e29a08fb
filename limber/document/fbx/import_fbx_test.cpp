#include "limber/document/fbx/import_fbx.h"

#include <cmath>
#include <map>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/document/fbx/import_fbx_budget.h"
#include "limber/document/fbx/import_fbx_curve.h"
#include "limber/document/fbx/import_fbx_mesh.h"
#include "limber/document/fbx/import_fbx_transform.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/scene/shape_name.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/uri.h"
#include "warning_kinds.h"

namespace limber {
namespace {

using testing::warningKinds;

constexpr std::int64_t kSecond = 46186158000;

std::string array(const char* name, const std::vector<double>& values) {
  return fmt::format("{}: *{} {{\na: {}\n}}\n", name, values.size(), fmt::join(values, ","));
}

std::string wholes(const char* name, const std::vector<std::int64_t>& values) {
  return fmt::format("{}: *{} {{\na: {}\n}}\n", name, values.size(), fmt::join(values, ","));
}

std::string properties(const std::string& lines) {
  return "Properties70:  {\n" + lines + "}\n";
}

std::string vector(const char* name, const Vec3& v) {
  return fmt::format("P: \"{}\", \"Vector3D\", \"Vector\", \"\",{},{},{}\n", name, v.x(), v.y(), v.z());
}

std::string number(const char* name, double value) {
  return fmt::format("P: \"{}\", \"double\", \"Number\", \"\",{}\n", name, value);
}

// In metres.
Asset importText(const std::string& objects, const std::string& connections, const Resolver& resolver = {}) {
  const std::string text =
      "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\nFBXVersion: 7400\n}\nGlobalSettings:  {\n" +
      properties(number("UnitScaleFactor", 100)) + "}\nObjects:  {\n" + objects + "}\nConnections:  {\n" + connections +
      "}\n";
  Asset asset = importFbx(asBytes(text), resolver);
  checkAsset(asset);
  return asset;
}

std::string model(int id, const char* name, const char* kind, const std::string& lines = {}) {
  return fmt::format("Model: {}, \"Model::{}\", \"{}\" {{\n{}}}\n", id, name, kind, properties(lines));
}

std::string link(int from, int to) {
  return fmt::format("C: \"OO\",{},{}\n", from, to);
}

std::string link(int from, int to, const char* property) {
  return fmt::format("C: \"OP\",{},{}, \"{}\"\n", from, to, property);
}

// By matrices of one axis each: nothing of the code's own quaternions.
Mat3 turns(const Vec3& degrees, const std::array<int, 3>& firstToLast) {
  Mat3 result = Mat3::Identity();
  for (const int axis : firstToLast) {
    result = Eigen::AngleAxisd(degrees[axis] * kDegree, Vec3::Unit(axis)).toRotationMatrix() * result;
  }
  return result;
}

const std::vector<double> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

std::string triangle(int id) {
  return fmt::format("Geometry: {}, \"Geometry::Tri\", \"Mesh\" {{\n{}{}}}\n", id, array("Vertices", kTriangle),
                     wholes("PolygonVertexIndex", {0, 1, -3}));
}

TEST(ImportFbx7, TheWholeTransformIsThatOfTheSdksFormula) {
  constexpr std::array<std::array<int, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};
  const Vec3 t(1, 2, 3), r(10, 20, -30), s(1, 2, 0.5), pre(5, -50, 70), post(-20, 15, 33),
      rotationOffset(0.1, 0.2, 0.3), rotationPivot(1, 0.5, -0.25), scalingOffset(-0.5, 0.3, 0.1),
      scalingPivot(0.2, 0.4, 0.8);
  for (int order = 0; order < 6; ++order) {
    const std::string lines = vector("Lcl Translation", t) + vector("Lcl Rotation", r) + vector("Lcl Scaling", s) +
                              vector("PreRotation", pre) + vector("PostRotation", post) +
                              vector("RotationOffset", rotationOffset) + vector("RotationPivot", rotationPivot) +
                              vector("ScalingOffset", scalingOffset) + vector("ScalingPivot", scalingPivot) +
                              number("RotationOrder", order) + number("RotationActive", 1);
    const Asset asset = importText(model(1, "Odd", "Null", lines), link(1, 0));
    const auto moved = [](const Vec3& by) { return Affine(Eigen::Translation3d(by)); };
    const Affine wanted = moved(t) * moved(rotationOffset) * moved(rotationPivot) * Affine(turns(pre, kOrders[0])) *
                          Affine(turns(r, kOrders[static_cast<std::size_t>(order)])) *
                          Affine(turns(post, kOrders[0])).inverse() * moved(-rotationPivot) * moved(scalingOffset) *
                          moved(scalingPivot) * Affine(Eigen::Scaling(s)) * moved(-scalingPivot);
    const Affine got = readSceneGraph(asset.document).world[0];
    EXPECT_LT((got.matrix() - wanted.matrix()).cwiseAbs().maxCoeff(), 1e-6) << order;
  }
}

TEST(ImportFbx7, WithoutRotationActivePreRotationDoesNotCount) {
  const Asset asset = importText(model(1, "Odd", "Null", vector("PreRotation", {0, 0, 90})), link(1, 0));
  EXPECT_FALSE(asset.document.nodes.at(0).rotation);
}

TEST(ImportFbx7, AGeometricTransformMovesTheMeshAndNoChild) {
  const Asset asset = importText(model(1, "Parent", "Mesh", vector("GeometricTranslation", {0, 5, 0})) +
                                     model(2, "Child", "Mesh") + triangle(3) + triangle(4),
                                 link(1, 0) + link(2, 1) + link(3, 1) + link(4, 2));
  const Geometry geometry = collectGeometry(asset);
  ASSERT_EQ(geometry.positions.size(), 6u);
  EXPECT_EQ(geometry.positions[0], Vec3f(0, 5, 0));
  EXPECT_EQ(geometry.positions[3], Vec3f(0, 0, 0));
}

TEST(ImportFbx7, ScalesComeDownAsInheritTypeSays) {
  // A parent of scale (2, 1, 1); a child turned by 90 degrees about z, moved by 1 along x.
  const std::string turned = vector("Lcl Translation", {1, 0, 0}) + vector("Lcl Rotation", {0, 0, 90});
  const auto tip = [&](int inherit) {
    const Asset asset = importText(model(1, "Parent", "Null", vector("Lcl Scaling", {2, 1, 1})) +
                                       model(2, "Child", "Null", turned + number("InheritType", inherit)),
                                   link(1, 0) + link(2, 1));
    return Vec3(readSceneGraph(asset.document).world[1] * Vec3(0, 1, 0));
  };
  // The child's y points along the world's -x. RSrs: the parent stretches it there. RrSs: its own y is the one that the
  // parent does not stretch. Rrs: neither.
  EXPECT_LT((tip(1) - Vec3(2 - 2, 0, 0)).norm(), 1e-6);
  EXPECT_LT((tip(0) - Vec3(2 - 1, 0, 0)).norm(), 1e-6);
  EXPECT_LT((tip(2) - Vec3(2 - 1, 0, 0)).norm(), 1e-6);
}

// Maya's segment scale compensate: the parent's own scale alone is undone, an uneven one further up shears the child.
TEST(ImportFbx7, WithoutItsParentsScaleAModelKeepsItsGrandparents) {
  const Asset asset = importText(
      model(1, "Grandparent", "Null", vector("Lcl Scaling", {1, 3, 1})) +
          model(2, "Parent", "Null", vector("Lcl Scaling", {2, 1, 1}) + vector("Lcl Rotation", {0, 0, 90})) +
          model(3, "Child", "Null",
                vector("Lcl Translation", {1, 0, 0}) + vector("Lcl Rotation", {0, 0, 45}) + number("InheritType", 2)),
      link(1, 0) + link(2, 1) + link(3, 2));
  // The child lies at (0, 2 * 3, 0); its x is turned by 90 + 45 degrees, then stretched along the world's y.
  const double half = std::sqrt(.5);
  EXPECT_LT((readSceneGraph(asset.document).world[2] * Vec3(1, 0, 0) - Vec3(-half, 6 + 3 * half, 0)).norm(), 1e-6);
}

// glTF allows no matrix where there are tracks.
TEST(ImportFbx7, WhatIsShearedByAParentThatMovesHasNoMatrix) {
  const std::string curves =
      "AnimationStack: 10, \"AnimStack::Swing\", \"\" {\n}\nAnimationLayer: 11, \"AnimLayer::Base\", \"\" {\n}\n"
      "AnimationCurveNode: 12, \"AnimCurveNode::R\", \"\" {\n" +
      properties("P: \"d|X\", \"Number\", \"\", \"A\",90\n") + "}\n";
  const auto child = [&](const std::string& objects, const std::string& links) {
    const Asset asset = importText(
        model(1, "Parent", "Null", vector("Lcl Scaling", {2, 1, 1})) +
            model(2, "Child", "Null", vector("Lcl Rotation", {0, 0, 30}) + number("InheritType", 0)) + objects,
        link(1, 0) + link(2, 1) + links);
    return asset.document.nodes.at(1);
  };
  EXPECT_TRUE(child("", "").matrix);
  EXPECT_FALSE(child(curves, link(11, 10) + link(12, 11) + link(12, 1, "Lcl Rotation")).matrix);
}

TEST(ImportFbx7, ARigidMeshBelowAnArmatureScaledAHundredTimes) {
  // A hat of 0.2 m in units of centimetres, below a bone of an armature of its own that is scaled 100 times.
  const Asset asset = importText(
      model(1, "Armature", "Null", vector("Lcl Scaling", {100, 100, 100}) + vector("Lcl Rotation", {-90, 0, 0})) +
          model(2, "Head", "LimbNode", vector("Lcl Translation", {0, 0, 0.017})) +
          model(3, "Hat", "Mesh", vector("Lcl Scaling", {0.002, 0.002, 0.002})) + triangle(4),
      link(1, 0) + link(2, 1) + link(3, 2) + link(4, 3));
  const Geometry geometry = collectGeometry(asset);
  EXPECT_LT((geometry.positions[0] - Vec3f(0, 1.7f, 0)).norm(), 1e-5);
  EXPECT_NEAR((geometry.positions[1] - geometry.positions[0]).norm(), 0.2, 1e-6);
}

std::string curve(int id, const std::vector<double>& seconds, const std::vector<double>& values,
                  const std::string& shape = {}) {
  std::vector<std::int64_t> ticks;
  for (const double t : seconds) ticks.push_back(std::llround(t * static_cast<double>(kSecond)));
  return fmt::format("AnimationCurve: {}, \"AnimCurve::\", \"\" {{\n{}{}{}}}\n", id, wholes("KeyTime", ticks),
                     array("KeyValueFloat", values), shape);
}

std::string shapes(std::int64_t flags, const std::vector<double>& data, std::int64_t count) {
  return wholes("KeyAttrFlags", {flags}) + array("KeyAttrDataFloat", data) + wholes("KeyAttrRefCount", {count});
}

// A model 1 whose property is moved by curves of x, y and z, or constant with the values of the curves' node.
Asset animated(const std::string& lines, const char* property, const std::array<std::string, 3>& curves,
               const std::string& stack = {}, const std::string& still = {}) {
  std::string objects =
      model(1, "Arm", "LimbNode", lines) +
      fmt::format("AnimationStack: 10, \"AnimStack::Swing\", \"\" {{\n{}}}\n", properties(stack)) +
      "AnimationLayer: 11, \"AnimLayer::Base\", \"\" {\n}\nAnimationCurveNode: 12, \"AnimCurveNode::R\", "
      "\"\" {\n" +
      properties(still) + "}\n";
  std::string links = link(1, 0) + link(11, 10) + link(12, 11) + link(12, 1, property);
  const char* axes[] = {"d|X", "d|Y", "d|Z"};
  for (int i = 0; i < 3; ++i) {
    if (curves[static_cast<std::size_t>(i)].empty()) continue;
    objects += curves[static_cast<std::size_t>(i)];
    links += link(20 + i, 12, axes[i]);
  }
  return importText(objects, links);
}

struct ReadTrack {
  std::vector<float> times, values;
  Interpolation interpolation;
};

ReadTrack trackOf(const Asset& asset, std::string_view path) {
  for (const gltf::AnimationChannel& channel : asset.document.animations.at(0).channels) {
    const gltf::AnimationSampler& sampler = asset.document.animations[0].samplers[channel.sampler];
    if (channel.target.path == path) {
      return {readFloats(asset, sampler.input), readFloats(asset, sampler.output), sampler.interpolation};
    }
  }
  ADD_FAILURE() << "no " << path;
  return {};
}

// Linear, by the letter of glTF.
Quat rotationAt(const ReadTrack& track, double seconds) {
  std::size_t next = 0;
  while (next < track.times.size() && track.times[next] <= seconds) ++next;
  const auto key = [&](std::size_t k) {
    return Quat(Vec4(Eigen::Map<const Vec4f>(&track.values[4 * k]).cast<double>()));
  };
  if (next == 0) return key(0);
  if (next == track.times.size()) return key(next - 1);
  const double x = (seconds - track.times[next - 1]) / (track.times[next] - track.times[next - 1]);
  return key(next - 1).slerp(x, key(next));
}

TEST(ImportFbx7, AnglesAreRightBetweenKeysToo) {
  // Three turns in two seconds about one axis while another one swings: no slerp between the two keys is near it.
  const Asset asset = animated(vector("PreRotation", {0, 30, 0}) + number("RotationActive", 1), "Lcl Rotation",
                               {curve(20, {0, 2}, {0, 1080}), curve(21, {0, 2}, {-60, 80}), ""});
  const ReadTrack track = trackOf(asset, "rotation");
  double worst = 0;
  for (int i = 0; i <= 400; ++i) {
    const double t = i / 200.0;
    const Mat3 wanted = turns({0, 30, 0}, {0, 1, 2}) * turns({540 * t, -60 + 70 * t, 0}, {0, 1, 2});
    worst = std::max(worst, Quat(wanted).angularDistance(rotationAt(track, t)));
  }
  EXPECT_LT(worst, 0.001);
  EXPECT_EQ(track.times.back(), 2);
}

TEST(ImportFbx7, WhatTurnsAboutAPivotGoesRoundIt) {
  // 270 degrees within eleven frames of a film, five metres away.
  const double end = 11.0 / 24;
  const Asset asset =
      animated(vector("RotationPivot", {5, 0, 0}), "Lcl Rotation", {"", "", curve(22, {0, end}, {0, 270})});
  const ReadTrack track = trackOf(asset, "translation");
  double worst = 0;
  for (std::size_t k = 1; k < track.times.size(); ++k) {
    for (const double x : {0.25, 0.5, 0.75}) {
      const double t = track.times[k - 1] + x * (track.times[k] - track.times[k - 1]);
      const Vec3 pivot(5, 0, 0), wanted = pivot - turns({0, 0, 270 * t / end}, {0, 1, 2}) * pivot;
      const auto key = [&](std::size_t at) { return Eigen::Map<const Vec3f>(&track.values[3 * at]).cast<double>(); };
      worst = std::max(worst, (key(k - 1) + x * (key(k) - key(k - 1)) - wanted).norm());
    }
  }
  EXPECT_LT(worst, 0.005);
  EXPECT_LT(track.times.size(), 100u);
}

TEST(ImportFbx7, SlopesOfCubicKeysAreHermites) {
  // One slope at the first key, another one at the second: 0 + start t at the start, end at the end, over a second.
  const auto expectSlopes = [](const std::vector<double>& data, double start, double end) {
    const Asset asset =
        animated({}, "Lcl Translation", {curve(20, {0, 1}, {0, 1}, shapes(0x8 | 0x400, data, 2)), "", ""});
    const ReadTrack track = trackOf(asset, "translation");
    EXPECT_GT(track.times.size(), 5u);
    for (std::size_t k = 0; k < track.times.size(); ++k) {
      const double t = track.times[k], t2 = t * t, t3 = t2 * t;
      const double wanted = (t3 - 2 * t2 + t) * start + (-2 * t3 + 3 * t2) * 1 + (t3 - t2) * end;
      EXPECT_NEAR(track.values[3 * k], wanted, 1e-6);
    }
  };
  expectSlopes({1077936128, -1073741824, 0, 0}, 3, -2);  // as text has them since 7.2: the bits of floats
  expectSlopes({3.5, -2, 0, 0}, 3.5, -2);                // and before
  expectSlopes({3, -2, 0, 0}, 3, -2);
}

// What is constant while another property is animated, here a mirroring scale, comes from the node itself.
TEST(ImportFbx7, MirroredModelsTurnAsTheirCurvesSay) {
  for (const Vec3& scale : {Vec3(1, 1, -2), Vec3(-1, -3, 1), Vec3(1, -1, 1), Vec3(-1, -1, -1)}) {
    const Asset asset = animated(vector("Lcl Scaling", scale) + vector("Lcl Rotation", {0, 20, 0}), "Lcl Rotation",
                                 {"", curve(21, {0, 1}, {20, 50}), curve(22, {0, 1}, {0, 70})});
    const Vec3 shown = asset.document.nodes.at(0).scale.value_or(Vec3::Ones());
    const ReadTrack track = trackOf(asset, "rotation");
    for (const double t : {0.0, 1.0}) {
      const Mat3 got = rotationAt(track, t).toRotationMatrix() * shown.asDiagonal();
      const Mat3 wanted = turns({0, 20 + 30 * t, 70 * t}, {0, 1, 2}) * scale.asDiagonal();
      EXPECT_LT((got - wanted).cwiseAbs().maxCoeff(), 1e-6) << scale.transpose();
    }
    const Mat3 rest = turns({0, 20, 0}, {0, 1, 2}) * scale.asDiagonal();
    EXPECT_LT((readSceneGraph(asset.document).world[0].linear() - rest).cwiseAbs().maxCoeff(), 1e-6);
  }
}

TEST(ImportFbx7, WhatGrowsFromNothingKeepsItsRotation) {
  const Asset asset = animated(vector("Lcl Scaling", {0, 0, 0}) + vector("Lcl Rotation", {0, 90, 0}), "Lcl Scaling",
                               {curve(20, {0, 1}, {0, 1}), curve(21, {0, 1}, {0, 1}), curve(22, {0, 1}, {0, 1})});
  const Quat shown(asset.document.nodes.at(0).rotation.value());
  EXPECT_LT(shown.angularDistance(Quat(turns({0, 90, 0}, {0, 1, 2}))), 1e-6);
}

// Joints that a take holds elsewhere than the rest have no curves there.
TEST(ImportFbx7, WhatATakeHoldsStillHasOneKey) {
  const std::string still = "P: \"d|X\", \"Number\", \"\", \"A\",90\n";
  const Asset asset = animated({}, "Lcl Rotation", {}, {}, still);
  const ReadTrack track = trackOf(asset, "rotation");
  EXPECT_EQ(track.times, std::vector<float>{0});
  EXPECT_LT(rotationAt(track, 0).angularDistance(Quat(turns({90, 0, 0}, {0, 1, 2}))), 1e-6);
  EXPECT_EQ(asset.document.animations.at(0).channels.size(), 1u);
  EXPECT_TRUE(animated(vector("Lcl Rotation", {90, 0, 0}), "Lcl Rotation", {}, {}, still).document.animations.empty());
}

TEST(ImportFbx7, CurvesThatGoOnBeyondTheirKeysAreTold) {
  const auto kinds = [](const char* mode) {
    const std::string beyond = fmt::format("Post-Extrapolation:  {{\nType: {}\nRepetition: -1\n}}\n", mode);
    return warningKinds(animated({}, "Lcl Translation", {curve(20, {0, 1}, {0, 1}, beyond), "", ""}).warnings);
  };
  EXPECT_TRUE(kinds("C").empty());
  EXPECT_EQ(kinds("R"), std::vector<std::string>{"extrapolated-curves"});
  EXPECT_EQ(kinds("82"), std::vector<std::string>{"extrapolated-curves"});  // as binary files have it
}

TEST(ImportFbx7, StepsStaySteps) {
  const std::string steps = shapes(0x2, {0, 0, 0, 0}, 3);
  const Asset asset = animated({}, "Lcl Translation", {curve(20, {0, 1, 2}, {0, 5, 7}, steps), "", ""});
  const ReadTrack track = trackOf(asset, "translation");
  EXPECT_EQ(track.interpolation, Interpolation::kStep);
  EXPECT_EQ(track.times, (std::vector<float>{0, 1, 2}));
  // Among what moves, a step is two keys one after the other.
  const Asset mixed =
      animated({}, "Lcl Translation", {curve(20, {0, 1, 2}, {0, 5, 7}, steps), curve(21, {0, 2}, {0, 1}), ""});
  const ReadTrack both = trackOf(mixed, "translation");
  ASSERT_EQ(both.times.size(), 5u);
  EXPECT_EQ(both.times[1], std::nextafter(1.0f, 0.0f));
  EXPECT_EQ(both.values[3], 0);
  EXPECT_EQ(both.values[6], 5);
}

TEST(ImportFbx7, AClipBeginsAndEndsWithItsStack) {
  const std::string span = fmt::format(
      "P: \"LocalStart\", \"KTime\", \"Time\", \"\",{}\nP: \"LocalStop\", \"KTime\", "
      "\"Time\", \"\",{}\n",
      kSecond, 3 * kSecond);
  const Asset asset = animated({}, "Lcl Translation", {curve(20, {0, 2, 4}, {0, 2, 4}), "", ""}, span);
  const ReadTrack track = trackOf(asset, "translation");
  EXPECT_EQ(track.times, (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(track.values[0], 1);
  EXPECT_EQ(track.values[6], 3);
  EXPECT_EQ(asset.document.animations[0].name, "Swing");
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"trimmed-clips"});
}

TEST(ImportFbx7, AClipThatStandsStillLastsAsLongAsItsStack) {
  const std::string span = fmt::format(
      "P: \"LocalStart\", \"KTime\", \"Time\", \"\",0\nP: \"LocalStop\", \"KTime\", "
      "\"Time\", \"\",{}\n",
      3 * kSecond);
  const Asset still = animated({}, "Lcl Translation", {curve(20, {0}, {5}), "", ""}, span);
  EXPECT_EQ(trackOf(still, "translation").times, (std::vector<float>{0, 3}));
  EXPECT_EQ(still.document.animations[0].channels.size(), 1u);
  const Asset keyedBefore = animated({}, "Lcl Translation", {curve(20, {-1}, {5}), "", ""}, span);
  EXPECT_EQ(trackOf(keyedBefore, "translation").times, (std::vector<float>{0, 3}));
  const Asset keyedAfter = animated({}, "Lcl Translation", {curve(20, {4}, {5}), "", ""}, span);
  EXPECT_EQ(trackOf(keyedAfter, "translation").times, (std::vector<float>{0, 3}));
  const Asset moving = animated({}, "Lcl Translation", {curve(20, {0, 2}, {5, 6}), "", ""}, span);
  EXPECT_EQ(trackOf(moving, "translation").times, (std::vector<float>{0, 2}));
}

TEST(ImportFbx7, AStackWithoutEndsHasThoseOfItsKeys) {
  const std::string span =
      "P: \"LocalStart\", \"KTime\", \"Time\", \"\",-9223372036854775807\n"
      "P: \"LocalStop\", \"KTime\", \"Time\", \"\",46186158000\n";
  const Asset asset = animated({}, "Lcl Translation", {curve(20, {2, 4}, {0, 2}), "", ""}, span);
  EXPECT_EQ(trackOf(asset, "translation").times, (std::vector<float>{0, 2}));
}

TEST(ImportFbx7, PolygonsLayersAndMaterials) {
  // A square and a concave pentagon beside it that shares an edge; a normal for all, texture coordinates by corner.
  const std::vector<double> positions = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0, 4, 0, 0, 3, 1, 0, 4, 2, 0};
  const std::string layers =
      "LayerElementNormal: 0 {\nMappingInformationType: \"AllSame\"\nReferenceInformationType: \"Direct\"\n" +
      array("Normals", {0, 0, 2}) +
      "}\nLayerElementUV: 0 {\nName: \"map\"\nMappingInformationType: \"ByVertice\"\nReferenceInformationType: "
      "\"IndexToDirect\"\n" +
      array("UV", {0, 0, 1, 0.25}) + wholes("UVIndex", {0, 1, 1, 0, 1, 0, 1}) +
      "}\nLayerElementMaterial: 0 {\nMappingInformationType: \"ByPolygon\"\nReferenceInformationType: "
      "\"IndexToDirect\"\n" +
      wholes("Materials", {1, 0}) + "}\n";
  const std::string geometry = "Geometry: 3, \"Geometry::Flat\", \"Mesh\" {\n" + array("Vertices", positions) +
                               wholes("PolygonVertexIndex", {0, 1, 2, -4, 1, 4, 5, 6, -3}) + layers + "}\n";
  const std::string red = "Material: 5, \"Material::Red\", \"\" {\n" +
                          properties(vector("DiffuseColor", {1, 0, 0}) + number("Opacity", 0.5)) + "}\n";
  const std::string blue =
      "Material: 6, \"Material::Blue\", \"\" {\n" + properties(vector("DiffuseColor", {0, 0, 1})) + "}\n";
  const Asset asset =
      importText(model(1, "Flat", "Mesh") + geometry + red + blue, link(1, 0) + link(3, 1) + link(5, 1) + link(6, 1));
  const gltf::Mesh& mesh = asset.document.meshes.at(0);
  ASSERT_EQ(mesh.primitives.size(), 2u);
  EXPECT_EQ(asset.document.materials.at(*mesh.primitives[0].material).name, "Red");
  EXPECT_EQ(asset.document.materials.at(*mesh.primitives[0].material).alphaMode, "BLEND");
  EXPECT_EQ(asset.document.materials.at(*mesh.primitives[1].material).name, "Blue");
  const Geometry all = collectGeometry(asset);
  EXPECT_EQ(all.positions.size(), 5u + 4u);
  EXPECT_EQ(all.triangles.size(), 3u + 2u);
  double area = 0;
  for (const Triangle& t : all.triangles) {
    const Vec3f cross = (all.positions[t[1]] - all.positions[t[0]]).cross(all.positions[t[2]] - all.positions[t[0]]);
    EXPECT_GT(cross.z(), 0);
    area += 0.5 * cross.z();
  }
  EXPECT_NEAR(area, 4 + 3, 1e-6);
  const std::vector<float> normals = readFloats(asset, *mesh.primitives[1].attributes.find("NORMAL"));
  EXPECT_EQ(normals[2], 1);
  const std::vector<float> uvs = readFloats(asset, *mesh.primitives[1].attributes.find("TEXCOORD_0"));
  EXPECT_EQ(uvs, (std::vector<float>{0, 1, 1, 0.75f, 1, 0.75f, 0, 1}));  // of control points 0 to 3
}

std::string matrix(const char* name, const Affine& map) {
  return array(name, std::vector<double>(map.matrix().data(), map.matrix().data() + 16));
}

TEST(ImportFbx7, ASkinStandsWhereItWasBoundAndBendsWithItsJoints) {
  // The mesh's model is rotated and scaled; the joint was bound elsewhere than where its node is.
  const Affine mesh = Eigen::Translation3d(1, 2, 3) * Affine(turns({0, 90, 0}, {0, 1, 2})) * Eigen::Scaling(2.0);
  const Affine bound = Eigen::Translation3d(0, 1, 0) * Affine(turns({45, 0, 0}, {0, 1, 2}));
  const Affine nodeTransform = Affine(Eigen::Translation3d(0, 1, 5));
  const std::string cluster = "Deformer: 6, \"SubDeformer::c\", \"Cluster\" {\n" + wholes("Indexes", {0, 1}) +
                              array("Weights", {1, 0.5}) + matrix("Transform", bound.inverse() * mesh) +
                              matrix("TransformLink", bound) + "}\n";
  const Asset asset = importText(model(1, "Body", "Mesh", vector("Lcl Translation", {7, 0, 0})) +
                                     model(2, "Joint", "LimbNode", vector("Lcl Translation", {0, 1, 5})) + triangle(3) +
                                     "Deformer: 5, \"Deformer::s\", \"Skin\" {\n}\n" + cluster,
                                 link(1, 0) + link(2, 0) + link(3, 1) + link(5, 3) + link(6, 5) + link(2, 6));
  ASSERT_EQ(asset.document.skins.size(), 1u);
  const gltf::Skin& skin = asset.document.skins[0];
  const std::vector<float> matrices = readFloats(asset, *skin.inverseBindMatrices);
  const SceneGraph graph = readSceneGraph(asset.document);
  const auto shown = [&](Index joint, const Vec3& point) {
    Affine inverseBind;
    inverseBind.matrix() = Eigen::Map<const Eigen::Matrix4f>(&matrices[16 * joint]).cast<double>();
    return Vec3(graph.world[skin.joints[joint]] * inverseBind * point);
  };
  const gltf::Primitive& primitive = asset.document.meshes.at(0).primitives.at(0);
  const std::vector<float> positions = readFloats(asset, *primitive.attributes.find("POSITION"));
  for (Index v = 0; v < 3; ++v) {
    const Vec3 own(kTriangle[3 * v], kTriangle[3 * v + 1], kTriangle[3 * v + 2]);
    const Vec3 position = Eigen::Map<const Vec3f>(&positions[3 * v]).cast<double>();
    EXPECT_LT((position - mesh * own).norm(), 1e-5);  // in the world as it was bound
    const Vec3 wanted =
        v < 2 ? nodeTransform * bound.inverse() * mesh * own : own + Vec3(7, 0, 0);  // without weights: its model
    EXPECT_LT((shown(v < 2 ? 0 : 1, position) - wanted).norm(), 1e-5);
  }
  const std::vector<float> weights = readFloats(asset, *primitive.attributes.find("WEIGHTS_0"));
  EXPECT_EQ(weights[0], 1);
  EXPECT_EQ(weights[4], 1);  // one half of one alone is all of it
  // glTF asks for a node above all joints.
  ASSERT_EQ(skin.joints.size(), 2u);
  ASSERT_TRUE(graph.parent[skin.joints[0]]);
  EXPECT_EQ(graph.parent[skin.joints[0]], graph.parent[skin.joints[1]]);
  EXPECT_TRUE(graph.shown[skin.joints[0]]);
}

TEST(ImportFbx7, BlendShapesWithOneInBetween) {
  const auto shape = [](int id, const char* name, double up) {
    return fmt::format("Geometry: {}, \"Geometry::{}\", \"Shape\" {{\n{}{}}}\n", id, name, wholes("Indexes", {1}),
                       array("Vertices", {0, up, 0}));
  };
  const std::string channel = "Deformer: 6, \"SubDeformer::Smile\", \"BlendShapeChannel\" {\nDeformPercent: 75\n" +
                              array("FullWeights", {50, 100}) + "}\n";
  const Asset asset = importText(model(1, "Face", "Mesh") + triangle(3) + shape(7, "half", 1) + shape(8, "full", 3) +
                                     "Deformer: 5, \"Deformer::b\", \"BlendShape\" {\n}\n" + channel,
                                 link(1, 0) + link(3, 1) + link(5, 3) + link(6, 5) + link(7, 6) + link(8, 6));
  const gltf::Mesh& mesh = asset.document.meshes.at(0);
  EXPECT_EQ(mesh.weights, (std::vector<double>{0.5, 0.5}));  // halfway from the first to the second
  ASSERT_EQ(mesh.primitives.at(0).targets.size(), 2u);
  const std::vector<float> moves = readFloats(asset, *mesh.primitives[0].targets[1].find("POSITION"));
  EXPECT_EQ(moves, (std::vector<float>{0, 0, 0, 0, 3, 0, 0, 0, 0}));
  EXPECT_EQ(shapeName(mesh, 0), "half");
}

// A triangle with one channel of blend shapes; each shape moves all its points up by 1.
Asset importChannel(const std::vector<std::vector<std::int64_t>>& pointsOfShapes, double percent,
                    const std::vector<double>& full, const std::string& more = {}, const std::string& moreLinks = {}) {
  std::string objects =
      model(1, "Face", "Mesh") + triangle(3) + "Deformer: 5, \"Deformer::b\", \"BlendShape\" {\n}\n" +
      fmt::format("Deformer: 6, \"SubDeformer::c\", \"BlendShapeChannel\" {{\nDeformPercent: {}\n{}}}\n", percent,
                  array("FullWeights", full));
  std::string links = link(1, 0) + link(3, 1) + link(5, 3) + link(6, 5);
  for (std::size_t s = 0; s < pointsOfShapes.size(); ++s) {
    const int id = 7 + static_cast<int>(s);
    std::vector<double> moves;
    for (std::size_t i = 0; i < pointsOfShapes[s].size(); ++i) moves.insert(moves.end(), {0, 1, 0});
    objects += fmt::format("Geometry: {}, \"Geometry::s{}\", \"Shape\" {{\n{}{}}}\n", id, s,
                           wholes("Indexes", pointsOfShapes[s]), array("Vertices", moves));
    links += link(id, 6);
  }
  return importText(objects + more, links + moreLinks);
}

TEST(ImportFbx7, FullWeightsOfAShapesPointsAreWhatTheyMoveBy) {
  const Asset asset = importChannel({{0, 1, 2}}, 100, {50, 25, 0});
  const gltf::Mesh& mesh = asset.document.meshes.at(0);
  EXPECT_EQ(mesh.weights, std::vector<double>{1});
  const std::vector<float> moves = readFloats(asset, *mesh.primitives.at(0).targets.at(0).find("POSITION"));
  EXPECT_EQ(moves, (std::vector<float>{0, 0.5f, 0, 0, 0.25f, 0, 0, 0, 0}));
}

TEST(ImportFbx7, OneFullWeightIsWhereAShapeOfOnePointIsReached) {
  const Asset asset = importChannel({{1}}, 25, {50});
  const gltf::Mesh& mesh = asset.document.meshes.at(0);
  EXPECT_EQ(mesh.weights, std::vector<double>{0.5});
  const std::vector<float> moves = readFloats(asset, *mesh.primitives.at(0).targets.at(0).find("POSITION"));
  EXPECT_EQ(moves, (std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(importChannel({{1}}, 25, {100}).document.meshes.at(0).weights, std::vector<double>{0.25});
}

TEST(ImportFbx7, TheBareMeshLiesBetweenInBetweensBelowZeroAndAbove) {
  const auto weights = [](double percent) {
    return importChannel({{0, 1}, {1, 2}, {0, 1, 2}}, percent, {-50, 50, 100}).document.meshes.at(0).weights;
  };
  EXPECT_EQ(weights(0), (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(weights(-25), (std::vector<double>{0.5, 0, 0}));
  EXPECT_EQ(weights(-100), (std::vector<double>{2, 0, 0}));
  EXPECT_EQ(weights(25), (std::vector<double>{0, 0.5, 0}));
  EXPECT_EQ(weights(75), (std::vector<double>{0, 0.5, 0.5}));
  EXPECT_EQ(importChannel({{0, 1}}, -25, {-50}).document.meshes.at(0).weights, std::vector<double>{0.5});
}

TEST(ImportFbx7, ATakeMayHoldABlendShape) {
  const std::string shape = fmt::format("Geometry: 7, \"Geometry::up\", \"Shape\" {{\n{}{}}}\n", wholes("Indexes", {1}),
                                        array("Vertices", {0, 1, 0}));
  const std::string curves =
      "AnimationStack: 10, \"AnimStack::Smile\", \"\" {\n}\nAnimationLayer: 11, \"AnimLayer::Base\", \"\" {\n}\n"
      "AnimationCurveNode: 12, \"AnimCurveNode::\", \"\" {\n" +
      properties("P: \"d|DeformPercent\", \"Number\", \"\", \"A\",75\n") + "}\n";
  const Asset asset = importText(
      model(1, "Face", "Mesh") + triangle(3) + shape + "Deformer: 5, \"Deformer::b\", \"BlendShape\" {\n}\n" +
          "Deformer: 6, \"SubDeformer::Smile\", \"BlendShapeChannel\" {\nDeformPercent: 0\n}\n" + curves,
      link(1, 0) + link(3, 1) + link(5, 3) + link(6, 5) + link(7, 6) + link(11, 10) + link(12, 11) +
          link(12, 6, "DeformPercent"));
  EXPECT_EQ(trackOf(asset, "weights").values, std::vector<float>{0.75f});
}

TEST(ImportFbx7, CurvesThatTooMuchSharesAreRefused) {
  std::vector<double> seconds, percents, full;
  for (int k = 0; k < 2500; ++k) {
    seconds.push_back(k / 30.0);
    percents.push_back(k % 2);
  }
  for (int s = 1; s <= 1800; ++s) full.push_back(s);
  const std::vector<std::vector<std::int64_t>> points(full.size(), {1});
  const std::string stack =
      "AnimationStack: 9010, \"AnimStack::Smile\", \"\" {\n}\nAnimationLayer: 9011, \"AnimLayer::Base\", \"\" {\n}\n"
      "AnimationCurveNode: 9012, \"AnimCurveNode::\", \"\" {\n}\n" +
      curve(9013, seconds, percents);
  const std::string links =
      link(9011, 9010) + link(9012, 9011) + link(9012, 6, "DeformPercent") + link(9013, 9012, "d|DeformPercent");
  try {
    importChannel(points, 0, full, stack, links);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    EXPECT_EQ(error.where(), "clip 'Smile'");
  }
}

TEST(ImportFbx7, ConnectionsThatAreRepeatedCountOnceButMaterialsMayStandTwice) {
  const std::string objects =
      "Model: 1, \"Model::a\", \"Mesh\" {\n}\nGeometry: 2, \"Geometry::g\", \"Mesh\" {\n}\n"
      "Material: 3, \"Material::m\", \"\" {\n}\n";
  const std::string links = link(2, 1) + link(3, 1) + link(2, 1) + link(3, 1) + link(2, 1, "Other");
  const FbxFile file = parseFbx(asBytes("FBXHeaderExtension:  {\nFBXVersion: 7400\n}\nObjects:  {\n" + objects +
                                        "}\nConnections:  {\n" + links + "}\n"));
  const FbxObjects read(file);
  EXPECT_EQ(read.sources(0).size(), 4u);
  EXPECT_EQ(read.sources(0, "Geometry"), std::vector<Index>{1});
  EXPECT_EQ(read.sources(0, "Material"), (std::vector<Index>{2, 2}));
  EXPECT_EQ(read.destinations(1).size(), 2u);
}

// A triangle with such layers on model 1.
Asset importLayers(const std::string& layers, const std::string& objects = {}, const std::string& links = {},
                   const Resolver& resolver = {}) {
  const std::string geometry = "Geometry: 3, \"Geometry::Tri\", \"Mesh\" {\n" + array("Vertices", kTriangle) +
                               wholes("PolygonVertexIndex", {0, 1, -3}) + layers + "}\n";
  return importText(model(1, "Tri", "Mesh") + geometry + objects, link(1, 0) + link(3, 1) + links, resolver);
}

std::string layerForAll(const char* element, const char* name, const char* values, const std::vector<double>& row) {
  return fmt::format(
      "{}: 0 {{\nName: \"{}\"\nMappingInformationType: \"AllSame\"\nReferenceInformationType: \"Direct\"\n{}}}\n",
      element, name, array(values, row));
}

TEST(ImportFbx7, ColorsAreLinearButAlphaIsAsItWas) {
  const Asset asset = importLayers(layerForAll("LayerElementColor", "", "Colors", {0.5, 1, 0, 0.5}));
  const gltf::Primitive& primitive = asset.document.meshes.at(0).primitives.at(0);
  const std::vector<float> colors = readFloats(asset, *primitive.attributes.find("COLOR_0"));
  EXPECT_NEAR(colors[0], 0.21404114, 1e-7);
  EXPECT_EQ(colors[1], 1);
  EXPECT_EQ(colors[2], 0);
  EXPECT_EQ(colors[3], 0.5f);
}

TEST(ImportFbx7, MoreThanEightSetsAreLeftOut) {
  std::string layers;
  for (int i = 0; i < 10; ++i) layers += layerForAll("LayerElementUV", "", "UV", {0, 0});
  const Asset asset = importLayers(layers);
  const gltf::Attributes& attributes = asset.document.meshes.at(0).primitives.at(0).attributes;
  EXPECT_TRUE(attributes.find("TEXCOORD_7"));
  EXPECT_FALSE(attributes.find("TEXCOORD_8"));
  EXPECT_EQ(testing::countOf(asset.warnings, "attribute-sets"), 2u);
}

TEST(ImportFbx7, MeshesBeyondTheBudgetAreRefused) {
  const FbxFile file = parseFbx(asBytes("FBXHeaderExtension:  {\nFBXVersion: 7400\n}\n" + triangle(3)));
  Asset asset;
  const auto importWith = [&](std::size_t left) {
    FbxBudget budget(0);
    budget.spend((std::size_t{1} << 26) - left);
    importFbxMesh(asset, file.root.children.at(1), "Tri", {}, budget);
  };
  importWith(9);  // three positions
  try {
    importWith(8);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
  }
}

std::string texture(int id, const std::string& lines = {}) {
  return fmt::format("Texture: {}, \"Texture::t{}\", \"\" {{\n{}RelativeFilename: \"skin.png\"\n}}\n", id, id,
                     properties(lines));
}

TEST(ImportFbx7, TexturesOfOnePictureShareIt) {
  const std::string materials = "Material: 5, \"Material::A\", \"\" {\n}\nMaterial: 6, \"Material::B\", \"\" {\n}\n";
  const std::string layer =
      "LayerElementMaterial: 0 {\nMappingInformationType: \"ByPolygon\"\n" + wholes("Materials", {0, 1}) + "}\n";
  const std::string geometry = "Geometry: 3, \"Geometry::Tri\", \"Mesh\" {\n" + array("Vertices", kTriangle) +
                               wholes("PolygonVertexIndex", {0, 1, -3, 0, 2, -2}) + layer + "}\n";
  const std::string links =
      link(1, 0) + link(3, 1) + link(5, 1) + link(6, 1) + link(7, 5, "DiffuseColor") + link(8, 6, "Maya|TEX_color_map");
  const std::string objects = model(1, "Tri", "Mesh") + geometry + materials + texture(7) + texture(8);
  const std::string video = "Video: 9, \"Video::skin\", \"Clip\" {\nContent: , \"iVBORw0KGgo=\"\n}\n";
  const Resolver folder = [](std::string_view) { return testing::pngBytes(); };
  for (const Asset& asset :
       {importText(objects, links, folder), importText(objects + video, links + link(9, 7) + link(9, 8))}) {
    EXPECT_EQ(asset.document.images.size(), 1u);
    EXPECT_EQ(asset.document.textures.size(), 2u);
    EXPECT_TRUE(asset.document.materials.at(1).pbrMetallicRoughness->baseColorTexture);
    EXPECT_TRUE(asset.warnings.empty());
  }
}

TEST(ImportFbx7, APictureMayComeInPartsThatArePaddedEach) {
  const Bytes png = testing::pngBytes();
  const std::string first = encodeBase64(ByteSpan(png).first(10)), second = encodeBase64(ByteSpan(png).subspan(10));
  ASSERT_TRUE(first.ends_with('='));
  const Asset asset = importLayers(
      "",
      "Material: 5, \"Material::A\", \"\" {\n}\n" + texture(7) +
          fmt::format("Video: 9, \"Video::skin\", \"Clip\" {{\nContent: ,\n\"{}\",\n\"{}\"\n}}\n", first, second),
      link(5, 1) + link(7, 5, "DiffuseColor") + link(9, 7));
  EXPECT_TRUE(asset.warnings.empty());
  ASSERT_EQ(asset.document.images.size(), 1u);
  const gltf::BufferView& view = asset.document.bufferViews.at(asset.document.images[0].bufferView.value());
  const auto begin = asset.buffers[0].bytes.begin() + static_cast<std::ptrdiff_t>(view.byteOffset);
  EXPECT_EQ(Bytes(begin, begin + static_cast<std::ptrdiff_t>(view.byteLength)), png);
}

TEST(ImportFbx7, TexturesThatAreLeftOutAreTold) {
  const Asset asset = importLayers(
      "", "Material: 5, \"Material::A\", \"\" {\n}\n" + texture(7),
      link(5, 1) + link(7, 5, "SpecularColor") + link(7, 5, "TransparentColor") + link(7, 5, "TransparentColor"));
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"other-textures"});
  EXPECT_EQ(asset.warnings.items()[0].where, "A.SpecularColor");
  EXPECT_EQ(asset.warnings.items()[0].count, 2u);
}

TEST(ImportFbx7, AnEmptySetOfTextureCoordinatesDoesNotCount) {
  const std::string named = "P: \"UVSet\", \"KString\", \"\", \"\", \"map\"\n";
  const Asset asset =
      importLayers("LayerElementUV: 0 {\nName: \"none\"\n}\n" + layerForAll("LayerElementUV", "map", "UV", {0, 0}),
                   "Material: 5, \"Material::A\", \"\" {\n}\n" + texture(7, named),
                   link(5, 1) + link(7, 5, "DiffuseColor"), [](std::string_view) { return testing::pngBytes(); });
  EXPECT_EQ(asset.document.materials.at(0).pbrMetallicRoughness->baseColorTexture->texCoord, 0u);
}

TEST(ImportFbx7, SkinsThatAskForDualQuaternionsAreReported) {
  const std::string cluster = "Deformer: 6, \"SubDeformer::c\", \"Cluster\" {\n" + wholes("Indexes", {0, 1, 2}) +
                              array("Weights", {1, 1, 1}) + "}\n";
  const Asset asset =
      importText(model(1, "Body", "Mesh") + model(2, "Joint", "LimbNode") + triangle(3) +
                     "Deformer: 5, \"Deformer::s\", \"Skin\" {\nSkinningType: \"DualQuaternion\"\n}\n" + cluster,
                 link(1, 0) + link(2, 0) + link(3, 1) + link(5, 3) + link(6, 5) + link(2, 6));
  EXPECT_EQ(warningKinds(asset.warnings), std::vector<std::string>{"dual-quaternions"});
}

TEST(ImportFbx7, WhatIsLostIsSaid) {
  const Asset asset = importText(
      model(1, "Sun", "Light") + "NodeAttribute: 2, \"NodeAttribute::Sun\", \"Light\" {\n}\n" +
          "NodeAttribute: 3, \"NodeAttribute::Eye\", \"Camera\" {\n}\n" +
          "Geometry: 4, \"Geometry::Sheet\", \"NurbsSurface\" {\n}\nConstraint: 5, \"Constraint::Aim\", \"Aim\" {\n}\n",
      link(1, 0) + link(2, 1));
  EXPECT_EQ(warningKinds(asset.warnings),
            (std::vector<std::string>{"lights", "cameras", "other-geometry", "constraints"}));
}

TEST(ImportFbx7, BrokenMeshesAreRefused) {
  const auto with = [](const std::string& arrays) {
    return [arrays] {
      importText(model(1, "M", "Mesh") + "Geometry: 3, \"Geometry::\", \"Mesh\" {\n" + arrays + "}\n",
                 link(1, 0) + link(3, 1));
    };
  };
  EXPECT_THROW(with(array("Vertices", kTriangle) + wholes("PolygonVertexIndex", {0, 1, -5}))(), Error);
  EXPECT_THROW(with("Vertices: *3 {\na: nan,0,0\n}\n" + wholes("PolygonVertexIndex", {0, 0, -1}))(), Error);
  EXPECT_THROW(with(array("Vertices", {1e300, 0, 0}) + wholes("PolygonVertexIndex", {0, 0, -1}))(), Error);
}

TEST(ImportFbx7, NumbersThatAreNoneLoseWhatTheySayAlone) {
  std::string holed = curve(20, {0, 1, 2}, {0, 7, 4});
  holed.replace(holed.find("0,7"), 3, "0,nan");
  const ReadTrack track = trackOf(animated({}, "Lcl Translation", {holed, "", ""}), "translation");
  ASSERT_EQ(track.times, (std::vector<float>{0, 2}));
  EXPECT_EQ(track.values[3], 4);

  std::string turned = triangle(3);
  turned.insert(turned.rfind('}'),
                "LayerElementNormal: 0 {\nMappingInformationType: \"AllSame\"\nReferenceInformationType: "
                "\"Direct\"\nNormals: *3 {\na: 0,nan,1\n}\n}\n");
  const Asset asset = importText(model(1, "M", "Mesh") + turned, link(1, 0) + link(3, 1));
  for (const Vec3f& normal : readNormals(asset, collectGeometry(asset))) EXPECT_NEAR(normal.norm(), 1, 1e-6);
}

TEST(FbxCurve, AutomaticSlopesDoNotOvershootWhereTheyAreClamped) {
  const FbxFile file =
      parseFbx(asBytes("FBXHeaderExtension:  {\nFBXVersion: 7400\n}\n" +
                       curve(20, {0, 1, 2, 3}, {0, 0, 1, 1}, shapes(0x8 | 0x100 | 0x4000, {0, 0, 0, 0}, 4))));
  Warnings warnings;
  const FbxCurve read = FbxCurve::read(file.root.children.at(1), warnings).value();
  for (int i = 0; i <= 300; ++i) {
    const double value = read.at(i * kSecond / 100);
    EXPECT_GE(value, -1e-12);
    EXPECT_LE(value, 1 + 1e-12);
  }
  EXPECT_NEAR(read.at(3 * kSecond / 2), 0.5, 1e-12);
}

}  // namespace
}  // namespace limber
