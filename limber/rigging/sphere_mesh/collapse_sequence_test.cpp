#include "limber/rigging/sphere_mesh/collapse_sequence.h"

#include <map>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "limber/core/error.h"
#include "limber/geometry/surface/mirror_map.h"
#include "limber/geometry/surface/testing/shape_meshes.h"
#include "limber/rigging/sphere_mesh/sphere_mesh_builder.h"

namespace limber {

namespace {

// The error and its minimum from the packed terms, by a dense solver and an explicit r >= 0.
struct DenseQuadric {
  Mat4 a = Mat4::Zero();
  Vec4 b = Vec4::Zero();
  double c = 0;

  explicit DenseQuadric(const SphereQuadric& q, bool image) {
    const double* t = q.terms;
    a << t[0], t[1], t[2], t[3], t[1], t[4], t[5], t[6], t[2], t[5], t[7], t[8], t[3], t[6], t[8], t[9];
    b << t[10], t[11], t[12], t[13];
    c = t[14];
    if (image) {
      const Mat4 mirror = Vec4(-1, 1, 1, 1).asDiagonal();
      a = (mirror * a * mirror).eval();
      b = (mirror * b).eval();
    }
  }
  DenseQuadric operator+(const DenseQuadric& other) const {
    DenseQuadric sum = *this;
    sum.a += other.a;
    sum.b += other.b;
    sum.c += other.c;
    return sum;
  }
  double error(const Vec4& s) const { return s.dot(a * s) - 2 * b.dot(s) + c; }
  Vec4 minimum() const {
    const Vec4 s = a.fullPivLu().solve(b);
    if (s[3] >= 0) return s;
    Vec4 flat = Vec4::Zero();
    flat.head<3>() = a.topLeftCorner<3, 3>().fullPivLu().solve(b.head<3>());
    return flat;
  }
  Vec4 minimumOfRadius(double radius) const {
    Vec4 s(0, 0, 0, radius);
    s.head<3>() = a.topLeftCorner<3, 3>().fullPivLu().solve(b.head<3>() - radius * a.col(3).head<3>());
    return s;
  }
  double minimumError() const { return error(minimum()); }
};

// Every sphere for itself, images too, merged by following the record; all costs are computed anew each time.
class BruteForce {
 public:
  explicit BruteForce(const CollapseInput& input) {
    for (Index node = 0; node < input.single.size(); ++node) {
      for (const bool image : {false, true}) {
        if (image && input.single[node]) continue;
        const Index sphere = static_cast<Index>(quadrics_.size());
        spheres_[{node, image}] = sphere;
        quadrics_.emplace_back(input.quadrics[node], image);
        imageOf_.push_back(input.single[node] ? sphere : image ? sphere - 1 : sphere + 1);
        alive_.insert(sphere);
      }
    }
    for (const GraphEdge& e : input.edges) {
      addEdge(sphere(e.from, false), sphere(nodeOf(e.to), crossesOf(e.to)));
      addEdge(sphere(e.from, true), sphere(nodeOf(e.to), !crossesOf(e.to)));
    }
  }

  Index sphere(Index node, bool image) const {
    const auto it = spheres_.find({node, image});
    return it != spheres_.end() ? it->second : spheres_.at({node, false});
  }
  std::size_t count() const { return alive_.size(); }

  // All that becomes one sphere when a and b merge, if symmetry is to stay.
  std::set<Index> group(Index a, Index b) const {
    std::set<Index> all = {a, b};
    if (imageOf_[a] == a || imageOf_[b] == b || imageOf_[a] == b) {
      all.insert(imageOf_[a]);
      all.insert(imageOf_[b]);
    }
    return all;
  }
  DenseQuadric sum(const std::set<Index>& group) const {
    DenseQuadric total = quadrics_[*group.begin()];
    for (auto it = std::next(group.begin()); it != group.end(); ++it) total = total + quadrics_[*it];
    return total;
  }
  double cheapest() const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : edges_) least = std::min(least, sum(group(a, b)).minimumError());
    return least;
  }
  bool hasEdge(Index a, Index b) const { return edges_.count({std::min(a, b), std::max(a, b)}) > 0; }

  void follow(const Merge& m) {
    const Index a = sphere(m.kept, false), b = sphere(m.gone, m.kept == m.gone ? true : m.crosses);
    const std::set<Index> first = group(a, b);
    if (first.count(imageOf_[a])) {  // one sphere on the plane
      mergeAll(first, a);
      imageOf_[a] = a;
      spheres_.erase({m.kept, true});
      return;
    }
    const Index aImage = imageOf_[a], bImage = imageOf_[b];
    mergeAll({a, b}, a);
    mergeAll({aImage, bImage}, aImage);
  }

  DenseQuadric total() const { return sum(alive_); }

 private:
  void addEdge(Index a, Index b) {
    if (a != b) edges_.insert({std::min(a, b), std::max(a, b)});
  }
  void mergeAll(const std::set<Index>& group, Index kept) {
    quadrics_[kept] = sum(group);
    std::set<std::pair<Index, Index>> old;
    old.swap(edges_);
    for (const auto& [a, b] : old) addEdge(group.count(a) ? kept : a, group.count(b) ? kept : b);
    for (const Index s : group) {
      if (s != kept) alive_.erase(s);
    }
  }

  std::map<std::pair<Index, bool>, Index> spheres_;
  std::vector<DenseQuadric> quadrics_;
  std::vector<Index> imageOf_;
  std::set<Index> alive_;
  std::set<std::pair<Index, Index>> edges_;
};

CollapseInput inputOf(const TriMesh& mesh, bool symmetric) {
  std::optional<MirrorMap> mirror;
  if (symmetric) mirror = findMirror(mesh);
  const CollapseFrame frame =
      CollapseFrame::of(mesh, mirror ? std::optional<MirrorPlane>(mirror->plane) : std::nullopt);
  std::vector<Vec3f> points;
  for (const Vec3f& p : mesh.positions) points.push_back(frame.toCollapse(p));
  CollapseInput input = collapseStart(mesh, points, surfaceEdges(mesh), mirror).input;
  input.costOfEnds = 0;
  return input;
}

// Returns how many spheres the bound of their radius has made smaller.
int checkAgainstBruteForce(const CollapseInput& input) {
  Progress progress;
  const CollapseSequence sequence = collapse(input, progress);
  BruteForce brute(input);
  EXPECT_EQ(sequence.initialCount, brute.count());
  const DenseQuadric total = brute.total();
  int bounded = 0;
  for (std::size_t i = 0; i < sequence.merges.size(); ++i) {
    const Merge& m = sequence.merges[i];
    SCOPED_TRACE("merge " + std::to_string(i));
    const Index a = brute.sphere(m.kept, false), b = brute.sphere(m.gone, m.kept == m.gone || m.crosses);
    EXPECT_TRUE(brute.hasEdge(a, b));
    const DenseQuadric joint = brute.sum(brute.group(a, b));
    // Keys are floats: 24 bits of the error, and solvers differ by the rounding of terms of size 1 in the quadric.
    const double rounding = 1e-14 * joint.a(3, 3);
    EXPECT_LE(joint.minimumError(), brute.cheapest() * (1 + 2e-7) + rounding);
    EXPECT_NEAR(m.error, joint.minimumError(), 1e-6 * joint.minimumError() + rounding);
    const Vec4 recorded(m.center.x(), m.center.y(), m.center.z(), m.radius);
    const Vec4 best = joint.minimum();
    if (m.radius > best[3] - 1e-6) {
      EXPECT_LT((recorded - best).norm(), 2e-6);
    } else {  // bounded: the best of its radius
      ++bounded;
      EXPECT_LT((recorded - joint.minimumOfRadius(m.radius)).norm(), 2e-6);
    }
    EXPECT_GE(m.radius, 0);
    EXPECT_NEAR(m.weight, joint.a(3, 3), 1e-6 * joint.a(3, 3));
    EXPECT_EQ(m.single, brute.group(a, b).count(brute.sphere(m.kept, true)) > 0);
    const bool onPlane = m.single && sequence.initialCount > input.single.size();
    EXPECT_TRUE(!onPlane || m.center.x() == 0);
    brute.follow(m);
    EXPECT_EQ(m.countAfter, brute.count());
  }
  EXPECT_EQ(brute.count(), 1u);
  const DenseQuadric last = brute.total();
  EXPECT_LT((last.a - total.a).norm() + (last.b - total.b).norm() + std::abs(last.c - total.c), 1e-12);
  EXPECT_EQ(sequence.deadEdges.size(), input.edges.size());
  return bounded;
}

TEST(CollapseSequence, EachMergeIsTheCheapestAndEachSphereTheBest) {
  for (const TriMesh& mesh :
       {testing::jittered(testing::ball(1), 0.1f), testing::jittered(testing::flatGrid(6, 5), 0.2f),
        testing::jittered(testing::cubes({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}}), 0.1f)}) {
    checkAgainstBruteForce(inputOf(mesh, false));
  }
}

TEST(CollapseSequence, TheSameForMeshesInPieces) {
  const TriMesh two = testing::joined(testing::octahedron(), testing::jittered(testing::ball(1), 0.1f), {3, 0, 0});
  checkAgainstBruteForce(inputOf(two, false));
  checkAgainstBruteForce(inputOf(testing::soupOf(testing::jittered(testing::octahedron(), 0.2f)), false));
}

TEST(CollapseSequence, TheSameForMirrorPairs) {
  const CollapseInput biped = inputOf(testing::blockBiped(), true);
  EXPECT_LT(biped.single.size(), testing::blockBiped().positions.size());
  checkAgainstBruteForce(biped);
  checkAgainstBruteForce(inputOf(testing::ball(1), true));
  const TriMesh half = testing::jittered(testing::ball(1), 0.1f);
  TriMesh image = half;
  for (Vec3f& p : image.positions) p.x() = -p.x();
  for (Triangle& t : image.triangles) std::swap(t[1], t[2]);
  checkAgainstBruteForce(inputOf(testing::joined(half, image, {5, 0, 0}), true));
}

TEST(CollapseSequence, TheSameForTroubledMeshes) {
  for (const auto& [name, mesh] : testing::meshCatalogue()) {
    if (mesh.positions.size() > 70) continue;
    SCOPED_TRACE(name);
    checkAgainstBruteForce(inputOf(mesh, false));
    checkAgainstBruteForce(inputOf(mesh, true));
  }
}

TEST(CollapseSequence, ADomeGetsNoSphereLargerThanItsWidthAllows) {
  TriMesh dome = testing::flatGrid(8, 8);
  for (Vec3f& p : dome.positions) p.z() = -0.02f * ((p.x() - 4) * (p.x() - 4) + (p.y() - 4) * (p.y() - 4));
  EXPECT_GT(checkAgainstBruteForce(inputOf(dome, false)), 0);
}

TEST(CollapseSequence, CanBeCancelled) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(collapse(inputOf(testing::ball(2), false), progress), Error);
}

}  // namespace

}  // namespace limber
