#include "limber/document/gltf/json_access.h"

#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

// Doubles hold every whole number up to here.
constexpr double kLargestCount = 9007199254740992.0;

}  // namespace

std::string JsonView::path() const {
  std::string text;
  for (std::size_t i = 0; i < depth_; ++i) {
    if (steps_[i].key.data() == nullptr) {
      text += fmt::format("[{}]", steps_[i].element);
    } else {
      if (!text.empty()) text += '.';
      text += steps_[i].key;
    }
  }
  return text;
}

void JsonView::fail(std::string message) const {
  throw Error(ErrorCode::kBadData, std::move(message), path());
}

JsonView JsonView::step(const Json* value, Step next) const {
  JsonView result = *this;
  result.value_ = value;
  if (result.depth_ == kSteps) --result.depth_;
  result.steps_[result.depth_++] = next;
  return result;
}

const Json& JsonView::requireObject() const {
  if (!exists()) fail("is missing");
  if (!value_->is_object()) fail("must be an object");
  return *value_;
}

JsonView JsonView::member(std::string_view key) const {
  if (!exists()) return step(nullptr, {key, 0});
  for (const auto& [name, value] : requireObject().get_ref<const Json::object_t&>()) {
    if (name == key) return step(&value, {key, 0});
  }
  return step(nullptr, {key, 0});
}

JsonView JsonView::object(std::string_view key) const {
  const JsonView found = member(key);
  if (found.exists()) found.requireObject();
  return found;
}

JsonView JsonView::array(std::string_view key) const {
  const JsonView found = member(key);
  if (found.exists() && !found.json().is_array()) found.fail("must be an array");
  return found;
}

void JsonView::forEachMember(const std::function<void(std::string_view, const JsonView&)>& visit) const {
  if (!exists()) return;
  for (const auto& [key, value] : requireObject().get_ref<const Json::object_t&>()) visit(key, step(&value, {key, 0}));
}

std::string_view JsonView::text(std::string_view key, std::string_view byDefault) const {
  const JsonView found = member(key);
  if (!found.exists()) return byDefault;
  if (!found.json().is_string()) found.fail("must be a string");
  return found.json().get_ref<const std::string&>();
}

double JsonView::number(std::string_view key, double byDefault) const {
  const JsonView found = member(key);
  return found.exists() ? found.asNumber() : byDefault;
}

bool JsonView::flag(std::string_view key, bool byDefault) const {
  const JsonView found = member(key);
  if (!found.exists()) return byDefault;
  if (!found.json().is_boolean()) found.fail("must be true or false");
  return found.json().get<bool>();
}

std::optional<std::size_t> JsonView::count(std::string_view key) const {
  const JsonView found = member(key);
  if (!found.exists()) return std::nullopt;
  return found.asCount();
}

std::optional<Index> JsonView::index(std::string_view key, std::size_t limit) const {
  const JsonView found = member(key);
  if (!found.exists()) return std::nullopt;
  return found.asIndex(limit);
}

Index JsonView::requireIndex(std::string_view key, std::size_t limit) const {
  const JsonView found = member(key);
  if (!found.exists()) found.fail("is missing");
  return found.asIndex(limit);
}

std::size_t JsonView::size() const {
  if (!exists()) return 0;
  if (!value_->is_array()) fail("must be an array");
  return value_->size();
}

JsonView JsonView::operator[](std::size_t element) const {
  const std::size_t elements = size();
  const JsonView found = step(element < elements ? &(*value_)[element] : nullptr, {{}, element});
  if (!found.exists()) found.fail(fmt::format("is missing: there are {} elements", elements));
  return found;
}

double JsonView::asNumber() const {
  if (!exists()) fail("is missing");
  if (!value_->is_number()) fail("must be a number");
  const double number = value_->get<double>();
  if (!std::isfinite(number)) fail("must be finite");
  return number;
}

std::size_t JsonView::asCount() const {
  const double number = asNumber();
  if (number < 0 || number > kLargestCount || number != std::floor(number)) {
    fail(fmt::format("must be a whole number that is not negative, and is {}", number));
  }
  if (number > static_cast<double>(std::numeric_limits<std::size_t>::max())) {  // of 32 bits in WebAssembly
    fail(fmt::format("is {}, more than can be counted here", number));
  }
  return static_cast<std::size_t>(number);
}

Index JsonView::asIndex(std::size_t limit) const {
  const std::size_t number = asCount();
  if (number >= limit || number >= kNoIndex) {
    fail(limit == 0 ? fmt::format("is {}, but there is no such element", number)
                    : fmt::format("is {}, but the last one is {}", number, limit - 1));
  }
  return static_cast<Index>(number);
}

const Json* member(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

}  // namespace limber
