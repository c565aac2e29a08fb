#include "limber/asset/asset.h"

#include <nlohmann/json.hpp>

namespace limber {

Asset::Asset() : json_(std::make_unique<Json>(Json::object())) {}
Asset::Asset(Asset&&) noexcept = default;
Asset& Asset::operator=(Asset&&) noexcept = default;
Asset::~Asset() = default;

Asset Asset::clone() const {
  Asset copy;
  *copy.json_ = *json_;
  copy.buffers = buffers;
  copy.sideFiles = sideFiles;
  copy.name = name;
  copy.format = format;
  copy.warnings = warnings;
  return copy;
}

}  // namespace limber
