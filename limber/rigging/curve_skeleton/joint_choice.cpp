#include "limber/rigging/curve_skeleton/joint_choice.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "limber/core/error.h"

namespace limber {

namespace {

// A straight bone against a branch: so much of its length. An arm gets its elbow before what is shorter than a quarter
// of the arm gets an end.
constexpr double kStraight = 0.25;
constexpr double kBent = 0.1;  // of its length, how far a bone's curve is off for the joint to go where it bends most
constexpr double kInBody = 0.05;   // of its length a branch counts that does not stick out of the body
constexpr double kMidNode = 0.25;  // of a bone's length, how far from its middle a node is still taken for it

class JointChooser {
 public:
  explicit JointChooser(const CurveTree& tree)
      : tree_(tree), branchesAt_(tree.points.size()), jointOf_(tree.points.size(), kNoIndex) {
    makeBranches();
    jointOf_[0] = addJoint(tree_.points[0], tree_.radii[0], tree_.isPaired[0]);
    offerBranches(0);
  }

  SphereMeshLevel run(Index count) {
    while (count_ < count && takeBest(count - count_)) {
    }
    if (count_ < count) takeHalf();
    if (count_ < count) {
      throw Error(ErrorCode::kUnsupported, "the model shrinks to one point, which can have one joint alone", {},
                  "ask for 1 handle, or take the rigger sphere-mesh");
    }
    return level();
  }

  std::vector<double> errors(Index most) {
    std::vector<double> errors = {std::numeric_limits<double>::infinity()};
    for (bool goesOn = true; goesOn && errors.size() <= most; goesOn = takeBest(kNoIndex)) {
      const double rest = std::min(errors.back(), offers_.empty() ? 0 : offers_.top().value);
      errors.resize(count_, errors.size() == 1 ? rest : errors.back());
      errors.push_back(rest);
    }
    errors.resize(most + std::size_t{1}, 0);
    return errors;
  }

 private:
  struct Joint {
    Vec3 point;
    double radius;
    bool isPaired, isHalf;  // half: the pair's image is left out
    double weight = 0;
  };
  // From the node that it comes off, to a leaf or to the last node on the plane.
  struct Branch {
    std::vector<Index> nodes;
    std::vector<double> arc;                       // per node, from the first
    std::vector<std::pair<double, Index>> joints;  // by arc; none until the branch is taken
  };
  struct Bone {
    Index branch, from, to;
    double begin, end;  // arc
    double split = 0;   // arc of its best joint
    bool isGone = false;
  };
  struct Offer {
    double value;
    bool isBone;
    Index number;
    bool operator<(const Offer& other) const {
      if (value != other.value) return value < other.value;
      return std::tie(other.isBone, other.number) < std::tie(isBone, number);
    }
  };

  void makeBranches();
  Index addJoint(const Vec3& point, double radius, bool isPaired, bool isHalf = false) {
    joints_.push_back({point, radius, isPaired, isHalf});
    count_ += isPaired && !isHalf ? 2 : 1;
    return static_cast<Index>(joints_.size() - 1);
  }
  void offerBranches(Index node);
  void addBone(Index branch, Index from, Index to, double begin, double end);
  bool isPaired(const Branch& branch) const { return tree_.isPaired[branch.nodes.back()]; }
  std::pair<Vec3, double> at(const Branch& branch, double arc) const;
  Index nearJoint(Index node) const;
  Index costOf(const Offer& offer) const;
  Index jointAtNode(Index node);
  void take(const Offer& offer);
  bool takeBest(Index left);
  void takeHalf();
  Index splitBone(Index bone, double arc);
  void spreadWeights();
  SphereMeshLevel level();

  const CurveTree& tree_;
  std::vector<Branch> branches_;
  std::vector<Index> branchOf_;                 // per node but the root: the branch that it is an inner node or end of
  std::vector<double> arcOf_;                   // and where on it
  std::vector<double> reach_;                   // per node: length of the longest path down
  std::vector<std::vector<Index>> branchesAt_;  // per node: those that come off there
  std::vector<Index> jointOf_;                  // per node
  std::vector<Joint> joints_;
  std::vector<Bone> bones_;
  std::vector<std::pair<Index, Index>> halves_;  // joints without an image, and what they hang on
  std::priority_queue<Offer> offers_;
  Index count_ = 0;
};

void JointChooser::makeBranches() {
  const Index size = static_cast<Index>(tree_.points.size());
  const auto lengthOf = [&](Index v) { return (tree_.points[v] - tree_.points[tree_.parents[v]]).norm(); };
  reach_.assign(size, 0);
  for (Index v = size; v-- > 1;) reach_[tree_.parents[v]] = std::max(reach_[tree_.parents[v]], lengthOf(v) + reach_[v]);
  // The child that goes on with its parent's branch: the one with the longest path, on the plane as the parent is.
  std::vector<Index> next(size, kNoIndex);
  for (Index v = 1; v < size; ++v) {
    const Index parent = tree_.parents[v];
    if (parent == 0 || tree_.isPaired[v] != tree_.isPaired[parent]) continue;
    Index& best = next[parent];
    if (best == kNoIndex || lengthOf(v) + reach_[v] > lengthOf(best) + reach_[best]) best = v;
  }
  branchOf_.assign(size, kNoIndex);
  arcOf_.assign(size, 0);
  for (Index v = 1; v < size; ++v) {
    const Index parent = tree_.parents[v];
    if (next[parent] == v) continue;
    const Index number = static_cast<Index>(branches_.size());
    Branch branch{{parent}, {0}, {}};
    for (Index u = v; u != kNoIndex; u = next[u]) {
      branch.arc.push_back(branch.arc.back() + lengthOf(u));
      branch.nodes.push_back(u);
      branchOf_[u] = number;
      arcOf_[u] = branch.arc.back();
    }
    branchesAt_[parent].push_back(number);
    branches_.push_back(std::move(branch));
  }
}

void JointChooser::offerBranches(Index node) {
  for (const Index b : branchesAt_[node]) {
    const Index first = branches_[b].nodes[1];
    const double length = (tree_.points[first] - tree_.points[node]).norm() + reach_[first];
    offers_.push({std::max(length - tree_.radii[node], kInBody * length), false, b});
  }
}

std::pair<Vec3, double> JointChooser::at(const Branch& branch, double arc) const {
  const auto above = std::upper_bound(branch.arc.begin() + 1, branch.arc.end() - 1, arc);
  const std::size_t i = static_cast<std::size_t>(above - branch.arc.begin());
  const double length = branch.arc[i] - branch.arc[i - 1];
  const double part = length > 0 ? std::clamp((arc - branch.arc[i - 1]) / length, 0.0, 1.0) : 0;
  const Index a = branch.nodes[i - 1], b = branch.nodes[i];
  return {(1 - part) * tree_.points[a] + part * tree_.points[b], (1 - part) * tree_.radii[a] + part * tree_.radii[b]};
}

void JointChooser::addBone(Index branch, Index from, Index to, double begin, double end) {
  Bone bone{branch, from, to, begin, end};
  const Branch& curve = branches_[branch];
  const Vec3 a = joints_[from].point, along = joints_[to].point - a;
  const double middle = 0.5 * (begin + end), length = end - begin;
  double off = 0, nearest = kMidNode * length;
  double farthestArc = middle, middleArc = middle;
  const auto first = std::upper_bound(curve.arc.begin(), curve.arc.end(), begin);
  for (std::size_t i = static_cast<std::size_t>(first - curve.arc.begin()); i < curve.arc.size(); ++i) {
    if (curve.arc[i] >= end) break;
    const Vec3 displacement = tree_.points[curve.nodes[i]] - a;
    const double part =
        along.squaredNorm() > 0 ? std::clamp(displacement.dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    const double distance = (displacement - part * along).norm();
    if (distance > off) {
      off = distance;
      farthestArc = curve.arc[i];
    }
    if (std::abs(curve.arc[i] - middle) < nearest) {
      nearest = std::abs(curve.arc[i] - middle);
      middleArc = curve.arc[i];
    }
  }
  const bool bends = off > kBent * length;
  bone.split = bends ? farthestArc : middleArc;
  const double value = off + kStraight * length;
  if (length > 0) offers_.push({value, true, static_cast<Index>(bones_.size())});
  bones_.push_back(bone);
}

Index JointChooser::splitBone(Index number, double arc) {
  const Bone bone = bones_[number];
  bones_[number].isGone = true;
  Branch& branch = branches_[bone.branch];
  const auto [point, radius] = at(branch, arc);
  const Index joint = addJoint(point, radius, isPaired(branch));
  for (std::size_t i = 0; i < branch.nodes.size(); ++i) {
    if (branch.arc[i] == arc && i > 0) jointOf_[branch.nodes[i]] = joint;
  }
  branch.joints.insert(std::upper_bound(branch.joints.begin(), branch.joints.end(), std::pair(arc, joint)),
                       {arc, joint});
  addBone(bone.branch, bone.from, joint, bone.begin, arc);
  addBone(bone.branch, joint, bone.to, arc, bone.end);
  return joint;
}

// The joint that a branch from a node may hang on without one of its own: at the node, or within the body's radius.
Index JointChooser::nearJoint(Index node) const {
  if (jointOf_[node] != kNoIndex) return jointOf_[node];
  Index best = kNoIndex;
  double least = tree_.radii[node];
  for (const auto& [arc, joint] : branches_[branchOf_[node]].joints) {
    const double distance = std::abs(arc - arcOf_[node]);
    if (distance >= least || joints_[joint].isPaired != static_cast<bool>(tree_.isPaired[node])) continue;
    least = distance;
    best = joint;
  }
  return best;
}

Index JointChooser::costOf(const Offer& offer) const {
  const auto times = [](bool isPair) { return Index{1} + isPair; };
  if (offer.isBone) return times(isPaired(branches_[bones_[offer.number].branch]));
  const Branch& branch = branches_[offer.number];
  const Index node = branch.nodes.front();
  return times(isPaired(branch)) + (nearJoint(node) == kNoIndex ? times(tree_.isPaired[node]) : 0);
}

Index JointChooser::jointAtNode(Index node) {
  const Index near = nearJoint(node);
  if (near != kNoIndex) return near;
  for (Index b = 0; b < bones_.size(); ++b) {
    const Bone& bone = bones_[b];
    if (bone.isGone || bone.branch != branchOf_[node] || arcOf_[node] < bone.begin || arcOf_[node] > bone.end) continue;
    return splitBone(b, arcOf_[node]);
  }
  return joints_.empty() ? kNoIndex : 0;
}

void JointChooser::take(const Offer& offer) {
  if (offer.isBone) {
    splitBone(offer.number, bones_[offer.number].split);
    return;
  }
  const Index from = jointAtNode(branches_[offer.number].nodes.front());
  Branch& branch = branches_[offer.number];
  const Index last = branch.nodes.back();
  const Index end = addJoint(tree_.points[last], tree_.radii[last], isPaired(branch));
  jointOf_[last] = end;
  branch.joints = {{0, from}, {branch.arc.back(), end}};
  addBone(offer.number, from, end, 0, branch.arc.back());
  for (std::size_t i = 1; i < branch.nodes.size(); ++i) offerBranches(branch.nodes[i]);
}

// The best that takes no more than `left` joints.
bool JointChooser::takeBest(Index left) {
  std::vector<Offer> tooMany;
  bool isTaken = false;
  while (!isTaken && !offers_.empty()) {
    const Offer offer = offers_.top();
    offers_.pop();
    if (offer.isBone && bones_[offer.number].isGone) continue;
    if (costOf(offer) > left) {
      tooMany.push_back(offer);
      continue;
    }
    take(offer);
    isTaken = true;
  }
  for (const Offer& offer : tooMany) offers_.push(offer);
  return isTaken;
}

// One of a pair, beside the bone that it would split or at the end of the branch.
void JointChooser::takeHalf() {
  for (; !offers_.empty(); offers_.pop()) {
    const Offer offer = offers_.top();
    if (offer.isBone && bones_[offer.number].isGone) continue;
    const Branch& branch = branches_[offer.isBone ? bones_[offer.number].branch : offer.number];
    const Index from = offer.isBone ? bones_[offer.number].from : nearJoint(branch.nodes.front());
    if (from == kNoIndex) continue;
    const auto [point, radius] = at(branch, offer.isBone ? bones_[offer.number].split : branch.arc.back());
    halves_.push_back({addJoint(point, radius, true, true), from});
    return;
  }
}

// Each node's weight goes to the nearest joint along its branch; of branches without joints to where they come off.
void JointChooser::spreadWeights() {
  std::vector<double> weights = tree_.weights;
  for (Index v = static_cast<Index>(weights.size()); v-- > 1;) {
    const auto& joints = branches_[branchOf_[v]].joints;
    if (joints.empty()) {
      const Index parent = tree_.parents[v];
      weights[parent] += weights[v] * (tree_.isPaired[v] && !tree_.isPaired[parent] ? 2 : 1);
      continue;
    }
    const auto nearest = std::min_element(joints.begin(), joints.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.first - arcOf_[v]) < std::abs(b.first - arcOf_[v]);
    });
    Joint& joint = joints_[nearest->second];
    joint.weight += weights[v] * (tree_.isPaired[v] && !joint.isPaired ? 2 : 1);
  }
  joints_[0].weight += weights[0];
}

SphereMeshLevel JointChooser::level() {
  spreadWeights();
  SphereMeshLevel level;
  std::vector<Index> handles;  // per joint; that of its image comes next
  const auto hasImage = [&](Index j) { return joints_[j].isPaired && !joints_[j].isHalf; };
  for (Index j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    const Index handle = static_cast<Index>(level.spheres.size());
    handles.push_back(handle);
    level.spheres.push_back({joint.point, joint.radius});
    level.weights.push_back(joint.weight);
    if (tree_.isMirrored) level.images.push_back(joint.isHalf ? kNoIndex : handle + hasImage(j));
    if (!hasImage(j)) continue;
    level.spheres.push_back({Vec3(-joint.point.x(), joint.point.y(), joint.point.z()), joint.radius});
    level.weights.push_back(joint.weight);
    level.images.push_back(handle);
  }
  const auto connect = [&](Index a, Index b) { level.edges.push_back({std::min(a, b), std::max(a, b)}); };
  for (const Bone& bone : bones_) {
    if (bone.isGone) continue;
    connect(handles[bone.from], handles[bone.to]);
    const bool from = hasImage(bone.from), to = hasImage(bone.to);
    if (from || to) connect(handles[bone.from] + from, handles[bone.to] + to);
  }
  for (const auto& [joint, from] : halves_) connect(handles[joint], handles[from]);
  // Where nothing lies on the plane, the root's pair holds both sides together.
  if (hasImage(0)) connect(handles[0], handles[0] + 1);
  std::sort(level.edges.begin(), level.edges.end());
  return level;
}

}  // namespace

SphereMeshLevel chooseJoints(const CurveTree& tree, Index count) {
  return JointChooser(tree).run(count);
}

std::vector<double> choiceErrors(const CurveTree& tree, Index maxCount) {
  return JointChooser(tree).errors(maxCount);
}

}  // namespace limber
