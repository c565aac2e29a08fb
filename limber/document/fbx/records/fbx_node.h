// The records that an FBX file consists of, whatever they mean: names, values, records below them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "limber/core/file/file.h"

namespace limber {

// A value of a record. Text is as the file has it ("name\0\1Class" in binary files), "Class::name" in text ones). A
// single letter without quotes (Type: C) is its number in binary files, text in text ones.
using FbxValue =
    std::variant<bool, std::int16_t, std::int32_t, std::int64_t, float, double, std::string, Bytes, std::vector<bool>,
                 std::vector<std::int32_t>, std::vector<std::int64_t>, std::vector<float>, std::vector<double>>;

struct FbxNode {
  std::string name;
  std::vector<FbxValue> values;
  std::vector<FbxNode> children;

  const FbxNode* find(std::string_view child) const;  // the first child of that name, null where there is none
};

}  // namespace limber
