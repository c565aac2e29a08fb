#include "limber/character/anatomy/half_body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <Eigen/Eigenvalues>

namespace limber {

namespace {

constexpr std::size_t kMaxCompared = 64;  // children of one joint; a hand has five
constexpr double kMinWidth = 1e-3;        // of the body's size: joints nearer to the plane are no pair
// Costs of a pair, each 0 for mirror images: differences of lengths and counts as fractions of the greater, of
// positions in lengths of the subtree there. A limb turned by 90 degrees about where it begins costs about 0.7.
constexpr double kMaxDifference = 0.35;  // fraction of length, and of joints
constexpr double kMaxCost = 1.2;         // of the sum: a limb may be turned by 90 degrees and be as unlike besides
constexpr double kNamedCost = 0.1;       // of partners by name that are not alike at all
// Of the labelled skeletons those without left and right have at most 0.04 by chance, all others at least 0.11.
constexpr double kMinPaired = 0.07;
constexpr double kContradict = 0.2;  // fraction of named limbs whose sides are opposite to those of the rest
constexpr double kClearly = 1.25;    // times the length that has partners
constexpr double kNearPlane = 0.01;  // of the body's size: what is that near to the plane lies in it
constexpr double kInPlane = 0.35;    // sine of the angle to the plane, up to which what has no partner lies in it

class Folder {
 public:
  Folder(const JointTree& tree, std::span<const Vec3> positions, std::span<const std::optional<NamedPartner>> named)
      : tree_(tree), positions_(positions), named_(named), length_(tree.size(), 0.0), middle_(tree.size()) {
    Box box;
    for (const Vec3& position : positions) box.add(position);
    size_ = box.empty() ? 1 : std::max(box.diagonal(), 1e-12);
    for (Index j = 0; j < tree.size(); ++j) middle_[j] = positions[j];
    const std::span<const Index> order = tree.order();
    for (auto it = order.rbegin(); it != order.rend(); ++it) {
      if (const std::optional<Index>& parent = tree.parent(*it)) {
        length_[*parent] += length_[*it] + (positions[*it] - positions[*parent]).norm();
        middle_[*parent] += middle_[*it];
      }
    }
    for (const Index root : tree.roots()) allBones_ += length_[root];
    for (Index j = 0; j < tree.size(); ++j) middle_[j] /= static_cast<double>(tree.subtree(j).size());
  }

  HalfBody fold() {
    HalfBody best = foldAcross();
    // Where names and positions contradict each other about sides, as where limbs hang together at rest, names decide.
    double agree = 0, differ = 0;
    for (const HalfJoint& half : best.joints) {
      if (half.parent && best.joints[*half.parent].kind == HalfKind::kPair)
        continue;  // where a limb begins it has its side
      if (half.partner && areNamed(half.joint, *half.partner)) (named_[half.joint]->isLeft ? agree : differ) += 1;
    }
    if (std::min(agree, differ) > kContradict * (agree + differ)) {
      sidesByName_ = true;
      best = foldAcross();
      best.sidesByName = true;
    }
    return best;
  }

 private:
  HalfBody foldAcross() {
    HalfBody best;
    double most = -1;
    for (const Vec3& lateral : candidates()) {
      body_ = {};
      body_.lateral = lateral;
      paired_ = 0;
      foldForest();
      // Nearly all files have left and right along X: another axis has to be clearly better.
      const double paired = lateral == Vec3(Vec3::UnitX()) ? paired_ : paired_ / kClearly;
      if (paired <= most + 1e-9 * size_) continue;
      most = paired;
      best = body_;
      best.pairedFraction = allBones_ > 0 ? paired_ / allBones_ : 0;
    }
    best.hasPairs = best.pairedFraction > kMinPaired;
    if (best.hasPairs) return best;
    // Where nothing is a pair no joint has a side.
    body_ = {};
    pairs_ = false;
    foldForest();
    for (HalfJoint& half : body_.joints) half.kind = HalfKind::kMiddle;
    return body_;
  }

  // The axes, and the direction in which siblings that are alike lie from each other.
  std::vector<Vec3> candidates() const {
    Mat3 spread = Mat3::Zero();
    for (Index j = 0; j < tree_.size(); ++j) {
      const std::span<const Index> children = compared(tree_.children(j));
      for (std::size_t a = 0; a < children.size(); ++a) {
        for (std::size_t b = a + 1; b < children.size(); ++b) {
          if (unlikeness(children[a], children[b]) > kMaxDifference / 2) continue;
          const Vec3 across = middle_[children[a]] - middle_[children[b]];
          const double reach = length_[children[a]] + length_[children[b]];
          if (across.norm() > 1e-9 * size_) spread += reach * across.normalized() * across.normalized().transpose();
        }
      }
    }
    std::vector<Vec3> all = {Vec3::UnitX(), Vec3::UnitZ(), Vec3::UnitY()};
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(spread);
    const Vec3 main = solver.eigenvectors().col(2);
    if (main.allFinite() && main.cwiseAbs().maxCoeff() < 0.9999) all.push_back(main);
    return all;
  }

  static std::span<const Index> compared(std::span<const Index> children) {
    return children.first(std::min(children.size(), kMaxCompared));
  }

  double across(const Vec3& point) const { return body_.lateral.dot(point); }
  Vec3 mirrored(const Vec3& point, double plane) const { return point - 2 * (across(point) - plane) * body_.lateral; }

  static double fractionOf(double a, double b) { return std::abs(a - b) / std::max({a, b, 1e-12}); }
  // Of all bones that hang there, with the one that it hangs on.
  double lengthWithBone(Index joint) const {
    const std::optional<Index>& parent = tree_.parent(joint);
    return length_[joint] + (parent ? (positions_[joint] - positions_[*parent]).norm() : 0) + 1e-6 * size_;
  }
  double unlikeness(Index a, Index b) const {
    return std::max(
        fractionOf(lengthWithBone(a), lengthWithBone(b)),
        0.7 * fractionOf(static_cast<double>(tree_.subtree(a).size()), static_cast<double>(tree_.subtree(b).size())));
  }

  // None where they cannot be partners.
  std::optional<double> pairCost(Index a, Index b, const Vec3& from, double plane) const {
    if (areNamed(a, b))
      return isNamedFirst(a, b, plane) ? std::optional(kNamedCost * std::min(unlikeness(a, b), 1.0)) : std::nullopt;
    const double unlike = unlikeness(a, b);
    if (unlike > kMaxDifference) return std::nullopt;
    const double one = across(middle_[a]) - plane, other = across(middle_[b]) - plane;
    if (one - other < 2 * kMinWidth * size_) return std::nullopt;  // `a` is on the positive side
    const double reach = 0.5 * (length_[a] + length_[b]) +
                         0.5 * ((positions_[a] - from).norm() + (positions_[b] - from).norm()) + 1e-9 * size_;
    const double apart =
        (mirrored(middle_[a], plane) - middle_[b]).norm() + (mirrored(positions_[a], plane) - positions_[b]).norm();
    const double cost = apart / reach + unlike;
    return cost < kMaxCost ? std::optional(cost) : std::nullopt;
  }

  bool areNamed(Index a, Index b) const { return !named_.empty() && named_[a] && named_[a]->partner == b; }
  // The one on the positive side; at the same position the left one.
  bool isNamedFirst(Index a, Index b, double plane) const {
    const double one = across(middle_[a]) - plane, other = across(middle_[b]) - plane;
    const bool apart = std::abs(one - other) > 2 * kMinWidth * size_;
    return apart && !sidesByName_ ? one > other : named_[a]->isLeft;
  }

  struct Pair {
    double cost = 0;
    Index a = 0, b = 0;
  };

  // The best first, each joint once. `costOf` two joints: none where they cannot be partners.
  std::vector<Pair> pairsOf(std::span<const Index> some, std::span<const Index> others, const auto& costOf) const {
    std::vector<Pair> all, chosen;
    if (!pairs_) return chosen;
    for (const Index a : compared(some)) {
      for (const Index b : compared(others)) {
        if (a == b) continue;
        const std::optional<double> cost = costOf(a, b);
        if (cost) all.push_back({*cost, a, b});
      }
    }
    std::sort(all.begin(), all.end(),
              [](const Pair& p, const Pair& q) { return std::tie(p.cost, p.a, p.b) < std::tie(q.cost, q.a, q.b); });
    std::vector<bool> used(tree_.size(), false);
    for (const Pair& pair : all) {
      if (used[pair.a] || used[pair.b]) continue;
      used[pair.a] = used[pair.b] = true;
      chosen.push_back(pair);
    }
    return chosen;
  }

  // Of what hangs on two partners: which side is which is known, and poses may turn it anywhere.
  std::optional<double> limbCost(Index a, Index b, double plane) const {
    const double unlike = areNamed(a, b) ? kNamedCost * unlikeness(a, b) : unlikeness(a, b);
    if (unlike > 2 * kMaxDifference) return std::nullopt;
    const double reach = length_[a] + length_[b] + 0.05 * size_;
    return (mirrored(positions_[a], plane) - positions_[b]).norm() / reach + unlike;
  }

  Index add(Index joint, std::optional<Index> partner, HalfKind kind, std::optional<Index> parent, double plane) {
    HalfJoint half{joint, partner, kind, parent, positions_[joint]};
    if (partner) half.at = 0.5 * (positions_[joint] + mirrored(positions_[*partner], plane));
    body_.joints.push_back(half);
    return static_cast<Index>(body_.joints.size() - 1);
  }

  struct Open {
    Index half = 0;
    double plane = 0;
    bool isLeaf = false;  // what hangs on it is placed elsewhere
  };

  void foldForest() {
    std::vector<double> coordinates;
    for (const Vec3& position : positions_) coordinates.push_back(across(position));
    double plane = 0;
    if (!coordinates.empty()) {
      std::nth_element(coordinates.begin(), coordinates.begin() + static_cast<std::ptrdiff_t>(coordinates.size() / 2),
                       coordinates.end());
      plane = coordinates[coordinates.size() / 2];
    }
    std::vector<Open> open;
    placeChildren(tree_.roots(), std::nullopt, plane, open);
    while (!open.empty()) {
      const Open next = open.back();
      open.pop_back();
      if (next.isLeaf) continue;
      const HalfJoint half = body_.joints[next.half];
      if (half.kind == HalfKind::kPair) {
        placePairsChildren(half, next, open);
      } else if (half.kind == HalfKind::kSingle) {
        for (const Index child : tree_.children(half.joint)) {
          open.push_back({add(child, std::nullopt, HalfKind::kSingle, next.half, next.plane), next.plane});
        }
      } else {
        placeChildren(tree_.children(half.joint), next.half, across(half.at), open);
      }
    }
  }

  void placeChildren(std::span<const Index> children, std::optional<Index> parent, double plane,
                     std::vector<Open>& open) {
    std::vector<bool> used(tree_.size(), false);
    const Vec3 from = parent ? body_.joints[*parent].at : Vec3(plane * body_.lateral);
    const auto costOf = [&](Index a, Index b) { return pairCost(a, b, from, plane); };
    for (const Pair& pair : pairsOf(children, children, costOf)) {
      used[pair.a] = used[pair.b] = true;
      open.push_back({add(pair.a, pair.b, HalfKind::kPair, parent, plane), plane});
      count(pair, parent ? std::optional(body_.joints[*parent].joint) : std::nullopt);
    }
    for (const Index child : children) {
      if (used[child]) continue;
      const Vec3 offset = middle_[child] - from;
      const double aside = std::abs(across(middle_[child]) - plane);
      // Of a spine with fingers on one hand alone the middle lies beside the plane, the spine itself does not.
      const bool inPlane = !parent ? aside < 0.05 * size_ || length_[child] > 0.5 * size_
                                   : aside < kInPlane * offset.norm() + kNearPlane * size_ ||
                                         (liesInPlane(positions_[child], from, plane) && straddles(child, plane));
      open.push_back({add(child, std::nullopt, inPlane ? HalfKind::kMiddle : HalfKind::kSingle, parent, plane), plane});
    }
  }

  bool liesInPlane(const Vec3& point, const Vec3& from, double plane) const {
    return std::abs(across(point) - plane) < kInPlane * (point - from).norm() + kNearPlane * size_;
  }

  // Whether it carries something on both sides of the plane.
  bool straddles(Index joint, double plane) const {
    bool left = false, right = false;
    for (const Index below : tree_.subtree(joint)) {
      left = left || across(positions_[below]) > plane + 2 * kNearPlane * size_;
      right = right || across(positions_[below]) < plane - 2 * kNearPlane * size_;
    }
    return left && right;
  }

  void placePairsChildren(const HalfJoint& half, const Open& at, std::vector<Open>& open) {
    std::vector<bool> used(tree_.size(), false);
    const std::vector<Index> left = withoutExtra(half.joint, *half.partner, at, open),
                             right = withoutExtra(*half.partner, half.joint, at, open);
    const auto costOf = [&](Index a, Index b) { return limbCost(a, b, at.plane); };
    for (const Pair& pair : pairsOf(left, right, costOf)) {
      used[pair.a] = used[pair.b] = true;
      open.push_back({add(pair.a, pair.b, HalfKind::kPair, at.half, at.plane), at.plane});
      count(pair, half.joint);
    }
    for (const std::vector<Index>* side : {&left, &right}) {
      for (const Index child : *side) {
        if (!used[child]) open.push_back({add(child, std::nullopt, HalfKind::kSingle, at.half, at.plane), at.plane});
      }
    }
  }

  // The children of one of a pair. A single joint that the other side lacks (a twist joint, say) is replaced by its
  // children, which are more like the other side's child.
  std::vector<Index> withoutExtra(Index joint, Index partner, const Open& at, std::vector<Open>& open) {
    const std::span<const Index> children = tree_.children(joint), others = tree_.children(partner);
    if (children.size() != 1 || others.size() != 1 || tree_.children(children[0]).size() != 1)
      return {children.begin(), children.end()};
    const Index extra = children[0], below = tree_.children(extra)[0], other = others[0];
    if (tree_.subtree(below).size() != tree_.subtree(other).size()) return {children.begin(), children.end()};
    const auto off = [&](Index child) { return (mirrored(positions_[child], at.plane) - positions_[other]).norm(); };
    const bool named = areNamed(below, other), closer = off(below) < off(extra);
    if (!named && (areNamed(extra, other) || !closer)) return {children.begin(), children.end()};
    open.push_back({add(extra, std::nullopt, HalfKind::kSingle, at.half, at.plane), at.plane, true});
    return {below};
  }

  void count(const Pair& pair, std::optional<Index> parent) {
    const double bone = parent ? (positions_[pair.a] - positions_[*parent]).norm() : 0;
    paired_ += bone * std::max(0.0, 1 - pair.cost / kMaxCost);
  }

  const JointTree& tree_;
  std::span<const Vec3> positions_;
  std::span<const std::optional<NamedPartner>> named_;
  std::vector<double> length_;  // #J, of all bones that hang on it
  std::vector<Vec3> middle_;    // #J, mean position of it and all its descendants
  double size_ = 1, allBones_ = 0;
  HalfBody body_;
  bool sidesByName_ = false, pairs_ = true;
  double paired_ = 0;  // length of bones that have a partner, less where they are no mirror images
};

}  // namespace

HalfBody foldBody(const JointTree& tree, std::span<const Vec3> positions,
                  std::span<const std::optional<NamedPartner>> named) {
  return Folder(tree, positions, named).fold();
}

}  // namespace limber
