// The values of FBX records, whichever of the numeric types a file chose for them.
#pragma once

#include <optional>

#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

// The value at that index as a number or as text (raw bytes are no text); none where there is no such value.
std::optional<double> fbxNumber(const FbxNode& node, std::size_t index);
std::optional<std::int64_t> fbxInteger(const FbxNode& node, std::size_t index);  // a fraction is cut off
std::optional<std::string_view> fbxText(const FbxNode& node, std::size_t index);

// The array that a child of that name holds; empty where there is none.
std::vector<double> fbxNumbers(const FbxNode& node, std::string_view child);
std::vector<std::int64_t> fbxIntegers(const FbxNode& node, std::string_view child);

// The text of a child's first value; empty where there is none.
std::string_view fbxChildText(const FbxNode& node, std::string_view child);

}  // namespace limber
