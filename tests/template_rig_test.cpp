// Template rigs of real characters, through the whole of limber, against the skeletons that artists made for them.
#include <algorithm>
#include <iterator>
#include <ostream>

#include <gtest/gtest.h>

#include "limber/actions/motion/retarget_asset.h"
#include "limber/actions/rig/auto_rig.h"
#include "limber/actions/rig/template_file.h"
#include "limber/core/file/file.h"
#include "limber/document/clip/clip_moment.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/write.h"
#include "limber/evaluate/rig/rig_metrics.h"
#include "limber/samples/samples.h"
#include "model_checks.h"
#include "shared_data.h"
#include "shared_people.h"
#include "warning_kinds.h"

namespace limber::testing {

namespace {

AutoRigOptions templateOptions(const std::string& name) {
  AutoRigOptions options;
  options.rigger = "template";
  options.rig.templateName = name;
  options.existingRig = ExistingRig::kReplace;
  return options;
}

RigComparison compared(const std::string& file, const AutoRigOptions& options) {
  const std::filesystem::path path = *sharedDataFolder() / "rigged" / file;
  const Asset asset = readAsset(path);
  const Rigged result = rigged(asset, options);
  const std::filesystem::path written =
      testOutputFolder() / ("template_" + std::filesystem::path(options.rig.templateName).stem().string() + "_" +
                            path.stem().string() + ".glb");
  writeFile(written, result.glb);
  noteSource(written, path);
  return compareRigs(readAsset(result.glb, "result.glb"), asset);
}

}  // namespace

class TemplateCharacters : public ::testing::TestWithParam<const char*> {};

TEST_P(TemplateCharacters, ComeNearTheArtistsSkeleton) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const RigComparison comparison = compared(GetParam(), templateOptions("humanoid"));
  EXPECT_LT(comparison.namedMean, 4);
  EXPECT_LT(comparison.withoutFingers.jointToJoint, 3.5);
  for (const NamedJointError& error : comparison.named) {
    // Left instead of right is off by far more.
    if (error.bone.find("Hand") != std::string::npos || error.bone.find("Foot") != std::string::npos) {
      EXPECT_LT(error.percent, 6) << error.bone;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Humanoids, TemplateCharacters,
                         ::testing::Values("cesium_man.glb", "kaykit_mannequin/manny_med_mod.gltf", "kenney_human.glb",
                                           "m2m_human_male.glb", "m2m_human_zombie.glb", "makehuman_mixamo.glb",
                                           "quaternius_knightcharacter.glb", "quaternius_man_king.glb"),
                         [](const ::testing::TestParamInfo<const char*>& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

// Of several files; without fingers.
struct Means {
  double jointToJoint = 0, jointToBone = 0, boneToBone = 0, named = 0;
  int beyond = 0;  // files whose named joints are off by more than 6 %
};

Means meansOf(const std::vector<std::string>& files, const std::string& name) {
  Means means;
  for (const std::string& file : files) {
    const RigComparison comparison = compared(file, templateOptions(name));
    const double part = 1.0 / static_cast<double>(files.size());
    means.jointToJoint += part * comparison.withoutFingers.jointToJoint;
    means.jointToBone += part * comparison.withoutFingers.jointToBone;
    means.boneToBone += part * comparison.withoutFingers.boneToBone;
    means.named += part * comparison.namedMean;
    means.beyond += comparison.namedMean > 6;
  }
  return means;
}

// Every person and every animal that docs/template-rigs.md lists.
TEST(TemplateMeans, OfPeople) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Means means = meansOf({std::begin(kSharedPeople), std::end(kSharedPeople)}, "humanoid");
  EXPECT_LT(means.jointToJoint, 2.5);
  EXPECT_LT(means.jointToBone, 1.8);
  EXPECT_LT(means.boneToBone, 1.5);
  EXPECT_LT(means.named, 3);
  EXPECT_LE(means.beyond, 2) << "robots";
}

TEST(TemplateMeans, OfAnimals) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Means means =
      meansOf({"fox_khronos.glb", "m2m_fox_cat.glb", "m2m_fox_dog.glb", "m2m_fox_fox.glb", "quaternius_alpaca.glb",
               "quaternius_cow.glb", "quaternius_horse.glb", "quaternius_wolf.glb", "quaternius_triceratops.glb"},
              "quadruped");
  EXPECT_LT(means.jointToJoint, 3);
  EXPECT_LT(means.jointToBone, 2);
  EXPECT_LT(means.boneToBone, 2);
}

// Skeletons of characters and motions as a user's own templates: arms level, lowered and hanging, with fingers, twist
// joints, roots on the ground and feet that are their children, on bodies whose arms are posed otherwise.
class OwnTemplates : public ::testing::TestWithParam<const char*> {};

TEST_P(OwnTemplates, FindPeopleHoweverTheArmsAreHeld) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  AutoRigOptions options = templateOptions(GetParam());
  options.rig.templateSkeleton = readTemplateFile(*sharedDataFolder() / GetParam());
  for (const char* body : {"m2m_human_male.glb", "makehuman_default.glb", "cesium_man.glb"}) {
    SCOPED_TRACE(body);
    const RigComparison comparison = compared(body, options);
    EXPECT_GE(comparison.named.size(), 15u);
    EXPECT_LT(comparison.namedMean, 4);
    for (const NamedJointError& error : comparison.named) {
      if (error.bone.find("Hand") == std::string::npos) continue;
      EXPECT_LT(error.percent, 3) << error.bone;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Skeletons, OwnTemplates,
                         ::testing::Values("rigged/cesium_man.glb", "rigged/makehuman_mixamo.glb",
                                           "rigged/makehuman_default.glb", "rigged/quaternius_platformer_character.glb",
                                           "rigged/robot_expressive.glb", "rigged/kaykit_mannequin/manny_med_mod.gltf",
                                           "motions/cmu1_jumping_jacks.bvh", "motions/cmu_daz_02_01_walk.bvh",
                                           "motions/rokoko_dance.bvh", "motions/pybvh_test2.bvh"),
                         [](const ::testing::TestParamInfo<const char*>& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

// Mid-stride, one leg lifted or behind; no value was set by these characters in this pose.
struct Stride {
  const char* file;
  double seconds;
};
class TemplateStrides : public ::testing::TestWithParam<Stride> {};

TEST_P(TemplateStrides, ComeNearTheArtistsSkeleton) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  Motion motion = readMotion(*sharedDataFolder() / "motions" / "kaykit_movementbasic.glb");
  std::erase_if(motion.clips, [](const Clip& clip) { return clip.name != "Rig_Medium|Walking_A"; });
  Asset asset = readAsset(*sharedDataFolder() / "rigged" / GetParam().file);
  retargetOnto(asset, Character(asset), motion, {});
  standAt(asset, {"", GetParam().seconds});
  const Rigged result = rigged(asset, templateOptions("humanoid"));
  const RigComparison comparison = compareRigs(readAsset(result.glb, "result.glb"), asset);
  EXPECT_LT(comparison.namedMean, 4.5);
  EXPECT_LT(comparison.withoutFingers.jointToJoint, 4);
  EXPECT_GT(result.report.matches.front().confidence, 0.7);
}

INSTANTIATE_TEST_SUITE_P(HeldOut, TemplateStrides,
                         ::testing::Values(Stride{"m2m_human_female.glb", 0.3}, Stride{"makehuman_mixamo.glb", 0.3},
                                           Stride{"quaternius_woman_scifi.glb", 0.3},
                                           Stride{"quaternius_woman_scifi.glb", 0.8}));

// The box of all but the hundredth part of the points at each end of an axis: specks that float about a scan are
// outside.
Box bulkBox(std::vector<Vec3f> points) {
  Box box;
  Vec3 low, high;
  const std::size_t rim = points.size() / 100;
  for (int axis = 0; axis < 3; ++axis) {
    std::sort(points.begin(), points.end(), [axis](const Vec3f& a, const Vec3f& b) { return a[axis] < b[axis]; });
    low[axis] = points[rim][axis];
    high[axis] = points[points.size() - 1 - rim][axis];
  }
  box.add(low);
  box.add(high);
  return box;
}

// People that stand with +Y up and face +Z, arms level or lowered: the hands are where they reach farthest to the
// sides.
class TemplatePeople : public ::testing::TestWithParam<const char*> {};

TEST_P(TemplatePeople, HaveHandsAndFeetInTheRightLimbs) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset asset = readAsset(*sharedDataFolder() / "meshes" / GetParam());
  const Box box = bulkBox(collectGeometry(asset).positions);
  const Skeleton skeleton =
      readSkeleton(readAsset(rigged(asset, templateOptions("humanoid")).glb, "result.glb")).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  const auto positionOf = [&](const std::string& name) {
    return Vec3((globals[skeleton.find(name).value()].translation() - box.center()) / box.size().y());
  };
  const double reach = 0.5 * box.size().x() / box.size().y();
  for (const auto& [side, sign] : {std::pair(std::string("left"), 1.0), std::pair(std::string("right"), -1.0)}) {
    // The wrist: a hand's length before the tips of the fingers.
    EXPECT_GT(sign * positionOf(side + "Hand").x(), 0.75 * reach) << side;
    EXPECT_LT(sign * positionOf(side + "Hand").x(), 0.9 * reach) << side;
    EXPECT_GT(sign * positionOf(side + "Hand").x(), sign * positionOf(side + "LowerArm").x()) << side;
    EXPECT_GT(sign * positionOf(side + "Foot").x(), 0.02) << side;
    EXPECT_LT(positionOf(side + "Foot").y(), -0.4) << side;
    EXPECT_GT(positionOf(side + "Toes").z(), positionOf(side + "Foot").z()) << side;
    EXPECT_GT(positionOf(side + "LowerLeg").y(), positionOf(side + "Foot").y() + 0.12) << side;
  }
  EXPECT_GT(positionOf("head").y(), 0.25);
}

INSTANTIATE_TEST_SUITE_P(Meshes, TemplatePeople,
                         ::testing::Values("human_man.obj", "m2m_human_static.glb", "m2m_human_small_static.glb",
                                           "m2m_human_a_pose_static.glb", "makehuman_body_quads.obj",
                                           "makehuman_base_quads.obj", "rawscan_makehuman.ply"),
                         [](const ::testing::TestParamInfo<const char*>& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

// Birds that stand with their wings spread, +Y up and facing +Z.
class TemplateBirds : public ::testing::TestWithParam<const char*> {};

TEST_P(TemplateBirds, HaveWingsHeadAndFeetInTheRightPlaces) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset asset = readAsset(*sharedDataFolder() / GetParam());
  Box box;
  for (const Vec3f& p : collectGeometry(asset).positions) box.add(p.cast<double>());
  const Skeleton skeleton = readSkeleton(readAsset(rigged(asset, templateOptions("bird")).glb, "result.glb")).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  const auto positionOf = [&](const std::string& name) {
    return Vec3((globals[skeleton.find(name).value()].translation() - box.min).cwiseQuotient(box.size()));
  };
  EXPECT_GT(positionOf("leftWingHand").x(), 0.65);
  EXPECT_LT(positionOf("rightWingHand").x(), 0.35);
  for (const char* side : {"left", "right"}) {
    EXPECT_LT(positionOf(std::string(side) + "Foot").y(), 0.3) << side;
    EXPECT_NEAR(positionOf(std::string(side) + "Foot").x(), 0.5, 0.1) << side;
  }
  double last = 0;
  for (const char* name : {"tail", "hips", "chest", "neck", "head"}) {
    EXPECT_GT(positionOf(name).z(), last) << name;
    EXPECT_NEAR(positionOf(name).x(), 0.5, 0.02) << name;
    last = positionOf(name).z();
  }
  EXPECT_GT(last, 0.65) << "the head is in front";
}

TEST_P(TemplateBirds, AreTakenForBirds) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset asset = readAsset(*sharedDataFolder() / GetParam());
  EXPECT_EQ(rigged(asset, templateOptions("auto")).report.matches.front().name, "bird");
}

INSTANTIATE_TEST_SUITE_P(Models, TemplateBirds,
                         ::testing::Values("rigged/m2m_bird_base.glb", "rigged/m2m_bird_eagle.glb",
                                           "meshes/m2m_bird_static.glb"),
                         [](const ::testing::TestParamInfo<const char*>& file) {
                           return std::filesystem::path(file.param).stem().string();
                         });

// Furniture, a bust, animals.
struct Misfit {
  const char* file;
  bool lacksLimbs;  // those of a person

  friend void PrintTo(const Misfit& misfit, std::ostream* out) { *out << misfit.file; }
};

class TemplateMisfits : public ::testing::TestWithParam<Misfit> {};

TEST_P(TemplateMisfits, AreDoubtedAndSaidToLackLimbs) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const Asset asset = readAsset(*sharedDataFolder() / "meshes" / GetParam().file);
  const Rigged result = rigged(asset, templateOptions("humanoid"));
  EXPECT_LT(result.report.matches.front().confidence, 0.4);
  const auto where = [&](std::string_view kind) -> std::string {
    for (const Warning& warning : result.report.warnings.items()) {
      if (warning.kind == kind) return warning.where;
    }
    return {};
  };
  EXPECT_EQ(where("low-confidence"), "humanoid");
  if (GetParam().lacksLimbs) {
    EXPECT_NE(where("no-place"), "") << "limbs are named";
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, TemplateMisfits,
                         ::testing::Values(Misfit{"chair_1.glb", true}, Misfit{"chair_2.glb", true},
                                           Misfit{"stool.glb", true}, Misfit{"demosthenes_low_res.obj", true},
                                           Misfit{"spot_low_resolution.obj", false},
                                           Misfit{"koala_low_resolution.obj", false}),
                         [](const ::testing::TestParamInfo<Misfit>& misfit) {
                           return std::filesystem::path(misfit.param.file).stem().string();
                         });

// Statues that crouch, sit, and lean on a trunk, and are one piece with their plinths; positions are read off the
// marble. Limbs that lie on the stone or in drapery need pins.
struct Statue {
  const char* file;
  Vec3 front;
  std::vector<JointPin> expected;

  friend void PrintTo(const Statue& statue, std::ostream* out) { *out << statue.file; }
};

class TemplateStatues : public ::testing::TestWithParam<Statue> {};

TEST_P(TemplateStatues, HaveTheirTrunkAndHeadInTheRightPlaces) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  const std::filesystem::path path = *sharedDataFolder() / "meshes" / GetParam().file;
  AutoRigOptions options = templateOptions("humanoid");
  options.rig.up = Vec3::UnitY();
  options.rig.front = GetParam().front;
  const Rigged result = rigged(readAsset(path), options);
  writeFile(testOutputFolder() / ("statue_" + path.stem().string() + ".glb"), result.glb);
  EXPECT_GT(result.report.matches.front().confidence, 0.6);
  const Skeleton skeleton = readSkeleton(readAsset(result.glb, "result.glb")).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  for (const JointPin& joint : GetParam().expected) {
    const Vec3 position = globals[skeleton.find(joint.joint).value()].translation();
    EXPECT_LT((position - joint.position).norm(), 0.21) << joint.joint;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, TemplateStatues,
    ::testing::Values(
        Statue{"statue_marbleplayer.obj",
               Vec3::UnitZ(),
               {{"head", {-0.17, 0.5, 0.07}},
                {"leftUpperArm", {-0.05, 0.56, -0.05}},
                {"rightUpperArm", {-0.22, 0.42, 0.02}},
                {"leftUpperLeg", {0.06, 0.27, -0.13}},
                {"rightUpperLeg", {-0.07, 0.22, -0.14}}}},
        Statue{"statue_shepherdboy.obj",
               Vec3::UnitZ(),
               {{"head", {0.07, 0.97, -0.23}},
                {"rightLowerArm", {-0.15, 0.68, -0.15}},
                {"leftLowerLeg", {0.06, 0.44, 0.12}},
                {"leftFoot", {-0.14, 0.13, 0.36}},
                {"rightLowerLeg", {-0.21, 0.44, 0.1}},
                {"rightFoot", {-0.1, 0.14, 0.22}}}},
        Statue{"statue_hermes.obj", -Vec3::UnitX(), {{"head", {-0.25, 1.46, 0.13}}, {"hips", {0.24, 1.0, 0}}}},
        Statue{"rawscan_hermes.ply", -Vec3::UnitX(), {{"head", {-0.25, 1.46, 0.13}}, {"hips", {0.24, 1.0, 0}}}}),
    [](const ::testing::TestParamInfo<Statue>& statue) {
      return std::filesystem::path(statue.param.file).stem().string();
    });

// The same, where a user points at joints.
struct PinnedStatue {
  const char* file;
  Vec3 front;
  std::vector<JointPin> pins, expected;

  friend void PrintTo(const PinnedStatue& statue, std::ostream* out) { *out << statue.file; }
};

class TemplatePins : public ::testing::TestWithParam<PinnedStatue> {};

TEST_P(TemplatePins, BendTheTemplateToAStatue) {
  if (!sharedDataFolder()) GTEST_SKIP() << kNoSharedData;
  AutoRigOptions options = templateOptions("humanoid");
  options.rig.up = Vec3::UnitY();
  options.rig.front = GetParam().front;
  options.rig.pins = GetParam().pins;
  const std::filesystem::path path = *sharedDataFolder() / "meshes" / GetParam().file;
  const Rigged result = rigged(readAsset(path), options);
  const std::filesystem::path written = testOutputFolder() / ("pinned_" + path.stem().string() + ".glb");
  writeFile(written, result.glb);
  const Skeleton skeleton = readSkeleton(readAsset(result.glb, "result.glb")).skeleton;
  const std::vector<Affine> globals = restGlobals(skeleton);
  const auto off = [&](const JointPin& pin) {
    return (globals[skeleton.find(pin.joint).value()].translation() - pin.position).norm();
  };
  for (const JointPin& pin : GetParam().pins) EXPECT_LT(off(pin), 1e-5) << pin.joint;
  for (const JointPin& pin : GetParam().expected) EXPECT_LT(off(pin), 0.1) << pin.joint;
}

INSTANTIATE_TEST_SUITE_P(Meshes, TemplatePins,
                         ::testing::Values(PinnedStatue{"statue_marbleplayer.obj",
                                                        Vec3::UnitZ(),
                                                        {{"head", {-0.17, 0.5, 0.07}},
                                                         {"hips", {0, 0.24, -0.16}},
                                                         {"leftLowerArm", {0.13, 0.58, -0.12}},
                                                         {"leftHand", {0.12, 0.46, 0}},
                                                         {"rightHand", {0, 0.1, 0.19}},
                                                         {"leftLowerLeg", {0.1, 0.42, 0.15}},
                                                         {"leftFoot", {0.16, 0.12, 0.07}},
                                                         {"rightLowerLeg", {-0.2, 0.13, 0.15}},
                                                         {"rightFoot", {0.05, 0.1, -0.18}}},
                                                        {{"leftUpperArm", {-0.05, 0.56, -0.05}},
                                                         {"rightUpperArm", {-0.22, 0.42, 0.02}},
                                                         {"leftUpperLeg", {0.06, 0.27, -0.13}},
                                                         {"rightUpperLeg", {-0.07, 0.22, -0.14}}}},
                                           PinnedStatue{"statue_shepherdboy.obj",
                                                        Vec3::UnitZ(),
                                                        {{"head", {0.07, 0.97, -0.23}},
                                                         {"hips", {0, 0.56, -0.25}},
                                                         {"leftLowerArm", {0.19, 0.72, -0.44}},
                                                         {"leftHand", {0.2, 0.63, -0.24}},
                                                         {"leftLowerLeg", {0.06, 0.44, 0.12}},
                                                         {"leftFoot", {-0.14, 0.13, 0.36}},
                                                         {"rightLowerLeg", {-0.21, 0.44, 0.1}},
                                                         {"rightFoot", {-0.1, 0.14, 0.22}}},
                                                        {{"leftUpperArm", {0.13, 0.88, -0.35}},
                                                         {"rightUpperArm", {-0.13, 0.85, -0.25}}}},
                                           PinnedStatue{"statue_hermes.obj",
                                                        -Vec3::UnitX(),
                                                        {{"head", {-0.25, 1.46, 0.13}},
                                                         {"hips", {0.24, 1.0, 0}},
                                                         {"leftHand", {-0.28, 1.03, 0.05}},
                                                         {"leftFoot", {0.33, 0.17, 0.03}},
                                                         {"rightLowerLeg", {-0.15, 0.9, 0}},
                                                         {"rightFoot", {-0.22, 0.48, 0.05}}},
                                                        {{"leftUpperArm", {-0.08, 1.36, 0.22}}}}),
                         [](const ::testing::TestParamInfo<PinnedStatue>& statue) {
                           return std::filesystem::path(statue.param.file).stem().string();
                         });

TEST(TemplateSamples, ABipedIsAPerson) {
  const Asset asset = makeSample("biped");
  const Rigged result = rigged(asset, templateOptions("auto"));
  EXPECT_EQ(result.report.matches.front().name, "humanoid");
  const Asset after = readAsset(result.glb, "result.glb");
  const Geometry geometry = collectGeometry(after);
  const AssetSkeleton rig = readSkeleton(after);
  expectSoundWeights(readWeights(after, geometry, rig), static_cast<Index>(geometry.positions.size()),
                     rig.skeleton.jointCount(), 4);
  const std::vector<Affine> globals = restGlobals(rig.skeleton);
  const auto positionOf = [&](const char* name) {
    return Vec3(globals[rig.skeleton.find(name).value()].translation());
  };
  EXPECT_GT(positionOf("leftHand").x(), 0);
  EXPECT_LT(positionOf("rightFoot").x(), 0);
  EXPECT_GT(positionOf("head").y(), positionOf("hips").y());
  writeFile(testOutputFolder() / "template_biped.glb", result.glb);
}

// What exporters and scenes do to a body whose feet are at y = 0.
struct Flaw {
  const char *name, *warning;
  std::size_t (*spoil)(TriMesh& mesh);  // how many triangles the warning is to count

  friend void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.name; }
};

Triangle turnedRound(const Triangle& t) {
  return {t[0], t[2], t[1]};
}

std::size_t reverseOneSide(TriMesh& mesh) {
  std::size_t count = 0;
  for (Triangle& t : mesh.triangles) {
    if (mesh.positions[t[0]].x() + mesh.positions[t[1]].x() + mesh.positions[t[2]].x() <= 0) continue;
    t = turnedRound(t);
    ++count;
  }
  return count;
}

std::size_t reverseEveryThird(TriMesh& mesh) {
  std::size_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    mesh.triangles[t] = turnedRound(mesh.triangles[t]);
    ++count;
  }
  return count;
}

std::size_t showBothSides(TriMesh& mesh) {
  const std::vector<Triangle> front = mesh.triangles;
  for (const Triangle& t : front) mesh.triangles.push_back(turnedRound(t));
  return front.size();
}

std::size_t putOnAFloor(TriMesh& mesh) {
  Box box;
  for (const Vec3f& p : mesh.positions) box.add(p.cast<double>());
  const auto half = static_cast<float>(5 * box.size().maxCoeff()), low = static_cast<float>(box.min.y());
  const Index first = mesh.vertexCount();
  for (const Vec3f& corner :
       {Vec3f(-half, low, -half), Vec3f(half, low, -half), Vec3f(half, low, half), Vec3f(-half, low, half)}) {
    mesh.positions.push_back(corner);
  }
  mesh.triangles.push_back({first, first + 2, first + 1});
  mesh.triangles.push_back({first, first + 3, first + 2});
  return 2;
}

class TemplateFlaws : public ::testing::TestWithParam<Flaw> {};

TEST_P(TemplateFlaws, LeaveTheJointsWhereTheyWere) {
  const Geometry geometry = collectGeometry(makeSample("biped"));
  TriMesh mesh{geometry.positions, geometry.triangles};
  const Rigged clean = rigged(meshAsset(mesh), templateOptions("humanoid"));
  const double height = bulkBox(mesh.positions).size().y();
  const std::size_t count = GetParam().spoil(mesh);
  const Rigged spoiled = rigged(meshAsset(mesh), templateOptions("humanoid"));
  for (const char* kind : {"reversed-faces", "repeated-faces", "surroundings"}) {
    EXPECT_EQ(countOf(clean.report.warnings, kind), 0u) << kind;
    EXPECT_EQ(countOf(spoiled.report.warnings, kind), kind == std::string(GetParam().warning) ? count : 0) << kind;
  }
  const Skeleton expected = readSkeleton(readAsset(clean.glb, "clean.glb")).skeleton;
  const Skeleton skeleton = readSkeleton(readAsset(spoiled.glb, "spoiled.glb")).skeleton;
  const std::vector<Affine> transforms = restGlobals(expected), globals = restGlobals(skeleton);
  EXPECT_EQ(skeleton.jointCount(), expected.jointCount());
  for (Index j = 0; j < expected.jointCount(); ++j) {
    const std::optional<Index> joint = skeleton.find(expected.joints[j].name);
    ASSERT_TRUE(joint) << expected.joints[j].name;
    EXPECT_LT((globals[*joint].translation() - transforms[j].translation()).norm(), 0.02 * height)
        << expected.joints[j].name;
  }
}

INSTANTIATE_TEST_SUITE_P(Biped, TemplateFlaws,
                         ::testing::Values(Flaw{"OneSideReversed", "reversed-faces", &reverseOneSide},
                                           Flaw{"EveryThirdReversed", "reversed-faces", &reverseEveryThird},
                                           Flaw{"BothSidesShown", "repeated-faces", &showBothSides},
                                           Flaw{"OnAFloor", "surroundings", &putOnAFloor}),
                         [](const ::testing::TestParamInfo<Flaw>& flaw) { return flaw.param.name; });

TEST(TemplateSamples, AStoolIsNoPerson) {
  const Rigged result = rigged(makeSample("stool"), templateOptions("humanoid"));
  EXPECT_LT(result.report.matches.front().confidence, 0.6);
  EXPECT_FALSE(result.report.warnings.empty());
}

}  // namespace limber::testing
