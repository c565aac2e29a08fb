#include "limber/pipeline/hanging_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/anatomy/anatomy.h"

namespace limber {

namespace {

constexpr Index kSegments = 3;
// Cloth falls, a tail is held up.
constexpr double kClothStiffness = 0.5, kClothGravity = 0.5, kTailStiffness = 1, kTailGravity = 0.1;
constexpr double kDrag = 0.4;
constexpr const char* kSpringBone = "VRMC_springBone";

// Middles of what hangs, from where it hangs to its far end, evenly far from there: kSegments + 1.
std::vector<Vec3> middlesOf(const PreparedMesh& prepared, const HungAccessory& hung) {
  double reach = 0;
  const auto away = [&](Index v) { return (prepared.mesh.position(v) - hung.place).norm(); };
  for (const Index v : hung.vertices) reach = std::max(reach, away(v));
  std::vector<Vec3> middles(kSegments + 1, Vec3::Zero());
  std::vector<Index> counts(kSegments + 1, 0);
  for (const Index v : hung.vertices) {
    const auto level = static_cast<std::size_t>(std::lround(kSegments * away(v) / std::max(reach, 1e-12)));
    middles[level] += prepared.mesh.position(v);
    ++counts[level];
  }
  for (Index level = 0; level <= kSegments; ++level) {
    if (counts[level] > 0) middles[level] /= counts[level];
  }
  middles[0] = hung.place;
  for (Index level = 1; level <= kSegments; ++level) {  // the far end has vertices, levels before it may have none
    Index next = level;
    while (counts[next] == 0) ++next;
    if (next > level) middles[level] = middles[level - 1] + (middles[next] - middles[level - 1]) / (next - level + 1.0);
  }
  return middles;
}

// How far along the bent line from 0 to kSegments the nearest place to a point lies.
double alongLine(const std::vector<Vec3>& line, const Vec3& point) {
  double best = 0, nearest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < kSegments; ++i) {
    const Vec3 way = line[i + 1] - line[i];
    const double share = std::clamp((point - line[i]).dot(way) / std::max(way.squaredNorm(), 1e-24), 0.0, 1.0);
    const double distance = (line[i] + share * way - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    best = i + share;
  }
  return best;
}

// Of the first joint of a chain called `word`, so that no joint of the skeleton has any of its names.
std::string freeName(const Skeleton& skeleton, const std::string& word) {
  for (Index number = 1;; ++number) {
    const std::string name = number == 1 ? word : fmt::format("{}{}_", word, number);
    if (!skeleton.find(name + "1")) return name;
  }
}

}  // namespace

std::vector<HangingChain> addChains(const PreparedMesh& prepared, const Accessories& accessories,
                                    const std::vector<HungAccessory>& hung, Skeleton& made, SkinWeights& weights) {
  std::vector<HangingChain> chains;
  for (std::size_t a = 0; a < hung.size(); ++a) {
    if (!accessories.hangs[a] || hung[a].vertices.empty()) continue;
    const std::vector<Vec3> line = middlesOf(prepared, hung[a]);
    HangingChain chain;
    chain.name = accessories.names[a];
    chain.stiffness = kClothStiffness;
    chain.gravityPower = kClothGravity;
    const std::string name = freeName(made, accessories.words[a]);
    const Index first = made.jointCount();
    std::vector<Affine> globals = restGlobals(made);
    for (Index i = 0; i <= kSegments; ++i) {
      Joint joint;
      joint.name = i < kSegments ? fmt::format("{}{}", name, i + 1) : name + "End";
      joint.parent = i == 0 ? hung[a].joint : first + i - 1;
      // +Y along the chain.
      Affine global = Affine::Identity();
      const Vec3 along = line[std::min(i + 1, kSegments)] - line[std::min(i, kSegments - 1)];
      global.linear() = Quat::FromTwoVectors(Vec3::UnitY(), along.norm() > 0 ? along : Vec3(Vec3::UnitY())).matrix();
      global.translation() = prepared.frame.toSource(line[i]);
      joint.rest = decompose(globals[*joint.parent].inverse(Eigen::Isometry) * global);
      joint.rest.scale = Vec3::Ones();
      globals.push_back(global);
      chain.joints.push_back(joint.name);
      made.joints.push_back(std::move(joint));
    }
    for (const Index v : hung[a].vertices) {
      const Vec3 place = prepared.mesh.position(v);
      // A joint holds the middle of its segment alone, and shares its ends.
      const double at = std::clamp(alongLine(line, place) - 0.5, 0.0, kSegments - 1.0);
      const Index upper = std::min(static_cast<Index>(at), kSegments - 2);
      const auto lower = static_cast<float>(weights.slots > 1 ? at - upper : std::round(at - upper));
      const std::size_t slot = std::size_t{v} * weights.slots;
      std::fill_n(weights.joints.begin() + slot, weights.slots, 0);
      std::fill_n(weights.weights.begin() + slot, weights.slots, 0.0f);
      std::array<std::pair<float, Index>, 2> both = {{{1 - lower, first + upper}, {lower, first + upper + 1}}};
      if (both[0].first < both[1].first) std::swap(both[0], both[1]);
      for (Index k = 0; k < std::min<Index>(2, weights.slots) && both[k].first > 0; ++k) {
        weights.joints[slot + k] = both[k].second;
        weights.weights[slot + k] = both[k].first;
      }
    }
    chains.push_back(std::move(chain));
  }
  return chains;
}

std::vector<HangingChain> chainsOfTails(const Skeleton& made) {
  std::vector<HangingChain> chains;
  for (const Part& part : readAnatomy(made).parts) {
    if (part.kind != PartKind::kTail || part.joints.size() < 2 || part.confidence < kDoubtful) continue;
    HangingChain chain;
    chain.name = nameOf(part.kind);
    chain.stiffness = kTailStiffness;
    chain.gravityPower = kTailGravity;
    for (const Index joint : part.joints) chain.joints.push_back(made.joints[joint].name);
    chains.push_back(std::move(chain));
  }
  return chains;
}

void writeSprings(Asset& asset, const AssetSkeleton& rig, const std::vector<HangingChain>& chains) {
  Json springs = Json::array();
  for (const HangingChain& chain : chains) {
    Json joints = Json::array();
    for (const std::string& name : chain.joints) {
      joints.push_back({{"node", rig.jointNode[rig.skeleton.find(name).value()]},
                        {"stiffness", chain.stiffness},
                        {"gravityPower", chain.gravityPower},
                        {"gravityDir", {0, -1, 0}},
                        {"dragForce", kDrag}});
    }
    springs.push_back({{"name", chain.name}, {"joints", std::move(joints)}});
  }
  if (springs.empty()) return;
  Json& json = asset.json();
  json["extensions"][kSpringBone] = {{"specVersion", "1.0"}, {"springs", std::move(springs)}};
  Json& used = json["extensionsUsed"];
  if (!used.is_array()) used = Json::array();
  if (std::find(used.begin(), used.end(), kSpringBone) == used.end()) used.push_back(kSpringBone);
}

}  // namespace limber
