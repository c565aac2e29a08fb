// USD's text form, line by line.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/types.h"

namespace limber {

// The prim that everything else stands below.
inline constexpr std::string_view kUsdRoot = "Model";

// A single value, to seven digits.
std::string usdNumber(double value);

// An identifier of USD: letters, digits and underscores, no digit first. Everything else becomes an underscore.
std::string usdName(std::string_view text);

// Writes prims and their properties, each on lines of its own.
class UsdText {
 public:
  explicit UsdText(std::string& out) : out_(out) {}

  // `def Mesh "name" (` with its API schemas and what stands below it until close().
  void open(std::string_view type, std::string_view name, const std::vector<std::string_view>& schemas = {});
  void close();
  void line(std::string_view text);

  // `name = [..]`; `metadata` behind it in parentheses ("elementSize = 4", "interpolation = \"vertex\"").
  void array(std::string_view name, std::span<const int> values, const std::vector<std::string>& metadata = {});
  void array(std::string_view name, std::span<const float> values, const std::vector<std::string>& metadata = {});
  void array(std::string_view name, std::span<const Vec2f> values, const std::vector<std::string>& metadata = {});
  void array(std::string_view name, std::span<const Vec3f> values, const std::vector<std::string>& metadata = {});
  // A line of values that the caller makes: start, what values(number, out) appends, end.
  using Values = std::function<void(std::size_t number, std::string& out)>;
  void list(std::string_view start, std::size_t number, const Values& values, std::string_view end);
  void tokens(std::string_view name, const std::vector<std::string>& values);
  void matrices(std::string_view name, std::span<const Affine> values);

 private:
  template <typename Value>
  void arrayOf(std::string_view name, std::span<const Value> values, const std::vector<std::string>& metadata);
  void indent();

  std::string& out_;
  std::size_t depth_ = 0;
};

// Appends one value: 0.5, (1,2), (1,2,3), and a quaternion as (w,x,y,z). Numbers are as short as they read back equal;
// `digits` above 0 rounds them to so many.
void appendUsd(std::string& out, float value, int digits = 0);
void appendUsd(std::string& out, const Vec2f& value, int digits = 0);
void appendUsd(std::string& out, const Vec3f& value, int digits = 0);
void appendUsd(std::string& out, const Eigen::Quaternionf& value, int digits = 0);

}  // namespace limber
