#include "limber/geometry/mesh/prepare.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include <gtest/gtest.h>

namespace limber {
namespace {

const std::vector<Vec3f> kSquare = {{0, 0, 0}, {2, 0, 0}, {2, 4, 0}, {0, 4, 0}};
const std::vector<Triangle> kSquareTriangles = {{0, 1, 2}, {0, 2, 3}};

ErrorCode errorCodeOf(const std::vector<Vec3f>& positions, const std::vector<Triangle>& triangles) {
  try {
    prepareMesh(positions, triangles);
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::kCancelled;
}

TEST(PrepareMesh, CentresAndScalesByTheLongestSide) {
  std::vector<Vec3f> positions = kSquare;
  for (Vec3f& p : positions) p += Vec3f(100, -7, 3);
  const PreparedMesh prepared = prepareMesh(positions, kSquareTriangles);
  EXPECT_DOUBLE_EQ(prepared.frame.scale, 4);
  EXPECT_TRUE(prepared.frame.offset.isApprox(Vec3(101, -5, 3)));
  Box box;
  for (Index v = 0; v < prepared.mesh.vertexCount(); ++v) {
    box.add(prepared.mesh.position(v));
    EXPECT_TRUE(prepared.frame.toSource(prepared.mesh.position(v)).isApprox(positions[v].cast<double>(), 1e-6));
  }
  EXPECT_LT(box.center().norm(), 1e-7);
  EXPECT_DOUBLE_EQ(box.longestSide(), 1);
  EXPECT_TRUE(prepared.warnings.empty());
}

TEST(PrepareMesh, TheFrameIsItsOwnInverse) {
  const WorkingFrame frame{2.5, Vec3(1, 2, 3)};
  EXPECT_TRUE(frame.toWorking(frame.toSource(Vec3(4, 5, 6))).isApprox(Vec3(4, 5, 6)));
}

TEST(PrepareMesh, WeldsWhatRoundingExplains) {
  const float next = std::nextafter(1.0f, 2.0f);
  const std::vector<Vec3f> positions = {{0, 0, 0},         {1, 0, 0}, {0, 1, 0},      {-0.0f, 0, -0.0f},
                                        {next, -1e-8f, 0}, {0, 1, 0}, {1.0001f, 0, 0}};
  const PreparedMesh prepared = prepareMesh(positions, std::vector<Triangle>{{0, 1, 2}, {3, 6, 5}, {0, 4, 2}});
  EXPECT_EQ(prepared.weldedVertex, (std::vector<Index>{0, 1, 2, 0, 1, 2, 3}));
  EXPECT_EQ(prepared.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}, {0, 1, 2}}));
  EXPECT_TRUE(prepared.frame.toSource(prepared.mesh.position(1)).isApprox(Vec3(1, 0, 0), 1e-6));
}

TEST(PrepareMesh, WeldsAsABruteForceDoes) {
  std::mt19937 random(7);
  std::vector<Vec3f> positions;
  for (int i = 0; i < 3000; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random() % 9) - 4.0f; };
    positions.push_back({coordinate(), coordinate(), coordinate()});
  }
  std::vector<Triangle> triangles;
  for (Index t = 0; t + 2 < positions.size(); t += 3) triangles.push_back({t, t + 1, t + 2});
  const PreparedMesh prepared = prepareMesh(positions, triangles);

  std::map<std::tuple<float, float, float>, Index> numbers;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const auto key = std::make_tuple(positions[v].x(), positions[v].y(), positions[v].z());
    const Index expected = numbers.try_emplace(key, static_cast<Index>(numbers.size())).first->second;
    ASSERT_EQ(prepared.weldedVertex[v], expected);
  }
  EXPECT_EQ(prepared.mesh.vertexCount(), numbers.size());
}

TEST(PrepareMesh, TrianglesWithARepeatedCornerGoThinOnesStay) {
  const std::vector<Vec3f> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {2, 0, 0}};
  // A sound one, one with a corner twice, one whose corners are at two positions, one with its corners on a line.
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 1, 2}, {0, 3, 1}, {0, 1, 4}};
  const PreparedMesh prepared = prepareMesh(positions, triangles);
  EXPECT_EQ(prepared.mesh.triangleCount(), 2u);
  ASSERT_EQ(prepared.warnings.items().size(), 1u);
  EXPECT_EQ(prepared.warnings.items()[0].kind, "degenerate-triangles");
  EXPECT_EQ(prepared.warnings.items()[0].count, 2u);
}

TEST(PrepareMesh, LooseVerticesAreKeptAndDoNotShrinkTheModel) {
  std::vector<Vec3f> positions = kSquare;
  positions.push_back({1e6f, 0, 0});
  const PreparedMesh prepared = prepareMesh(positions, kSquareTriangles);
  EXPECT_DOUBLE_EQ(prepared.frame.scale, 4);
  EXPECT_EQ(prepared.mesh.vertexCount(), 5u);
  EXPECT_EQ(prepared.weldedVertex[4], 4u);
  ASSERT_EQ(prepared.warnings.items().size(), 1u);
  EXPECT_EQ(prepared.warnings.items()[0].kind, "far-vertices");
  positions.back() = {6, 0, 0};
  EXPECT_TRUE(prepareMesh(positions, kSquareTriangles).warnings.empty());
}

TEST(PrepareMesh, AFarBitDoesNotShrinkTheModelAndIsTold) {
  std::vector<Vec3f> positions = kSquare;
  for (const Vec3f& p : kSquare) positions.push_back(0.1f * p + Vec3f(100, 0, 0));
  std::vector<Triangle> triangles = kSquareTriangles;
  triangles.push_back({4, 5, 6});
  const PreparedMesh prepared = prepareMesh(positions, triangles);
  EXPECT_DOUBLE_EQ(prepared.frame.scale, 4);
  EXPECT_EQ(prepared.mesh.triangleCount(), 3u);
  EXPECT_TRUE(prepared.frame.toSource(prepared.mesh.position(4)).isApprox(Vec3(100, 0, 0), 1e-6));
  ASSERT_EQ(prepared.warnings.items().size(), 1u);
  EXPECT_EQ(prepared.warnings.items()[0].kind, "far-vertices");
  EXPECT_EQ(prepared.warnings.items()[0].count, 4u);
}

TEST(PrepareMesh, TinyAndHugeModelsBecomeTheSame) {
  const PreparedMesh unit = prepareMesh(kSquare, kSquareTriangles);
  for (const float scale : {1e-20f, 1e20f}) {
    std::vector<Vec3f> positions;
    for (const Vec3f& p : kSquare) positions.push_back(scale * p);
    const PreparedMesh prepared = prepareMesh(positions, kSquareTriangles);
    for (Index v = 0; v < 4; ++v) {
      EXPECT_TRUE(prepared.mesh.positions[v].isApprox(unit.mesh.positions[v], 1e-6f)) << scale;
    }
  }
}

TEST(PrepareMesh, ALooseVertexTooFarOffForSinglePrecisionIsBroughtNear) {
  std::vector<Vec3f> positions;
  for (const Vec3f& p : kSquare) positions.push_back(1e-5f * p);
  positions.push_back(Vec3f(1e34f, 0, 0));
  const PreparedMesh prepared = prepareMesh(positions, kSquareTriangles);
  EXPECT_TRUE(prepared.mesh.positions[4].allFinite());
  EXPECT_GT(prepared.mesh.positions[4].x(), 100);
  ASSERT_EQ(prepared.warnings.items().size(), 1u);
  EXPECT_EQ(prepared.warnings.items()[0].kind, "far-vertices");
}

TEST(PrepareMesh, RefusesWhatItCannotUse) {
  EXPECT_EQ(errorCodeOf(kSquare, {}), ErrorCode::kBadData);
  EXPECT_EQ(errorCodeOf(kSquare, {{0, 0, 1}}), ErrorCode::kBadData);
  EXPECT_EQ(errorCodeOf(kSquare, {{0, 1, 4}}), ErrorCode::kBadArgument);
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    std::vector<Vec3f> positions = kSquare;
    positions[2].y() = bad;
    EXPECT_EQ(errorCodeOf(positions, kSquareTriangles), ErrorCode::kBadData);
  }
}

}  // namespace
}  // namespace limber
