#include "limber/crowd/crowd.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "limber/core/counted.h"
#include "limber/core/parallel.h"
#include "limber/core/random.h"
#include "limber/crowd/body_motion.h"
#include "limber/crowd/crowd_note.h"
#include "limber/crowd/mixed_turns.h"
#include "limber/crowd/shared_accessors.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/gltf/accessor_layout.h"
#include "limber/document/gltf/accessor_sweep.h"
#include "limber/document/gltf/compact_buffers.h"
#include "limber/document/merge_assets.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"

namespace limber {

namespace {

constexpr double kMaxNodes = 1e7;         // 3 GB of text
constexpr double kRoomRound = 1.25;       // times the widest body: arms do not meet
constexpr double kPositionJitter = 0.15;  // of the spacing, to either side: no ranks and files
constexpr std::size_t kMaxNamed = 10;     // of what is left out

void checkOptions(std::span<const Asset> characters, std::span<const Motion> motions, const CrowdOptions& options) {
  const bool isRight = options.bodies > 0 && options.offsets > 0 && options.variety >= 0 && options.variety <= 1 &&
                       options.framesPerSecond > 0 && std::isfinite(options.framesPerSecond) &&
                       std::isfinite(options.heading) && (!options.spacing || std::isfinite(*options.spacing));
  if (!isRight) throw Error(ErrorCode::kBadArgument, "an option of the crowd is out of its range");
  if (characters.empty()) throw Error(ErrorCode::kBadArgument, "no character is given");
  if (motions.empty()) throw Error(ErrorCode::kBadArgument, "no motion is given");
}

// The data common to all bodies and builds: materials with their textures.
Asset withoutScene(const Asset& character) {
  Asset asset = character.clone();
  asset.warnings = {};
  const AccessorSweep accessors(asset);
  const BufferViewSweep views(asset);
  gltf::Document& document = asset.document;
  document.nodes.clear();
  document.scenes.clear();
  document.scene.reset();
  document.meshes.clear();
  document.skins.clear();
  document.animations.clear();
  document.cameras.clear();
  accessors.sweep(asset);
  views.sweep(asset);
  return asset;
}

// #characters: has it a build?
std::vector<bool> usedCharacters(std::size_t characters, std::span<const BodyMotion> builds) {
  std::vector<bool> isUsed(characters, false);
  for (const BodyMotion& build : builds) isUsed[build.character] = true;
  return isUsed;
}

Asset sharedOf(std::span<const Asset> characters, const std::vector<bool>& isUsed) {
  std::vector<AssetPart> parts;
  for (std::size_t c = 0; c < characters.size(); ++c) {
    if (isUsed[c]) parts.push_back({withoutScene(characters[c]), "body", Affine::Identity(), std::nullopt});
  }
  Asset asset = mergeAssets(std::move(parts));
  asset.document.nodes.clear();
  asset.document.scenes.assign(1, {});
  asset.document.scene = 0;
  asset.document.animations.clear();
  return asset;
}

// #nodes: skinned meshes that are no joints and have no children. They go to the root of a scene, where glTF wants
// them.
std::vector<bool> placedByJoints(const gltf::Document& document) {
  std::vector<bool> placed;
  for (const gltf::Node& node : document.nodes) placed.push_back(node.skin && node.children.empty());
  for (const gltf::Skin& skin : document.skins) {
    for (const Index joint : skin.joints) placed[joint] = false;
  }
  return placed;
}

// A square of rows, the first in front, the middle at the origin.
Vec3 gridPosition(Index body, Index bodies, double spacing, double jitterX, double jitterZ) {
  const Index columns = static_cast<Index>(std::ceil(std::sqrt(static_cast<double>(bodies))));
  const Index rows = (bodies + columns - 1) / columns;
  const double x = body % columns - 0.5 * (columns - 1), z = 0.5 * (rows - 1) - body / columns;
  return spacing * Vec3(x + kPositionJitter * jitterX, 0, z + kPositionJitter * jitterZ);
}

Quat headingTurn(const CrowdBody& body) {
  const double half = body.heading * std::numbers::pi / 360;
  return Quat(std::cos(half), 0, std::sin(half), 0);
}

// Builds the document, body after body.
class CrowdWriter {
 public:
  CrowdWriter(Asset& asset, std::span<const Asset> characters, const std::vector<bool>& isUsed,
              std::span<const BodyMotion> builds, Index frames, double framesPerSecond)
      : asset_(asset), shared_(asset), builds_(builds), frames_(frames) {
    Index materials = 0;
    for (std::size_t c = 0; c < characters.size(); ++c) {
      firstMaterial_.push_back(materials);
      if (isUsed[c]) materials += static_cast<Index>(characters[c].document.materials.size());
    }
    for (const BodyMotion& build : builds) {
      graphs_.push_back(readSceneGraph(build.moving.document));
      placedByJoints_.push_back(placedByJoints(build.moving.document));
    }
    std::vector<float> times;
    for (Index f = 0; f <= frames; ++f) times.push_back(static_cast<float>(f / framesPerSecond));
    times_ = addFloatAccessor(asset, times, 1, 0, true);
    asset.document.animations.emplace_back().name = "crowd";
  }

  void add(const CrowdBody& body, Index number, Index offsetFrames, const std::string& clip) {
    const std::vector<Index> nodes = addNodes(body, number, clip, offsetFrames);
    addChannels(body, offsetFrames, nodes);
  }

  // Of what could not be taken over.
  std::size_t lostExtensions() const { return lostExtensions_; }

 private:
  // Number of the new node, of each node of the build; kNoIndex of those that the scene does not show.
  std::vector<Index> addNodes(const CrowdBody& body, Index number, const std::string& clip, Index offsetFrames) {
    gltf::Document& document = asset_.document;
    const Asset& from = builds_[body.build].moving;
    const SceneGraph& graph = graphs_[body.build];
    const Index root = addElement(document.nodes, rootNode(body, number, clip, offsetFrames));
    document.scenes[0].nodes.push_back(root);
    std::vector<Index> newNode(from.document.nodes.size(), kNoIndex);
    for (std::size_t i = 0; i < graph.order.size(); ++i) newNode[graph.order[i]] = root + 1 + static_cast<Index>(i);
    std::map<Index, Index> skins;
    const std::vector<bool>& isPlaced = placedByJoints_[body.build];
    for (const Index old : graph.order) {
      gltf::Node node = from.document.nodes[old];
      std::erase_if(node.children, [&](Index child) { return isPlaced[child]; });
      for (Index& child : node.children) child = newNode[child];
      node.camera.reset();
      dropExtensions(node);
      if (node.mesh) node.mesh = meshOf(body.build, *node.mesh);
      if (node.skin) {
        const auto [skin, isNew] = skins.try_emplace(*node.skin, kNoIndex);
        if (isNew) skin->second = addSkin(from, *node.skin, newNode);
        node.skin = skin->second;
      }
      if (isPlaced[old]) {
        node.clearTransform();
        document.scenes[0].nodes.push_back(newNode[old]);
      } else if (!graph.parent[old]) {
        document.nodes[root].children.push_back(newNode[old]);
      }
      document.nodes.push_back(std::move(node));
    }
    return newNode;
  }

  gltf::Node rootNode(const CrowdBody& body, Index number, const std::string& clip, Index offsetFrames) const {
    gltf::Node root;
    root.name = fmt::format("body_{}", number + 1);
    setNodeTransform(root, Eigen::Translation3d(body.position) * headingTurn(body), false);
    Json extras = {{"build", body.build + 1}, {"clip", clip}, {"offset", body.offset}, {"offset_frames", offsetFrames}};
    root.extras.change()[kCrowdNote] = std::move(extras);
    return root;
  }

  void dropExtensions(gltf::Object& object) {
    if (!object.extensions.exists()) return;
    object.extensions.reset();
    ++lostExtensions_;
  }

  Index addSkin(const Asset& from, Index number, const std::vector<Index>& newNode) {
    gltf::Skin skin = from.document.skins[number];
    dropExtensions(skin);
    skin.skeleton.reset();
    for (Index& joint : skin.joints) {
      joint = newNode[joint];
      if (joint == kNoIndex) throw Error(ErrorCode::kUnsupported, "a joint stands in no scene", from.name);
    }
    if (skin.inverseBindMatrices) skin.inverseBindMatrices = shared_.add(from, *skin.inverseBindMatrices, 0);
    return addElement(asset_.document.skins, std::move(skin));
  }

  Index meshOf(Index build, Index number) {
    const auto [known, isNew] = meshes_.try_emplace({build, number}, kNoIndex);
    if (!isNew) return known->second;
    const Asset& from = builds_[build].moving;
    gltf::Mesh mesh = from.document.meshes[number];
    dropExtensions(mesh);
    for (gltf::Primitive& primitive : mesh.primitives) {
      dropExtensions(primitive);
      for (auto& [name, accessor] : primitive.attributes) accessor = shared_.add(from, accessor, kVertexTarget);
      for (gltf::Attributes& target : primitive.targets) {
        for (auto& [name, accessor] : target) accessor = shared_.add(from, accessor, kVertexTarget);
      }
      if (primitive.indices) primitive.indices = shared_.add(from, *primitive.indices, kIndexTarget);
      if (primitive.material) *primitive.material += firstMaterial_[builds_[build].character];
    }
    return known->second = addElement(asset_.document.meshes, std::move(mesh));
  }

  void addChannels(const CrowdBody& body, Index offsetFrames, const std::vector<Index>& newNode) {
    const Asset& from = builds_[body.build].moving;
    gltf::Animation& crowd = asset_.document.animations[0];
    const gltf::Animation& animation = from.document.animations[body.clip];
    for (std::size_t c = 0; c < animation.channels.size(); ++c) {
      const gltf::AnimationChannel& channel = animation.channels[c];
      const Index node = newNode[*channel.target.node];
      if (node == kNoIndex) continue;
      const Index sampler = samplerOf({body.build, body.clip, offsetFrames, channel.sampler});
      crowd.channels.push_back({{}, sampler, {{}, node, channel.target.path}});
    }
  }

  using SamplerKey = std::tuple<Index, Index, Index, Index>;  // build, clip, frames of the offset, sampler of the clip

  Index samplerOf(const SamplerKey& key) {
    const auto [known, isNew] = samplers_.try_emplace(key, kNoIndex);
    if (!isNew) return known->second;
    const auto [build, clip, offset, number] = key;
    const Asset& from = builds_[build].moving;
    gltf::AnimationSampler sampler = from.document.animations[clip].samplers[number];
    if (from.document.accessors[sampler.input].count == 1) {
      sampler.input = shared_.add(from, sampler.input, 0);
      sampler.output = shared_.add(from, sampler.output, 0);
    } else {
      sampler.output = windowOf(from, sampler.output, offset);
      sampler.input = times_;
    }
    return known->second = addElement(asset_.document.animations[0].samplers, std::move(sampler));
  }

  // Of the keys of one build and clip those from a frame on: another accessor of the same bytes.
  Index windowOf(const Asset& from, Index output, Index firstFrame) {
    const Index whole = shared_.add(from, output, 0);
    gltf::Accessor window = asset_.document.accessors[whole];
    const auto [known, isNew] = windows_.try_emplace({*window.bufferView, firstFrame}, kNoIndex);
    if (!isNew) return known->second;
    window.byteOffset = firstFrame * accessorShape(asset_, whole).elementSize;
    window.count = frames_ + 1;
    return known->second = addElement(asset_.document.accessors, std::move(window));
  }

  Asset& asset_;
  SharedAccessors shared_;
  std::span<const BodyMotion> builds_;
  Index frames_ = 0, times_ = 0;
  std::vector<Index> firstMaterial_;               // of each character
  std::vector<SceneGraph> graphs_;                 // of each build
  std::vector<std::vector<bool>> placedByJoints_;  // likewise, of each node
  std::map<std::pair<Index, Index>, Index> meshes_, windows_;
  std::map<SamplerKey, Index> samplers_;
  std::size_t lostExtensions_ = 0;
};

// No more than there are bodies.
std::vector<BodyMotion> makeBuilds(std::span<const Asset> characters, std::span<const Motion> motions,
                                   const CrowdOptions& options) {
  const std::size_t count =
      options.variety > 0 ? std::max<std::size_t>(options.builds, characters.size()) : characters.size();
  std::vector<BodyMotion> builds(std::min<std::size_t>(count, options.bodies));
  SkeletonMatches matches;
  Random random(options.seed);
  MixedTurns turns(static_cast<Index>(characters.size()), random.bits());
  std::vector<std::uint64_t> seeds;
  for (std::size_t b = 0; b < builds.size(); ++b) seeds.push_back(random.bits());
  std::vector<Index> from;
  for (std::size_t b = 0; b < builds.size(); ++b) from.push_back(turns.next());
  parallelFor(builds.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const BodyBuild build = randomBuild(seeds[b], options.variety);
      builds[b] = moveBuild(characters[from[b]], build, motions, options, matches);
      builds[b].character = from[b];
    }
  });
  return builds;
}

// The clips in an order by chance, no more than there are bodies. Gives the names of the others.
std::vector<std::string> mixClips(std::vector<BodyMotion>& builds, const CrowdOptions& options) {
  const Index count = static_cast<Index>(builds.front().clips.size()), kept = std::min(count, options.bodies);
  MixedTurns turns(count, options.seed ^ 0x2545f4914f6cdd1dULL);
  std::vector<Index> order;
  for (Index c = 0; c < count; ++c) order.push_back(turns.next());
  std::vector<std::string> others;
  for (Index c = kept; c < count; ++c) others.push_back(builds.front().clips[order[c]].clip.name);
  for (BodyMotion& build : builds) {
    std::vector<BodyClip> clips;
    for (Index c = 0; c < kept; ++c) clips.push_back(std::move(build.clips[order[c]]));
    build.clips = std::move(clips);
  }
  return others;
}

// The bodies with their builds and clips: the first have them as they are numbered, for these orders are mixed already.
std::vector<CrowdBody> castBodies(const std::vector<BodyMotion>& builds, const CrowdOptions& options) {
  const Index clips = static_cast<Index>(builds.front().clips.size());
  Random seeds(options.seed ^ 0x9fb21c651e98df25ULL);
  MixedTurns buildTurns(static_cast<Index>(builds.size()), seeds.bits());
  MixedTurns clipTurns(clips, seeds.bits());
  std::vector<CrowdBody> bodies(options.bodies);
  for (Index i = 0; i < options.bodies; ++i) {
    bodies[i].build = i < builds.size() ? i : buildTurns.next();
    bodies[i].clip = i < clips ? i : clipTurns.next();
  }
  return bodies;
}

Index longestCycle(const std::vector<BodyMotion>& builds, const std::vector<CrowdBody>& bodies) {
  Index longest = 0;
  for (const CrowdBody& body : bodies) longest = std::max(longest, builds[body.build].clips[body.clip].cycle);
  return longest;
}

void warnOfLeftOut(Warnings& warnings, std::string_view noun, std::vector<std::string> names) {
  if (names.empty()) return;
  const std::size_t count = names.size();
  names.resize(std::min(count, kMaxNamed));
  warnings.add(fmt::format("{}s-left-out", noun),
               fmt::format("there are fewer bodies than {}s, so {} {} no body: {}{}", noun, counted(count, noun),
                           count == 1 ? "has" : "have", fmt::join(names, ", "), count > names.size() ? ", ..." : ""));
}

std::vector<std::string> namesOfUnused(std::span<const Asset> characters, const std::vector<bool>& isUsed) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < characters.size(); ++c) {
    if (!isUsed[c]) names.push_back(characters[c].name);
  }
  return names;
}

}  // namespace

Crowd makeCrowd(std::span<const Asset> characters, std::span<const Motion> motions, const CrowdOptions& options,
                Progress& progress) {
  checkOptions(characters, motions, options);
  progress.stage("retarget");
  std::vector<BodyMotion> builds = makeBuilds(characters, motions, options);
  const std::vector<std::string> otherClips = mixClips(builds, options);
  const std::vector<bool> isUsed = usedCharacters(characters.size(), builds);
  Crowd crowd;
  crowd.bodies = castBodies(builds, options);
  const Index frames = longestCycle(builds, crowd.bodies);
  double nodes = 0, width = 0;
  for (BodyMotion& build : builds) {
    nodes = std::max(nodes, static_cast<double>(build.moving.document.nodes.size()));
    width = std::max(width, build.width);
    lengthenClips(build, frames, options.framesPerSecond);
  }
  if (nodes * options.bodies > kMaxNodes) throw Error(ErrorCode::kLimit, "the crowd has too many bodies");
  progress.stage("crowd");
  crowd.asset = sharedOf(characters, isUsed);
  crowd.asset.name = "crowd";
  crowd.seconds = frames / options.framesPerSecond;
  for (const BodyClip& one : builds.front().clips) crowd.clips.push_back(one.clip.name);
  CrowdWriter writer(crowd.asset, characters, isUsed, builds, frames, options.framesPerSecond);
  const double spacing = options.spacing.value_or(kRoomRound * width);
  for (Index i = 0; i < options.bodies; ++i) {
    progress.update(static_cast<double>(i) / options.bodies);
    Random random(options.seed ^ (0x5851f42d4c957f2dULL * (i + 1)));  // each body's own, whatever others there are
    CrowdBody& body = crowd.bodies[i];
    const BodyClip& clip = builds[body.build].clips[body.clip];
    const Index step = static_cast<Index>(random.below(options.offsets));
    const Index offsetFrames = static_cast<Index>(std::uint64_t{step} * clip.cycle / options.offsets);
    body.offset = offsetFrames / options.framesPerSecond;
    const double jitterX = random.uniform(-1, 1), jitterZ = random.uniform(-1, 1);
    body.heading = options.heading * random.uniform(-1, 1);
    body.position = gridPosition(i, options.bodies, spacing, jitterX, jitterZ) - headingTurn(body) * clip.start;
    writer.add(body, i, offsetFrames, crowd.clips[body.clip]);
  }
  for (BodyMotion& build : builds) {
    crowd.asset.warnings.append(build.moving.warnings);
    crowd.builds.push_back(std::move(build.still));
  }
  warnOfLeftOut(crowd.asset.warnings, "character", namesOfUnused(characters, isUsed));
  warnOfLeftOut(crowd.asset.warnings, "clip", otherClips);
  crowd.asset.warnings.add("body-extensions", "what extensions say of nodes and meshes is left out of a crowd", {},
                           writer.lostExtensions());
  checkAsset(crowd.asset);
  return crowd;
}

}  // namespace limber
