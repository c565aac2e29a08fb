// Checked reading of a document's JSON: what is missing or of the wrong type becomes an Error that says where.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "limber/core/error.h"
#include "limber/document/gltf/gltf.h"

namespace limber {

// A value inside a document together with its path ("meshes[0].primitives[2]"). May represent an absent value: an
// absent array has size 0, an absent object has no members.
//
// Cheap to copy. Valid as long as the JSON is not changed; the keys given to it must live as long (literals do). Every
// getter throws Error kBadData, with the path in where(), if what is there has the wrong type.
class JsonView {
 public:
  explicit JsonView(const Json& root) : value_(&root) {}
  // A value at `location` of a larger one; null: absent. `location` must live as long.
  JsonView(const Json* value, std::string_view location) : value_(value), steps_{Step{location}}, depth_(1) {}

  bool exists() const { return value_ != nullptr; }
  const Json& json() const { return *value_; }  // only where exists()
  std::string path() const;
  [[noreturn]] void fail(std::string message) const;  // Error kBadData at this path

  // Members of an object. member: whatever is there, absent if nothing is. The others check the type of what is there
  // and are absent, or the given default, where the key is missing.
  JsonView member(std::string_view key) const;
  JsonView object(std::string_view key) const;
  JsonView array(std::string_view key) const;
  std::string_view text(std::string_view key, std::string_view byDefault = {}) const;
  double number(std::string_view key, double byDefault) const;  // finite
  bool flag(std::string_view key, bool byDefault) const;
  std::optional<std::size_t> count(std::string_view key) const;  // a whole number from 0 to 2^53
  // A whole number below `limit`: the index of an element in an array of that size.
  std::optional<Index> index(std::string_view key, std::size_t limit) const;
  Index requireIndex(std::string_view key, std::size_t limit) const;

  // Elements of an array (size() == 0 where absent).
  std::size_t size() const;
  JsonView operator[](std::size_t element) const;

  // This value itself.
  const Json& requireObject() const;
  double asNumber() const;
  std::size_t asCount() const;
  Index asIndex(std::size_t limit) const;

  // Visits each member of an object (none where absent), in order.
  void forEachMember(const std::function<void(std::string_view key, const JsonView& value)>& visit) const;

 private:
  struct Step {
    std::string_view key = {};  // data() is null: an array element
    std::size_t element = 0;
  };
  static constexpr std::size_t kSteps = 10;  // longer paths are shortened to this in messages

  JsonView step(const Json* value, Step step) const;

  const Json* value_ = nullptr;
  std::array<Step, kSteps> steps_;
  std::size_t depth_ = 0;
};

// A member of a JSON object; null where it has none of that name, or is no object.
const Json* member(const Json& object, const char* key);

}  // namespace limber
