// Sheets whose triangles are parts by their position: one sample in the middle of each.
#include "limber/rigging/roles/part_contacts.h"

#include <functional>

#include <gtest/gtest.h>

namespace limber {

namespace {

constexpr int kCells = 20;
constexpr double kZigzag = 1.5;  // of a border between triangles, to a straight one

// A sheet from `corner`, `size` large in x and y.
void addSheet(TriMesh& mesh, const Vec3f& corner, const Vec3f& size) {
  const Index first = mesh.vertexCount();
  for (int y = 0; y <= kCells; ++y) {
    for (int x = 0; x <= kCells; ++x) {
      mesh.positions.emplace_back(corner +
                                  size.cwiseProduct(Vec3f(static_cast<float>(x), static_cast<float>(y), 0) / kCells));
    }
  }
  const auto at = [&](int x, int y) { return first + static_cast<Index>(y * (kCells + 1) + x); };
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x + 1, y + 1)});
      mesh.triangles.push_back({at(x, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  }
}

std::vector<PartContact> contactsOf(const TriMesh& mesh, const std::function<std::string_view(const Vec3&)>& partAt,
                                    double height = 1) {
  std::vector<SurfaceSample> samples;
  std::vector<std::string_view> parts;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const Triangle& corners = mesh.triangles[t];
    SurfaceSample& sample = samples.emplace_back();
    sample.position = (mesh.position(corners[0]) + mesh.position(corners[1]) + mesh.position(corners[2])) / 3;
    sample.triangle = t;
    parts.push_back(partAt(sample.position));
  }
  return grownTogether(mesh, samples, parts, height);
}

TriMesh square() {
  TriMesh mesh;
  addSheet(mesh, {0, 0, 0}, {1, 1, 0});
  return mesh;
}

// A square of which one half is of each part.
std::vector<PartContact> contactsBetween(std::string_view one, std::string_view other) {
  return contactsOf(square(), [&](const Vec3& p) { return p.x() < 0.5 ? one : other; });
}

}  // namespace

TEST(PartContacts, AHandIsNotOfTheThigh) {
  const std::vector<PartContact> contacts = contactsBetween("hind_upper.L", "fore_end.L");
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].one, "fore_end.L");
  EXPECT_EQ(contacts[0].other, "hind_upper.L");
  EXPECT_GE(contacts[0].length, 1);
  EXPECT_LE(contacts[0].length, kZigzag);
  for (const auto& [one, other] : {std::pair("fore_end.L", "fore_end.R"), std::pair("hind_lower.L", "hind_lower.R"),
                                   std::pair("fore_lower.L", "trunk"), std::pair("fore_upper.L", "head")}) {
    EXPECT_EQ(contactsBetween(one, other).size(), 1u) << one << " and " << other;
  }
}

TEST(PartContacts, WhatBodiesHaveSideBySideIsNone) {
  for (const auto& [one, other] :
       {std::pair("fore_end.L", "fore_lower.L"), std::pair("trunk", "fore_upper.R"), std::pair("neck", "head"),
        std::pair("hind_upper.L", "hind_upper.R"), std::pair("prop", "fore_end.L"), std::pair("other", "hind_end.R")}) {
    EXPECT_TRUE(contactsBetween(one, other).empty()) << one << " and " << other;
  }
}

// A tenth of a millimetre apart, for a body of one metre.
TEST(PartContacts, SurfacesThatOnlyTouchAreApart) {
  TriMesh mesh;
  addSheet(mesh, {0, 0, 0}, {0.5f, 1, 0});
  addSheet(mesh, {0.5001f, 0, 0}, {0.5f, 1, 0});
  EXPECT_TRUE(contactsOf(mesh, [](const Vec3& p) { return p.x() < 0.50005 ? "fore_end.L" : "hind_upper.L"; }).empty());
}

TEST(PartContacts, LengthsAreOfTheBodysHeight) {
  const auto partAt = [](const Vec3& p) { return p.x() < 0.5 ? "fore_end.L" : "hind_upper.L"; };
  const std::vector<PartContact> contacts = contactsOf(square(), partAt, 10);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_GE(contacts[0].length, 0.1);
  EXPECT_LE(contacts[0].length, 0.1 * kZigzag);
  EXPECT_TRUE(contactsOf(square(), partAt, 50).empty());  // 0.02 heights hold nothing together
}

TEST(PartContacts, TheLongestComesFirst) {
  const std::vector<PartContact> contacts = contactsOf(square(), [](const Vec3& p) {
    if (p.x() < 0.5) return p.y() < 0.3 ? "fore_end.L" : "fore_lower.L";
    return "hind_upper.L";
  });
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_EQ(contacts[0].one, "fore_lower.L");
  EXPECT_EQ(contacts[1].one, "fore_end.L");
  EXPECT_GT(contacts[0].length, contacts[1].length);
}

}  // namespace limber
