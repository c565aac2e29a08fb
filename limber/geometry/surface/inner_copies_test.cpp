#include "limber/geometry/surface/inner_copies.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "limber/geometry/mesh/normals.h"
#include "limber/geometry/surface/testing/dressed_figure.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {
namespace {

using testing::movedInwards;

std::vector<InnerCopy> copiesIn(const TriMesh& mesh) {
  return innerCopies(mesh, SurfaceComponents::of(mesh).list);
}

// How many of the copies are of vertices from `first` on, and lie within those before.
std::size_t laterOnes(const TriMesh& mesh, Index first) {
  const SurfaceComponents components = SurfaceComponents::of(mesh);
  const std::vector<InnerCopy> copies = innerCopies(mesh, components.list);
  return static_cast<std::size_t>(std::count_if(copies.begin(), copies.end(), [&](const InnerCopy& copy) {
    return components.list[copy.inner].vertices.front() >= first &&
           components.list[copy.outer].vertices.front() < first;
  }));
}

TEST(InnerCopies, OpenComponentsAreFoundVertexByVertex) {
  const TriMesh figure = testing::openFigure();
  for (const bool facesInwards : {false, true}) {
    TriMesh inner = movedInwards(figure, 0.1f);
    if (facesInwards) {
      for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
    }
    const TriMesh mesh = testing::joined(figure, inner);
    const SurfaceComponents components = SurfaceComponents::of(mesh);
    const std::vector<InnerCopy> copies = innerCopies(mesh, components.list);
    EXPECT_EQ(copies.size(), 4u);
    for (const auto& [outer, of, isVertexByVertex] : copies) {
      EXPECT_TRUE(isVertexByVertex);
      EXPECT_EQ(components.list[outer].vertices.front() + figure.vertexCount(), components.list[of].vertices.front());
    }
    const TriMesh reversed = testing::joined(inner, figure);
    EXPECT_EQ(laterOnes(mesh, figure.vertexCount()), 4u);
    EXPECT_EQ(laterOnes(reversed, figure.vertexCount()), 0u);
  }
}

// The copy of a band that is thinner than it is deep comes out on the other side.
TEST(InnerCopies, CopiesOfThinComponentsAreInTheOrderOfTheOthers) {
  TriMesh band = testing::ball(2);
  for (Vec3f& p : band.positions) p = Vec3f(0.5f * p.x(), 0.5f * p.y() + 12, 0.04f * p.z());
  const TriMesh figure = testing::joined(testing::openFigure(), band);
  EXPECT_EQ(laterOnes(testing::joined(figure, movedInwards(figure, 0.1f)), figure.vertexCount()), 5u);
}

TEST(InnerCopies, ACopyWithOtherTrianglesIsOneByItsShape) {
  const TriMesh figure = testing::openFigure();
  const TriMesh finer = testing::subdivided(movedInwards(figure, 0.1f));
  EXPECT_EQ(laterOnes(testing::joined(figure, finer), figure.vertexCount()), 4u);
  const TriMesh shuffled = testing::shuffled(movedInwards(figure, 0.1f));
  EXPECT_EQ(laterOnes(testing::joined(figure, shuffled), figure.vertexCount()), 4u);
}

TEST(InnerCopies, ABodyUnderItsClothesIsNone) {
  const TriMesh body = testing::blockBiped(1), clothes = testing::openFigure();
  EXPECT_TRUE(copiesIn(testing::joined(body, movedInwards(clothes, -0.2f))).empty());
  EXPECT_TRUE(copiesIn(clothes).empty());
}

// Each leaf has others of the same triangles within a copy's distance.
TEST(InnerCopies, LeavesOfABushAreNone) {
  TriMesh bush;
  for (int i = 0; i < 600; ++i) {
    const float x = 0.04f * static_cast<float>(i % 8), y = 0.04f * static_cast<float>(i / 8 % 8);
    const Vec3f middle(x, y, 0.04f * static_cast<float>(i / 64));
    TriMesh leaf = testing::ball(1);
    for (Vec3f& p : leaf.positions) p = 0.008f * p + middle;
    bush = testing::joined(bush, leaf);
  }
  TriMesh pole = testing::ball(1);
  for (Vec3f& p : pole.positions) p = Vec3f(0.01f * p.x() - 0.2f, p.y(), 0.01f * p.z());
  EXPECT_TRUE(copiesIn(testing::joined(bush, pole)).empty());
}

TEST(InnerCopies, AnEyeAndALensInAFigureAreNone) {
  TriMesh mesh = testing::openFigure();
  for (const float x : {-0.4f, 0.4f}) {
    for (const float radius : {0.2f, 0.21f}) {
      TriMesh eye = testing::ball(2);
      for (Vec3f& p : eye.positions) p *= radius;
      mesh = testing::joined(mesh, eye, {x, 9, 0.6f});
    }
  }
  EXPECT_TRUE(copiesIn(mesh).empty());
}

}  // namespace
}  // namespace limber
