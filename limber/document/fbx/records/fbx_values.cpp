#include "limber/document/fbx/records/fbx_values.h"

#include <limits>
#include <type_traits>

namespace limber {

namespace {

// What does not fit becomes the least integer, which is no count, no index and no id.
template <typename To, typename From>
To converted(From value) {
  if constexpr (std::is_integral_v<To> && std::is_floating_point_v<From>) {
    constexpr From kBound = static_cast<From>(std::int64_t{1} << 62);
    return value > -kBound && value < kBound ? static_cast<To>(value) : std::numeric_limits<To>::min();
  } else {
    return static_cast<To>(value);
  }
}

template <typename To>
std::optional<To> arithmetic(const FbxNode& node, std::size_t index) {
  if (index >= node.values.size()) return std::nullopt;
  return std::visit(
      [](const auto& value) -> std::optional<To> {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) return converted<To>(value);
        return std::nullopt;
      },
      node.values[index]);
}

template <typename To>
std::vector<To> arrayOf(const FbxNode& node, std::string_view child) {
  const FbxNode* found = node.find(child);
  std::vector<To> result;
  if (!found || found->values.empty()) return result;
  std::visit(
      [&](const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (!std::is_arithmetic_v<Value> && !std::is_same_v<Value, std::string> &&
                      !std::is_same_v<Value, Bytes>) {
          result.reserve(value.size());
          for (const auto element : value) result.push_back(converted<To>(element));
        }
      },
      found->values[0]);
  return result;
}

}  // namespace

std::optional<double> fbxNumber(const FbxNode& node, std::size_t index) {
  return arithmetic<double>(node, index);
}

std::optional<std::int64_t> fbxInteger(const FbxNode& node, std::size_t index) {
  return arithmetic<std::int64_t>(node, index);
}

std::optional<std::string_view> fbxText(const FbxNode& node, std::size_t index) {
  const auto* text = index < node.values.size() ? std::get_if<std::string>(&node.values[index]) : nullptr;
  return text ? std::optional<std::string_view>(*text) : std::nullopt;
}

std::vector<double> fbxNumbers(const FbxNode& node, std::string_view child) {
  return arrayOf<double>(node, child);
}

std::vector<std::int64_t> fbxIntegers(const FbxNode& node, std::string_view child) {
  return arrayOf<std::int64_t>(node, child);
}

std::string_view fbxChildText(const FbxNode& node, std::string_view child) {
  const FbxNode* found = node.find(child);
  return found ? fbxText(*found, 0).value_or(std::string_view()) : std::string_view();
}

}  // namespace limber
