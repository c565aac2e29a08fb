#include "limber/skinning/jointed_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "limber/core/assignment.h"
#include "limber/mesh/bvh.h"
#include "limber/mesh/winding_number.h"

namespace limber {

namespace {

constexpr double kTouch = 0.1;        // a joint so many diagonals of a piece from it touches it
constexpr double kLiesOn = 0.02;      // diagonals of a piece from another, at which a point of it counts half
constexpr double kFirstReach = 0.05;  // diagonals of a piece to the parts that it may hang on at first
constexpr double kInside = 2;         // votes of a point within another piece; one that lies on it has one

// Costs of giving a joint a piece that others touch, too.
constexpr double kNoPair = 1e6;  // does not touch it
constexpr double kCarried = 10;  // for each of the others that carries the joint
constexpr double kBeside = 1;    // for each that the joint does not carry
constexpr double kLight = 0.5;   // for a joint that carries none at all; of equals the one that carries most

struct Part {
  std::vector<Index> vertices, triangles;
  Box box;
  double area = 0;
  std::unique_ptr<WindingNumber> inside;  // made when it is first asked
};

struct Pivot {
  Index joint = 0;
  Vec3 place = Vec3::Zero();
  std::optional<Index> parent;  // among pivots
};

bool contains(const Box& box, const Vec3& point, double margin = 0) {
  return ((point - box.min).array() >= -margin).all() && ((box.max - point).array() >= -margin).all();
}

class PieceJoints {
 public:
  PieceJoints(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount, std::span<const Bone> bones)
      : mesh_(mesh), piece_(piece), parts_(pieceCount), touched_(pieceCount), pivotOf_(pieceCount) {
    addPivots(bones);
    for (Index v = 0; v < mesh.vertexCount(); ++v) {
      parts_[piece[v]].vertices.push_back(v);
      parts_[piece[v]].box.add(mesh.position(v));
    }
    for (Index t = 0; t < mesh.triangleCount(); ++t) {
      Part& part = parts_[piece[mesh.triangles[t][0]]];
      part.triangles.push_back(t);
      part.area += 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
    }
  }

  std::optional<PieceBinding> find() {
    if (parts_.size() < std::max<std::size_t>(2, pivots_.size())) return std::nullopt;
    for (Index p = 0; p < parts_.size(); ++p) findTouched(p);
    if (!givePiecesToAll()) return std::nullopt;
    hangRoots();
    for (Index p = 0; p < parts_.size(); ++p) {
      if (!pivotOf_[p] && !touched_[p].empty()) pivotOf_[p] = above(touched_[p]);
    }
    while (hangRest()) {
    }
    PieceBinding binding;
    // Pieces without a triangle, which are loose vertices, may be left over.
    for (const std::optional<Index>& pivot : pivotOf_) binding.push_back(pivots_[pivot.value_or(0)].joint);
    return binding;
  }

 private:
  using PivotSet = std::set<Index>;

  Vec3 corner(Index triangle, int k) const { return mesh_.position(mesh_.triangles[triangle][k]); }

  void addPivots(std::span<const Bone> bones) {
    std::map<Index, Index> pivotOfJoint;
    for (const Bone& bone : bones) {
      if (pivotOfJoint.emplace(bone.joint, static_cast<Index>(pivots_.size())).second) {
        pivots_.push_back({bone.joint, bone.a, std::nullopt});
      }
    }
    for (const Bone& bone : bones) {
      const auto parent = bone.parent ? pivotOfJoint.find(*bone.parent) : pivotOfJoint.end();
      if (parent != pivotOfJoint.end()) pivots_[pivotOfJoint[bone.joint]].parent = parent->second;
    }
  }

  void findTouched(Index p) {
    const Part& part = parts_[p];
    if (part.triangles.empty()) return;
    const double reach = kTouch * part.box.diagonal();
    std::optional<Bvh> surface;
    for (Index i = 0; i < pivots_.size(); ++i) {
      const Vec3& place = pivots_[i].place;
      if (!contains(part.box, place, reach)) continue;
      if (!surface) surface.emplace(mesh_, part.triangles);
      if (surface->nearestPoint(place).distance < reach || isInside(p, place)) touched_[p].insert(i);
    }
    // What carries all that a piece touches need not lie in it: where a root lies is arbitrary.
    if (touched_[p].empty()) return;
    if (const std::optional<Index> top = above(touched_[p])) touched_[p].insert(*top);
  }

  bool isInside(Index p, const Vec3& point) {
    Part& part = parts_[p];
    if (!contains(part.box, point)) return false;
    if (!part.inside) {
      TriMesh alone;
      for (const Index t : part.triangles) {
        const Index first = alone.vertexCount();
        for (const Index v : mesh_.triangles[t]) alone.positions.push_back(mesh_.positions[v]);
        alone.triangles.push_back({first, first + 1, first + 2});
      }
      part.inside = std::make_unique<WindingNumber>(alone);
    }
    return std::abs(part.inside->at(point)) > 0.5;
  }

  bool carries(Index upper, Index lower) const {
    for (std::optional<Index> i = pivots_[lower].parent; i; i = pivots_[*i].parent) {
      if (*i == upper) return true;
    }
    return false;
  }

  // The nearest pivot that carries, or is, each of the set.
  std::optional<Index> above(const PivotSet& set) const {
    for (std::optional<Index> i = *set.begin(); i; i = pivots_[*i].parent) {
      if (std::all_of(set.begin(), set.end(), [&](Index each) { return each == *i || carries(*i, each); })) return i;
    }
    return std::nullopt;
  }

  double costOf(Index pivot, Index p) const {
    if (touched_[p].count(pivot) == 0) return kNoPair;
    double cost = 0;
    for (const Index other : touched_[p]) {
      if (other != pivot && !carries(pivot, other)) cost += carries(other, pivot) ? kCarried : kBeside;
    }
    return cost + kLight * (1 - carriedPart(pivot));
  }

  // Of all pivots.
  double carriedPart(Index pivot) const {
    double count = 0;
    for (Index other = 0; other < pivots_.size(); ++other) count += carries(pivot, other);
    return count / static_cast<double>(pivots_.size());
  }

  bool givePiecesToAll() {
    std::vector<Index> candidates;
    PivotSet reached;
    for (Index p = 0; p < parts_.size(); ++p) {
      if (touched_[p].empty()) continue;
      candidates.push_back(p);
      reached.insert(touched_[p].begin(), touched_[p].end());
    }
    if (reached.size() < pivots_.size() || candidates.size() < pivots_.size()) return false;

    std::vector<std::vector<double>> costs(pivots_.size(), std::vector<double>(candidates.size()));
    for (std::size_t c = 0; c < candidates.size(); ++c) {
      for (Index i = 0; i < pivots_.size(); ++i) costs[i][c] = costOf(i, candidates[c]);
    }
    const std::vector<std::optional<Index>> pairs = cheapestPairs(costs);
    for (Index i = 0; i < pivots_.size(); ++i) {
      if (!pairs[i] || costs[i][*pairs[i]] >= kNoPair) return false;
      pivotOf_[candidates[*pairs[i]]] = i;
    }
    return true;
  }

  // Hangs the roots but one on the joints whose parts they touch, from that one outwards; what touches nothing hangs on
  // it. Joints that all hang on one root are taken for roots, too: such a skeleton tells no more than a list.
  void hangRoots() {
    const bool isList = std::none_of(pivots_.begin(), pivots_.end(),
                                     [&](const Pivot& pivot) { return pivot.parent && pivots_[*pivot.parent].parent; });
    if (isList && countRoots() == 1) {
      for (Pivot& pivot : pivots_) pivot.parent.reset();
    }
    std::vector<Index> own(pivots_.size());
    for (Index p = 0; p < parts_.size(); ++p) {
      if (pivotOf_[p]) own[*pivotOf_[p]] = p;
    }
    const auto size = [&](Index pivot) { return std::pair(carriedPart(pivot), parts_[own[pivot]].area); };
    PivotSet loose;
    for (Index i = 0; i < pivots_.size(); ++i) {
      if (!pivots_[i].parent) loose.insert(i);
    }
    const Index base =
        *std::max_element(loose.begin(), loose.end(), [&](Index a, Index b) { return size(a) < size(b); });
    std::vector<Index> reached;
    const auto reach = [&](Index root) {
      loose.erase(root);
      for (Index i = 0; i < pivots_.size(); ++i) {
        if (i == root || carries(root, i)) reached.push_back(i);
      }
    };
    reach(base);
    for (std::size_t next = 0; next < reached.size(); ++next) {
      const PivotSet rest = loose;
      for (const Index root : rest) {
        if (touched_[own[reached[next]]].count(root) == 0 && touched_[own[root]].count(reached[next]) == 0) continue;
        pivots_[root].parent = reached[next];
        reach(root);
      }
    }
    for (const Index root : loose) pivots_[root].parent = base;
  }

  std::ptrdiff_t countRoots() const {
    return std::count_if(pivots_.begin(), pivots_.end(), [](const Pivot& pivot) { return !pivot.parent; });
  }

  // Hangs pieces on those that are hung already and are in reach; false where none is left.
  bool hangRest() {
    std::vector<Index> hung, rest;
    for (Index p = 0; p < parts_.size(); ++p) {
      if (parts_[p].triangles.empty()) continue;
      if (!pivotOf_[p]) {
        rest.push_back(p);
      } else {
        hung.insert(hung.end(), parts_[p].triangles.begin(), parts_[p].triangles.end());
      }
    }
    if (rest.empty()) return false;
    const Bvh surface(mesh_, hung);
    std::vector<Vote> votes;
    double nearest = std::numeric_limits<double>::infinity();
    for (const Index p : rest) {
      votes.push_back(voteFor(p, surface));
      nearest = std::min(nearest, votes.back().distance);
    }
    const double reach = std::max(reach_, nearest);
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (votes[i].distance <= reach) pivotOf_[rest[i]] = votes[i].pivot;
    }
    reach_ *= 2;
    return true;
  }

  struct Vote {
    Index pivot = 0;
    double distance = 0;  // to what is hung, in diagonals of the piece
  };

  Vote voteFor(Index p, const Bvh& hung) {
    const Part& part = parts_[p];
    std::vector<Vec3> points;
    for (const Index v : part.vertices) points.push_back(mesh_.position(v));
    for (const Index t : part.triangles) points.push_back((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3);
    std::vector<Index> overlaps;
    for (Index q = 0; q < parts_.size(); ++q) {
      const Box& other = parts_[q].box;
      if (pivotOf_[q] && (other.min.array() <= part.box.max.array()).all() &&
          (part.box.min.array() <= other.max.array()).all()) {
        overlaps.push_back(q);
      }
    }
    const double diagonal = std::max(part.box.diagonal(), 1e-9);
    Vote vote;
    vote.distance = std::numeric_limits<double>::infinity();
    std::map<Index, double> shares;
    for (const Vec3& point : points) {
      const SurfacePoint nearest = hung.nearestPoint(point);
      const double away = nearest.distance / diagonal;
      vote.distance = std::min(vote.distance, away);
      shares[*pivotOf_[piece_[mesh_.triangles[nearest.triangle][0]]]] += 1 / (1 + std::pow(away / kLiesOn, 4));
      for (const Index q : overlaps) {
        if (isInside(q, point)) shares[*pivotOf_[q]] += kInside;
      }
    }
    vote.pivot = std::max_element(shares.begin(), shares.end(), [](const auto& a, const auto& b) {
                   return a.second < b.second;
                 })->first;
    return vote;
  }

  const TriMesh& mesh_;
  std::span<const Index> piece_;
  std::vector<Part> parts_;
  std::vector<Pivot> pivots_;
  std::vector<PivotSet> touched_;              // by piece
  std::vector<std::optional<Index>> pivotOf_;  // by piece
  double reach_ = kFirstReach;                 // grows, so that pieces far from all end the search soon
};

}  // namespace

std::optional<PieceBinding> jointsOfPieces(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount,
                                           std::span<const Bone> bones) {
  return PieceJoints(mesh, piece, pieceCount, bones).find();
}

}  // namespace limber
