// Whose a VRM is, and what others may do with it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "limber/core/error.h"
#include "limber/document/gltf/gltf.h"

namespace limber {

// What a user says of a model. What is not said is as narrow as VRM knows it.
struct VrmMeta {
  std::optional<std::string> name;
  std::vector<std::string> authors;
  std::optional<std::string> license;  // where a licence of its own is to be read (otherLicenseUrl)
  std::optional<std::string> copyright, contact, version;
  std::vector<std::string> allowed;  // of vrmPermissions()
};

// What can be allowed: "everyone", "violence", ...
std::vector<std::string> vrmPermissions();

// "meta" of VRMC_vrm 1.0. `kept` is that of the model as it was read, none: null. What the user gives replaces the
// names, authors and addresses there; permissions of a model that has some are not changed. Required fields that nobody
// has given are marked as to be filled in, with a warning "vrm-meta".
//
// Throws Error kBadArgument where permissions are given for a model that has its own, or a permission is unknown.
Json vrmMeta(const VrmMeta& said, const Json* kept, std::string_view modelName, Warnings& warnings);

// "meta" of VRM 0.x as that of 1.0: no permission is wider than it was, and where 1.0 asks what 0.x did not, the answer
// is no. Creative Commons licences are told apart; those that 1.0 cannot say in full become narrower, and stand in
// otherLicenseUrl.
//
// thumbnail  the image of the texture that it names, if any
Json vrmMetaOfVrm0(const Json& meta, std::optional<Index> thumbnail);

}  // namespace limber
