#include "limber/actions/motion/vertex_animation.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tuple>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/deform/linear_blend.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/clip/clip_name.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/rig/pose_io.h"
#include "limber/document/scene/node_edit.h"

namespace limber {

namespace {

// The weights of a node's morph targets over time, three to a track.
struct MorphTrack {
  Index node = 0;
  std::vector<Track<Vec3f>> tracks;
};

struct SampledClip {
  Clip clip;
  std::vector<MorphTrack> morphs;

  double seconds() const {
    double last = clip.duration();
    for (const MorphTrack& morph : morphs) last = std::max(last, double{morph.tracks.front().times.back()});
    return last;
  }
};

// Where a primitive's vertices go with each of its targets.
struct MorphTargets {
  Index node = 0, firstVertex = 0;
  std::vector<float> still;                 // #targets, weights where no animation says otherwise
  std::vector<std::vector<Vec3f>> offsets;  // #targets x #vertices, in world space; empty where a target moves nothing
};

std::vector<Vec3f> offsetsOf(const Asset& asset, const gltf::Attributes& target, const PrimitiveInstance& instance) {
  std::vector<Vec3f> offsets;
  const std::optional<Index> accessor = target.find("POSITION");
  if (!accessor) return offsets;
  const std::vector<float> stored = readFloats(asset, *accessor);
  for (std::size_t i = 0; i + 2 < stored.size(); i += 3) {
    const Vec3 offset(stored[i], stored[i + 1], stored[i + 2]);
    offsets.push_back((instance.toWorld.linear() * offset).cast<float>());
  }
  return offsets;
}

std::vector<MorphTargets> morphTargetsOf(const Asset& asset, const Geometry& geometry) {
  std::vector<MorphTargets> result;
  for (const PrimitiveInstance& instance : geometry.instances) {
    const gltf::Mesh& mesh = asset.document.meshes[instance.mesh];
    const std::vector<gltf::Attributes>& targets = mesh.primitives[instance.primitive].targets;
    if (targets.empty()) continue;
    MorphTargets morph;
    morph.node = instance.node;
    morph.firstVertex = instance.firstVertex;
    const std::vector<double>& ownWeights = asset.document.nodes[instance.node].weights;
    const std::vector<double>& weights = ownWeights.empty() ? mesh.weights : ownWeights;
    morph.still.assign(weights.begin(), weights.end());
    morph.still.resize(targets.size(), 0.0f);
    for (const gltf::Attributes& target : targets) morph.offsets.push_back(offsetsOf(asset, target, instance));
    result.push_back(std::move(morph));
  }
  return result;
}

// Keys that are not finite or not later than the one before are left out, as readClips does.
std::optional<MorphTrack> morphTrackOf(const Asset& asset, const gltf::AnimationSampler& sampler, Index node,
                                       std::size_t targets) {
  const std::vector<float> times = readFloats(asset, sampler.input);
  const std::vector<float> values = readFloats(asset, sampler.output);
  const bool isCubic = sampler.interpolation == Interpolation::kCubic;
  const std::size_t parts = isCubic ? 3 : 1;
  if (targets == 0 || values.size() < times.size() * targets * parts) return std::nullopt;
  MorphTrack morph;
  morph.node = node;
  morph.tracks.resize((targets + 2) / 3);
  for (Track<Vec3f>& track : morph.tracks) track.interpolation = sampler.interpolation;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::vector<float>& earlier = morph.tracks.front().times;
    const float* key = &values[k * targets * parts];
    const bool isFinite = std::all_of(key, key + targets * parts, [](float x) { return std::isfinite(x); });
    if (!std::isfinite(times[k]) || !isFinite || (!earlier.empty() && !(times[k] > earlier.back()))) continue;
    for (std::size_t t = 0; t < morph.tracks.size(); ++t) {
      morph.tracks[t].times.push_back(times[k]);
      for (std::size_t part = 0; part < parts; ++part) {
        Vec3f value = Vec3f::Zero();
        for (std::size_t i = 3 * t; i < std::min(3 * t + 3, targets); ++i) {
          value[static_cast<int>(i - 3 * t)] = key[part * targets + i];
        }
        morph.tracks[t].values.push_back(value);
      }
    }
  }
  if (morph.tracks.front().times.empty()) return std::nullopt;
  return morph;
}

std::vector<MorphTrack> morphTracksOf(const Asset& asset, const gltf::Animation& animation,
                                      const std::vector<MorphTargets>& targets) {
  std::vector<MorphTrack> tracks;
  for (const gltf::AnimationChannel& channel : animation.channels) {
    const ChannelTarget target = channelTarget(channel);
    if (!target.node || target.path != "weights") continue;
    const auto morph =
        std::find_if(targets.begin(), targets.end(), [&](const MorphTargets& m) { return m.node == *target.node; });
    if (morph == targets.end()) continue;
    std::optional<MorphTrack> track =
        morphTrackOf(asset, animation.samplers[channel.sampler], *target.node, morph->still.size());
    if (track) tracks.push_back(std::move(*track));
  }
  return tracks;
}

bool movesNodes(const Asset& asset) {
  for (const gltf::Animation& animation : asset.document.animations) {
    for (const gltf::AnimationChannel& channel : animation.channels) {
      const ChannelTarget target = channelTarget(channel);
      if (target.node && target.path != "weights") return true;
    }
  }
  return false;
}

// Puts the vertices of a document where they are at a moment.
class VertexPoser {
 public:
  explicit VertexPoser(const Character& character)
      : character_(character), morphs_(morphTargetsOf(character.document(), geometry())) {
    const Asset& asset = character.document();
    if (asset.document.skins.empty() && !movesNodes(asset)) return;
    skeleton_ = character.moving();
    weights_ = readWeights(asset, geometry(), skeleton_);
    normalizeWeights(weights_);
    checkWeights(weights_, skeleton_.skeleton.jointCount());
    nodePose_ = readNodePose(asset, skeleton_);
    scratch_.resize(linearBlendScratch(geometry().positions.size(), skeleton_.skeleton.jointCount()));
  }

  const Geometry& geometry() const { return character_.surface(); }

  std::vector<SampledClip> clips() const {
    const Asset& asset = character_.document();
    std::vector<SampledClip> result;
    Warnings ignored;  // of reading, which the caller hears of when the rig is read
    std::vector<Clip> moved = skeleton_.jointNode.empty() ? std::vector<Clip>() : readClips(asset, skeleton_, ignored);
    const std::vector<gltf::Animation>& animations = asset.document.animations;
    for (std::size_t a = 0; a < animations.size(); ++a) {
      SampledClip clip;
      if (a < moved.size()) clip.clip = std::move(moved[a]);
      clip.clip.name = animations[a].name;
      clip.morphs = morphTracksOf(asset, animations[a], morphs_);
      result.push_back(std::move(clip));
    }
    return result;
  }

  const std::vector<Vec3f>& positionsAt(const SampledClip& clip, double seconds) {
    positions_ = geometry().positions;
    for (const MorphTargets& morph : morphs_) addMorphs(morph, clip, seconds);
    if (skeleton_.jointNode.empty()) return positions_;
    Pose pose = nodePose_;
    sampleClip(clip.clip, seconds, pose);
    const std::vector<Affine> transforms = skinTransforms(skeleton_.skeleton, pose);
    linearBlend({positions_, {}, weights_, transforms, {}}, {positions_, {}}, scratch_);
    return positions_;
  }

 private:
  void addMorphs(const MorphTargets& morph, const SampledClip& clip, double seconds) {
    std::vector<float> amounts = morph.still;
    for (const MorphTrack& track : clip.morphs) {
      if (track.node != morph.node) continue;
      for (std::size_t t = 0; t < amounts.size(); ++t) {
        amounts[t] = static_cast<float>(sampleTrack(track.tracks[t / 3], seconds)[static_cast<int>(t % 3)]);
      }
    }
    for (std::size_t t = 0; t < amounts.size(); ++t) {
      if (amounts[t] == 0) continue;
      for (std::size_t v = 0; v < morph.offsets[t].size(); ++v) {
        positions_[morph.firstVertex + v] += amounts[t] * morph.offsets[t][v];
      }
    }
  }

  Character character_;
  std::vector<MorphTargets> morphs_;
  AssetSkeleton skeleton_;  // none where nothing but blend shapes moves
  SkinWeights weights_;
  Pose nodePose_;
  std::vector<Vec3f> positions_;
  std::vector<float> scratch_;
};

std::vector<SampledClip> chosenClips(std::vector<SampledClip> clips, const std::string& name, const Asset& asset) {
  if (clips.empty()) {
    throw KnownError(ErrorKind::kNoAnimation,
                     {ErrorCode::kBadData, "has no animation", asset.name,
                      "give a file with clips or animated morph targets, or one OBJ file for each frame"});
  }
  if (name.empty()) return clips;
  std::vector<std::string> names;
  for (const SampledClip& clip : clips) names.push_back(clip.clip.name);
  std::vector<SampledClip> chosen;
  chosen.push_back(std::move(clips[clipNamed(names, name, asset.name)]));
  return chosen;
}

// Keys a second of what a clip's tracks, morphs among them, tell.
double rateOf(const SampledClip& clip) {
  Clip all = clip.clip;
  for (const MorphTrack& morph : clip.morphs) all.translations.push_back(morph.tracks.front());
  return frameRateOf(all);
}

struct Moment {
  const SampledClip* clip = nullptr;
  double seconds = 0;
};

void mix(std::uint64_t& hash, const Vec3f& value) {
  for (int i = 0; i < 3; ++i) {
    std::uint32_t bits = 0;
    const float number = value[i] + 0.0f;  // -0 is 0
    std::memcpy(&bits, &number, sizeof bits);
    hash = (hash ^ bits) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  }
}

// Vertices that begin at one position and move alike are one point. Sequences are distinguished by 64 bits of hash, and
// only among vertices at one position.
std::vector<Index> pointsOf(VertexPoser& poser, const std::vector<Moment>& moments, Progress& progress) {
  const std::vector<Vec3f>& rest = poser.geometry().positions;
  std::vector<std::uint64_t> hashes(rest.size(), 0);
  for (std::size_t m = 0; m < moments.size(); ++m) {
    progress.update(0.5 * static_cast<double>(m) / static_cast<double>(moments.size()));
    const std::vector<Vec3f>& positions = poser.positionsAt(*moments[m].clip, moments[m].seconds);
    for (std::size_t v = 0; v < positions.size(); ++v) mix(hashes[v], positions[v]);
  }
  std::vector<Index> order(rest.size());
  for (Index v = 0; v < order.size(); ++v) order[v] = v;
  const auto key = [&](Index v) { return std::tuple(hashes[v], rest[v].x(), rest[v].y(), rest[v].z()); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  std::vector<Index> first(rest.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool isSame = i > 0 && key(order[i]) == key(order[i - 1]);
    first[order[i]] = isSame ? first[order[i - 1]] : order[i];
  }
  std::vector<Index> pointOf(rest.size());
  Index points = 0;
  for (Index v = 0; v < rest.size(); ++v) pointOf[v] = first[v] == v ? points++ : pointOf[first[v]];
  return pointOf;
}

void fill(VertexPoser& poser, const std::vector<Moment>& moments, VertexAnimation& animation, Progress& progress) {
  const std::vector<Vec3f>& rest = poser.geometry().positions;
  const Index points = *std::max_element(animation.pointOf.begin(), animation.pointOf.end()) + 1;
  animation.sequence = VertexSequence::forFrames(points, moments.size());
  for (std::size_t v = 0; v < rest.size(); ++v) animation.sequence.rest[animation.pointOf[v]] = rest[v];
  for (Index f = 0; f < moments.size(); ++f) {
    progress.update(0.5 + 0.5 * f / static_cast<double>(moments.size()));
    const std::vector<Vec3f>& positions = poser.positionsAt(*moments[f].clip, moments[f].seconds);
    for (std::size_t v = 0; v < positions.size(); ++v) animation.sequence.set(animation.pointOf[v], f, positions[v]);
  }
}

// Before anything is posed, as if no two vertices moved alike.
void checkFrames(const VertexPoser& poser, double frames, const Asset& asset) {
  try {
    VertexSequence::checkSize(static_cast<double>(poser.geometry().positions.size()), frames);
  } catch (const Error& error) {
    throwWithin(error, asset.name);
  }
}

}  // namespace

void refuseStill(const VertexSequence& sequence, const std::string& name) {
  for (Index f = 1; f < sequence.frameCount(); ++f) {
    for (Index v = 0; v < sequence.pointCount(); ++v) {
      if (sequence.at(v, f) != sequence.at(v, 0)) return;
    }
  }
  throw KnownError(
      ErrorKind::kNoAnimation,
      {ErrorCode::kBadData,
       sequence.frameCount() == 1 ? "has a single frame" : "all frames are the same: nothing moves", name,
       "bones are found by motion: give frames in which the mesh bends, or rig it without --from-animation"});
}

VertexAnimation readVertexAnimation(const Character& character, const VertexAnimationOptions& options,
                                    Progress& progress) {
  const Asset& asset = character.document();
  VertexPoser poser(character);
  const std::vector<SampledClip> clips = chosenClips(poser.clips(), options.clip, asset);
  VertexAnimation animation;
  std::vector<Moment> moments;
  for (const SampledClip& clip : clips) {
    const double rate = options.framesPerSecond.value_or(rateOf(clip));
    if (!(rate > 0) || !std::isfinite(rate)) throw Error(ErrorCode::kBadArgument, "the frame rate is not above 0");
    const double frames = std::floor(clip.seconds() * rate + 0.5) + 1;
    const auto first = static_cast<Index>(moments.size());
    checkFrames(poser, first + frames, asset);
    for (Index f = 0; f < frames; ++f) moments.push_back({&clip, f / rate});
    animation.clips.push_back({clip.clip.name, first, static_cast<Index>(frames), rate});
  }
  animation.pointOf = pointsOf(poser, moments, progress);
  fill(poser, moments, animation, progress);
  refuseStill(animation.sequence, asset.name);
  return animation;
}

}  // namespace limber
