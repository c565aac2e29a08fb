#include "limber/document/scene/shape_name.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"

namespace limber {

std::string shapeName(const gltf::Mesh& mesh, std::size_t shape) {
  const Json* names = mesh.extras.exists() ? member(*mesh.extras, "targetNames") : nullptr;
  if (names && names->is_array() && shape < names->size() && (*names)[shape].is_string()) {
    return (*names)[shape].get<std::string>();
  }
  return fmt::format("shape_{}", shape);
}

}  // namespace limber
