#include "limber/geometry/mesh/weld.h"

#include <cmath>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "limber/core/text/numbers.h"
#include "limber/geometry/mesh/tri_mesh.h"

namespace limber {
namespace {

using Points = std::vector<Vec3f>;

// A tube about the y axis, open at both ends, of rings of `around` vertices.
TriMesh tube(double radius, double bottom, double top, Index rings, Index around = 40) {
  TriMesh mesh;
  for (Index r = 0; r <= rings; ++r) {
    for (Index i = 0; i < around; ++i) {
      const double angle = (2 * kPi * i) / around + 0.1, y = bottom + (top - bottom) * r / rings;
      mesh.positions.push_back(Vec3(radius * std::cos(angle), y, radius * std::sin(angle)).cast<float>());
    }
  }
  for (Index r = 0; r < rings; ++r) {
    for (Index i = 0; i < around; ++i) {
      const Index a = r * around + i, b = r * around + (i + 1) % around;
      mesh.triangles.push_back({a, a + around, b});
      mesh.triangles.push_back({b, a + around, b + around});
    }
  }
  return mesh;
}

// One after the other, each a range of its own.
struct Parts {
  Points positions;
  std::vector<Triangle> triangles;
  std::vector<StoredVertices> stored;

  void add(const TriMesh& mesh, double quantisation = 0) {
    const auto first = static_cast<Index>(positions.size());
    stored.push_back({first, mesh.vertexCount(), Vec3::Zero(), quantisation});
    positions.insert(positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Triangle& t : mesh.triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  std::size_t pointCount() const {
    const std::vector<Index> same = samePoints(positions, triangles, stored);
    return std::set<Index>(same.begin(), same.end()).size();
  }
};

// Rounds to a grid of 2^bits steps along the longest side; returns the largest distance that this can move a vertex by.
double quantise(int bits, TriMesh& mesh, const Vec3& shift = Vec3::Zero()) {
  Box box;
  for (Index v = 0; v < mesh.vertexCount(); ++v) box.add(mesh.position(v));
  const Vec3 origin = box.min - shift * box.longestSide() / std::ldexp(1.0, bits);
  const double step = box.longestSide() / (std::ldexp(1.0, bits) - 1);
  for (Vec3f& p : mesh.positions) {
    for (int i = 0; i < 3; ++i) p[i] = static_cast<float>(origin[i] + step * std::round((p[i] - origin[i]) / step));
  }
  return 0.5 * std::sqrt(3.0) * step;
}

// Every triangle with corners of its own, each moved by noise of that standard deviation.
TriMesh soup(const TriMesh& mesh, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, noise);
  TriMesh result;
  for (const Triangle& t : mesh.triangles) {
    const Index first = result.vertexCount();
    for (const Index v : t) {
      result.positions.push_back(
          (mesh.position(v) + Vec3(normal(random), normal(random), normal(random))).cast<float>());
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

TEST(SamePoints, TriangleSoupWithNoiseInTheLastBitsIsOneSurface) {
  for (const double size : {1e-6, 1.0, 1e5}) {
    const TriMesh body = tube(0.1 * size, 0, size, 20);
    Parts parts;
    parts.add(soup(body, 1e-7 * size));
    EXPECT_EQ(parts.pointCount(), body.vertexCount()) << size;
  }
}

TEST(SamePoints, MeshesThatWereTransformedFarFromTheirPositionsMeet) {
  TriMesh low = tube(0.1, 0, 1, 10), high = tube(0.1, 1, 2, 10);
  const std::size_t count = low.positions.size() + high.positions.size() - 40;
  for (Vec3f& p : high.positions) p = (p + Vec3f::Constant(300)) - Vec3f::Constant(300);
  Parts parts;
  parts.add(low);
  parts.add(high);
  EXPECT_GT(parts.pointCount(), count);
  parts.stored[1].origin.setConstant(-300);
  EXPECT_EQ(parts.pointCount(), count);
}

TEST(SamePoints, SurfacesThatComeNearStayApart) {
  for (const double gap : {1e-4, 1e-5}) {
    Parts parts;
    parts.add(tube(0.1, 0, 1, 20));
    parts.add(tube(0.1 + gap, 0, 1, 20));
    EXPECT_EQ(parts.pointCount(), parts.positions.size()) << gap;
    const TriMesh inner = tube(0.1, 0, 1, 20);
    TriMesh both = inner;  // the same within one mesh
    const TriMesh outer = tube(0.1 + gap, 0, 1, 20);
    both.positions.insert(both.positions.end(), outer.positions.begin(), outer.positions.end());
    for (const Triangle& t : outer.triangles) {
      both.triangles.push_back({t[0] + inner.vertexCount(), t[1] + inner.vertexCount(), t[2] + inner.vertexCount()});
    }
    Parts one;
    one.add(both);
    EXPECT_EQ(one.pointCount(), one.positions.size()) << gap;
  }
}

// On a floor as large as this the rounding of the scene is larger than what the small mesh is made of.
TEST(SamePoints, FineMeshesInLargeScenesKeepTheirDetail) {
  Parts parts;
  parts.add({{{-2000, 0, -2000}, {2000, 0, -2000}, {2000, 0, 2000}, {-2000, 0, 2000}}, {{0, 2, 1}, {0, 3, 2}}});
  parts.add(tube(0.01, 0.1, 0.2, 100));
  EXPECT_EQ(parts.pointCount(), parts.positions.size());
}

TEST(SamePoints, JoinTheNearestOfThoseBeforeAsABruteForceDoes) {
  std::mt19937 random(3);
  Points positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<Triangle> triangles = {{0, 1, 2}};
  while (positions.size() < 2000) {
    positions.push_back(Vec3f(static_cast<float>(random() % 4096), static_cast<float>(random() % 4096), 0) * 0x1p-26f);
  }
  const std::vector<Index> same = samePoints(positions, triangles);
  const auto rounding = [&](Index v) { return 0x1p-21 + 0x1p-21 * double{positions[v].maxCoeff()}; };
  for (Index v = 0; v < positions.size(); ++v) {
    Index expected = v;
    double nearest = 1;
    for (Index w = 0; w < v; ++w) {
      const double squared = (positions[v].cast<double>() - positions[w].cast<double>()).squaredNorm();
      const double allowed = rounding(v) + rounding(w);
      if (same[w] != w || squared > allowed * allowed || squared >= nearest) continue;
      nearest = squared;
      expected = w;
    }
    ASSERT_EQ(same[v], expected) << v;
  }
}

TEST(SamePoints, SeamsBetweenGridsOfTheirOwnAreClosed) {
  for (int bits = 8; bits <= 16; ++bits) {
    TriMesh low = tube(0.1, 0, 0.45, 20), high = tube(0.1, 0.45, 1, 20);
    const double lowGrid = quantise(bits, low), highGrid = quantise(bits, high, {0.3, 0.4, 0.2});
    Parts parts;
    parts.add(low, lowGrid);
    parts.add(high, highGrid);
    EXPECT_EQ(parts.pointCount(), parts.positions.size() - 40) << bits << " bits";
    for (StoredVertices& range : parts.stored) range.quantisation = 0;
    EXPECT_GT(parts.pointCount(), parts.positions.size() - 5) << bits << " bits";
  }
}

TEST(SamePoints, GridsJoinNothingButOpenEdgesThatMeetAlongASeam) {
  // One tube within the other, not farther away than the steps of the grids, one reaching beyond the other.
  TriMesh inner = tube(0.1, 0, 1, 20), outer = tube(0.101, 0.21, 0.79, 12);
  const double innerGrid = quantise(8, inner), outerGrid = quantise(8, outer, {0.5, 0.5, 0.5});
  Parts within;
  within.add(inner, innerGrid);
  within.add(outer, outerGrid);
  EXPECT_EQ(within.pointCount(), within.positions.size());

  // A corner that touches another's edge in one point.
  TriMesh sheet = {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  TriMesh corner = {{{1.001f, 1.001f, 0}, {2, 2, 0}, {1, 2, 0}}, {{0, 1, 2}}};
  Parts touching;
  touching.add(sheet, 0.003);
  touching.add(corner, 0.003);
  EXPECT_EQ(touching.pointCount(), touching.positions.size());
}

TEST(SamePoints, MeshesOnOneGridJoinWhereTheyAreEqualAlone) {
  // Two strips on a grid of step 1, which share a side but for a slit one step wide at its end.
  const auto strip = [](float x) {
    TriMesh mesh;
    for (int i = 0; i <= 10; ++i) {
      mesh.positions.push_back({x, 0, 4.0f * static_cast<float>(i)});
      mesh.positions.push_back({x + 4, 0, 4.0f * static_cast<float>(i)});
    }
    for (Index i = 0; i < 20; ++i) {
      mesh.triangles.push_back(i % 2 == 0 ? Triangle{i, i + 1, i + 2} : Triangle{i, i + 2, i + 1});
    }
    return mesh;
  };
  TriMesh beside = strip(4);
  for (std::size_t v = 14; v < beside.positions.size(); v += 2) beside.positions[v].x() += 1;
  const double grid = 0.5 * std::sqrt(3.0);
  Parts parts;
  parts.add(strip(0), grid);
  parts.add(beside, grid);
  EXPECT_EQ(parts.pointCount(), parts.positions.size() - 7);
}

// A tube in two parts with what vertex of it each of theirs is. A jagged cut leaves teeth of one triangle each.
struct CutTube {
  TriMesh parts[2];
  std::vector<Index> vertexOf[2];
};

CutTube cutTube(Index around, bool isJagged) {
  const TriMesh whole = tube(0.1, 0, 1, 20, around);
  CutTube cut;
  std::vector<Index> moved[2] = {std::vector<Index>(whole.positions.size(), kNoIndex),
                                 std::vector<Index>(whole.positions.size(), kNoIndex)};
  for (Index t = 0; t < whole.triangles.size(); ++t) {
    const Index ring = t / (2 * around);
    const std::size_t side = ring > 9 || (ring == 9 && isJagged && t % 2 == 1) ? 1 : 0;
    Triangle own;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = whole.triangles[t][i];
      if (moved[side][v] == kNoIndex) {
        moved[side][v] = cut.parts[side].vertexCount();
        cut.parts[side].positions.push_back(whole.positions[v]);
        cut.vertexOf[side].push_back(v);
      }
      own[i] = moved[side][v];
    }
    cut.parts[side].triangles.push_back(own);
  }
  return cut;
}

TEST(SamePoints, SeamsOfMeshesFinerThanAGridAreClosed) {
  for (const bool isJagged : {false, true}) {
    for (const Index around : {100u, 200u, 280u}) {  // edges of 6 to 2 mm on steps of 2 mm
      CutTube cut = cutTube(around, isJagged);
      Parts parts;
      for (std::size_t side = 0; side < 2; ++side) {
        const double grid = quantise(side == 0 ? 14 : 8, cut.parts[side], {0.3, 0.4, 0.2});
        parts.add(cut.parts[side], grid);
      }
      const std::vector<Index> same = samePoints(parts.positions, parts.triangles, parts.stored);
      std::map<Index, Index> lowOf;
      for (Index v = 0; v < cut.vertexOf[0].size(); ++v) lowOf[cut.vertexOf[0][v]] = v;
      std::size_t seam = 0, torn = 0;
      for (Index v = 0; v < cut.vertexOf[1].size(); ++v) {
        const auto low = lowOf.find(cut.vertexOf[1][v]);
        if (low == lowOf.end()) continue;
        ++seam;
        if (same[low->second] != same[parts.stored[1].first + v]) ++torn;
      }
      EXPECT_EQ(seam, isJagged ? 2 * around : around);
      EXPECT_EQ(torn, 0) << around << (isJagged ? " jagged" : "");
    }
  }
}

TEST(SamePoints, OfOneGridBecomeOneOnlyWhereACoarserGridHasMadeOneOfTheirCounterparts) {
  CutTube cut = cutTube(400, false);
  Parts parts;
  parts.add(cut.parts[0], quantise(14, cut.parts[0]));
  parts.add(cut.parts[1], quantise(8, cut.parts[1]));
  const std::vector<Index> same = samePoints(parts.positions, parts.triangles, parts.stored);
  const Index last = parts.stored[0].count - 400;
  for (Index v = 0; v < last; ++v) EXPECT_EQ(same[v], v);
  for (Index v = last; v < last + 400; ++v) {
    const double apart = (parts.positions[v] - parts.positions[same[v]]).norm();
    EXPECT_LT(apart, 2 * (parts.stored[0].quantisation + parts.stored[1].quantisation));
  }
}

// A face with a mouth, and the bag within it on a finer grid. The lips are 2 steps of the coarser grid apart.
TEST(SamePoints, LipsStayApartThoughTheirSeamsAreClosed) {
  const Index half = 12;
  const auto ring = [&](double scale, double gap, double z) {
    Points points;
    for (Index i = 0; i < 2 * half; ++i) {
      const double angle = kPi * (i + 0.5) / half;
      const double x = 0.025 * std::cos(angle), y = 0.5 * gap * (i < half ? 1 : -1);
      points.push_back(Vec3(x * scale + 0.001, y * scale + 0.3 * x, z).cast<float>());
    }
    return points;
  };
  const auto band = [&](const Points& inner, const Points& outer) {
    TriMesh mesh;
    mesh.positions = inner;
    mesh.positions.insert(mesh.positions.end(), outer.begin(), outer.end());
    for (Index i = 0; i < 2 * half; ++i) {
      const Index j = (i + 1) % (2 * half);
      mesh.triangles.push_back({i, j, i + 2 * half});
      mesh.triangles.push_back({j, j + 2 * half, i + 2 * half});
    }
    return mesh;
  };
  const double gap = 2 * 0.25 / 255;
  TriMesh face = band(ring(1, gap, 0), ring(5, 10 * gap, 0)), bag = band(ring(1, gap, 0), ring(1, 3 * gap, -0.02));
  Parts parts;
  parts.add(face, quantise(8, face));
  parts.add(bag, quantise(8, bag, {0.3, 0.4, 0.2}));
  const std::vector<Index> same = samePoints(parts.positions, parts.triangles, parts.stored);
  for (Index i = 0; i < 2 * half; ++i) {
    EXPECT_EQ(same[parts.stored[1].first + i], same[i]) << i;
    EXPECT_NE(same[i], same[2 * half - 1 - i]) << i;
  }
}

}  // namespace
}  // namespace limber
