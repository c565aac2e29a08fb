// The objects of an FBX file that is being made, and how they hang together.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/types.h"
#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

// Adds a record below another. The reference holds until the parent gets the next one.
FbxNode& addRecord(FbxNode& parent, std::string_view name, std::vector<FbxValue> values = {});

// FBX 7's properties: "P" records below "Properties70", each with its type, label and flags ("A": can be animated).
class FbxPropertyWriter {
 public:
  explicit FbxPropertyWriter(FbxNode& owner) : list_(addRecord(owner, "Properties70")) {}

  void add(std::string_view name, std::string_view type, std::string_view label, std::string_view flags,
           std::vector<FbxValue> values = {});
  void text(std::string_view name, std::string_view value);
  void integer(std::string_view name, int value);
  void flag(std::string_view name, bool value);
  void choice(std::string_view name, int value);
  void number(std::string_view name, double value, std::string_view flags = "A");
  void color(std::string_view name, const Vec3& value);
  void vector(std::string_view name, const Vec3& value);      // not animated
  void animatable(std::string_view name, const Vec3& value);  // "Lcl Translation", ...: the type is the name
  void time(std::string_view name, std::int64_t value);

 private:
  FbxNode& list_;
};

// A name as binary files have it: with its class behind. Control characters become underscores.
std::string fbxName(std::string_view name, std::string_view objectClass);

using FbxId = std::int64_t;
inline constexpr FbxId kFbxRoot = 0;  // of the scene

class FbxObjectWriter {
 public:
  struct Made {
    FbxId id;
    FbxNode& record;  // holds until the next one is made
  };
  // `type` is the record's name ("Model"), `objectClass` is appended to the name, `kind` is the third value
  // ("LimbNode").
  Made make(std::string_view type, std::string_view name, std::string_view objectClass, std::string_view kind);

  void connect(FbxId child, FbxId parent);
  void connect(FbxId child, FbxId parent, std::string_view property);

  FbxId newId() { return ++lastId_; }
  const std::map<std::string, int>& counts() const { return counts_; }  // of objects by their type
  FbxNode takeObjects() { return std::move(objects_); }
  FbxNode takeConnections() { return std::move(connections_); }

 private:
  FbxNode objects_{"Objects", {}, {}}, connections_{"Connections", {}, {}};
  std::map<std::string, int> counts_;
  FbxId lastId_ = 1000000;  // small ones are the SDK's own
};

// 16 numbers: columns one after the other, the translation last.
std::vector<double> fbxMatrix(const Affine& affine);

// FBX' clock: ticks in a second.
inline constexpr std::int64_t kFbxSecond = 46186158000;
std::int64_t fbxTime(double seconds);

}  // namespace limber
