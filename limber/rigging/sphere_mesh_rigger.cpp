#include "limber/rigging/sphere_mesh_rigger.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "limber/rigging/sphere_mesh/handle_count.h"
#include "limber/rigging/sphere_mesh/handle_tree.h"
#include "limber/rigging/sphere_mesh/spheres_inside.h"

namespace limber {

namespace {

constexpr Index kFewestSuggested = 5, kMaxSuggested = 64, kMaxListed = 8;
constexpr double kNeighborhood = 1.4;  // the trend is taken from a count divided by this to one multiplied by it

// The number in a handle's name: one for each mirror pair or single handle, in the order of the joints.
std::vector<Index> handleNumbers(const HandleTree& tree, const SphereMeshLevel& level) {
  std::vector<Index> numbers(tree.order.size(), kNoIndex);
  Index next = 0;
  for (const Index handle : tree.order) {
    const Index image = level.images.empty() ? kNoIndex : level.images[handle];
    numbers[handle] = image != kNoIndex && numbers[image] != kNoIndex ? numbers[image] : next++;
  }
  return numbers;
}

std::string_view sideOf(Index handle, const SphereMeshLevel& level) {
  if (level.images.empty() || level.images[handle] == kNoIndex || level.images[handle] == handle) return "";
  return handle < level.images[handle] ? ".L" : ".R";
}

// Errors over counts as a curve, both axes logarithmic.
class ErrorCurve {
 public:
  explicit ErrorCurve(std::vector<double> errors) : errors_(std::move(errors)), floor_(1e-6 * errors_[1]) {}

  Index most() const { return static_cast<Index>(errors_.size() - 1); }
  bool isWorth(Index count) const { return errors_[count - 1] > errors_[count] && errors_[count] > floor_; }
  // How much steeper the error falls up to a count than from there on.
  double bend(Index count) const {
    const double here = at(count), before = at(count / kNeighborhood), after = at(count * kNeighborhood);
    return ((before - here) - (here - after)) / std::log(kNeighborhood);
  }

 private:
  double at(double count) const {
    count = std::clamp(count, 1.0, static_cast<double>(most()));
    const std::size_t low = static_cast<std::size_t>(count), high = std::min<std::size_t>(low + 1, most());
    const double part = count - static_cast<double>(low);
    return (1 - part) * std::log(errors_[low] + floor_) + part * std::log(errors_[high] + floor_);
  }

  std::vector<double> errors_;
  double floor_;  // less is no error
};

// Few handles make poor limbs; many are hard to take hold of, and lie about the trunk in rings.
double distanceFromUsual(Index count, Index usual) {
  const double ratio = std::log(static_cast<double>(count) / usual);
  const double width = ratio < 0 ? 0.3 : 0.5;
  return 0.7 * (ratio / width) * (ratio / width);
}

}  // namespace

void checkHandles(const TriMesh& mesh, const RigOptions& options) {
  if (!options.handles) return;
  if (*options.handles >= 1 && *options.handles <= mesh.vertexCount()) return;
  refuseHandleCount(*options.handles, mesh.vertexCount());
}

Index suggestedFrom() {
  return static_cast<Index>(kMaxSuggested * kNeighborhood) + 1;
}

std::vector<HandleSuggestion> suggestHandles(const SphereMesh& spheres) {
  const LimbCount limbs = spheres.limbs();
  // Three for each limb, so that it bends, and some for the trunk.
  const Index usual = std::max<Index>(10, 3 * limbs.limbs + 5);
  // Where an end is lost that early, it is no limb that anybody would count.
  const bool allHaveHandles = 2 * limbs.fewestHandles <= 3 * usual;
  return suggestHandles(spheres.errors(suggestedFrom()), spheres.maxSpheres(), usual,
                        allHaveHandles ? limbs.fewestHandles : 1);
}

std::vector<HandleSuggestion> suggestHandles(std::vector<double> errors, Index maxHandles, Index usual, Index fewest) {
  const ErrorCurve curve(std::move(errors));
  std::vector<HandleSuggestion> steps;
  const Index most = std::min(kMaxSuggested, static_cast<Index>(curve.most() / kNeighborhood));
  for (Index count = std::max(kFewestSuggested, fewest); count <= most; ++count) {
    if (!curve.isWorth(count)) continue;
    const double clearness = curve.bend(count) - distanceFromUsual(count, usual);
    steps.push_back({count, 1 / (1 + std::exp(-2 * clearness))});
  }
  std::stable_sort(steps.begin(), steps.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  // Of counts that are nearly the same only the best.
  std::vector<HandleSuggestion> suggestions;
  for (const HandleSuggestion& step : steps) {
    const bool isNew = std::none_of(suggestions.begin(), suggestions.end(), [&](const HandleSuggestion& better) {
      return 10 * std::max(step.handles, better.handles) < 12 * std::min(step.handles, better.handles);
    });
    if (isNew && suggestions.size() < kMaxListed) suggestions.push_back(step);
  }
  if (suggestions.empty()) suggestions.push_back({std::min(std::max(usual, std::min(fewest, most)), maxHandles), 0});
  return suggestions;
}

Skeleton handleSkeleton(const SphereMesh& spheres, Index count) {
  return handleSkeleton(spheres.level(count));
}

Skeleton handleSkeleton(const SphereMeshLevel& level) {
  return handleSkeleton(level, handleTree(level));
}

Skeleton handleSkeleton(const SphereMeshLevel& level, const HandleTree& tree) {
  const std::vector<Index> numbers = handleNumbers(tree, level);
  const std::size_t width = std::max<std::size_t>(2, fmt::formatted_size("{}", level.spheres.size() - 1));
  Skeleton skeleton;
  skeleton.boneShape = BoneShape::kSphere;
  skeleton.joints.reserve(tree.order.size());
  for (std::size_t j = 0; j < tree.order.size(); ++j) {
    const Index handle = tree.order[j];
    Joint joint;
    joint.name = fmt::format("handle_{:0{}}{}", numbers[handle], width, sideOf(handle, level));
    joint.parent = tree.parents[j];
    joint.rest.translation = level.spheres[handle].center;
    if (joint.parent) joint.rest.translation -= level.spheres[tree.order[*joint.parent]].center;
    joint.radius = level.spheres[handle].radius;
    skeleton.joints.push_back(std::move(joint));
  }
  return skeleton;
}

AutoRig rigWithSphereMesh(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  checkHandles(mesh, options);
  const std::shared_ptr<RigMemory> memory = options.memory ? options.memory : std::make_shared<RigMemory>();
  if (!memory->spheres || memory->spheres->vertexCount() != mesh.vertexCount()) {
    progress.step("collapse");
    memory->spheres = std::make_shared<const SphereMesh>(SphereMesh::build(mesh, progress));
  }
  const SphereMesh& spheres = *memory->spheres;
  AutoRig rig;
  progress.step("handles");
  rig.suggestions = suggestHandles(spheres);
  const Index count = options.handles.value_or(rig.suggestions.front().handles);
  SphereMeshLevel level = spheres.level(count);
  rig.jointOf = spheres.vertexHandles(count);
  moveSpheresInside(level, mesh, rig.jointOf, spheres.mirror());
  const HandleTree tree = handleTree(level);
  rig.skeleton = handleSkeleton(level, tree);
  std::vector<Index> joints(tree.order.size());  // per handle
  for (Index j = 0; j < joints.size(); ++j) joints[tree.order[j]] = j;
  for (Index& of : rig.jointOf) of = joints[of];
  return rig;
}

}  // namespace limber
