#include "limber/document/vrm/vrm_meta.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace limber {
namespace {

Json vrm0(const char* license) {
  return {{"title", "Alicia"},
          {"author", "Somebody"},
          {"allowedUserName", "Everyone"},
          {"violentUssageName", "Disallow"},
          {"sexualUssageName", "Allow"},
          {"commercialUssageName", "Allow"},
          {"licenseName", license},
          {"otherPermissionUrl", "https://example.org/rules"}};
}

TEST(VrmMeta, EachPermissionIsAMemberOfItsOwn) {
  for (const std::string& permission : vrmPermissions()) {
    VrmMeta said;
    said.name = "a";
    said.authors = {"b"};
    Warnings warnings;
    const Json narrow = vrmMeta(said, nullptr, "", warnings);
    said.allowed = {permission};
    const Json wide = vrmMeta(said, nullptr, "", warnings);
    std::size_t changed = 0;
    for (const auto& [key, value] : wide.items()) changed += narrow.at(key) != value ? 1 : 0;
    EXPECT_EQ(changed, 1u) << permission;
  }
  VrmMeta unknown;
  unknown.allowed = {"anything"};
  Warnings warnings;
  EXPECT_THROW(vrmMeta(unknown, nullptr, "", warnings), Error);
}

TEST(VrmMeta, OfVrm0) {
  const Json meta = vrmMetaOfVrm0(vrm0("Other"), 5);
  EXPECT_EQ(meta["name"], "Alicia");
  EXPECT_EQ(meta["authors"], Json::array({"Somebody"}));
  EXPECT_EQ(meta["avatarPermission"], "everyone");
  EXPECT_EQ(meta["allowExcessivelyViolentUsage"], false);
  EXPECT_EQ(meta["allowExcessivelySexualUsage"], true);
  EXPECT_EQ(meta["commercialUsage"], "personalProfit");
  EXPECT_EQ(meta["modification"], "prohibited");
  EXPECT_EQ(meta["allowRedistribution"], false);
  EXPECT_EQ(meta["allowAntisocialOrHateUsage"], false);  // 0.x does not ask
  EXPECT_EQ(meta["otherLicenseUrl"], "https://example.org/rules");
  EXPECT_EQ(meta["thumbnailImage"], 5);
}

// What each licence of 0.x lets others do; nothing more may come out, whatever else is said.
TEST(VrmMeta, LicensesOfVrm0AreNeverWidened) {
  struct Row {
    const char* name;
    bool redistribution, changes, changedCopies, profit, noCredit;
  };
  for (const Row& row : {Row{"Redistribution_Prohibited", false, false, false, true, false},
                         {"CC0", true, true, true, true, true},
                         {"CC_BY", true, true, true, true, false},
                         {"CC_BY_NC", true, true, true, false, false},
                         {"CC_BY_SA", true, true, true, true, false},
                         {"CC_BY_NC_SA", true, true, true, false, false},
                         {"CC_BY_ND", true, false, false, true, false},
                         {"CC_BY_NC_ND", true, false, false, false, false},
                         {"Other", false, false, false, true, false},
                         {"Unheard of", false, false, false, true, false}}) {
    const Json meta = vrmMetaOfVrm0(vrm0(row.name), std::nullopt);
    EXPECT_LE(meta["allowRedistribution"].get<bool>(), row.redistribution) << row.name;
    EXPECT_LE(meta["modification"] != "prohibited", row.changes) << row.name;
    EXPECT_LE(meta["modification"] == "allowModificationRedistribution", row.changedCopies) << row.name;
    EXPECT_LE(meta["commercialUsage"] != "personalNonProfit", row.profit) << row.name;
    EXPECT_LE(meta["creditNotation"] == "unnecessary", row.noCredit) << row.name;
    EXPECT_NE(meta["commercialUsage"], "corporation") << row.name;
  }
}

TEST(VrmMeta, OfVrm0InAnyShape) {
  for (const Json& odd : {Json(), Json::array({1}), Json("text"),
                          Json{{"title", 3}, {"author", Json::object()}, {"allowedUserName", 7}}}) {
    const Json meta = vrmMetaOfVrm0(odd, std::nullopt);
    EXPECT_EQ(meta["avatarPermission"], "onlyAuthor");
    EXPECT_FALSE(meta.contains("name"));
  }
}

}  // namespace
}  // namespace limber
