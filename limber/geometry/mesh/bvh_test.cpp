// The tree against brute force in extended precision, and against Embree where that is installed.
#include "limber/geometry/mesh/bvh.h"

#include <random>

#include <gtest/gtest.h>

#ifdef LIMBER_TEST_EMBREE
#include <embree3/rtcore.h>
#endif

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/testing/shapes.h"

namespace limber {
namespace {

using testing::catalogue;
using testing::NamedMesh;

using Vec3l = Eigen::Matrix<long double, 3, 1>;

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : random_(seed) {}
  Vec3 next(double range = 0.8) {
    std::uniform_real_distribution<double> coordinate(-range, range);
    const double x = coordinate(random_), y = coordinate(random_);
    return {x, y, coordinate(random_)};
  }

 private:
  std::mt19937 random_;
};

Vec3l corner(const TriMesh& mesh, const Triangle& t, int k) {
  return mesh.positions[t[k]].cast<long double>();
}

// Cramer's rule for origin + t d = a + u (b - a) + v (c - a).
std::optional<long double> bruteHit(const TriMesh& mesh, const Vec3& origin, const Vec3& direction) {
  std::optional<long double> best;
  const Vec3l o = origin.cast<long double>(), d = direction.cast<long double>();
  for (const Triangle& triangle : mesh.triangles) {
    const Vec3l a = corner(mesh, triangle, 0), e1 = corner(mesh, triangle, 1) - a, e2 = corner(mesh, triangle, 2) - a;
    const long double det = e1.cross(e2).dot(-d);
    if (det == 0) continue;
    const Vec3l s = o - a;
    const long double t = e1.cross(e2).dot(s) / det, u = e2.cross(s).dot(d) / det, v = s.cross(e1).dot(d) / det;
    if (t <= 0 || u < 0 || v < 0 || u + v > 1) continue;
    if (!best || t < *best) best = t;
  }
  return best;
}

// The least squares over each triangle by trying its interior, sides and corners: an active set method that tries all.
long double bruteDistance(const TriMesh& mesh, const Vec3& point) {
  const Vec3l p = point.cast<long double>();
  long double best = std::numeric_limits<long double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3l a = corner(mesh, t, k), e = corner(mesh, t, (k + 1) % 3) - a;
      best = std::min(best, (p - a).norm());
      const long double s = e.squaredNorm() > 0 ? e.dot(p - a) / e.squaredNorm() : 0;
      if (s > 0 && s < 1) best = std::min(best, (p - a - s * e).norm());
    }
    Eigen::Matrix<long double, 3, 2> edges;
    edges << corner(mesh, t, 1) - corner(mesh, t, 0), corner(mesh, t, 2) - corner(mesh, t, 0);
    const Eigen::Matrix<long double, 2, 2> gram = edges.transpose() * edges;
    if (gram.determinant() < 1e-25L) continue;
    const Eigen::Matrix<long double, 2, 1> uv = gram.inverse() * (edges.transpose() * (p - corner(mesh, t, 0)));
    if (uv.minCoeff() < 0 || uv.sum() > 1) continue;
    best = std::min(best, (p - corner(mesh, t, 0) - edges * uv).norm());
  }
  return best;
}

class BvhCatalogue : public ::testing::TestWithParam<NamedMesh> {};

TEST_P(BvhCatalogue, FirstHitIsTheNearestOfAllTriangles) {
  const TriMesh& mesh = GetParam().mesh;
  const Bvh bvh(mesh);
  RandomPoints points(11);
  int hits = 0;
  for (int i = 0; i < 400; ++i) {
    const Vec3 origin = points.next(), direction = points.next() - origin;
    const auto expected = bruteHit(mesh, origin, direction);
    const auto hit = bvh.firstHit(origin, direction, 1e9);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_NEAR(hit->distance, static_cast<double>(*expected), 1e-9 * (1 + hit->distance));
    Vec3 onTriangle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) onTriangle += hit->weights[k] * mesh.position(mesh.triangles[hit->triangle][k]);
    EXPECT_LT((onTriangle - origin - hit->distance * direction).norm(), 1e-9 * (1 + hit->distance));
  }
  EXPECT_GT(hits, 5);
}

TEST_P(BvhCatalogue, BlockedExactlyWhereARayIsStopped) {
  const TriMesh& mesh = GetParam().mesh;
  const Bvh bvh(mesh);
  RandomPoints points(12);
  for (int i = 0; i < 400; ++i) {
    const Vec3 from = points.next(), to = points.next();
    const auto hit = bruteHit(mesh, from, to - from);
    EXPECT_EQ(bvh.segmentBlocked(from, to), hit && *hit < 1) << i;
  }
}

TEST_P(BvhCatalogue, NearestPointIsTheNearestOfAllTriangles) {
  const TriMesh& mesh = GetParam().mesh;
  const Bvh bvh(mesh);
  RandomPoints points(13);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = points.next(i % 10 == 0 ? 50.0 : 0.8);
    const SurfacePoint nearest = bvh.nearestPoint(point);
    EXPECT_NEAR(nearest.distance, static_cast<double>(bruteDistance(mesh, point)), 1e-7) << i;
    EXPECT_NEAR(nearest.weights.sum(), 1, 1e-12);
    EXPECT_GE(nearest.weights.minCoeff(), -1e-12);
    Vec3 onTriangle = Vec3::Zero();
    for (int k = 0; k < 3; ++k) onTriangle += nearest.weights[k] * mesh.position(mesh.triangles[nearest.triangle][k]);
    EXPECT_NEAR((onTriangle - point).norm(), nearest.distance, 1e-9);
  }
}

TEST_P(BvhCatalogue, VertexIsItsOwnNearestPoint) {
  const TriMesh& mesh = GetParam().mesh;
  const Bvh bvh(mesh);
  for (const Triangle& t : mesh.triangles) EXPECT_LT(bvh.nearestPoint(mesh.position(t[0])).distance, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(, BvhCatalogue, ::testing::ValuesIn(catalogue()), testing::MeshName());

TEST(Bvh, NoRayLeavesAClosedMeshThroughAnEdgeOrVertex) {
  const TriMesh ball = testing::icosphere(3);
  const Bvh bvh(ball);
  const Vec3 inside(0.013, -0.021, 0.007);
  for (const Triangle& t : ball.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 a = ball.position(t[k]), b = ball.position(t[(k + 1) % 3]);
      EXPECT_TRUE(bvh.firstHit(inside, a - inside, 1e9)) << "vertex";
      EXPECT_TRUE(bvh.firstHit(inside, 0.5 * (a + b) - inside, 1e9)) << "edge";
      EXPECT_TRUE(bvh.firstHit(Vec3::Zero(), a, 1e9)) << "vertex from the centre";
    }
  }
}

TEST(Bvh, RaysAlongAnAxisFindTheirTriangle) {
  const TriMesh grid = testing::flatGrid(16, 16);
  const Bvh bvh(grid);
  for (int i = 0; i <= 16; ++i) {  // exactly through vertices, and along the plane of the boxes' faces
    const Vec3 above(i / 16.0, 0.25, 1);
    ASSERT_TRUE(bvh.firstHit(above, -Vec3::UnitZ(), 2)) << i;
    EXPECT_NEAR(bvh.firstHit(above, -Vec3::UnitZ(), 2)->distance, 1, 1e-12);
  }
  EXPECT_FALSE(bvh.firstHit(Vec3(0.3, 0.3, 1), Vec3::UnitZ(), 1e9));
  EXPECT_FALSE(bvh.firstHit(Vec3(0.3, 0.3, 1), -Vec3::UnitZ(), 0.999));
  EXPECT_FALSE(bvh.firstHit(Vec3(0.3, 0.3, 1), Vec3::Zero(), 1));
}

TEST(Bvh, TrianglesAtTheStartDoNotBlock) {
  const TriMesh ball = testing::icosphere(2);
  const Bvh bvh(ball);
  for (Index v = 0; v < ball.vertexCount(); ++v) {
    EXPECT_FALSE(bvh.segmentBlocked(ball.position(v), Vec3::Zero())) << v;
    EXPECT_FALSE(bvh.segmentBlocked(ball.position(v), 2 * ball.position(v))) << v;
    EXPECT_TRUE(bvh.segmentBlocked(ball.position(v), -1.1 * ball.position(v))) << v;
  }
}

TEST(Bvh, HitsWithinTheMarginDoNotBlock) {
  const TriMesh grid = testing::flatGrid(4, 4);
  const Bvh bvh(grid);
  const Vec3 below(0.3, 0.4, -0.01), above(0.3, 0.4, 0.5);
  EXPECT_TRUE(bvh.segmentBlocked(below, above));
  EXPECT_FALSE(bvh.segmentBlocked(below, above, 0.02));
  EXPECT_FALSE(bvh.segmentBlocked(above, below, 0.02));
  EXPECT_TRUE(bvh.segmentBlocked(above, below, 0.005));
  EXPECT_FALSE(bvh.segmentBlocked(above, above));
}

TEST(Bvh, OnlyTheNamedTriangles) {
  const TriMesh grid = testing::flatGrid(4, 4);
  const Index some[] = {0, 31};
  const Bvh bvh(grid, some);
  EXPECT_EQ(bvh.nearestPoint(Vec3(1, 1, 3)).triangle, 31u);
  EXPECT_NEAR(bvh.nearestPoint(Vec3(0.125, 0.1, 0.2)).distance, 0.2, 1e-9);
  EXPECT_FALSE(bvh.firstHit(Vec3(0.5, 0.5, 1), -Vec3::UnitZ(), 2));
}

TEST(Bvh, NothingToHit) {
  const Bvh bvh(TriMesh{});
  EXPECT_FALSE(bvh.firstHit(Vec3::Zero(), Vec3::UnitX(), 1e9));
  EXPECT_FALSE(bvh.segmentBlocked(Vec3::Zero(), Vec3::UnitX()));
  EXPECT_THROW(bvh.nearestPoint(Vec3::Zero()), Error);
}

TEST(Bvh, ThousandsOfTrianglesAtOnePlace) {
  TriMesh mesh = testing::flatGrid(1, 1);
  for (int i = 0; i < 5000; ++i) mesh.triangles.push_back(mesh.triangles[i % 2]);
  const Bvh bvh(mesh);
  const auto hit = bvh.firstHit(Vec3(0.75, 0.25, 1), -Vec3::UnitZ(), 2);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 0u);  // the lowest of all that tie
  EXPECT_EQ(bvh.nearestPoint(Vec3(0.75, 0.25, 1)).triangle, 0u);
}

TEST(Bvh, SizesThatDoubleFromOneTriangleToTheNext) {
  TriMesh mesh;
  for (int i = 0; i < 100; ++i) {  // over 30 orders of magnitude: the most lopsided tree
    const float x = std::ldexp(1.0f, -i), s = 0.2f * x;
    mesh.positions.insert(mesh.positions.end(), {{x, 0, 0}, {x + s, 0, 0}, {x, s, 0}});
    const Index first = static_cast<Index>(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const Bvh bvh(mesh);
  for (int i = 0; i < 100; ++i) {
    const double x = std::ldexp(1.05, -i), y = std::ldexp(0.05, -i);
    const auto hit = bvh.firstHit(Vec3(x, y, 1), -Vec3::UnitZ(), 2);
    ASSERT_TRUE(hit) << i;
    EXPECT_EQ(hit->triangle, static_cast<Index>(i));
  }
}

TEST(Bvh, SameAnswersForAnyNumberOfThreads) {
  const TriMesh mesh = testing::soup(3000, 20000, 1);
  setThreadCount(1);
  const Bvh one(mesh);
  setThreadCount(4);
  const Bvh four(mesh);
  setThreadCount(0);
  RandomPoints points(14);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = points.next();
    const SurfacePoint a = one.nearestPoint(point), b = four.nearestPoint(point);
    EXPECT_EQ(a.triangle, b.triangle);
    EXPECT_EQ(a.position, b.position);
  }
}

#ifdef LIMBER_TEST_EMBREE

class EmbreeScene {
 public:
  explicit EmbreeScene(const TriMesh& mesh) : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                             mesh.positions.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                            mesh.triangles.size());
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3f*>(vertices));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<Triangle*>(indices));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  // The parameter of the first hit; infinity for none.
  float firstHit(const Vec3f& origin, const Vec3f& direction) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray = {origin.x(),
               origin.y(),
               origin.z(),
               0,
               direction.x(),
               direction.y(),
               direction.z(),
               0,
               std::numeric_limits<float>::infinity(),
               ~0u,
               0,
               0};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : ray.ray.tfar;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

TEST_P(BvhCatalogue, SameHitsAsEmbree) {
  const TriMesh& mesh = GetParam().mesh;
  const Bvh bvh(mesh);
  const EmbreeScene embree(mesh);
  RandomPoints points(15);
  int hits = 0, differ = 0;
  constexpr int kRays = 3000;
  for (int i = 0; i < kRays; ++i) {
    const Vec3f origin = points.next().cast<float>();
    const Vec3f direction = points.next().cast<float>() - origin;
    const auto hit = bvh.firstHit(origin.cast<double>(), direction.cast<double>(), 1e9);
    const float expected = embree.firstHit(origin, direction);
    hits += hit.has_value();
    // Embree works in single precision: a ray past the very edge of an open mesh may fall on either side.
    if (hit.has_value() != std::isfinite(expected) || (hit && std::abs(hit->distance - expected) > 1e-4)) ++differ;
  }
  EXPECT_GT(hits, 20);
  EXPECT_LE(differ, kRays / 1000);
}

#endif

}  // namespace
}  // namespace limber
