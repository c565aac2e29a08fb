#include "limber/rigging/curve_skeleton/curve_skeleton.h"

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "limber/core/disjoint_sets.h"
#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/testing/capsule.h"
#include "limber/geometry/surface/testing/shape_meshes.h"

namespace limber {

namespace {

CurveSkeleton curvesOf(const TriMesh& mesh) {
  Progress progress;
  return CurveSkeleton::build(mesh, progress);
}

// Rings of `around` points about (u, v) -> position; the last ring meets the first where it `closes`.
TriMesh ringsOf(int rings, int around, bool closes, const std::function<Vec3(double, double)>& position) {
  TriMesh mesh;
  for (int r = 0; r < rings; ++r) {
    for (int i = 0; i < around; ++i) {
      const double u = closes ? 2 * kPi * r / rings : r / (rings - 1.0);
      mesh.positions.push_back(position(u, 2 * kPi * i / around).cast<float>());
    }
  }
  const auto at = [&](int r, int i) { return static_cast<Index>(r % rings * around + i % around); };
  for (int r = 0; r + !closes < rings; ++r) {
    for (int i = 0; i < around; ++i) {
      mesh.triangles.push_back({at(r, i), at(r, i + 1), at(r + 1, i)});
      mesh.triangles.push_back({at(r, i + 1), at(r + 1, i + 1), at(r + 1, i)});
    }
  }
  return mesh;
}

TriMesh openCylinder() {
  return ringsOf(60, 24, false,
                 [](double u, double angle) { return Vec3(0.1 * std::cos(angle), 0.1 * std::sin(angle), u); });
}

TriMesh torus() {
  return ringsOf(60, 20, true, [](double u, double angle) {
    const double thick = 0.15 + 0.03 * std::sin(u) + 0.02 * std::cos(2 * u + 1), radius = 1 + thick * std::cos(angle);
    return Vec3(radius * std::cos(u), radius * std::sin(u), thick * std::sin(angle) + 0.1 * std::sin(3 * u + 0.5));
  });
}

// Three arms of 2 x 2 cubes from the origin, along +x, -x and +y, of different lengths.
TriMesh threeArms() {
  std::set<std::array<int, 3>> cells;
  const auto fill = [&](int x0, int x1, int y0, int y1) {
    for (int x = x0; x < x1; ++x) {
      for (int y = y0; y < y1; ++y) cells.insert({{x, y, -1}}), cells.insert({{x, y, 0}});
    }
  };
  fill(-9, 14, -1, 1);
  fill(-1, 1, -1, 11);
  return testing::subdivided(testing::cubes(cells));
}

std::vector<int> degreesOf(const SphereMeshLevel& level) {
  std::vector<int> degree(level.spheres.size(), 0);
  for (const auto& [a, b] : level.edges) {
    ++degree[a];
    ++degree[b];
  }
  return degree;
}

void expectSoundTree(const SphereMeshLevel& level, Index count) {
  ASSERT_EQ(level.spheres.size(), count);
  ASSERT_EQ(level.edges.size() + 1, count);
  DisjointSets sets(count);
  for (const auto& [a, b] : level.edges) sets.unite(a, b);
  EXPECT_EQ(sets.count(), 1u);
  double weight = 0;
  for (Index h = 0; h < count; ++h) {
    EXPECT_TRUE(level.spheres[h].center.allFinite());
    EXPECT_GE(level.spheres[h].radius, 0);
    weight += level.weights[h];
  }
  EXPECT_NEAR(weight, 1, 1e-9);
}

TEST(CurveSkeleton, OfACylinderIsItsAxis) {
  const SphereMeshLevel curves = curvesOf(openCylinder()).curves();
  const std::vector<int> degree = degreesOf(curves);
  EXPECT_EQ(std::count(degree.begin(), degree.end(), 1), 2);
  EXPECT_EQ(*std::max_element(degree.begin(), degree.end()), 2);
  Box box;
  for (std::size_t n = 0; n < curves.spheres.size(); ++n) {
    const Vec3& p = curves.spheres[n].center;
    EXPECT_LT(std::hypot(p.x(), p.y()), 0.1 * 0.1) << n;  // a tenth of the radius
    box.add(p);
  }
  EXPECT_LT(box.min.z(), 0.15);
  EXPECT_GT(box.max.z(), 0.85);
}

TEST(CurveSkeleton, OfThreeArmsHasOneBranchAndThreeEnds) {
  const CurveSkeleton skeleton = curvesOf(threeArms());
  const SphereMeshLevel joints = skeleton.level(4);
  const std::vector<int> degree = degreesOf(joints);
  ASSERT_EQ(std::count(degree.begin(), degree.end(), 3), 1);
  ASSERT_EQ(std::count(degree.begin(), degree.end(), 1), 3);
  const std::size_t branch = static_cast<std::size_t>(std::find(degree.begin(), degree.end(), 3) - degree.begin());
  EXPECT_LT(joints.spheres[branch].center.norm(), 1.5);  // the arms are 2 wide
  for (const Vec3& tip : {Vec3(14, 0, 0), Vec3(-9, 0, 0), Vec3(0, 11, 0)}) {
    double nearest = 1e9;
    for (const Sphere& sphere : joints.spheres) nearest = std::min(nearest, (sphere.center - tip).norm());
    EXPECT_LT(nearest, 2) << tip.transpose();
  }
}

TEST(CurveSkeleton, OfATorusIsALoopThatBecomesATree) {
  const CurveSkeleton skeleton = curvesOf(torus());
  const SphereMeshLevel& curves = skeleton.curves();
  EXPECT_EQ(curves.edges.size(), curves.spheres.size());
  for (const Sphere& sphere : curves.spheres) {
    EXPECT_NEAR(std::hypot(sphere.center.x(), sphere.center.y()), 1, 0.03);
  }
  const SphereMeshLevel joints = skeleton.level(12);
  expectSoundTree(joints, 12);
  const std::vector<int> degree = degreesOf(joints);
  EXPECT_EQ(*std::max_element(degree.begin(), degree.end()), 2);
}

TEST(CurveSkeleton, OfAPersonOfBlocksHasFiveEnds) {
  const CurveSkeleton skeleton = curvesOf(testing::blockBiped(1));
  const SphereMeshLevel joints = skeleton.level(12);
  const std::vector<int> degree = degreesOf(joints);
  EXPECT_EQ(std::count(degree.begin(), degree.end(), 1), 5);
  for (const Vec3& tip :
       {Vec3(5.5, 7.5, 0), Vec3(-5.5, 7.5, 0), Vec3(1.5, -0.5, 0), Vec3(-1.5, -0.5, 0), Vec3(0, 9.5, 0)}) {
    double nearest = 1e9;
    for (const Sphere& sphere : joints.spheres) nearest = std::min(nearest, (sphere.center - tip).norm());
    EXPECT_LT(nearest, 1) << tip.transpose();
  }
}

TEST(CurveSkeleton, JoinsPiecesWhereTheyMeet) {
  TriMesh mesh;
  testing::addCapsule(mesh, {0, 0, 0}, {1, 0, 0}, 0.1);
  testing::addCapsule(mesh, {0.5, 0, 0}, {0.5, 1, 0.1}, 0.08);
  testing::addCapsule(mesh, {0.8, 0, 0}, {0.9, -0.7, 0.2}, 0.06);
  const SphereMeshLevel joints = curvesOf(mesh).level(9);
  expectSoundTree(joints, 9);
  const std::vector<int> degree = degreesOf(joints);
  EXPECT_EQ(std::count(degree.begin(), degree.end(), 1), 4);
}

TEST(CurveSkeleton, TakesEveryMeshOrSaysWhyNot) {
  const std::set<std::string> flat = {"zero area",  "nothing but zero area", "all at one point", "points alone",
                                      "one vertex", "one triangle",          "flat grid"};
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    SCOPED_TRACE(name);
    if (flat.count(name)) {
      try {
        curvesOf(mesh);
        ADD_FAILURE() << "took it";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
        EXPECT_NE(error.remedy().find("sphere-mesh"), std::string::npos);
      }
      continue;
    }
    const CurveSkeleton skeleton = curvesOf(mesh);
    EXPECT_EQ(skeleton.vertexCount(), mesh.vertexCount());
    for (const Index count : {1u, 2u, 3u, 7u, 20u}) expectSoundTree(skeleton.level(count), count);
  }
}

TEST(CurveSkeleton, OfASymmetricBodyIsItsOwnMirrorImage) {
  for (const TriMesh& mesh : {testing::blockBiped(1), testing::shuffled(testing::blockBiped(1))}) {
    const CurveSkeleton skeleton = curvesOf(mesh);
    ASSERT_TRUE(skeleton.mirror());
    for (const Index count : {5u, 8u, 13u, 20u, 41u}) {
      const SphereMeshLevel level = skeleton.level(count);
      for (Index h = 0; h < count; ++h) {
        const Vec3 p = level.spheres[h].center;
        EXPECT_EQ(level.spheres[level.images[h]].center, Vec3(-p.x(), p.y(), p.z()));
      }
    }
  }
}

TEST(CurveSkeleton, IsTheSameForAnyNumberOfThreads) {
  const TriMesh mesh = testing::jittered(testing::blockBiped(2), 0.2f);
  std::vector<SphereMeshLevel> levels;
  for (const int threads : {1, 4}) {
    setThreadCount(threads);
    levels.push_back(curvesOf(mesh).level(25));
  }
  setThreadCount(0);
  for (Index h = 0; h < 25; ++h) EXPECT_EQ(levels[0].spheres[h].center, levels[1].spheres[h].center);
  EXPECT_EQ(levels[0].edges, levels[1].edges);
}

// The curves do not follow how finely a model is made.
TEST(CurveSkeleton, ComesNearToTheSameOnAFinerMesh) {
  const SphereMeshLevel coarse = curvesOf(testing::blockBiped(0)).level(12);
  const SphereMeshLevel fine = curvesOf(testing::blockBiped(2)).level(12);
  for (const Sphere& sphere : fine.spheres) {
    double nearest = 1e9;
    for (const Sphere& other : coarse.spheres) nearest = std::min(nearest, (sphere.center - other.center).norm());
    EXPECT_LT(nearest, 1);
  }
}

}  // namespace

}  // namespace limber
