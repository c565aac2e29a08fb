// Every model that there is, through the whole of limber, for every count of handles.
#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "limber/actions/rig/auto_rig.h"
#include "limber/core/parallel.h"
#include "limber/document/read.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/write.h"
#include "limber/geometry/mesh/prepare.h"
#include "limber/samples/samples.h"
#include "model_checks.h"
#include "shared_data.h"

namespace limber::testing {

namespace {

namespace fs = std::filesystem;

// 6, 10, 20, 50 and 100, or what LIMBER_MATRIX_HANDLES lists, separated by commas.
std::vector<Index> handleCounts() {
  const char* named = std::getenv("LIMBER_MATRIX_HANDLES");
  std::istringstream list(named ? named : "6,10,20,50,100");
  std::vector<Index> counts;
  for (std::string count; std::getline(list, count, ',');) counts.push_back(static_cast<Index>(std::stoul(count)));
  return counts;
}

std::string nameOf(const std::string& path) {
  std::string name;
  for (const char c : path) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

void writeOutput(const std::string& name, const Bytes& glb, const fs::path& source) {
  const fs::path path = testOutputFolder() / (name + ".glb");
  writeFile(path, glb);
  if (!source.empty()) noteSource(path, source);
}

// The output must be readable, pass checkAsset, and contain a sound rig for the input model.
void expectSoundRig(const Asset& before, const Geometry& geometry, const Rigged& result, Index maxInfluences) {
  const Asset after = readAsset(result.glb, "result.glb");
  const Geometry geometryAfter = collectGeometry(after);
  expectSameShape(geometry, geometryAfter);
  expectSameContent(before, after);
  const AssetSkeleton rig = readSkeleton(after);
  checkSkeleton(rig.skeleton);
  expectSoundWeights(readWeights(after, geometryAfter, rig), static_cast<Index>(geometryAfter.positions.size()),
                     rig.skeleton.jointCount(), maxInfluences);
}

enum class Symmetry { kWhereMeshIs, kRequired };

void rigAtEveryCount(const Asset& asset, const std::string& name, const fs::path& source,
                     Symmetry symmetry = Symmetry::kWhereMeshIs) {
  const Geometry geometry = collectGeometry(asset);
  const bool hadRig = hasRig(asset);
  const Index weldedVertices = prepareGeometry(geometry, geometry.triangles).mesh.vertexCount();
  AutoRigOptions options;
  options.existingRig = hadRig ? ExistingRig::kReplace : ExistingRig::kRefuse;
  for (const Index handles : handleCounts()) {
    SCOPED_TRACE(name + " at " + std::to_string(handles) + " handles");
    options.rig.handles = handles;
    if (handles > weldedVertices) {
      EXPECT_THROW(rigged(asset, options), Error);
      continue;
    }
    const Rigged result = rigged(asset, options);
    EXPECT_EQ(result.report.weldedVertices, weldedVertices);
    writeOutput(name + "_" + std::to_string(handles), result.glb, source);
    expectSoundRig(asset, geometry, result, options.weights.maxInfluences);
    const AssetSkeleton rig = readSkeleton(readAsset(result.glb, "result.glb"));
    expectJointCount(rig, handles);
    const bool symmetric = expectSymmetricWhereMeshIs(geometry, rig.skeleton);
    EXPECT_TRUE(symmetric || symmetry == Symmetry::kWhereMeshIs);
    if (!hadRig && source.extension() == ".glb" && asset.warnings.empty())
      expectOnlyAdditions(readFile(source), result.glb, result.report);
  }
}

std::vector<std::string> modelsBelow(std::initializer_list<const char*> folders) {
  std::vector<std::string> names;
  if (const auto data = sharedDataFolder())
    for (const char* folder : folders)
      for (const fs::path& file : modelFiles(*data / folder)) names.push_back(fs::relative(file, *data).string());
  if (names.empty()) names.push_back("");  // one test that says why it skips
  return names;
}

std::string testName(const ::testing::TestParamInfo<std::string>& info) {
  return info.param.empty() ? "none" : nameOf(info.param);
}

class ModelTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (GetParam().empty()) GTEST_SKIP() << kNoSharedData;
    path_ = *sharedDataFolder() / GetParam();
  }
  fs::path path_;
};

// Skeletons without a mesh: to be refused, in words.
bool isSkeletonOnly(const std::string& name) {
  return name.find("_rigonly") != std::string::npos;
}

}  // namespace

using SharedModels = ModelTest;

TEST_P(SharedModels, AreRiggedAtEveryCountOfHandles) {
  const Asset asset = readAsset(path_);
  if (isSkeletonOnly(GetParam())) {
    EXPECT_THROW(collectGeometry(asset), Error);
    return;
  }
  rigAtEveryCount(asset, nameOf(GetParam()), path_);
}

TEST_P(SharedModels, GiveTheSameBytesOnOneThread) {
  if (isSkeletonOnly(GetParam())) return;
  const Asset asset = readAsset(path_);
  AutoRigOptions options;
  options.existingRig = hasRig(asset) ? ExistingRig::kReplace : ExistingRig::kRefuse;
  options.rig.handles = handleCounts().front();
  const Rigged many = rigged(asset, options);
  setThreadCount(1);
  const Rigged one = rigged(asset, options);
  setThreadCount(0);
  EXPECT_TRUE(many.glb == one.glb);
}

INSTANTIATE_TEST_SUITE_P(Models, SharedModels, ::testing::ValuesIn(modelsBelow({"meshes", "rigged", "broken/encoded"})),
                         testName);

class Samples : public ::testing::TestWithParam<std::string> {};

TEST_P(Samples, AreRiggedAtEveryCountOfHandles) {
  const Asset asset = makeSample(GetParam());
  const fs::path source = testOutputFolder() / ("sample_" + GetParam() + ".glb");
  writeAsset(asset, source);
  rigAtEveryCount(readAsset(source), "sample_" + GetParam(), source, Symmetry::kRequired);
}

std::vector<std::string> sampleNames() {
  std::vector<std::string> names;
  for (const SampleModel& sample : sampleModels()) names.emplace_back(sample.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Models, Samples, ::testing::ValuesIn(sampleNames()));

using RiggedModels = ModelTest;

TEST_P(RiggedModels, AreRefusedUnlessAskedFor) {
  const Asset asset = readAsset(path_);
  if (!hasRig(asset) || isSkeletonOnly(GetParam())) return;
  try {
    rigged(asset, {});
    FAIL() << "rigged over a rig of its own";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
  }
}

// New weights for the artist's own skeleton: all else stays.
TEST_P(RiggedModels, KeepTheirSkeleton) {
  const Asset asset = readAsset(path_);
  if (isSkeletonOnly(GetParam())) return;
  AutoRigOptions options;
  options.existingRig = ExistingRig::kKeepSkeleton;
  if (!hasRig(asset)) {
    EXPECT_THROW(rigged(asset, options), Error);
    return;
  }
  const Rigged result = rigged(asset, options);
  writeOutput(nameOf(GetParam()) + "_kept", result.glb, path_);
  expectSoundRig(asset, collectGeometry(asset), result, options.weights.maxInfluences);
  const AssetSkeleton before = readSkeleton(asset), after = readSkeleton(readAsset(result.glb, "result.glb"));
  ASSERT_EQ(before.skeleton.jointCount(), after.skeleton.jointCount());
  const std::vector<Affine> globalsBefore = restGlobals(before.skeleton), globalsAfter = restGlobals(after.skeleton);
  for (Index j = 0; j < before.skeleton.jointCount(); ++j) {
    EXPECT_EQ(before.skeleton.joints[j].name, after.skeleton.joints[j].name);
    // Made from another format's doubles, written as floats.
    EXPECT_TRUE(globalsBefore[j].isApprox(globalsAfter[j], 1e-6)) << before.skeleton.joints[j].name;
  }
  // A second set of four influences is removed where four are requested, and so is its accessor.
  const bool hasSecondSet = documentJson(asset).dump().find("\"JOINTS_1\"") != std::string::npos;
  if (path_.extension() == ".glb" && asset.warnings.empty() && !hasSecondSet)
    expectOnlyAdditions(readFile(path_), result.glb, result.report);
}

INSTANTIATE_TEST_SUITE_P(Models, RiggedModels, ::testing::ValuesIn(modelsBelow({"rigged"})), testName);

}  // namespace limber::testing
