// Programs of the tests' own that imitate each format, and get wrong what real ones do.
#include "limber/adapters/rig_by_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "limber/actions/testing/elsewhere_skin.h"
#include "limber/core/random.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/mesh/mesh_asset.h"
#include "limber/document/read.h"
#include "limber/document/testing/scene_builder.h"
#include "temporary_folder.h"
#include "testing/fbx_text.h"
#include "testing/made_body.h"

namespace limber {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::madeBody;
using testing::madeGlb;
using testing::madeJoints;
using testing::madeText;
using testing::madeToHanded;
using testing::madeWeights;
using testing::nearestMadeJoint;
using testing::putFile;
using testing::shellAdapter;

// The model's placement in its world.
Affine modelTransform() {
  Affine map = Affine::Identity();
  map.translate(Vec3(3, -2, 5));
  map.scale(2.5);
  return map;
}

// The made body under a node that moves and scales it.
Asset offsetModel() {
  Asset asset = meshAsset(madeBody());
  asset.document.nodes[0].translation = Vec3(3, -2, 5);
  asset.document.nodes[0].scale = Vec3::Constant(2.5);
  asset.name = "scan.glb";
  return asset;
}

class RigByProgram : public ::testing::Test {
 protected:
  // Copies a prepared file to where the output is expected.
  Adapter copying(const std::string& text, AdapterFormat format) {
    const fs::path file = folder_.path() / "prepared";
    putFile(file, text);
    return shellAdapter(fmt::format("test -s \"$1\" && cp '{}' \"$2\"", file.string()), format);
  }
  Adapter copying(const Bytes& bytes, AdapterFormat format) {
    return copying(std::string(bytes.begin(), bytes.end()), format);
  }

  static AutoRigReport rig(Asset& asset, const Adapter& adapter, const AutoRigOptions& options = {}) {
    Progress progress;
    return rigByProgram(asset, adapter, options, progress);
  }

  std::string problemOf(const Adapter& adapter) {
    Asset asset = offsetModel();
    const Bytes before = writeGlb(asset);
    try {
      rig(asset, adapter);
    } catch (const Error& error) {
      EXPECT_EQ(writeGlb(asset), before);
      const std::string what = error.what();
      EXPECT_THAT(what, ::testing::StartsWith("scan.glb: fake"));
      EXPECT_EQ(what.find('\n'), std::string::npos);
      return what;
    }
    return "no error";
  }

  // The rig is the made one under the model's transform, and the model's own vertices are untouched.
  static void expectMadeRig(const Asset& asset, const SkinWeights& expected, double tolerance) {
    const Asset untouched = offsetModel();
    EXPECT_EQ(readFloats(asset, 0), readFloats(untouched, 0));
    const Geometry before = collectGeometry(untouched), after = collectGeometry(asset);
    ASSERT_EQ(after.positions.size(), before.positions.size());
    for (std::size_t v = 0; v < before.positions.size(); ++v) {
      EXPECT_LT((after.positions[v] - before.positions[v]).norm(), 1e-5f);
    }
    const AssetSkeleton read = readSkeleton(asset);
    const std::vector<Affine> globals = restGlobals(read.skeleton);
    const SkinWeights weights = readWeights(asset, after, read);
    ASSERT_EQ(weights.vertexCount(), expected.vertexCount());
    for (const testing::MadeJoint& made : madeJoints()) {
      const auto joint = read.skeleton.find(made.name);
      ASSERT_TRUE(joint) << made.name;
      EXPECT_LT((globals[*joint].translation() - modelTransform() * made.position).norm(), 1e-4) << made.name;
      for (Index v = 0; v < weights.vertexCount(); ++v) {
        EXPECT_NEAR(weightOf(weights, v, *joint), weightOf(expected, v, indexOf(made.name)), tolerance);
      }
    }
  }
  static double weightOf(const SkinWeights& weights, Index vertex, Index joint) {
    for (Index slot = 0; slot < weights.slots; ++slot) {
      const float weight = weights.weightsOf(vertex)[slot];
      if (weights.jointsOf(vertex)[slot] == joint && weight > 0) return static_cast<double>(weight);
    }
    return 0;
  }
  static Index indexOf(std::string_view name) {
    for (Index j = 0; j < madeJoints().size(); ++j) {
      if (madeJoints()[j].name == name) return j;
    }
    return kNoIndex;
  }

  testing::TemporaryFolder folder_;
};

// A program that reads the OBJ for itself and binds each vertex to the nearest joint.
TEST_F(RigByProgram, ATextRiggerReadsTheObjAndItsRigIsAttached) {
  const fs::path script = folder_.path() / "rigger.awk";
  putFile(
      script,
      "NR == FNR { print; if ($1 == \"joints\") { n++; name[n] = $2; x[n] = $3; y[n] = $4; z[n] = $5 } next }\n"
      "$1 == \"v\" { best = 1e30\n"
      "  for (j = 1; j <= n; j++) { d = ($2-x[j])^2 + ($3-y[j])^2 + ($4-z[j])^2; if (d < best) { best = d; b = j } }\n"
      "  print \"skin\", v++, name[b], 1 }\n");
  for (const AdapterUp up : {AdapterUp::kY, AdapterUp::kZ}) {
    Adapter adapter = shellAdapter("");
    adapter.inputUp = adapter.outputUp = up;
    adapter.inputSize = 3;
    const std::string text = madeText(madeToHanded(adapter), madeBody(), {});
    putFile(folder_.path() / "joints.txt", text);
    adapter.steps = {{{"/bin/sh", "-c", "awk -f rigger.awk joints.txt \"$1\" > \"$2\"", "sh", "{input}", "{output}"},
                      folder_.path()}};
    Asset asset = offsetModel();
    const AutoRigReport report = rig(asset, adapter);
    EXPECT_EQ(report.rigger, "fake");
    EXPECT_EQ(report.skinning, "fake");
    EXPECT_EQ(report.joints, 5u);
    EXPECT_EQ(report.pieces, 3u);
    SkinWeights nearest;
    nearest.slots = 1;
    for (Index v = 0; v < madeBody().vertexCount(); ++v) {
      nearest.joints.push_back(nearestMadeJoint(madeBody().position(v)));
      nearest.weights.push_back(1);
    }
    expectMadeRig(asset, nearest, 1e-6);
    EXPECT_NO_THROW(checkAsset(readAsset(writeGlb(asset), "rigged.glb")));
  }
}

TEST_F(RigByProgram, BothWordsForJointsGiveTheSameBytes) {
  const Affine map = madeToHanded(shellAdapter(""));
  Bytes made[2];
  for (int i = 0; i < 2; ++i) {
    Asset asset = offsetModel();
    rig(asset, copying(madeText(map, madeBody(), madeWeights(madeBody()), i == 0 ? "joints" : "joint"),
                       AdapterFormat::kRignetText));
    expectMadeRig(asset, madeWeights(madeBody()), 1e-6);
    made[i] = writeGlb(asset);
  }
  EXPECT_EQ(made[0], made[1]);
}

TEST_F(RigByProgram, ASkeletonAloneGetsLimbersWeights) {
  const std::string skeleton = madeText(madeToHanded(shellAdapter("")), madeBody(), {});
  Asset asset = offsetModel();
  AutoRigOptions options;
  options.skinning = "geodesic-voxel";
  const AutoRigReport report = rig(asset, copying(skeleton, AdapterFormat::kRignetText), options);
  EXPECT_EQ(report.skinning, "geodesic-voxel");
  EXPECT_EQ(report.joints, 5u);
  const Geometry geometry = collectGeometry(asset);
  const SkinWeights weights = readWeights(asset, geometry, readSkeleton(asset));
  for (Index v = 0; v < weights.vertexCount(); ++v) EXPECT_GT(weights.weightsOf(v)[0], 0);
}

TEST_F(RigByProgram, WeightsThatTheAdapterPassesOverAreMadeAnew) {
  Adapter adapter = copying(madeText(madeToHanded(shellAdapter("")), madeBody(), madeWeights(madeBody())),
                            AdapterFormat::kRignetText);
  adapter.ignoresWeights = true;
  Asset asset = offsetModel();
  EXPECT_EQ(rig(asset, adapter).skinning, "bone-heat");
}

TEST_F(RigByProgram, VerticesWithoutALineTakeTheWeightsOfWhatIsNearest) {
  std::string text = madeText(madeToHanded(shellAdapter("")), madeBody(), madeWeights(madeBody()));
  text.erase(text.find("skin 20 "), text.find("skin 30 ") - text.find("skin 20 "));
  Asset asset = offsetModel();
  const AutoRigReport report = rig(asset, copying(text, AdapterFormat::kRignetText));
  ASSERT_EQ(report.warnings.items().size(), 1u);
  EXPECT_EQ(report.warnings.items()[0].kind, "unbound-vertices");
  EXPECT_EQ(report.warnings.items()[0].count, 10u);
  expectMadeRig(asset, madeWeights(madeBody()), 0.2);
}

// --- the surface that is handed over ---

// The program knows nothing of the floor, whose vertices stand behind the body's.
TEST_F(RigByProgram, AFloorIsNotHandedOverAndFollowsTheRoot) {
  TriMesh mesh = madeBody();
  const Index first = mesh.vertexCount();
  for (const Vec3f& corner : {Vec3f(-3, -0.2f, -3), Vec3f(-3, -0.2f, 3), Vec3f(3, -0.2f, 3), Vec3f(3, -0.2f, -3)}) {
    mesh.positions.push_back(corner);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
  Asset asset = meshAsset(mesh);
  const SkinWeights made = madeWeights(madeBody());
  const auto expectBound = [&] {
    const AssetSkeleton read = readSkeleton(asset);
    const SkinWeights weights = readWeights(asset, collectGeometry(asset), read);
    const Index arm = *read.skeleton.find("arm"), hips = *read.skeleton.find("hips");
    for (Index v = 0; v < first; ++v) {
      EXPECT_NEAR(weightOf(weights, v, arm), weightOf(made, v, indexOf("arm")), 1e-5) << v;
    }
    for (Index v = first; v < mesh.vertexCount(); ++v) EXPECT_EQ(weightOf(weights, v, hips), 1) << v;
  };
  const AutoRigReport report =
      rig(asset, copying(madeText(madeToHanded(shellAdapter("")), madeBody(), made), AdapterFormat::kRignetText));
  EXPECT_EQ(report.pieces, 3u);
  expectBound();

  Adapter weigher = copying(madeGlb(madeBody(), made, madeToHanded(shellAdapter(""))), AdapterFormat::kGlb);
  weigher.kind = AdapterKind::kWeights;
  weigher.inputFormat = AdapterFormat::kGlb;
  Progress progress;
  weightsByProgram(asset, weigher, {}, progress);
  expectBound();
}

// The file's vertices lie elsewhere than where the blend shape that is in use has them.
TEST_F(RigByProgram, TheSurfaceIsHandedOverAsItsShapesHaveIt) {
  TriMesh flat = madeBody();
  std::vector<float> offsets;
  for (Vec3f& p : flat.positions) {
    offsets.insert(offsets.end(), {0, 0.5f * p.y(), 0});
    p.y() *= 0.5f;
  }
  Asset asset = meshAsset(flat);
  asset.document.meshes[0].primitives[0].targets.emplace_back().set(
      "POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
  asset.document.nodes[0].weights = {1};
  Adapter adapter =
      copying(madeGlb(madeBody(), madeWeights(madeBody()), madeToHanded(shellAdapter(""))), AdapterFormat::kGlb);
  rig(asset, adapter);
  adapter.kind = AdapterKind::kWeights;
  adapter.inputFormat = AdapterFormat::kGlb;
  Progress progress;
  EXPECT_NO_THROW(weightsByProgram(asset, adapter, {}, progress));
}

TEST_F(RigByProgram, SkinsOfOtherPosesAreHandedOverInOne) {
  testing::SceneBuilder scene;
  std::vector<Index> nodes;
  TriMesh parts[2];
  testing::addCapsule(parts[0], Vec3(0, 0, 0), Vec3(0, 1.2, 0), 0.2);
  testing::addCapsule(parts[0], Vec3(0, 0.1, 0.3), Vec3(0, 0.1, 0.6), 0.08);
  testing::addCapsule(parts[1], Vec3(0.3, 1, 0), Vec3(1, 1, 0), 0.1);
  SkinWeights weights;
  weights.slots = 1;
  for (const TriMesh& part : parts) {
    const Json primitive = scene.primitive(part.positions, part.triangles);
    nodes.push_back(scene.addNode({{"mesh", scene.addMesh(Json::array({primitive}))}}));
    weights.joints.insert(weights.joints.end(), part.positions.size(), indexOf(nodes.size() == 1 ? "hips" : "arm"));
  }
  weights.weights.assign(weights.joints.size(), 1);
  scene.asset().document.scene = scene.addScene(nodes);
  Asset asset = scene.build();
  const std::vector<Index> joints = attachRig(asset, collectGeometry(asset), testing::madeSkeleton(), weights);
  testing::bindElsewhere(asset, nodes[1], {joints[indexOf("arm")]}, Vec3f(0, 0, 4));
  Adapter adapter =
      copying(madeGlb(madeBody(), madeWeights(madeBody()), madeToHanded(shellAdapter(""))), AdapterFormat::kGlb);
  AutoRigOptions options;
  options.existingRig = ExistingRig::kReplace;
  Asset anew = asset.clone();
  EXPECT_NO_THROW(rig(anew, adapter, options));
  adapter.kind = AdapterKind::kWeights;
  adapter.inputFormat = AdapterFormat::kGlb;
  Progress progress;
  EXPECT_NO_THROW(weightsByProgram(asset, adapter, {}, progress));
}

TEST_F(RigByProgram, GarbageIsALineOfText) {
  EXPECT_THAT(problemOf(copying("Traceback (most recent call last):\n", AdapterFormat::kRignetText)),
              HasSubstr("model.txt: line 1: begins with 'Traceback'"));
  const std::string noise = std::string("\0\xff\xfe", 3) + "\x01\x02 junk";
  for (const AdapterFormat format : {AdapterFormat::kRignetText, AdapterFormat::kGlb, AdapterFormat::kFbx}) {
    EXPECT_THAT(problemOf(copying(noise, format)), HasSubstr(fmt::format("model{}", adapterExtension(format))));
  }
  const Bytes glb = madeGlb(madeBody(), madeWeights(madeBody()));
  EXPECT_THAT(problemOf(copying(Bytes(glb.begin(), glb.begin() + 1000), AdapterFormat::kGlb)), HasSubstr("model.glb"));
}

TEST_F(RigByProgram, ATextForAnotherMeshIsRefused) {
  TriMesh more = madeBody();
  testing::addCapsule(more, Vec3(0, 2, 0), Vec3(0, 3, 0), 0.1);
  EXPECT_THAT(
      problemOf(copying(madeText(madeToHanded(shellAdapter("")), more, madeWeights(more)), AdapterFormat::kRignetText)),
      HasSubstr("but the model that was handed over has"));
}

TEST_F(RigByProgram, JointsInSwappedAxesAreRefused) {
  const Adapter plain = shellAdapter("");
  const Affine map = madeToHanded(plain);
  const Affine turned = toHandedSpace(AdapterUp::kZ, 1) * map;
  Affine mirrored = map;
  mirrored.prescale(Vec3(-1, 1, 1));
  const SkinWeights weights = madeWeights(madeBody());
  EXPECT_THAT(problemOf(copying(madeText(turned, madeBody(), weights), AdapterFormat::kRignetText)),
              AllOf(HasSubstr("swapped axes: the model's x, y, z are its x, z, -y"), HasSubstr("\"up\"")));
  EXPECT_THAT(problemOf(copying(madeText(mirrored, madeBody(), weights), AdapterFormat::kRignetText)),
              HasSubstr("the model's x, y, z are its -x, y, z"));
}

TEST_F(RigByProgram, JointsInAnotherUnitAreRefused) {
  const Affine map = Eigen::Scaling(100.0) * madeToHanded(shellAdapter(""));
  EXPECT_THAT(problemOf(copying(madeText(map, madeBody(), madeWeights(madeBody())), AdapterFormat::kRignetText)),
              HasSubstr("lies outside the model"));
}

// --- documents ---

// Vertices and triangles in another order, each triangle with vertices of its own: as exporters of textured models
// write them.
void shuffle(TriMesh& mesh, SkinWeights& weights) {
  Random random(3);
  for (std::size_t t = mesh.triangles.size(); t > 1; --t)
    std::swap(mesh.triangles[t - 1], mesh.triangles[random.below(t)]);
  TriMesh apart;
  std::vector<Index> taken;
  for (const Triangle& t : mesh.triangles) {
    const Index first = apart.vertexCount();
    for (const Index v : t) {
      apart.positions.push_back(mesh.positions[v]);
      taken.push_back(v);
    }
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  weights = expandWeights(weights, taken);
  mesh = apart;
}

TEST_F(RigByProgram, ReorderedAndDoubledVerticesAreKnownByTheirPlaces) {
  TriMesh body = madeBody();
  SkinWeights weights = madeWeights(body);
  shuffle(body, weights);
  for (const AdapterFormat input : {AdapterFormat::kObj, AdapterFormat::kGlb}) {
    Adapter plain = shellAdapter("");
    plain.inputSize = 2;
    Adapter adapter = copying(madeGlb(body, weights, madeToHanded(plain)), AdapterFormat::kGlb);
    adapter.inputSize = 2;
    adapter.inputFormat = input;
    Asset asset = offsetModel();
    EXPECT_EQ(rig(asset, adapter).skinning, "fake");
    expectMadeRig(asset, madeWeights(madeBody()), 1e-5);
  }
}

TEST_F(RigByProgram, AnFbxIsReadToo) {
  TriMesh body = madeBody();
  SkinWeights weights = madeWeights(body);
  const Affine map = madeToHanded(shellAdapter(""));
  for (Vec3f& p : body.positions) p = (map * Vec3(p.cast<double>())).cast<float>();
  Asset asset = offsetModel();
  const AutoRigReport report =
      rig(asset,
          copying(testing::fbxText(body, movedSkeleton(testing::madeSkeleton(), map), weights), AdapterFormat::kFbx));
  EXPECT_EQ(report.joints, 5u);
  expectMadeRig(asset, madeWeights(madeBody()), 1e-5);
}

TEST_F(RigByProgram, WhatIsMovedAndScaledIsRefusedUnlessTheAdapterSaysSo) {
  Affine away = Affine::Identity();
  away.translate(Vec3(0.5, 3, -1));
  away.scale(40);
  const Bytes glb = madeGlb(madeBody(), madeWeights(madeBody()), away * madeToHanded(shellAdapter("")));
  Adapter adapter = copying(glb, AdapterFormat::kGlb);
  EXPECT_THAT(problemOf(adapter), HasSubstr("model.glb: the surface is 40 times as large as what was handed over"));
  adapter.mayRescale = true;
  Asset asset = offsetModel();
  rig(asset, adapter);
  expectMadeRig(asset, madeWeights(madeBody()), 1e-4);
}

TEST_F(RigByProgram, SurfacesInSwappedAxesAreRefused) {
  const Affine map = madeToHanded(shellAdapter(""));
  Affine mirrored = map;
  mirrored.prescale(Vec3(1, -1, 1));
  Affine moved = map;
  moved.pretranslate(Vec3(0, 1, 0));
  const SkinWeights weights = madeWeights(madeBody());
  const auto problem = [&](const Affine& wrong) {
    return problemOf(copying(madeGlb(madeBody(), weights, wrong), AdapterFormat::kGlb));
  };
  EXPECT_THAT(problem(toHandedSpace(AdapterUp::kZ, 1) * map),
              HasSubstr("the surface has its axes swapped: the model's x, y, z are its x, z, y"));
  EXPECT_THAT(problem(mirrored), AllOf(HasSubstr("the surface is not the model's"), HasSubstr("lie farther")));
  EXPECT_THAT(problem(moved), HasSubstr("the surface lies 1 times the model's longest side from where it was"));
}

TEST_F(RigByProgram, AnotherSurfaceIsRefused) {
  TriMesh other;
  testing::addCapsule(other, Vec3::Zero(), Vec3(0, 1, 0), 0.2);
  const Affine map = madeToHanded(shellAdapter(""));
  EXPECT_THAT(problemOf(copying(madeGlb(other, madeWeights(other), map), AdapterFormat::kGlb)),
              HasSubstr("the surface is not the model's"));
  EXPECT_THAT(problemOf(copying(writeGlb(meshAsset(madeBody())), AdapterFormat::kGlb)),
              HasSubstr("has no skeleton with a skin"));
}

// Each triangle as four, with vertices of its own; `ends` tells between which vertices each new one lies.
TriMesh subdivided(const TriMesh& mesh, std::vector<std::pair<Index, Index>>& ends) {
  TriMesh fine;
  for (const Triangle& t : mesh.triangles) {
    const Index first = fine.vertexCount();
    for (int k = 0; k < 3; ++k) {
      for (const Index end : {t[k], t[(k + 1) % 3]}) {
        fine.positions.push_back(0.5f * (mesh.positions[t[k]] + mesh.positions[end]));
        ends.emplace_back(t[k], end);
      }
    }
    fine.triangles.push_back({first, first + 1, first + 5});
    fine.triangles.push_back({first + 1, first + 2, first + 3});
    fine.triangles.push_back({first + 3, first + 4, first + 5});
    fine.triangles.push_back({first + 1, first + 3, first + 5});
  }
  return fine;
}

TEST_F(RigByProgram, FewerTrianglesStillTellTheWeights) {
  const TriMesh body = madeBody();
  const SkinWeights coarse = madeWeights(body);
  std::vector<std::pair<Index, Index>> ends;
  Asset asset = meshAsset(subdivided(body, ends));
  rig(asset, copying(madeGlb(body, coarse, madeToHanded(shellAdapter(""))), AdapterFormat::kGlb));
  const AssetSkeleton read = readSkeleton(asset);
  const SkinWeights weights = readWeights(asset, collectGeometry(asset), read);
  ASSERT_EQ(weights.vertexCount(), ends.size());
  for (const testing::MadeJoint& made : madeJoints()) {
    const Index joint = *read.skeleton.find(made.name), own = indexOf(made.name);
    for (Index v = 0; v < ends.size(); ++v) {
      const double expected = 0.5 * (weightOf(coarse, ends[v].first, own) + weightOf(coarse, ends[v].second, own));
      EXPECT_NEAR(weightOf(weights, v, joint), expected, 1e-4) << made.name << " at " << v;
    }
  }
}

TEST_F(RigByProgram, ARigOfTheModelsOwnIsReplacedOnlyWhereAsked) {
  const std::string text = madeText(madeToHanded(shellAdapter("")), madeBody(), madeWeights(madeBody()));
  const Adapter adapter = copying(text, AdapterFormat::kRignetText);
  Asset asset = offsetModel();
  rig(asset, adapter);
  EXPECT_THROW(rig(asset, adapter), Error);
  AutoRigOptions options;
  options.existingRig = ExistingRig::kReplace;
  rig(asset, adapter, options);
  expectMadeRig(asset, madeWeights(madeBody()), 1e-6);
  options.existingRig = ExistingRig::kKeepSkeleton;
  EXPECT_THROW(rig(asset, adapter, options), Error);
}

TEST_F(RigByProgram, HangsAndCrashesAreErrorsOfTheModel) {
  Adapter adapter = shellAdapter("sleep 100");
  adapter.limits.seconds = 0.2;
  EXPECT_THAT(problemOf(adapter), HasSubstr("did not end within 0.2 s"));
  EXPECT_THAT(problemOf(shellAdapter("kill -SEGV $$")), HasSubstr("crashed"));
  EXPECT_THAT(problemOf(shellAdapter("echo done")), HasSubstr("wrote no output/model.txt"));
}

// --- weights for a skeleton that is there ---

Adapter weighing(std::string_view line) {
  Adapter adapter = shellAdapter(line, AdapterFormat::kGlb);
  adapter.kind = AdapterKind::kWeights;
  adapter.inputFormat = AdapterFormat::kGlb;
  return adapter;
}

TEST_F(RigByProgram, AProgramThatGivesBackWhatItIsGivenChangesNothing) {
  Asset asset = offsetModel();
  rig(asset, copying(madeText(madeToHanded(shellAdapter("")), madeBody(), madeWeights(madeBody())),
                     AdapterFormat::kRignetText));
  Progress progress;
  EXPECT_TRUE(weightsByProgram(asset, weighing("cp \"$1\" \"$2\""), {}, progress).empty());
  expectMadeRig(asset, madeWeights(madeBody()), 1e-5);
}

TEST_F(RigByProgram, WeightsOfAProgramTakeThePlaceOfLimbers) {
  Asset asset = offsetModel();
  const std::string skeleton = madeText(madeToHanded(shellAdapter("")), madeBody(), {});
  rig(asset, copying(skeleton, AdapterFormat::kRignetText));
  const fs::path file = folder_.path() / "weighed.glb";
  putFile(file, madeGlb(madeBody(), madeWeights(madeBody()), madeToHanded(shellAdapter(""))));
  Progress progress;
  weightsByProgram(asset, weighing(fmt::format("cp '{}' \"$2\"", file.string())), {}, progress);
  expectMadeRig(asset, madeWeights(madeBody()), 1e-5);
}

// The same rig under other names.
Bytes renamedGlb(const Affine& map, bool isElsewhere) {
  TriMesh moved = madeBody();
  for (Vec3f& p : moved.positions) p = (map * Vec3(p.cast<double>())).cast<float>();
  Skeleton skeleton = movedSkeleton(testing::madeSkeleton(), map);
  for (Joint& joint : skeleton.joints) joint.name = "bone_" + joint.name;
  if (isElsewhere) skeleton.joints[3].rest.translation += Vec3(0.1, 0, 0);
  Asset asset = meshAsset(moved);
  attachRig(asset, collectGeometry(asset), skeleton, madeWeights(madeBody()));
  return writeGlb(asset);
}

TEST_F(RigByProgram, JointsUnderOtherNamesAreKnownByTheirPlaces) {
  Asset asset = offsetModel();
  const std::string skeleton = madeText(madeToHanded(shellAdapter("")), madeBody(), {});
  rig(asset, copying(skeleton, AdapterFormat::kRignetText));
  const fs::path file = folder_.path() / "weighed.glb";
  const Adapter adapter = weighing(fmt::format("cp '{}' \"$2\"", file.string()));
  Progress progress;
  putFile(file, renamedGlb(madeToHanded(shellAdapter("")), true));
  try {
    weightsByProgram(asset, adapter, {}, progress);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the joint 'bone_hand' is none of the model's"));
  }
  putFile(file, renamedGlb(madeToHanded(shellAdapter("")), false));
  weightsByProgram(asset, adapter, {}, progress);
  expectMadeRig(asset, madeWeights(madeBody()), 1e-5);
}

}  // namespace
}  // namespace limber
