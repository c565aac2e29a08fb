#include "limber/document/fbx/import_fbx_objects.h"

#include <cmath>

#include "limber/document/fbx/records/fbx_values.h"
#include "limber/document/utf8.h"

namespace limber {

namespace {

constexpr std::size_t kFirstValue = 4;  // of a property, behind its name, type, label and flags

const FbxNode* propertyNamed(const FbxNode* properties, std::string_view name) {
  if (!properties) return nullptr;
  for (const FbxNode& property : properties->children) {
    if (property.name == "P" && fbxText(property, 0) == name) return &property;
  }
  return nullptr;
}

// "Body\0\1Model" in binary files, "Model::Body" in text.
std::string nameWithoutClass(std::string_view name, std::string_view className) {
  const std::size_t end = name.find(std::string_view("\0\1", 2));
  if (end != name.npos) return validUtf8(name.substr(0, end));
  constexpr std::string_view kSeparator = "::";
  const std::size_t separator = name.find(kSeparator);
  const bool hasClass = separator != name.npos && !className.empty() && separator < name.size();
  return validUtf8(hasClass ? name.substr(separator + kSeparator.size()) : name);
}

}  // namespace

const FbxNode* FbxProperties::find(std::string_view name) const {
  const FbxNode* own = propertyNamed(own_, name);
  return own ? own : propertyNamed(ofClass_, name);
}

std::optional<double> FbxProperties::number(std::string_view name) const {
  const FbxNode* property = find(name);
  const std::optional<double> value = property ? fbxNumber(*property, kFirstValue) : std::nullopt;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

double FbxProperties::number(std::string_view name, double otherwise) const {
  return number(name).value_or(otherwise);
}

std::int64_t FbxProperties::integer(std::string_view name, std::int64_t otherwise) const {
  const FbxNode* property = find(name);
  return property ? fbxInteger(*property, kFirstValue).value_or(otherwise) : otherwise;
}

std::optional<Vec3> FbxProperties::vector(std::string_view name) const {
  const FbxNode* property = find(name);
  if (!property) return std::nullopt;
  Vec3 result;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> value = fbxNumber(*property, kFirstValue + static_cast<std::size_t>(i));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    result[i] = *value;
  }
  return result;
}

Vec3 FbxProperties::vector(std::string_view name, const Vec3& otherwise) const {
  return vector(name).value_or(otherwise);
}

std::string_view FbxProperties::text(std::string_view name) const {
  const FbxNode* property = find(name);
  return property ? fbxText(*property, kFirstValue).value_or(std::string_view()) : std::string_view();
}

FbxObjects::FbxObjects(const FbxFile& file) {
  if (const FbxNode* definitions = file.root.find("Definitions")) {
    for (const FbxNode& type : definitions->children) {
      const FbxNode* first = type.name == "ObjectType" ? type.find("PropertyTemplate") : nullptr;
      if (first) templates_.emplace(fbxText(type, 0).value_or(""), first->find("Properties70"));
    }
  }
  if (const FbxNode* objects = file.root.find("Objects")) {
    for (const FbxNode& node : objects->children) addObject(node);
  }
  sources_.resize(objects_.size());
  destinations_.resize(objects_.size());
  if (const FbxNode* connections = file.root.find("Connections")) {
    std::set<Connection> known;
    for (const FbxNode& node : connections->children) addConnection(node, known);
  }
}

void FbxObjects::addObject(const FbxNode& node) {
  const std::optional<std::int64_t> id = fbxInteger(node, 0);
  if (!id || !byId_.emplace(*id, count()).second) return;
  objects_.push_back({&node, nameWithoutClass(fbxText(node, 1).value_or(""), node.name),
                      fbxText(node, 2).value_or(std::string_view())});
}

void FbxObjects::addConnection(const FbxNode& node, std::set<Connection>& known) {
  const auto source = byId_.find(fbxInteger(node, 1).value_or(0)),
             destination = byId_.find(fbxInteger(node, 2).value_or(0));
  if (source == byId_.end() || destination == byId_.end()) return;
  const std::string_view property = fbxText(node, 0) == "OP" ? fbxText(node, 3).value_or("") : "";
  const bool isNew = known.emplace(source->second, destination->second, property).second;
  if (!isNew && !is(source->second, "Material")) return;
  sources_[destination->second].push_back({source->second, property});
  destinations_[source->second].push_back({destination->second, property});
}

bool FbxObjects::is(Index object, std::string_view className, std::string_view kind) const {
  return is(object, className) && objects_[object].kind == kind;
}

std::vector<Index> FbxObjects::sources(Index object, std::string_view className) const {
  std::vector<Index> result;
  for (const Link& link : sources_[object]) {
    if (link.property.empty() && is(link.object, className)) result.push_back(link.object);
  }
  return result;
}

FbxProperties FbxObjects::properties(Index object) const {
  const FbxNode& node = *objects_[object].node;
  const auto ofClass = templates_.find(node.name);
  return {node.find("Properties70"), ofClass == templates_.end() ? nullptr : ofClass->second};
}

}  // namespace limber
