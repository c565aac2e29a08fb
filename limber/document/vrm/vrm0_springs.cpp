#include "limber/document/vrm/vrm0_springs.h"

#include <utility>

#include "limber/document/scene/node_edit.h"
#include "limber/document/scene/scene_graph.h"
#include "limber/document/vrm/loose_json.h"

namespace limber {

namespace {

constexpr double kTail = 0.07;  // metres: of a chain's last joint in VRM 0.x

Vec3 vectorIn(const Json& object, const char* key, const Vec3& byDefault) {
  const Json* value = member(object, key);
  if (value == nullptr || !value->is_object()) return byDefault;
  return {numberIn(*value, "x", 0), numberIn(*value, "y", 0), numberIn(*value, "z", 0)};
}

Json listOf(const Vec3& v) {
  return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};  // no -0
}

class SpringMaker {
 public:
  SpringMaker(Asset& asset, const Json& animation)
      : asset_(asset), animation_(animation), swings_(asset.document.nodes.size()) {}

  Json make() {
    addColliders();
    for (const Json& group : listIn(animation_, "boneGroups")) addGroup(group);
    if (springs_.empty()) return nullptr;
    Json extension = {{"specVersion", "1.0"}};
    if (!colliders_.empty()) {
      extension["colliders"] = std::move(colliders_);
      extension["colliderGroups"] = std::move(colliderGroups_);
    }
    extension["springs"] = std::move(springs_);
    return extension;
  }

 private:
  // Offsets are in Unity's coordinates, whose Z points in the opposite direction; the node's own axes rotate with it.
  void addColliders() {
    for (const Json& group : listIn(animation_, "colliderGroups")) {
      Json numbers = Json::array();
      const std::optional<Index> node = indexIn(group, "node", swings_.size());
      for (const Json& collider : listIn(group, "colliders")) {
        if (!node) break;
        const Vec3 offset = vectorIn(collider, "offset", Vec3::Zero());
        numbers.push_back(colliders_.size());
        colliders_.push_back({{"node", *node},
                              {"shape",
                               {{"sphere",
                                 {{"offset", listOf({offset.x(), offset.y(), -offset.z()})},
                                  {"radius", numberIn(collider, "radius", 0)}}}}}});
      }
      groupNumber_.push_back(numbers.empty() ? std::nullopt : std::optional<std::size_t>(colliderGroups_.size()));
      if (!numbers.empty()) colliderGroups_.push_back({{"colliders", std::move(numbers)}});
    }
  }

  void addGroup(const Json& group) {
    const Vec3 gravity = vectorIn(group, "gravityDir", -Vec3::UnitY());
    settings_ = {{"hitRadius", numberIn(group, "hitRadius", 0)},
                 {"stiffness", numberIn(group, "stiffiness", 1)},  // 0.x spells it so
                 {"gravityPower", numberIn(group, "gravityPower", 0)},
                 {"gravityDir", listOf({-gravity.x(), gravity.y(), gravity.z()})},
                 {"dragForce", numberIn(group, "dragForce", 0.5)}};
    about_ = Json::object();
    if (const std::string comment = textIn(group, "comment"); !comment.empty()) about_["name"] = comment;
    Json groups = Json::array();
    for (const Json& number : listIn(group, "colliderGroups")) {
      const std::optional<Index> index = indexOf(number, groupNumber_.size());
      if (index && groupNumber_[*index]) groups.push_back(*groupNumber_[*index]);
    }
    if (!groups.empty()) about_["colliderGroups"] = std::move(groups);
    if (const auto center = indexIn(group, "center", swings_.size())) about_["center"] = *center;
    for (const Json& bone : listIn(group, "bones")) {
      if (const std::optional<Index> root = indexOf(bone, swings_.size())) addChains(*root);
    }
  }

  void addChains(Index root) {
    std::vector<Index> starts = {root};
    while (!starts.empty()) {
      Index node = starts.back();
      starts.pop_back();
      if (swings_[node]) continue;
      Json joints = Json::array();
      for (bool goesOn = true; goesOn;) {
        swings_[node] = true;
        joints.push_back(joint(node));
        const std::vector<Index>& children = asset_.document.nodes[node].children;
        for (std::size_t c = children.size(); c > 1; --c) starts.push_back(children[c - 1]);
        goesOn = !children.empty() && !swings_[children.front()];
        if (goesOn) node = children.front();
      }
      if (const std::optional<Index> tail = addTail(node)) joints.push_back({{"node", *tail}});
      if (joints.size() < 2) continue;
      Json spring = about_;
      spring["joints"] = std::move(joints);
      springs_.push_back(std::move(spring));
    }
  }

  Json joint(Index node) const {
    Json joint = {{"node", node}};
    joint.update(settings_);
    return joint;
  }

  // A node behind the chain's last, in the direction in which that lies from its own parent.
  std::optional<Index> addTail(Index last) {
    const Vec3 displacement = nodeTransform(asset_.document.nodes[last]).translation();
    if (!(displacement.norm() > 0) || !asset_.document.nodes[last].children.empty()) return std::nullopt;
    gltf::Node tail;
    if (!asset_.document.nodes[last].name.empty()) tail.name = asset_.document.nodes[last].name + "_end";
    setNodeTransform(tail, Affine(Eigen::Translation3d(kTail * displacement.normalized())), false);
    const Index number = addElement(asset_.document.nodes, std::move(tail));
    asset_.document.nodes[last].children = {number};
    return number;
  }

  Asset& asset_;
  const Json& animation_;
  std::vector<bool> swings_;  // #nodes as they were read
  std::vector<std::optional<std::size_t>> groupNumber_;
  Json colliders_ = Json::array(), colliderGroups_ = Json::array(), springs_ = Json::array(), settings_, about_;
};

}  // namespace

Json springsOfVrm0(Asset& asset, const Json& secondaryAnimation) {
  return SpringMaker(asset, secondaryAnimation).make();
}

}  // namespace limber
