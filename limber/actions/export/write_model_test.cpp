#include "limber/actions/export/write_model.h"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/scene/geometry.h"
#include "limber/document/stored_archive.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/vrm/testing/avatars.h"
#include "limber/document/write.h"
#include "temporary_folder.h"

namespace limber {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Asset everything() {
  return readAsset(testing::everythingModel().glb(), "everything.glb");
}

TEST(WriteModel, WritesEveryFormatThatItNamesWithWhatBelongsBeside) {
  const testing::TemporaryFolder folder;
  const Asset asset = testing::avatarOf(testing::mixamoPerson());
  const std::string report = "{}";
  for (const std::string_view extension : modelExtensions()) {
    const std::filesystem::path path = folder.path() / ("model" + std::string(extension));
    const std::filesystem::path beside = folder.path() / ("report" + std::string(extension) + ".json");
    const std::vector<OutputFile> companions = {{beside, asBytes(report)}};
    WriteModelOptions options;
    options.companions = companions;
    writeModel(asset, path, options);
    EXPECT_TRUE(std::filesystem::exists(path)) << extension;
    EXPECT_TRUE(std::filesystem::exists(beside)) << extension;
  }
}

TEST(WriteModel, GivesTheTargetsNames) {
  const Asset asset = everything();
  WriteModelOptions options;
  options.target = "godot";
  const Asset read = readAsset(encodeModel(asset, ".glb", options).bytes, "everything.glb");
  EXPECT_EQ(readSkeleton(read).skeleton.joints[0].name, "Root");
  EXPECT_NE(readSkeleton(asset).skeleton.joints[0].name, "Root");
}

TEST(WriteModel, WritesFbxInCentimetres) {
  const Asset asset = everything();
  EXPECT_EQ(encodeModel(asset, ".fbx").bytes, encodeFbx(asset, {FbxUnit::kCentimetre, FbxUpAxis::kY, {}}).bytes);
}

TEST(WriteModel, LeavesAPlainModelToTheByte) {
  const Asset asset = everything();
  EXPECT_EQ(encodeModel(asset, ".glb").bytes, writeGlb(asset));
}

TEST(WriteModel, CanLeaveTheClipOutWhereAFormatHoldsOne) {
  const Asset asset = everything();
  WriteModelOptions still;
  still.isStill = true;
  EXPECT_LT(encodeModel(asset, ".usdz", still).bytes.size(), encodeModel(asset, ".usdz").bytes.size());
  EXPECT_EQ(encodeModel(asset, ".glb", still).bytes, writeGlb(asset));
}

TEST(WriteModel, PutsFormatsOfSeveralFilesIntoAnArchive) {
  const Asset asset = everything();
  const std::map<std::string, Bytes> gltf = readZipArchive(encodeModel(asset, ".gltf").bytes, "model.zip");
  ASSERT_TRUE(gltf.count("model.gltf"));
  EXPECT_GT(gltf.size(), 1u);
  const Resolver beside = [&](std::string_view name) -> std::optional<Bytes> { return gltf.at(std::string(name)); };
  const Asset read = readAsset(gltf.at("model.gltf"), "model.gltf", beside);
  EXPECT_EQ(collectGeometry(read).positions, collectGeometry(asset).positions);
  EXPECT_TRUE(readZipArchive(encodeModel(asset, ".usdc").bytes, "model.zip").count("model.usdc"));
  const std::map<std::string, Bytes> text = readZipArchive(encodeModel(asset, ".usda").bytes, "model.zip");
  EXPECT_THAT(std::string(text.at("model.usda").begin(), text.at("model.usda").end()), StartsWith("#usda 1.0"));
}

TEST(WriteModel, NamesTheFormatsThatThereAre) {
  try {
    writeModel(everything(), "model.max");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "model.max");
    EXPECT_THAT(error.remedy(), HasSubstr(".glb"));
  }
  EXPECT_TRUE(holdsOneClip("a.USDZ"));
  EXPECT_FALSE(holdsOneClip("a.glb"));
}

}  // namespace
}  // namespace limber
