// A USD stage as data: prims, their properties and their children. usd_text.h and usd_crate.h write it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// The prim that everything else is below.
inline constexpr std::string_view kUsdRoot = "Model";
// Those that may stand directly below it beside the meshes.
inline constexpr const char *kUsdSkeleton = "Skeleton", *kUsdMaterials = "Materials";

// An identifier of USD: letters of ASCII, digits and underscores, no digit first. Everything else becomes an
// underscore.
std::string usdName(std::string_view text);

// A text without control characters, as each form of a file can hold it.
std::string usdLabel(std::string_view text);

// What an attribute holds; texts are strings, tokens and paths of assets alike: the attribute's type tells. A vector is
// an array, even where it has one value. Matrices map columns, as everywhere here; USD's files have them transposed.
using UsdValue = std::variant<std::monostate, bool, int, float, std::string, Vec2f, Vec3f, Vec4f, Affine,
                              std::vector<int>, std::vector<float>, std::vector<std::string>, std::vector<Vec2f>,
                              std::vector<Vec3f>, std::vector<Eigen::Quaternionf>, std::vector<Affine>>;

// An attribute, or a relationship where it has no type.
struct UsdProperty {
  std::string type;  // "point3f[]", "token"
  std::string name;
  bool isUniform = false;
  UsdValue value;                                    // std::monostate: none
  std::vector<std::pair<double, UsdValue>> samples;  // by time code, increasing
  std::vector<std::string> targets;                  // paths; of an attribute: the one that it is connected to
  std::optional<int> elementSize;                    // values for each vertex
  std::string interpolation;                         // "vertex", or of USD's choice
  std::optional<int> decimals;                       // that text is rounded to; none: as many as read back equal
};

struct UsdPrim {
  std::string type, name;
  std::vector<std::string> schemas;  // that are applied to it
  std::vector<UsdProperty> properties;
  std::vector<UsdPrim> children;
  std::string displayName{};  // what users know it by, where the name cannot say it; empty: none

  // Keeps the text that the prim's name was made of where that is another.
  void display(const std::string& text);
  UsdProperty& add(std::string type, std::string name, UsdValue value = {});
  UsdProperty& addUniform(std::string type, std::string name, UsdValue value);
  void relate(std::string name, std::vector<std::string> targets);
  // An attribute that has the value of another.
  void connect(std::string type, std::string name, std::string target);
};

// +Y up, metres.
struct UsdStage {
  double timeCodesPerSecond = 24;
  double endTimeCode = 0;  // 0: nothing moves
  UsdPrim root;            // named kUsdRoot
};

}  // namespace limber
