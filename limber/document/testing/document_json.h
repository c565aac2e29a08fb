// A document as JSON, for tests: what a file of it would say.
#pragma once

#include <nlohmann/json.hpp>

#include "limber/document/asset.h"
#include "limber/document/gltf/gltf_json.h"

namespace limber::testing {

inline Json documentJson(const Asset& asset) {
  return gltf::jsonOf(asset.document);
}

// Lets edit(Json&) change the document; its bytes stay.
template <typename Edit>
void editDocument(Asset& asset, const Edit& edit) {
  Json json = documentJson(asset);
  edit(json);
  asset.document = gltf::documentOf(std::move(json));
}

}  // namespace limber::testing
