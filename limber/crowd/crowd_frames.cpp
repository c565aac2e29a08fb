#include "limber/crowd/crowd_frames.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/character/character.h"
#include "limber/core/error.h"
#include "limber/crowd/crowd_note.h"
#include "limber/document/clip/clip_io.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/skeleton/pose.h"

namespace limber {

namespace {

using Rows = Eigen::Map<Eigen::Matrix<float, 3, 4, Eigen::RowMajor>>;
constexpr std::size_t kNumbers = 12, kMaxNumbers = std::size_t{1} << 30;

[[noreturn]] void failAt(const Asset& asset, Index node, const std::string& problem) {
  throw Error(ErrorCode::kBadData, problem, fmt::format("{}: nodes[{}]", asset.name, node));
}

// The document's one animation, by its densest keys.
void readTimes(const Asset& asset, CrowdAnimation& animation) {
  for (const gltf::Animation& one : asset.document.animations) {
    for (const gltf::AnimationSampler& sampler : one.samplers) {
      const gltf::Accessor& times = asset.document.accessors[sampler.input];
      if (times.count <= animation.frames + std::size_t{1} || times.max.empty()) continue;
      animation.frames = static_cast<Index>(times.count - 1);
      animation.seconds = times.max.front();
    }
  }
}

// Writes frames of one member into its table, those that are not there yet.
class TableFiller {
 public:
  TableFiller(const Asset& asset, CrowdFrames& table, const CrowdAnimation& animation)
      : asset_(asset), table_(table), animation_(animation) {}

  void add(const CrowdMember& member) {
    const Character alone(crowdMemberAlone(asset_, member));
    const Skeleton& skeleton = alone.binding().skeleton;
    Warnings ignored;
    const std::vector<Clip> clips = readClips(alone.document(), alone.binding(), ignored);
    if (clips.empty()) failAt(asset_, member.node, "the body does not move");
    if (table_.joints == 0) makeRoom(skeleton.jointCount());
    if (table_.joints != skeleton.jointCount()) failAt(asset_, member.node, "the body has other joints than its build");
    const std::vector<Affine> inverseBind = inverseBindOf(skeleton);
    std::vector<Affine> skin(inverseBind.size());
    Pose pose = restPose(skeleton);
    for (Index row = std::max(filled_, member.offset - table_.first); row < rowsWith(member); ++row) {
      const double frame = static_cast<double>(row) + table_.first - member.offset;
      sampleClip(clips.front(), frame * animation_.seconds / animation_.frames, pose);
      skinTransforms(poseGlobals(skeleton, pose), inverseBind, skin);
      float* to = table_.matrices.data() + kNumbers * row * table_.joints;
      for (const Affine& one : skin) {
        Rows rows(to);
        rows = one.matrix().topRows<3>().cast<float>();
        to += kNumbers;
      }
    }
    filled_ = rowsWith(member);
  }

  Index filled() const { return filled_; }
  Index rowsWith(const CrowdMember& member) const { return member.offset - table_.first + animation_.frames + 1; }

 private:
  void makeRoom(Index joints) {
    table_.joints = joints;
    const std::size_t numbers = kNumbers * table_.frames * joints;
    if (numbers > kMaxNumbers) throw Error(ErrorCode::kLimit, "the crowd moves for too long", asset_.name);
    table_.matrices.assign(numbers, 0.0f);
  }

  const Asset& asset_;
  CrowdFrames& table_;
  const CrowdAnimation& animation_;
  Index filled_ = 0;
};

}  // namespace

std::vector<CrowdMember> crowdMembers(const Asset& asset) {
  const gltf::Document& document = asset.document;
  std::vector<CrowdMember> members;
  std::optional<SceneGraph> graph;
  for (Index node = 0; node < document.nodes.size(); ++node) {
    const gltf::KeptJson& extras = document.nodes[node].extras;
    if (!extras.exists() || !extras->is_object() || !extras->contains(kCrowdNote)) continue;
    if (!graph) graph = readSceneGraph(document);
    try {
      const JsonView note = JsonView(*extras).object(kCrowdNote);
      CrowdMember member;
      const Index build = note.requireIndex("build", document.nodes.size() + 1);
      if (build == 0) note.fail("has a build of 0");
      member.build = build - 1;
      member.clip = note.text("clip");
      member.offset = note.requireIndex("offset_frames", kNoIndex / 4);
      member.transform = graph->world[node];
      member.node = node;
      members.push_back(std::move(member));
    } catch (const Error& error) {
      failAt(asset, node, error.message());
    }
  }
  return members;
}

Asset crowdMemberAlone(const Asset& asset, const CrowdMember& member) {
  Asset alone = asset.clone();
  gltf::Document& document = alone.document;
  std::vector<bool> isOwn(document.nodes.size(), false);
  std::vector<Index> open = {member.node};
  while (!open.empty()) {
    const Index node = open.back();
    open.pop_back();
    isOwn[node] = true;
    open.insert(open.end(), document.nodes[node].children.begin(), document.nodes[node].children.end());
  }
  // Surfaces stand beside the body that moves them.
  for (Index node = 0; node < document.nodes.size(); ++node) {
    const auto& skin = document.nodes[node].skin;
    if (!skin) continue;
    const std::vector<Index>& joints = document.skins[*skin].joints;
    if (!joints.empty() && isOwn[joints.front()]) isOwn[node] = true;
  }
  document.nodes[member.node].clearTransform();
  removeChannels(alone, [&](Index node, std::string_view) { return !isOwn[node]; });
  deleteNodes(alone, isOwn);
  return alone;
}

CrowdAnimation readCrowdAnimation(const Asset& asset, const std::vector<CrowdMember>& members) {
  CrowdAnimation animation;
  readTimes(asset, animation);
  std::map<std::pair<Index, std::string>, std::map<Index, const CrowdMember*>> groups;
  for (const CrowdMember& member : members) groups[{member.build, member.clip}].try_emplace(member.offset, &member);
  for (const auto& [key, byOffset] : groups) {
    CrowdFrames& table = animation.tables.emplace_back();
    std::tie(table.build, table.clip) = key;
    table.first = byOffset.begin()->first;
    table.frames = byOffset.rbegin()->first - table.first + animation.frames + 1;
    if (animation.frames == 0) failAt(asset, byOffset.begin()->second->node, "the body does not move");
    // As few members as have all frames between them.
    TableFiller filler(asset, table, animation);
    while (filler.filled() < table.frames) {
      auto next = byOffset.upper_bound(table.first + filler.filled());
      if (next != byOffset.begin() && filler.rowsWith(*std::prev(next)->second) > filler.filled()) --next;
      filler.add(*next->second);
    }
  }
  return animation;
}

}  // namespace limber
