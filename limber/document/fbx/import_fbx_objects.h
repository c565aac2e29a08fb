// The objects of an FBX file, their connections and properties.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/fbx/records/fbx_parse.h"

namespace limber {

// The properties of an object: its own, else its class's from the file's definitions.
class FbxProperties {
 public:
  FbxProperties(const FbxNode* own, const FbxNode* ofClass) : own_(own), ofClass_(ofClass) {}

  double number(std::string_view name, double otherwise) const;
  std::optional<double> number(std::string_view name) const;  // none where it is not there or not finite
  std::int64_t integer(std::string_view name, std::int64_t otherwise) const;
  Vec3 vector(std::string_view name, const Vec3& otherwise) const;
  std::optional<Vec3> vector(std::string_view name) const;
  std::string_view text(std::string_view name) const;  // empty where it is not there

 private:
  const FbxNode* find(std::string_view name) const;

  const FbxNode *own_, *ofClass_;  // "Properties70"; may be null
};

struct FbxObject {
  const FbxNode* node = nullptr;
  std::string name;       // valid UTF-8, without its class
  std::string_view kind;  // "Mesh", "LimbNode", "Skin", ...
};

// Views into an FbxFile, which must outlive this. Objects are numbered by their order in the file.
class FbxObjects {
 public:
  explicit FbxObjects(const FbxFile& file);

  struct Link {
    Index object;
    std::string_view property;  // of the destination ("Lcl Rotation"); empty where the objects as such are connected
  };

  Index count() const { return static_cast<Index>(objects_.size()); }
  const FbxObject& operator[](Index object) const { return objects_[object]; }
  bool is(Index object, std::string_view className) const { return objects_[object].node->name == className; }
  bool is(Index object, std::string_view className, std::string_view kind) const;

  // What is connected to an object and what it is connected to, in the order of the file; the scene's root is left out.
  // Equal connections count once, except those of materials.
  std::span<const Link> sources(Index object) const { return sources_[object]; }
  std::span<const Link> destinations(Index object) const { return destinations_[object]; }

  // Of those, the ones of a class that are connected to the object as such.
  std::vector<Index> sources(Index object, std::string_view className) const;

  FbxProperties properties(Index object) const;

 private:
  void addObject(const FbxNode& node);
  // Each connection is added once (see `known`), but materials are added again: their numbers are their positions in
  // their model's list.
  using Connection = std::tuple<Index, Index, std::string_view>;  // source, destination, property
  void addConnection(const FbxNode& node, std::set<Connection>& known);

  std::vector<FbxObject> objects_;
  std::map<std::int64_t, Index> byId_;
  std::vector<std::vector<Link>> sources_, destinations_;
  std::map<std::string_view, const FbxNode*> templates_;  // by class
};

}  // namespace limber
