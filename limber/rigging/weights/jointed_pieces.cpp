#include "limber/rigging/weights/jointed_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>

#include "limber/core/assignment.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/winding_number.h"

namespace limber {

namespace {

constexpr double kTouch = 0.1;          // a joint so many diagonals of a piece from it touches it
constexpr double kLiesOn = 0.02;        // diagonals of a piece from another, at which a point of it counts half
constexpr double kFirstReach = 0.05;    // diagonals of a piece to the parts that it may hang on at first
constexpr double kMinPiece = 0.01;      // longest sides: smaller pieces, and single vertices, look as far as these
constexpr std::size_t kMaxPoints = 64;  // of a piece that look for what it hangs on
constexpr int kBonePoints = 8;          // at which a bone is looked at
constexpr double kVotesInside = 2;      // votes of a point within another piece; one that lies on it has one

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
  Vec3 position = Vec3::Zero();
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
      part.area += triangleArea(mesh, mesh.triangles[t]);
    }
  }

  std::optional<PieceBinding> find(Progress& progress) {
    const auto solid =
        std::count_if(parts_.begin(), parts_.end(), [](const Part& part) { return !part.triangles.empty(); });
    if (static_cast<std::size_t>(solid) < std::max<std::size_t>(2, pivots_.size())) return std::nullopt;
    for (Index p = 0; p < parts_.size(); ++p) findTouched(p);
    if (!givePiecesToAll() || (!isList() && anyPieceBends())) return std::nullopt;
    hangRoots();
    for (Index p = 0; p < parts_.size(); ++p) {
      if (!pivotOf_[p] && !touched_[p].empty()) pivotOf_[p] = above(touched_[p]);
    }
    hangRest(progress);
    PieceBinding binding;
    for (const std::optional<Index>& pivot : pivotOf_) binding.push_back(pivots_[*pivot].joint);
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
      const Vec3& position = pivots_[i].position;
      if (!contains(part.box, position, reach)) continue;
      if (!surface) surface.emplace(mesh_, part.triangles);
      if (surface->nearestPoint(position).distance < reach || isInside(p, position)) touched_[p].insert(i);
    }
    // What carries all that a piece touches need not lie in it: where a root lies is arbitrary.
    if (touched_[p].empty()) return;
    if (const std::optional<Index> top = above(touched_[p])) touched_[p].insert(*top);
  }

  void measureInside(Index p) {
    Part& part = parts_[p];
    if (part.inside || part.triangles.empty()) return;
    TriMesh alone;
    for (const Index t : part.triangles) {
      const Index first = alone.vertexCount();
      for (const Index v : mesh_.triangles[t]) alone.positions.push_back(mesh_.positions[v]);
      alone.triangles.push_back({first, first + 1, first + 2});
    }
    part.inside = std::make_unique<WindingNumber>(alone);
  }

  // Of a piece that was measured.
  bool liesInside(Index p, const Vec3& point) const {
    return parts_[p].inside && contains(parts_[p].box, point) && std::abs(parts_[p].inside->at(point)) > 0.5;
  }

  bool isInside(Index p, const Vec3& point) {
    if (!contains(parts_[p].box, point)) return false;
    measureInside(p);
    return liesInside(p, point);
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

  // By pivot: the piece that givePiecesToAll gave it.
  std::vector<Index> pieceOfEach() const {
    std::vector<Index> own(pivots_.size());
    for (Index p = 0; p < parts_.size(); ++p) {
      if (pivotOf_[p]) own[*pivotOf_[p]] = p;
    }
    return own;
  }

  // Whether a bone runs through a piece that belongs to another joint, as in a body of one skin that wears something at
  // each of its joints: that piece has to bend there.
  bool anyPieceBends() {
    const std::vector<Index> own = pieceOfEach();
    for (const Pivot& child : pivots_) {
      if (!child.parent) continue;
      const Pivot& pivot = pivots_[*child.parent];
      for (Index p = 0; p < parts_.size(); ++p) {
        if (p == own[*child.parent] || touched_[p].count(*child.parent) == 0) continue;
        int foreign = 0;
        for (int k = 0; k < kBonePoints; ++k) {
          const Vec3 at = pivot.position + (k + 0.5) / kBonePoints * (child.position - pivot.position);
          foreign += isInside(p, at) && !isInside(own[*child.parent], at);
        }
        if (2 * foreign > kBonePoints) return true;
      }
    }
    return false;
  }

  // Hangs the roots but one on the joints whose parts they touch, from that one outwards; what touches nothing hangs on
  // it. Joints that all hang on one root are taken for roots, too: such a skeleton tells no more than a list.
  void hangRoots() {
    if (isList() && countRoots() == 1) {
      for (Pivot& pivot : pivots_) pivot.parent.reset();
    }
    const std::vector<Index> own = pieceOfEach();
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

  // Of a skeleton whose joints are roots or hang on one, which tells nothing of chains.
  bool isList() const {
    return std::none_of(pivots_.begin(), pivots_.end(),
                        [&](const Pivot& pivot) { return pivot.parent && pivots_[*pivot.parent].parent; });
  }

  std::ptrdiff_t countRoots() const {
    return std::count_if(pivots_.begin(), pivots_.end(), [](const Pivot& pivot) { return !pivot.parent; });
  }

  // A piece that is not hung yet, and what its points have found so far.
  struct LoosePiece {
    Index part = 0;
    double diagonal = 0;
    std::vector<Vec3> points;
    std::vector<double> away;        // by point: to what is hung
    std::vector<Index> onPivot;      // by point: of what it is nearest to
    std::map<Index, double> inside;  // votes by pivot
    double distance = 0;             // of the nearest point, in diagonals
  };

  LoosePiece looseFrom(Index p) const {
    const Part& part = parts_[p];
    LoosePiece loose;
    loose.part = p;
    loose.diagonal = std::max(part.box.diagonal(), kMinPiece);
    const std::size_t all = part.vertices.size() + part.triangles.size(), step = 1 + all / kMaxPoints;
    for (std::size_t i = 0; i < all; i += step) {
      if (i < part.vertices.size()) {
        loose.points.push_back(mesh_.position(part.vertices[i]));
      } else {
        const Index t = part.triangles[i - part.vertices.size()];
        loose.points.push_back((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3);
      }
    }
    loose.away.assign(loose.points.size(), std::numeric_limits<double>::infinity());
    loose.onPivot.assign(loose.points.size(), 0);
    return loose;
  }

  // Pieces that are near enough to what is hung hang on it, and others on them: those in a small reach first, which
  // grows, so that pieces far from all end the search soon.
  void hangRest(Progress& progress) {
    std::vector<LoosePiece> rest;
    std::vector<Index> hung;
    for (Index p = 0; p < parts_.size(); ++p) {
      if (pivotOf_[p]) {
        hung.push_back(p);
      } else {
        rest.push_back(looseFrom(p));
      }
    }
    for (double reach = kFirstReach; !rest.empty(); reach *= 2) {
      progress.update(1 - static_cast<double>(rest.size()) / static_cast<double>(parts_.size()));
      lookAt(hung, rest);
      hung.clear();
      double nearest = std::numeric_limits<double>::infinity();
      for (const LoosePiece& loose : rest) nearest = std::min(nearest, loose.distance);
      std::erase_if(rest, [&](const LoosePiece& loose) {
        if (loose.distance > std::max(reach, nearest)) return false;
        pivotOf_[loose.part] = maxVotes(loose);
        hung.push_back(loose.part);
        return true;
      });
    }
  }

  // What the points of pieces find on pieces that were hung since they last looked.
  void lookAt(const std::vector<Index>& hung, std::vector<LoosePiece>& rest) {
    std::vector<Index> triangles;
    for (const Index p : hung) {
      triangles.insert(triangles.end(), parts_[p].triangles.begin(), parts_[p].triangles.end());
      measureInside(p);
    }
    if (triangles.empty()) return;
    const Bvh surface(mesh_, triangles);
    parallelFor(rest.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) lookAt(surface, hung, rest[i]);
    });
  }

  void lookAt(const Bvh& surface, const std::vector<Index>& hung, LoosePiece& loose) const {
    loose.distance = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < loose.points.size(); ++i) {
      const SurfacePoint nearest = surface.nearestPoint(loose.points[i]);
      if (nearest.distance < loose.away[i]) {
        loose.away[i] = nearest.distance;
        loose.onPivot[i] = *pivotOf_[piece_[mesh_.triangles[nearest.triangle][0]]];
      }
      loose.distance = std::min(loose.distance, loose.away[i] / loose.diagonal);
    }
    const Box& own = parts_[loose.part].box;
    for (const Index p : hung) {
      const Box& other = parts_[p].box;
      if ((other.min.array() > own.max.array()).any() || (own.min.array() > other.max.array()).any()) continue;
      for (const Vec3& point : loose.points) {
        if (liesInside(p, point)) loose.inside[*pivotOf_[p]] += kVotesInside;
      }
    }
  }

  static Index maxVotes(const LoosePiece& loose) {
    std::map<Index, double> votes = loose.inside;
    for (std::size_t i = 0; i < loose.points.size(); ++i) {
      const double away = loose.away[i] / (kLiesOn * loose.diagonal), squared = away * away;
      votes[loose.onPivot[i]] += 1 / (1 + squared * squared);
    }
    return std::max_element(votes.begin(), votes.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
  }

  const TriMesh& mesh_;
  std::span<const Index> piece_;
  std::vector<Part> parts_;
  std::vector<Pivot> pivots_;
  std::vector<PivotSet> touched_;              // by piece
  std::vector<std::optional<Index>> pivotOf_;  // by piece
};

}  // namespace

std::optional<PieceBinding> jointsOfPieces(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount,
                                           std::span<const Bone> bones, Progress& progress) {
  return PieceJoints(mesh, piece, pieceCount, bones).find(progress);
}

bool mayBeOfParts(Index pieceCount, std::span<const Bone> bones, PieceMode pieces) {
  return pieces != PieceMode::kSoft && pieceCount > 1 &&
         std::all_of(bones.begin(), bones.end(), [](const Bone& bone) { return bone.radius == 0; });
}

std::optional<WeightResult> jointedPieceWeights(const TriMesh& mesh, std::span<const Index> piece, Index pieceCount,
                                                std::span<const Bone> bones, const WeightOptions& options,
                                                Progress& progress) {
  if (!mayBeOfParts(pieceCount, bones, options.pieces)) return std::nullopt;
  const std::optional<PieceBinding> parts = jointsOfPieces(mesh, piece, pieceCount, bones, progress);
  if (!parts) return std::nullopt;
  WeightResult result;
  result.weights.slots = options.maxInfluences;
  result.weights.joints.resize(piece.size() * options.maxInfluences);
  result.weights.weights.resize(result.weights.joints.size());
  bindPieces(*parts, piece, result.weights, result.warnings);
  return result;
}

}  // namespace limber
