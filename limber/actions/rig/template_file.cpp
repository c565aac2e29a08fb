#include "limber/actions/rig/template_file.h"

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "limber/core/file/file.h"
#include "limber/core/known_error.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& where) {
  throw Error(ErrorCode::kBadData, what, where, "docs/template-rigs.md shows the format");
}

struct NamedJoint {
  std::string name, parent;
  Vec3 position = Vec3::Zero();
};

NamedJoint parseJoint(const Json& json, std::size_t number) {
  NamedJoint joint;
  const std::string location = "joint " + std::to_string(number);
  if (!json.is_object() || !json.contains("name") || !json["name"].is_string()) refuse("has no name", location);
  joint.name = json["name"].get<std::string>();
  if (joint.name.empty()) refuse("has no name", location);
  if (json.contains("parent") && !json["parent"].is_null()) {
    if (!json["parent"].is_string()) refuse("names its parent by something that is no name", joint.name);
    joint.parent = json["parent"].get<std::string>();
  }
  const bool placed = json.contains("position") && json["position"].is_array() && json["position"].size() == 3;
  if (!placed) refuse("has no position of three numbers", joint.name);
  for (int axis = 0; axis < 3; ++axis) {
    const Json& value = json["position"][static_cast<std::size_t>(axis)];
    if (!value.is_number() || !std::isfinite(value.get<double>()))
      refuse("has a position that is no number", joint.name);
    joint.position[axis] = value.get<double>();
  }
  return joint;
}

// Parents before children. Follows each joint up to one that is known; whoever meets itself again is in a cycle.
class JointOrder {
 public:
  explicit JointOrder(const std::vector<NamedJoint>& joints) : joints_(joints), done_(joints.size()) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (!byName_.emplace(joints[j].name, j).second) refuse("two joints have this name", joints[j].name);
    }
  }

  Skeleton sort() {
    for (std::size_t j = 0; j < joints_.size(); ++j) add(j);
    return std::move(skeleton_);
  }

 private:
  void add(std::size_t last) {
    std::vector<std::size_t> waiting;
    for (std::size_t j = last; !done_[j];) {
      waiting.push_back(j);
      if (waiting.size() > joints_.size()) refuse("is its own ancestor: the joints form a cycle", joints_[last].name);
      if (joints_[j].parent.empty()) break;
      const auto parent = byName_.find(joints_[j].parent);
      if (parent == byName_.end()) refuse("hangs on '" + joints_[j].parent + "', which there is not", joints_[j].name);
      j = parent->second;
    }
    while (!waiting.empty()) {
      const NamedJoint& from = joints_[waiting.back()];
      Joint joint;
      joint.name = from.name;
      joint.rest.translation = from.position;
      if (!from.parent.empty()) {
        const std::size_t parent = byName_.at(from.parent);
        joint.parent = done_[parent];
        joint.rest.translation -= joints_[parent].position;
      }
      done_[waiting.back()] = skeleton_.jointCount();
      skeleton_.joints.push_back(std::move(joint));
      waiting.pop_back();
    }
  }

  const std::vector<NamedJoint>& joints_;
  std::vector<std::optional<Index>> done_;
  std::map<std::string, std::size_t> byName_;
  Skeleton skeleton_;
};

// What goes wrong is said of the file of that name.
template <class Read>
Skeleton withinTemplate(std::string_view name, Read&& read) {
  try {
    return read();
  } catch (const Error& error) {
    throwWithin(error, name);
  }
}

}  // namespace

Skeleton parseTemplate(std::string_view text) {
  Warnings duplicates;  // the last one counts
  const Json json = parseJson(text, duplicates);
  if (!json.is_object() || !json.contains("joints") || !json["joints"].is_array() || json["joints"].empty()) {
    refuse("has no joint", "template");
  }
  std::vector<NamedJoint> joints;
  for (const Json& joint : json["joints"]) joints.push_back(parseJoint(joint, joints.size()));
  return JointOrder(joints).sort();
}

Skeleton readTemplateFile(const std::filesystem::path& path) {
  if (path.extension() == ".json") return readTemplateFile(readFile(path), path.string());
  return withinTemplate(path.string(), [&] { return readMotion(path).skeleton; });
}

Skeleton readTemplateFile(ByteSpan bytes, std::string_view name) {
  return withinTemplate(name, [&] {
    if (!name.ends_with(".json")) return readMotion(bytes, name).skeleton;
    return parseTemplate({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  });
}

}  // namespace limber
