#include "limber/actions/rig/hanging_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/character/anatomy/anatomy.h"
#include "limber/document/gltf/extensions.h"

namespace limber {

namespace {

constexpr Index kSegments = 3;
// Cloth falls, a tail is raised.
constexpr double kClothStiffness = 0.5, kClothGravity = 0.5, kTailStiffness = 1, kTailGravity = 0.1;
constexpr double kDrag = 0.4;
constexpr double kShortest = 1e-4;    // longest sides: what reaches no farther does not hang
constexpr double kAlongFront = 0.87;  // cosine of 30 degrees

double reachOf(const PreparedMesh& prepared, const HungAccessory& hung) {
  double reach = 0;
  for (const Index v : hung.vertices) reach = std::max(reach, (prepared.mesh.position(v) - hung.position).norm());
  return reach;
}

// Middles of what hangs, from where it hangs to its far end, evenly far from there: kSegments + 1.
std::vector<Vec3> middlesOf(const PreparedMesh& prepared, const HungAccessory& hung) {
  const double reach = reachOf(prepared, hung);
  const auto away = [&](Index v) { return (prepared.mesh.position(v) - hung.position).norm(); };
  std::vector<Vec3> middles(kSegments + 1, Vec3::Zero());
  std::vector<Index> counts(kSegments + 1, 0);
  for (const Index v : hung.vertices) {
    const auto level = static_cast<std::size_t>(std::lround(kSegments * away(v) / reach));
    middles[level] += prepared.mesh.position(v);
    ++counts[level];
  }
  for (Index level = 0; level <= kSegments; ++level) {
    if (counts[level] > 0) middles[level] /= counts[level];
  }
  middles[0] = hung.position;
  for (Index level = 1; level <= kSegments; ++level) {  // the far end has vertices, levels before it may have none
    Index next = level;
    while (counts[next] == 0) ++next;
    if (next > level) middles[level] = middles[level - 1] + (middles[next] - middles[level - 1]) / (next - level + 1.0);
  }
  return middles;
}

// The parameter, 0 to kSegments along the polyline, of its point nearest to `point`.
double alongLine(const std::vector<Vec3>& line, const Vec3& point) {
  double best = 0, nearest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < kSegments; ++i) {
    const Vec3 displacement = line[i + 1] - line[i];
    const double fraction =
        std::clamp((point - line[i]).dot(displacement) / std::max(displacement.squaredNorm(), 1e-24), 0.0, 1.0);
    const double distance = (line[i] + fraction * displacement - point).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    best = i + fraction;
  }
  return best;
}

// "cape1", "cape2", "cape3" and "capeEnd", or others of which the skeleton has none.
std::vector<std::string> freeNames(const Skeleton& skeleton, const std::string& word) {
  for (Index number = 1;; ++number) {
    const std::string start = number == 1 ? word : fmt::format("{}{}_", word, number);
    std::vector<std::string> names;
    for (Index i = 1; i <= kSegments; ++i) names.push_back(fmt::format("{}{}", start, i));
    names.push_back(start + "End");
    if (std::none_of(names.begin(), names.end(), [&](const std::string& name) { return skeleton.find(name); })) {
      return names;
    }
  }
}

// +Y along the chain, +Z to the front or, where the chain points there, up.
Mat3 axesAlong(const Vec3& displacement) {
  const Vec3 y = displacement.norm() > 0 ? Vec3(displacement.normalized()) : Vec3(-Vec3::UnitY());
  const Vec3 toward = std::abs(y.z()) > kAlongFront ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 z = (toward - toward.dot(y) * y).normalized();
  Mat3 axes;
  axes << y.cross(z), y, z;
  return axes;
}

}  // namespace

std::vector<HangingChain> addChains(const PreparedMesh& prepared, const Accessories& accessories,
                                    const std::vector<HungAccessory>& hung, Skeleton& made, SkinWeights& weights) {
  std::vector<HangingChain> chains;
  for (std::size_t a = 0; a < hung.size(); ++a) {
    if (!accessories.hangs[a] || reachOf(prepared, hung[a]) < kShortest) continue;
    const std::vector<Vec3> line = middlesOf(prepared, hung[a]);
    HangingChain chain;
    chain.name = accessories.names[a];
    chain.stiffness = kClothStiffness;
    chain.gravityPower = kClothGravity;
    const std::vector<std::string> names = freeNames(made, accessories.words[a]);
    const Index first = made.jointCount();
    std::vector<Affine> globals = restGlobals(made);
    for (Index i = 0; i <= kSegments; ++i) {
      Joint joint;
      joint.name = names[i];
      joint.parent = i == 0 ? hung[a].joint : first + i - 1;
      Affine global = Affine::Identity();
      global.linear() = axesAlong(line[std::min(i + 1, kSegments)] - line[std::min(i, kSegments - 1)]);
      global.translation() = prepared.frame.toSource(line[i]);
      joint.rest = decompose(globals[*joint.parent].inverse(Eigen::Isometry) * global);
      joint.rest.scale = Vec3::Ones();
      globals.push_back(global);
      chain.joints.push_back(made.jointCount());
      made.joints.push_back(std::move(joint));
    }
    for (const Index v : hung[a].vertices) {
      const Vec3 position = prepared.mesh.position(v);
      // One joint alone moves the middle of its segment; the ends are blended with its neighbours'.
      const double at = std::clamp(alongLine(line, position) - 0.5, 0.0, kSegments - 1.0);
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
    chain.joints = part.joints;
    chains.push_back(std::move(chain));
  }
  return chains;
}

void writeSprings(Asset& asset, const std::vector<Index>& jointNode, const std::vector<HangingChain>& chains) {
  if (chains.empty()) return;
  Json& extension = changeExtension(asset.document, kSpringBoneName);
  if (!extension.is_object()) extension = Json::object();
  extension["specVersion"] = "1.0";
  Json& springs = extension["springs"];
  if (!springs.is_array()) springs = Json::array();
  for (const HangingChain& chain : chains) {
    Json joints = Json::array();
    for (const Index joint : chain.joints) {
      joints.push_back({{"node", jointNode[joint]},
                        {"stiffness", chain.stiffness},
                        {"gravityPower", chain.gravityPower},
                        {"gravityDir", {0, -1, 0}},
                        {"dragForce", kDrag}});
    }
    springs.push_back({{"name", chain.name}, {"joints", std::move(joints)}});
  }
  declareExtension(asset.document, kSpringBoneName);
}

}  // namespace limber
