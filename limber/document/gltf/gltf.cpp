#include "limber/document/gltf/gltf.h"

#include <algorithm>
#include <atomic>

#include <nlohmann/json.hpp>

namespace limber::gltf {

KeptJson::KeptJson(Json value) : value_(std::make_shared<Json>(std::move(value))) {}

Json& KeptJson::change() {
  if (!value_) {
    value_ = std::make_shared<Json>(Json::object());
  } else if (value_.use_count() > 1) {
    value_ = std::make_shared<Json>(*value_);
  } else {
    std::atomic_thread_fence(std::memory_order_acquire);  // another thread may have read its copy just now
  }
  return *value_;
}

std::optional<Index> Attributes::find(std::string_view name) const {
  for (const auto& [known, accessor] : list_) {
    if (known == name) return accessor;
  }
  return std::nullopt;
}

void Attributes::set(std::string_view name, Index accessor) {
  for (auto& [known, value] : list_) {
    if (known != name) continue;
    value = accessor;
    return;
  }
  list_.emplace_back(name, accessor);
}

bool Attributes::erase(std::string_view name) {
  return std::erase_if(list_, [&](const auto& entry) { return entry.first == name; }) > 0;
}

void Node::clearTransform() {
  matrix.reset();
  translation.reset();
  rotation.reset();
  scale.reset();
}

}  // namespace limber::gltf
