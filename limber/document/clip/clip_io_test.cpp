#include "limber/document/clip/clip_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/read.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/testing/document_json.h"
#include "limber/document/testing/gltf_builder.h"
#include "limber/document/write.h"
#include "random_values.h"
#include "shared_data.h"

namespace limber {
namespace {

using testing::documentJson;
using testing::randomRotation;

namespace fs = std::filesystem;

Vec3 randomVector(std::mt19937& random) {
  std::uniform_real_distribution<double> length(-1, 1);
  return {length(random), length(random), length(random)};
}

// What the document says at a moment, by the letter of the specification: the world transforms of its nodes.
std::vector<Affine> nodeWorldsAt(const Asset& asset, const gltf::Animation& animation, double time) {
  const SceneGraph graph = readSceneGraph(asset.document);
  std::vector<Transform> locals;
  for (const gltf::Node& node : asset.document.nodes) {
    Transform& local = locals.emplace_back(decompose(nodeTransform(node)));
    if (node.rotation) local.rotation = Quat(*node.rotation);
    if (node.scale) local = {local.translation, Quat(node.rotation.value_or(Vec4(0, 0, 0, 1))), *node.scale};
  }
  for (const gltf::AnimationChannel& channel : animation.channels) {
    const gltf::AnimationSampler& sampler = animation.samplers.at(channel.sampler);
    const std::vector<float> times = readFloats(asset, sampler.input);
    const std::vector<float> values = readFloats(asset, sampler.output);
    const std::string& path = channel.target.path;
    if (path == "weights" || !channel.target.node) continue;
    const std::size_t width = path == "rotation" ? 4 : 3;
    std::size_t k = 0;
    while (k + 1 < times.size() && times[k + 1] <= time) ++k;
    const bool between = k + 1 < times.size() && time > times[k];
    const double span = between ? double{times[k + 1]} - times[k] : 1, u = between ? (time - times[k]) / span : 0;
    const auto at = [&](std::size_t element) {
      Eigen::VectorXd v(width);
      for (std::size_t c = 0; c < width; ++c) v[static_cast<Eigen::Index>(c)] = values[element * width + c];
      return v;
    };
    Eigen::VectorXd value;
    if (sampler.interpolation == Interpolation::kCubic) {
      value = at(3 * k + 1);
      if (between) {
        value = (2 * u * u * u - 3 * u * u + 1) * at(3 * k + 1) + span * (u * u * u - 2 * u * u + u) * at(3 * k + 2) +
                (-2 * u * u * u + 3 * u * u) * at(3 * k + 4) + span * (u * u * u - u * u) * at(3 * k + 3);
      }
    } else if (sampler.interpolation == Interpolation::kStep || !between) {
      value = at(k);
    } else if (path == "rotation") {
      value = Quat(Vec4(at(k))).slerp(u, Quat(Vec4(at(k + 1)))).coeffs();
    } else {
      value = (1 - u) * at(k) + u * at(k + 1);
    }
    Transform& local = locals[*channel.target.node];
    if (path == "rotation") local.rotation = Quat(Vec4(value)).normalized();
    if (path == "translation") local.translation = value;
    if (path == "scale") local.scale = value;
  }
  std::vector<Affine> worlds(graph.parent.size());
  for (const Index n : graph.allNodes) {
    worlds[n] = graph.parent[n] ? worlds[*graph.parent[n]] * locals[n].toAffine() : locals[n].toAffine();
  }
  return worlds;
}

// The largest difference between where the clip and where the document has the joints.
double largestError(const Asset& asset, const AssetSkeleton& skeleton, const Clip& clip,
                    const gltf::Animation& animation, int samples) {
  double largest = 0;
  for (int i = 0; i <= samples; ++i) {
    const double time = clip.duration() * i / samples;
    Pose pose = restPose(skeleton.skeleton);
    sampleClip(clip, time, pose);
    const std::vector<Affine> globals = poseGlobals(skeleton.skeleton, pose);
    const std::vector<Affine> worlds = nodeWorldsAt(asset, animation, time);
    for (std::size_t j = 0; j < globals.size(); ++j) {
      const double size = 1 + worlds[skeleton.jointNode[j]].translation().norm();
      largest = std::max(largest,
                         (globals[j].matrix() - worlds[skeleton.jointNode[j]].matrix()).cwiseAbs().maxCoeff() / size);
    }
  }
  return largest;
}

Motion randomMotion(unsigned seed) {
  std::mt19937 random(seed);
  Motion motion;
  motion.name = "made";
  for (Index j = 0; j < 7; ++j) {
    Joint joint;
    joint.name = fmt::format("joint{}", j);
    if (j > 0) joint.parent = random() % j;
    joint.rest.translation = randomVector(random);
    joint.rest.rotation = randomRotation(random);
    motion.skeleton.joints.push_back(joint);
  }
  const Interpolation kinds[] = {Interpolation::kLinear, Interpolation::kStep, Interpolation::kCubic};
  for (const Interpolation kind : kinds) {
    Clip clip;
    clip.name = fmt::format("clip{}", static_cast<int>(kind));
    for (Index j = 0; j < 7; ++j) {
      Track<Eigen::Quaternionf> turns;
      Track<Vec3f> moves;
      turns.joint = moves.joint = j;
      turns.interpolation = moves.interpolation = kind;
      for (int k = 0; k < 6; ++k) {
        turns.times.push_back(0.25f * static_cast<float>(k));
        for (int v = 0; v < (kind == Interpolation::kCubic ? 3 : 1); ++v) {
          turns.values.emplace_back(randomRotation(random).cast<float>());
          moves.values.emplace_back(randomVector(random).cast<float>());
        }
      }
      moves.times = turns.times;
      if (random() % 3 != 0) clip.rotations.push_back(turns);
      if (random() % 3 == 0) clip.translations.push_back(moves);
      if (j == 2) {
        for (Vec3f& value : moves.values) value = Vec3f::Constant(1.5f + 0.5f * value.x());
        clip.scales.push_back(moves);
      }
    }
    motion.clips.push_back(clip);
  }
  return motion;
}

template <typename Value>
void expectEqual(const std::vector<Track<Value>>& a, const std::vector<Track<Value>>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t t = 0; t < a.size(); ++t) {
    EXPECT_EQ(a[t].joint, b[t].joint);
    EXPECT_EQ(a[t].interpolation, b[t].interpolation);
    EXPECT_EQ(a[t].times, b[t].times);
    ASSERT_EQ(a[t].values.size(), b[t].values.size());
    for (std::size_t v = 0; v < a[t].values.size(); ++v) {
      if constexpr (std::is_same_v<Value, Vec3f>) {
        EXPECT_EQ(a[t].values[v], b[t].values[v]);
      } else {
        EXPECT_TRUE(a[t].values[v].coeffs().isApprox(b[t].values[v].coeffs(), 1e-6f));
      }
    }
  }
}

TEST(ClipIo, ReadsBackWhatItWrote) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Motion motion = randomMotion(seed);
    const Bytes bytes = writeGlb(motionAsset(motion));
    writeFile(limber::testing::testOutputFolder() / fmt::format("clip_io_{}.glb", seed), bytes);
    const Asset asset = readAsset(bytes, "made.glb");
    const Motion back = motionOf(asset);
    ASSERT_EQ(back.clips.size(), 3u);
    EXPECT_TRUE(back.warnings.empty());
    EXPECT_EQ(back.framesPerSecond, 4);
    const AssetSkeleton skeleton = readSkeleton(asset);
    std::vector<Index> newIndex;
    for (const Joint& joint : motion.skeleton.joints) newIndex.push_back(*back.skeleton.find(joint.name));
    for (std::size_t c = 0; c < 3; ++c) {
      Clip expected = motion.clips[c];
      const auto renumber = [&](auto& tracks) {
        for (auto& track : tracks) track.joint = newIndex[track.joint];
        std::sort(tracks.begin(), tracks.end(), [](const auto& a, const auto& b) { return a.joint < b.joint; });
      };
      renumber(expected.translations);
      renumber(expected.rotations);
      renumber(expected.scales);
      EXPECT_EQ(back.clips[c].name, expected.name);
      expectEqual(back.clips[c].translations, expected.translations);
      expectEqual(back.clips[c].rotations, expected.rotations);
      expectEqual(back.clips[c].scales, expected.scales);
      EXPECT_LT(largestError(asset, skeleton, back.clips[c], asset.document.animations[c], 31), 1e-5) << seed;
    }
  }
}

// The same document below a node that moves, turns and scales it.
Asset belowArmature(const Motion& motion) {
  gltf::Node armature;
  armature.name = "armature";
  armature.translation = Vec3(1, 2, 3);
  armature.rotation = Vec4(-0.70710678, 0, 0, 0.70710678);
  armature.scale = Vec3::Constant(0.25);
  Asset asset = motionAsset(motion);
  armature.children = asset.document.scenes[0].nodes;
  asset.document.scenes[0].nodes = {addElement(asset.document.nodes, std::move(armature))};
  return asset;
}

TEST(ClipIo, CarriesNodesAboveTheRootIntoItsTracks) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Asset asset = belowArmature(randomMotion(seed));
    const AssetSkeleton skeleton = readSkeleton(asset);
    Warnings warnings;
    const std::vector<Clip> clips = readClips(asset, skeleton, warnings);
    EXPECT_TRUE(warnings.empty());
    for (std::size_t c = 0; c < clips.size(); ++c) {
      EXPECT_LT(largestError(asset, skeleton, clips[c], asset.document.animations[c], 31), 1e-5) << seed;
    }
    // And back out of them on writing.
    Asset other = belowArmature(randomMotion(seed));
    other.document.animations.clear();
    addClips(other, skeleton, clips);
    for (std::size_t c = 0; c < clips.size(); ++c) {
      EXPECT_LT(largestError(other, skeleton, clips[c], other.document.animations[c], 31), 1e-5) << seed;
    }
    writeAsset(other, limber::testing::testOutputFolder() / fmt::format("clip_io_armature_{}.glb", seed));
  }
}

// With the bind pose of a skin, and as the nodes stand.
TEST(ClipIo, MirroredNodesMoveAsTheDocumentHasThem) {
  const auto mirrored = [](unsigned seed, bool moving) {
    Asset asset = belowArmature(randomMotion(seed));
    std::vector<gltf::Node>& nodes = asset.document.nodes;
    nodes[0].scale = Vec3(1, 1, -1);
    nodes[2].scale = Vec3(1, -2, 1);
    nodes[3].scale = Vec3(-1, -1, 1);
    nodes[5].matrix = nodeTransform(nodes[5]).matrix() * Vec4(1, -1, 1, 1).asDiagonal();
    nodes[5].translation.reset();
    nodes[5].rotation.reset();
    if (!moving) asset.document.animations.clear();
    return asset;
  };
  for (unsigned seed = 0; seed < 10; ++seed) {
    Asset asset = mirrored(seed, true), still = mirrored(seed, false);
    for (const bool hasSkin : {true, false}) {
      if (!hasSkin) asset.document.skins.clear();
      const AssetSkeleton skeleton = animatedSkeleton(asset);
      Warnings warnings;
      const std::vector<Clip> clips = readClips(asset, skeleton, warnings);
      if (hasSkin) addClips(still, skeleton, clips);
      for (std::size_t c = 0; c < clips.size(); ++c) {
        EXPECT_LT(largestError(asset, skeleton, clips[c], asset.document.animations[c], 31), 2e-5) << seed;
        EXPECT_LT(largestError(still, skeleton, clips[c], still.document.animations[c], 31), 2e-5) << seed;
      }
    }
  }
}

TEST(ClipIo, FollowsMovingNodesAboveTheRoot) {
  Motion motion = randomMotion(3);
  motion.clips.erase(motion.clips.begin() + 1, motion.clips.end());
  Asset asset = belowArmature(motion);
  gltf::Animation& animation = asset.document.animations[0];
  const std::vector<float> times = {0, 0.3f, 0.9f}, positions = {0, 0, 0, 1, 2, 3, 0, 1, 0};
  const Index input = addFloatAccessor(asset, times, 1, 0, true), output = addFloatAccessor(asset, positions, 3);
  const Index sampler = addElement(animation.samplers, {{}, input, output});
  const Index armature = asset.document.nodeCount() - 1;
  animation.channels.push_back({{}, sampler, {{}, armature, "translation"}});
  const AssetSkeleton skeleton = readSkeleton(asset);
  Warnings warnings;
  const Clip clip = readClips(asset, skeleton, warnings).at(0);
  ASSERT_EQ(warnings.items().size(), 1u);
  EXPECT_EQ(warnings.items()[0].kind, "moving-parents");
  EXPECT_LT(largestError(asset, skeleton, clip, animation, 60), 2e-2);  // slerps of two nodes, cut into sixtieths
}

TEST(ClipIo, LeavesTheRestOfTheDocumentAlone) {
  const Asset before = readAsset(limber::testing::everythingModel().glb(), "everything.glb");
  Asset asset = before.clone();
  const AssetSkeleton skeleton = readSkeleton(asset);
  Clip clip;
  clip.name = "turn";
  clip.rotations.push_back(
      {1, Interpolation::kLinear, {0, 1}, {Eigen::Quaternionf(1, 0, 0, 0), Eigen::Quaternionf(0, 1, 0, 0)}});
  EXPECT_EQ(addClips(asset, skeleton, {{clip, clip}}), (std::vector<std::string>{"turn_2", "turn_3"}));
  checkAsset(asset);
  const Json read = documentJson(before), json = documentJson(asset);
  for (const auto& [key, value] : read.items()) {
    if (key == "accessors" || key == "bufferViews" || key == "buffers" || key == "animations") {
      for (std::size_t i = 0; key != "buffers" && i < value.size(); ++i) EXPECT_EQ(json[key][i], value[i]);
    } else {
      EXPECT_EQ(json[key], value) << key;
    }
  }
  const Bytes &old = before.buffers[0].bytes, &now = asset.buffers[0].bytes;
  ASSERT_GE(now.size(), old.size());
  EXPECT_TRUE(std::equal(old.begin(), old.end(), now.begin()));
  ASSERT_EQ(asset.document.animations.size(), 3u);
  EXPECT_EQ(asset.document.animations[1].name, "turn_2");
  EXPECT_EQ(asset.document.animations[2].name, "turn_3");
}

TEST(ClipIo, CollapsesWhatStandsStillAndKeepsTheDuration) {
  Motion motion = randomMotion(2);
  motion.clips.clear();
  Clip clip;
  const Eigen::Quaternionf rest = motion.skeleton.joints[1].rest.rotation.cast<float>(), other(0, 1, 0, 0);
  clip.rotations.push_back({1, Interpolation::kLinear, {0, 1, 2}, {rest, rest, rest}});
  clip.rotations.push_back({2, Interpolation::kStep, {0, 1, 2}, {other, other, other}});
  motion.clips.push_back(clip);
  const Asset asset = motionAsset(motion);
  const AssetSkeleton skeleton = readSkeleton(asset);
  Warnings warnings;
  const Clip still = readClips(asset, skeleton, warnings).at(0);
  EXPECT_EQ(still.name, "clip");
  EXPECT_EQ(still.duration(), 2);
  std::size_t keys = 0;
  for (const auto& track : still.rotations) keys += track.times.size();
  EXPECT_EQ(keys, 3u);  // one track holds the duration, the other has one key

  motion.clips[0].translations.push_back({3, Interpolation::kLinear, {0, 2}, {Vec3f::Zero(), Vec3f::Ones()}});
  const Asset moving = motionAsset(motion);
  EXPECT_EQ(moving.document.animations[0].channels.size(), 2u);  // tracks that repeat the node's transform are left out

  motion.clips = {Clip()};
  const Asset empty = motionAsset(motion);
  checkAsset(empty);
  EXPECT_EQ(empty.document.animations[0].channels.size(), 1u);
  writeAsset(empty, limber::testing::testOutputFolder() / "clip_io_empty.glb");
}

TEST(ClipIo, StandsAsTheNodesStandWhereNoChannelIs) {
  Motion motion = randomMotion(5);
  Asset asset = motionAsset(motion);
  asset.document.nodes[4].translation = Vec3(9, 8, 7);  // off the bind pose
  asset.document.nodes[4].rotation = Vec4(0, 1, 0, 0);
  const AssetSkeleton skeleton = readSkeleton(asset);
  Warnings warnings;
  const std::vector<Clip> clips = readClips(asset, skeleton, warnings);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    EXPECT_LT(largestError(asset, skeleton, clips[c], asset.document.animations[c], 11), 1e-5);
  }
  // Written again, a joint without a track goes to its rest pose, not to its node's transform.
  asset.document.animations.clear();
  addClips(asset, skeleton, motion.clips);
  for (std::size_t c = 0; c < clips.size(); ++c) {
    EXPECT_LT(largestError(asset, skeleton, motion.clips[c], asset.document.animations[c], 11), 1e-5);
  }
}

TEST(ClipIo, LeavesInvalidKeysOut) {
  Motion motion = randomMotion(1);
  motion.clips.erase(motion.clips.begin() + 1, motion.clips.end());
  Asset asset = motionAsset(motion);
  const std::vector<float> times = {0, 1, 1, 0.5f, 2, NAN, 3};
  std::vector<float> turns;
  for (int k = 0; k < 7; ++k) turns.insert(turns.end(), {0, 0, k == 4 ? 0.0f : 2.0f, 0});
  const Index input = addFloatAccessor(asset, times, 1), output = addFloatAccessor(asset, turns, 4);
  gltf::Animation& animation = asset.document.animations[0];
  animation.samplers[0] = {{}, input, output};
  ASSERT_EQ(animation.channels[0].sampler, 0u);
  animation.channels.clear();
  animation.channels.push_back({{}, 0, {{}, 0, "rotation"}});
  Warnings warnings;
  const Clip clip = readClips(asset, readSkeleton(asset), warnings).at(0);
  ASSERT_EQ(clip.rotations.size(), 1u);
  EXPECT_EQ(clip.rotations[0].times, (std::vector<float>{0, 1, 3}));
  EXPECT_EQ(clip.rotations[0].values[0].z(), 1);
  ASSERT_EQ(warnings.items().size(), 1u);
  EXPECT_EQ(warnings.items()[0].count, 4u);
}

void expectLimitIn(const Asset& asset, const std::string& location) {
  Warnings warnings;
  try {
    readClips(asset, readSkeleton(asset), warnings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kLimit);
    EXPECT_THAT(error.what(), ::testing::HasSubstr(location));
  }
}

TEST(ClipIo, LongChainsAboveARootAreRefusedBeforeTheyAreSampled) {
  testing::GltfBuilder model = testing::everythingModel();
  const Index times = model.accessor<float>({0, 600}, 5126, "SCALAR", 2);  // 36 000 samples
  const Index slots = model.accessor<float>({0, 1, 0, 3, 1, 0}, 5126, "VEC3", 2);
  Index top = 0;
  for (int i = 0; i < 2000; ++i) top = model.push("nodes", {{"children", {top}}});
  model.json["scenes"][0]["nodes"] = {top, 2};
  Json& animation = model.json["animations"][0];
  animation["samplers"].push_back({{"input", times}, {"output", slots}});
  animation["channels"].push_back({{"sampler", 1}, {"target", {{"node", top}, {"path", "translation"}}}});
  expectLimitIn(readAsset(model.glb(), "chain.glb"), "animation 'turn'");
}

TEST(ClipIo, KeysThatTooManyChannelsShareAreRefusedBeforeTheyAreRead) {
  testing::GltfBuilder model = testing::everythingModel();
  std::vector<float> times, turns;
  for (int k = 0; k < 1000; ++k) {
    times.push_back(static_cast<float>(k));
    turns.insert(turns.end(), {0, 0, 0, 1});
  }
  Json& animation = model.json["animations"][0];
  animation["samplers"][0] = {{"input", model.accessor(times, 5126, "SCALAR", times.size())},
                              {"output", model.accessor(turns, 5126, "VEC4", times.size())}};
  Asset asset = readAsset(model.glb(), "shared.glb");
  std::vector<gltf::Animation>& animations = asset.document.animations;
  animations.resize(20, animations[0]);
  Warnings warnings;
  EXPECT_EQ(readClips(asset, readSkeleton(asset), warnings).size(), 20u);
  animations.resize(850, animations[0]);
  expectLimitIn(asset, "animation 'turn'");
}

TEST(ClipIo, RefusesWhatDoesNotFit) {
  Asset asset = motionAsset(randomMotion(1));
  AssetSkeleton skeleton = readSkeleton(asset);
  Clip clip;
  clip.name = "bad";
  clip.translations.push_back({99, Interpolation::kLinear, {0}, {Vec3f::Zero()}});
  EXPECT_THROW(addClips(asset, skeleton, {&clip, 1}), Error);
  skeleton.jointNode.back() = 1000;
  EXPECT_THROW(addClips(asset, skeleton, {}), Error);
}

TEST(ClipIo, ReadsEverySharedMotionAsTheDocumentHasIt) {
  const std::optional<fs::path> data = limber::testing::sharedDataFolder();
  if (!data) GTEST_SKIP() << limber::testing::kNoSharedData;
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(*data / "motions")) {
    if (entry.path().extension() != ".glb") continue;
    SCOPED_TRACE(entry.path().filename().string());
    const Asset asset = readAsset(entry.path());
    const AssetSkeleton skeleton = animatedSkeleton(asset);
    Warnings warnings;
    const std::vector<Clip> clips = readClips(asset, skeleton, warnings);
    EXPECT_FALSE(clips.empty());
    for (std::size_t c = 0; c < clips.size(); c += 5) {
      EXPECT_LT(largestError(asset, skeleton, clips[c], asset.document.animations[c], 3), 1e-4) << clips[c].name;
    }
    ++count;
  }
  EXPECT_GE(count, 10u);
}

}  // namespace
}  // namespace limber
