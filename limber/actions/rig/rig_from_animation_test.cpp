#include "limber/actions/rig/rig_from_animation.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "limber/actions/obj_series.h"
#include "limber/core/error.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/rig/rig_io.h"
#include "limber/document/write.h"

namespace limber {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kRows = 9;

// Where a strip along +Y, two vertices a row, is when its upper half is bent at y = 1 by an angle; the bend spreads
// over the middle three rows.
std::vector<float> bentStrip(double angle) {
  std::vector<float> positions;
  for (int row = 0; row < kRows; ++row) {
    const double y = 0.25 * row, w = std::min(1.0, std::max(0.0, 0.5 + (y - 1)));
    for (const double x : {-0.2, 0.2}) {
      const double turnedX = std::cos(angle) * x - std::sin(angle) * (y - 1);
      const double turnedY = std::sin(angle) * x + std::cos(angle) * (y - 1) + 1;
      for (const double value : {(1 - w) * x + w * turnedX, (1 - w) * y + w * turnedY, 0.05 * (row % 2)}) {
        positions.push_back(static_cast<float>(value));
      }
    }
  }
  return positions;
}

std::vector<std::uint16_t> stripCorners() {
  std::vector<std::uint16_t> corners;
  for (int row = 0; row + 1 < kRows; ++row) {
    for (const int corner : {0, 1, 2, 2, 1, 3}) corners.push_back(static_cast<std::uint16_t>(2 * row + corner));
  }
  return corners;
}

gltf::AnimationSampler addSampler(Asset& asset, const std::vector<float>& times, const std::vector<float>& values,
                                  Index components) {
  gltf::AnimationSampler sampler;
  sampler.input = addFloatAccessor(asset, times, 1, 0, true);
  sampler.output = addFloatAccessor(asset, values, components);
  return sampler;
}

// A channel for the node 0 by the sampler that is added with it.
void addChannel(gltf::Animation& clip, const char* path, gltf::AnimationSampler sampler) {
  gltf::AnimationChannel channel;
  channel.sampler = addElement(clip.samplers, std::move(sampler));
  channel.target.node = 0;
  channel.target.path = path;
  clip.channels.push_back(std::move(channel));
}

// A strip with a morph target for each bend, played one after the other, on a node that is translated and rotated.
Asset morphingStrip(int frames, double reach, bool isTurning = true) {
  Asset asset;
  asset.name = "strip.glb";
  const std::vector<float> rest = bentStrip(0);
  const std::vector<std::uint16_t> corners = stripCorners();
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, rest, 3, kVertexTarget, true));
  const AccessorInfo info{static_cast<Index>(corners.size()), 1, ComponentType::kU16, false};
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(corners.data());
  primitive.indices = addAccessor(asset, info, {bytes, 2 * corners.size()}, kIndexTarget);
  primitive.material = 0;
  std::vector<float> times, weights;
  for (int f = 0; f < frames; ++f) {
    std::vector<float> offsets = bentStrip(reach * std::sin(1.0 + 0.5 * f));
    for (std::size_t i = 0; i < offsets.size(); ++i) offsets[i] -= rest[i];
    primitive.targets.emplace_back().set("POSITION", addFloatAccessor(asset, offsets, 3, kVertexTarget, true));
    times.push_back(static_cast<float>(f) / 10);
    for (int t = 0; t < frames; ++t) weights.push_back(t == f ? 1.0f : 0.0f);
  }
  gltf::Document& document = asset.document;
  document.materials.emplace_back().name = "paint";
  document.meshes.emplace_back().primitives.push_back(std::move(primitive));
  gltf::Node& node = document.nodes.emplace_back();
  node.name = "strip";
  node.mesh = 0;
  node.translation = Vec3(5, 0, 0);
  document.scenes.emplace_back().nodes = {0};
  document.scene = 0;
  gltf::Animation bend;
  bend.name = "bend";
  addChannel(bend, "weights", addSampler(asset, times, weights, 1));
  if (isTurning) {
    const float half = std::sqrt(0.5f);
    addChannel(bend, "rotation", addSampler(asset, {0, times.back()}, {0, 0, 0, 1, 0, half, 0, half}, 4));
  }
  document.animations.push_back(std::move(bend));
  checkAsset(asset);
  return asset;
}

// Largest distance between where two documents put their vertices, frame by frame.
double farthestApart(const VertexAnimation& a, const VertexAnimation& b) {
  EXPECT_EQ(a.pointOf.size(), b.pointOf.size());
  EXPECT_EQ(a.sequence.frameCount(), b.sequence.frameCount());
  double farthest = 0;
  for (std::size_t v = 0; v < a.pointOf.size(); ++v) {
    for (Index f = 0; f < a.sequence.frameCount(); ++f) {
      const Vec3f apart = a.sequence.at(a.pointOf[v], f) - b.sequence.at(b.pointOf[v], f);
      farthest = std::max(farthest, double{apart.norm()});
    }
  }
  return farthest;
}

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

DecompositionOptions someBones(Index count) {
  DecompositionOptions options;
  options.bones = count;
  return options;
}

VertexAnimation readAnimation(const Asset& asset, const VertexAnimationOptions& options) {
  Progress progress;
  return readVertexAnimation(asset, options, progress);
}

ObjSeries readSeries(const std::vector<fs::path>& files, double framesPerSecond) {
  Progress progress;
  return readObjSeries(files, framesPerSecond, progress);
}

TEST(RigFromAnimation, MorphTargetsOnATurningNodeBecomeBones) {
  Asset asset = morphingStrip(12, 0.8);
  const VertexAnimation before = readAnimation(asset, {});
  EXPECT_EQ(before.sequence.frameCount(), 12u);
  EXPECT_EQ(before.clips[0].framesPerSecond, 10);
  Progress progress;
  const AnimationRigReport report = rigFromAnimation(asset, readAnimation(asset, {}), someBones(2), progress);
  EXPECT_EQ(report.joints, 2u);
  EXPECT_LT(report.error, 1e-3);

  // Written and read again it does what the morphs did.
  const Asset written = readAsset(writeGlb(asset), "strip.glb");
  EXPECT_TRUE(hasRig(written));
  EXPECT_TRUE(written.document.meshes[0].primitives[0].targets.empty());
  EXPECT_EQ(written.document.meshes[0].primitives[0].material, Index{0});
  ASSERT_EQ(written.document.animations.size(), 1u);
  EXPECT_EQ(written.document.animations[0].name, "bend");
  EXPECT_LT(farthestApart(before, readAnimation(written, {"bend", 10})), 0.01);
}

TEST(RigFromAnimation, MorphTargetsAloneBecomeBones) {
  Asset asset = morphingStrip(12, 0.8, false);
  const VertexAnimation before = readAnimation(asset, {});
  Progress progress;
  rigFromAnimation(asset, readAnimation(asset, {}), someBones(2), progress);
  EXPECT_LT(farthestApart(before, readAnimation(asset, {"", 10})), 0.01);
}

TEST(RigFromAnimation, ARiggedModelIsRiggedAnew) {
  Asset asset = morphingStrip(12, 0.8);
  Progress progress;
  rigFromAnimation(asset, readAnimation(asset, {}), someBones(2), progress);
  const VertexAnimation before = readAnimation(asset, {"", 20});
  const AnimationRigReport report = rigFromAnimation(asset, readAnimation(asset, {"", 20}), someBones(3), progress);
  EXPECT_LT(report.error, 5e-4);
  EXPECT_EQ(asset.document.skins.size(), 1u);
  EXPECT_EQ(asset.document.animations.size(), 1u);
  EXPECT_LT(farthestApart(before, readAnimation(asset, {"", 20})), 0.002);
}

TEST(RigFromAnimation, RefusesWhatDoesNotMove) {
  Asset still = morphingStrip(5, 0, false);
  EXPECT_THAT(messageOf([&] { readAnimation(still, {}); }), HasSubstr("nothing moves"));
  Asset single = morphingStrip(1, 0.5, false);
  EXPECT_THAT(messageOf([&] { readAnimation(single, {}); }), HasSubstr("a single frame"));
  still.document.animations.clear();
  EXPECT_THAT(messageOf([&] { readAnimation(still, {}); }), HasSubstr("strip.glb: has no animation"));
}

TEST(RigFromAnimation, RefusesClipsAndRatesThatMakeNoSense) {
  const Asset asset = morphingStrip(5, 0.5);
  EXPECT_THAT(messageOf([&] { readAnimation(asset, {"run", std::nullopt}); }), HasSubstr("there are: bend"));
  EXPECT_THAT(messageOf([&] { readAnimation(asset, {"", 0.0}); }), HasSubstr("frame rate"));
  EXPECT_THAT(messageOf([&] { readAnimation(asset, {"", 1e12}); }), HasSubstr("--fps"));
}

// A second clip of the node alone, with keys at another rate.
void addTurns(Asset& asset, const std::string& name, const std::vector<float>& times) {
  std::vector<float> turns;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double angle = 0.1 * static_cast<double>(k);
    for (const double value : {0.0, std::sin(angle), 0.0, std::cos(angle)}) turns.push_back(static_cast<float>(value));
  }
  gltf::Animation clip;
  clip.name = name;
  addChannel(clip, "rotation", addSampler(asset, times, turns, 4));
  asset.document.animations.push_back(std::move(clip));
  checkAsset(asset);
}

TEST(RigFromAnimation, EachClipIsSampledAtItsOwnRate) {
  Asset asset = morphingStrip(12, 0.8);
  addTurns(asset, "slow", {0, 0.5f, 1, 1.5f, 2});
  const VertexAnimation both = readAnimation(asset, {});
  ASSERT_EQ(both.clips.size(), 2u);
  EXPECT_EQ(both.clips[0].framesPerSecond, 10);
  EXPECT_EQ(both.clips[0].count, 12u);
  EXPECT_EQ(both.clips[1].framesPerSecond, 2);
  EXPECT_EQ(both.clips[1].first, 12u);
  EXPECT_EQ(both.clips[1].count, 5u);
  Progress progress;
  rigFromAnimation(asset, readAnimation(asset, {}), someBones(3), progress);
  const VertexAnimation again = readAnimation(asset, {});
  ASSERT_EQ(again.clips.size(), 2u);
  EXPECT_EQ(again.clips[1].framesPerSecond, 2);
  EXPECT_LT(farthestApart(both, again), 0.01);
}

TEST(RigFromAnimation, AClipCalledSoInFullGoesFirst) {
  Asset asset = morphingStrip(12, 0.8);
  asset.document.animations[0].name = "Armature|turn";
  addTurns(asset, "turn", {0, 0.5f, 1});
  EXPECT_EQ(readAnimation(asset, {"turn", std::nullopt}).clips[0].count, 3u);
  EXPECT_EQ(readAnimation(asset, {"Armature|turn", std::nullopt}).clips[0].count, 12u);
}

TEST(RigFromAnimation, RefusesClipsTooLongToBeHeld) {
  Asset asset = morphingStrip(3, 0.5);
  addTurns(asset, "long", {0, 0.01f, 1e6f});
  EXPECT_THAT(messageOf([&] { readAnimation(asset, {"long", 30.0}); }), HasSubstr("30000001 frames"));
}

TEST(RigFromAnimation, ReadingCanBeCancelled) {
  const Asset asset = morphingStrip(12, 0.8);
  for (const int last : {1, 7, 15, 23}) {
    int reported = 0;
    Progress progress([&](std::string_view, double) {
      if (++reported == last) progress.cancel();
    });
    ErrorCode code = ErrorCode::kFile;
    try {
      readVertexAnimation(asset, {}, progress);
    } catch (const Error& error) {
      code = error.code();
    }
    EXPECT_EQ(code, ErrorCode::kCancelled) << last;
    EXPECT_EQ(reported, last);
  }
}

TEST(RigFromAnimation, AnErrorLeavesTheModelAsItWas) {
  Asset asset = morphingStrip(12, 0.8);
  const Bytes before = writeGlb(asset);
  VertexAnimation other = readAnimation(asset, {});
  other.pointOf.push_back(0);
  Progress progress;
  EXPECT_THROW(rigFromAnimation(asset, std::move(other), someBones(2), progress), Error);
  EXPECT_EQ(writeGlb(asset), before);
}

class ObjFrames : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "limber_obj_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path put(const std::string& name, double angle, int leftOut = 0) const {
    std::ofstream file(folder_ / name);
    const std::vector<float> positions = bentStrip(angle);
    for (std::size_t i = 0; i < positions.size(); i += 3) {
      file << "v " << positions[i] << " " << positions[i + 1] << " " << positions[i + 2] << "\n";
    }
    const std::vector<std::uint16_t> corners = stripCorners();
    for (std::size_t i = 0; i + 3 * leftOut < corners.size(); i += 3) {
      file << "f " << corners[i] + 1 << " " << corners[i + 1] + 1 << " " << corners[i + 2] + 1 << "\n";
    }
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(ObjFrames, OfAFolderBecomeOneClipInTheOrderOfTheirNumbers) {
  for (int f = 0; f < 12; ++f) put("bend_" + std::to_string(f) + ".obj", 0.08 * f);
  const std::vector<fs::path> files = objFilesIn(folder_);
  ASSERT_EQ(files.size(), 12u);
  EXPECT_EQ(files[2].filename(), "bend_2.obj");
  EXPECT_EQ(files[11].filename(), "bend_11.obj");
  ObjSeries series = readSeries(files, 24);
  ASSERT_EQ(series.animation.clips.size(), 1u);
  EXPECT_EQ(series.animation.clips[0].name, "bend");
  const VertexAnimation before = series.animation;
  Progress progress;
  const AnimationRigReport report = rigFromAnimation(series.asset, std::move(series.animation), someBones(2), progress);
  EXPECT_LT(report.error, 1e-3);
  EXPECT_LT(farthestApart(before, readAnimation(series.asset, {"", 24})), 0.01);
}

TEST_F(ObjFrames, ThatAreNotOneMeshAreRefused) {
  const fs::path first = put("a1.obj", 0), second = put("a2.obj", 0.5), fewer = put("a3.obj", 0.7, 1);
  EXPECT_THAT(messageOf([&] {
                readSeries(std::vector{first, second, fewer}, 30);
              }),
              HasSubstr("a3.obj: has other faces than a1.obj"));
  std::ofstream(folder_ / "a4.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_THAT(messageOf([&] {
                readSeries(std::vector{first, folder_ / "a4.obj"}, 30);
              }),
              HasSubstr("a4.obj: has 3 vertices where a1.obj has 18"));
  EXPECT_THAT(messageOf([&] { readSeries(std::vector{first}, 30); }), HasSubstr("a single frame"));
  EXPECT_THAT(messageOf([&] { readSeries(std::vector{first, first}, 30); }), HasSubstr("nothing moves"));
  std::ofstream(folder_ / "a5.obj") << "v 0 0 x\n";
  EXPECT_THAT(messageOf([&] {
                readSeries(std::vector{first, folder_ / "a5.obj"}, 30);
              }),
              HasSubstr("three finite numbers"));
}

}  // namespace
}  // namespace limber
