#include "limber/document/vrm/vrm_meta.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "limber/document/gltf/json_access.h"

namespace limber {

namespace {

constexpr const char *kLicenseUrl = "https://vrm.dev/licenses/1.0/", *kToFillIn = "(to be filled in)";

// A permission, and what it says in "meta".
struct Permission {
  const char *name, *key, *value;  // value: none for a flag
};
constexpr std::array<Permission, 12> kPermissions = {{
    {"licensed-persons", "avatarPermission", "onlySeparatelyLicensedPerson"},
    {"everyone", "avatarPermission", "everyone"},
    {"violence", "allowExcessivelyViolentUsage", nullptr},
    {"sexual", "allowExcessivelySexualUsage", nullptr},
    {"profit", "commercialUsage", "personalProfit"},
    {"corporations", "commercialUsage", "corporation"},
    {"politics", "allowPoliticalOrReligiousUsage", nullptr},
    {"hate", "allowAntisocialOrHateUsage", nullptr},
    {"no-credit", "creditNotation", "unnecessary"},
    {"redistribution", "allowRedistribution", nullptr},
    {"modification", "modification", "allowModification"},
    {"modified-redistribution", "modification", "allowModificationRedistribution"},
}};

// Nothing is allowed that need not be.
Json narrowest() {
  return {{"avatarPermission", "onlyAuthor"},
          {"allowExcessivelyViolentUsage", false},
          {"allowExcessivelySexualUsage", false},
          {"commercialUsage", "personalNonProfit"},
          {"allowPoliticalOrReligiousUsage", false},
          {"allowAntisocialOrHateUsage", false},
          {"creditNotation", "required"},
          {"allowRedistribution", false},
          {"modification", "prohibited"}};
}

void allow(Json& meta, const std::string& permission) {
  const auto* found = std::find_if(kPermissions.begin(), kPermissions.end(),
                                   [&](const Permission& known) { return known.name == permission; });
  if (found == kPermissions.end()) {
    throw Error(ErrorCode::kBadArgument, fmt::format("\"{}\" is no permission of VRM", permission), "",
                fmt::format("there are: {}", fmt::join(vrmPermissions(), ", ")));
  }
  meta[found->key] = found->value != nullptr ? Json(found->value) : Json(true);
}

std::string textOf(const Json& object, const char* key) {
  const Json* text = member(object, key);
  return text != nullptr && text->is_string() ? text->get<std::string>() : std::string();
}

bool hasAuthors(const Json& meta) {
  const Json* authors = member(meta, "authors");
  return authors != nullptr && authors->is_array() && !authors->empty();
}

// What a licence that VRM 0.x names says of redistribution and changes; `nonCommercial` narrows that of use, too.
struct NamedLicense {
  const char *name, *url;
  bool redistribution, nonCommercial;
  const char *modification, *credit;
};
constexpr const char *kNoChanges = "prohibited", *kOwnChanges = "allowModification",
                     *kAllChanges = "allowModificationRedistribution";
// Of "non-commercial" licences copies may only be given away, and of "share alike" ones changed copies only under the
// same licence; 1.0 has no word for either, so both are left out.
constexpr std::array<NamedLicense, 7> kNamedLicenses = {{
    {"CC0", "https://creativecommons.org/publicdomain/zero/1.0/", true, false, kAllChanges, "unnecessary"},
    {"CC_BY", "https://creativecommons.org/licenses/by/4.0/", true, false, kAllChanges, "required"},
    {"CC_BY_NC", "https://creativecommons.org/licenses/by-nc/4.0/", false, true, kOwnChanges, "required"},
    {"CC_BY_SA", "https://creativecommons.org/licenses/by-sa/4.0/", true, false, kOwnChanges, "required"},
    {"CC_BY_NC_SA", "https://creativecommons.org/licenses/by-nc-sa/4.0/", false, true, kOwnChanges, "required"},
    {"CC_BY_ND", "https://creativecommons.org/licenses/by-nd/4.0/", true, false, kNoChanges, "required"},
    {"CC_BY_NC_ND", "https://creativecommons.org/licenses/by-nc-nd/4.0/", false, true, kNoChanges, "required"},
}};

}  // namespace

std::vector<std::string> vrmPermissions() {
  std::vector<std::string> names;
  for (const Permission& permission : kPermissions) names.emplace_back(permission.name);
  return names;
}

Json vrmMeta(const VrmMeta& said, const Json* kept, std::string_view modelName, Warnings& warnings) {
  const bool isKept = kept != nullptr && kept->is_object();
  if (isKept && !said.allowed.empty()) {
    throw Error(ErrorCode::kBadArgument, "says itself what is allowed; limber does not change that",
                std::string(modelName), "leave the permissions out");
  }
  Json meta = isKept ? *kept : narrowest();
  for (const std::string& permission : said.allowed) allow(meta, permission);
  const auto say = [&](const char* key, const std::optional<std::string>& text) {
    if (text) meta[key] = *text;
  };
  say("name", said.name);
  say("version", said.version);
  if (!said.authors.empty()) meta["authors"] = said.authors;
  say("copyrightInformation", said.copyright);
  say("contactInformation", said.contact);
  say("otherLicenseUrl", said.license);
  std::vector<std::string> missing;
  if (textOf(meta, "name").empty()) {
    meta["name"] = modelName.empty() ? std::string(kToFillIn) : std::string(modelName);
    if (modelName.empty()) missing.emplace_back("name");
  }
  if (!hasAuthors(meta)) {
    meta["authors"] = Json::array({kToFillIn});
    missing.emplace_back("authors");
  }
  if (textOf(meta, "licenseUrl").empty()) meta["licenseUrl"] = kLicenseUrl;
  if (!isKept && said.allowed.empty()) missing.emplace_back("permissions (all that VRM asks about is denied)");
  warnings.add("vrm-meta", fmt::format("what a VRM says of itself is to be filled in: {}", fmt::join(missing, ", ")),
               {}, missing.empty() ? 0 : 1);
  return meta;
}

Json vrmMetaOfVrm0(const Json& old, std::optional<Index> thumbnail) {
  Json meta = narrowest();
  const auto take = [&](const char* key, const char* oldKey) {
    if (const std::string text = textOf(old, oldKey); !text.empty()) meta[key] = text;
  };
  take("name", "title");
  take("version", "version");
  if (const std::string author = textOf(old, "author"); !author.empty()) meta["authors"] = Json::array({author});
  take("contactInformation", "contactInformation");
  if (const std::string work = textOf(old, "reference"); !work.empty()) meta["references"] = Json::array({work});
  if (thumbnail) meta["thumbnailImage"] = *thumbnail;

  const std::string users = textOf(old, "allowedUserName");
  if (users == "ExplicitlyLicensedPerson") meta["avatarPermission"] = "onlySeparatelyLicensedPerson";
  if (users == "Everyone") meta["avatarPermission"] = "everyone";
  const auto isAllowed = [&](const char* key) { return textOf(old, key) == "Allow"; };
  meta["allowExcessivelyViolentUsage"] = isAllowed("violentUssageName");  // 0.x spells it so
  meta["allowExcessivelySexualUsage"] = isAllowed("sexualUssageName");
  if (isAllowed("commercialUssageName")) meta["commercialUsage"] = "personalProfit";

  std::vector<std::string> addresses;
  const auto addAddress = [&](const std::string& address) {
    const bool isNew = std::find(addresses.begin(), addresses.end(), address) == addresses.end();
    if (!address.empty() && isNew) addresses.push_back(address);
  };
  addAddress(textOf(old, "otherLicenseUrl"));
  addAddress(textOf(old, "otherPermissionUrl"));
  const std::string name = textOf(old, "licenseName");
  const auto* license = std::find_if(kNamedLicenses.begin(), kNamedLicenses.end(),
                                     [&](const NamedLicense& known) { return known.name == name; });
  if (license != kNamedLicenses.end()) {
    addAddress(license->url);
    meta["allowRedistribution"] = license->redistribution;
    meta["modification"] = license->modification;
    meta["creditNotation"] = license->credit;
    if (license->nonCommercial) meta["commercialUsage"] = "personalNonProfit";
  }
  if (!addresses.empty()) meta["otherLicenseUrl"] = fmt::format("{}", fmt::join(addresses, ", "));
  return meta;
}

}  // namespace limber
