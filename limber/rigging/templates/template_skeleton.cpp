#include "limber/rigging/templates/template_skeleton.h"

#include <cctype>
#include <cmath>
#include <utility>

#include "limber/core/error.h"

namespace limber {

namespace {

constexpr double kPinnedEvenly = 0.01;  // heights between a pin and the mirror image of the other
constexpr double kSamePosition = 0.02;  // heights between a position and its mirror image

struct SideWord {
  std::string_view left, right;
};
constexpr SideWord kSides[] = {{"left", "right"}, {"Left", "Right"}, {".L", ".R"}, {".l", ".r"},
                               {"_L", "_R"},      {"_l", "_r"},      {"-L", "-R"}, {"-l", "-r"}};

// The name with its side turned, if it has one.
std::optional<std::string> otherSide(const std::string& name) {
  for (const SideWord& word : kSides) {
    for (const auto& [own, other] : {std::pair(word.left, word.right), std::pair(word.right, word.left)}) {
      const std::size_t at = name.rfind(own);
      // Short signs count only at the end of a name or before a further part.
      if (at == std::string::npos) continue;
      const std::size_t end = at + own.size();
      if (own.size() == 2 && end < name.size() && std::isalnum(static_cast<unsigned char>(name[end]))) continue;
      return name.substr(0, at) + std::string(other) + name.substr(end);
    }
  }
  return std::nullopt;
}

void findMirrors(TemplateSkeleton& skeleton) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<std::string> name = otherSide(skeleton.joints[j].name);
    const std::optional<Index> other = name ? skeleton.find(*name) : std::nullopt;
    if (!other) continue;
    const Vec3 position = skeleton.joints[j].position,
               image = skeleton.joints[*other].position.cwiseProduct(Vec3(-1, 1, 1));
    // Collars of motion files often stand in the middle both: those have no sides.
    if ((image - position).norm() > kSamePosition || std::abs(position.x()) < 0.5 * kSamePosition) continue;
    skeleton.joints[j].mirror = other;
  }
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    const std::optional<Index> other = skeleton.joints[j].mirror;
    if (other && skeleton.joints[*other].mirror != j) skeleton.joints[j].mirror.reset();
  }
}

// Motion files have a joint of such a name where a limb ends.
bool endsBone(std::string_view name) {
  constexpr std::string_view kEnd = "_end";
  return name.size() > kEnd.size() && name.substr(name.size() - kEnd.size()) == kEnd;
}

// Adds a tip to every leaf that is none, half as long as the bone above.
void addTips(TemplateSkeleton& skeleton, const std::vector<Index>& children) {
  const Index count = skeleton.jointCount();
  for (Index j = 0; j < count; ++j) {
    if (children[j] > 0) continue;
    TemplateJoint& leaf = skeleton.joints[j];
    if (endsBone(leaf.name) && leaf.parent) {
      leaf.role = TemplateRole::kTip;
      continue;
    }
    const Vec3 bone = leaf.parent ? Vec3(leaf.position - skeleton.joints[*leaf.parent].position) : Vec3(0, 0.2, 0);
    TemplateJoint tip;
    tip.name = leaf.name + " tip";
    tip.parent = j;
    tip.position = leaf.position + 0.5 * bone;
    tip.role = TemplateRole::kTip;
    skeleton.joints.push_back(std::move(tip));
  }
}

}  // namespace

std::optional<Index> TemplateSkeleton::find(std::string_view joint) const {
  for (Index j = 0; j < jointCount(); ++j) {
    if (joints[j].name == joint) return j;
  }
  return std::nullopt;
}

bool pinnedEvenly(const TemplateSkeleton& skeleton, const TemplatePins& pins) {
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    if (!pins[j]) continue;
    const std::optional<Vec3>& other = pins[skeleton.joints[j].mirror.value_or(j)];
    if (!other || (other->cwiseProduct(Vec3(-1, 1, 1)) - *pins[j]).norm() > kPinnedEvenly) return false;
  }
  return true;
}

TemplateSkeleton templateFrom(const Skeleton& skeleton, std::string_view name) {
  if (skeleton.joints.empty()) {
    throw Error(ErrorCode::kBadData, "the template has no joint", std::string(name));
  }
  checkSkeleton(skeleton);
  const std::vector<Affine> globals = restGlobals(skeleton);
  Box box;
  for (const Affine& global : globals) box.add(global.translation());
  const double height = box.size().y();
  if (!(height > 1e-6 * box.longestSide())) {
    throw Error(ErrorCode::kBadData, "all joints of the template lie at one height", skeleton.joints.front().name,
                "its up must be +Y");
  }
  TemplateSkeleton result;
  result.name = std::string(name);
  std::vector<Index> children(skeleton.jointCount(), 0);
  for (Index j = 0; j < skeleton.jointCount(); ++j) {
    TemplateJoint joint;
    joint.name = skeleton.joints[j].name;
    joint.parent = skeleton.joints[j].parent;
    if (joint.parent) ++children[*joint.parent];
    const Vec3 position = globals[j].translation() - Vec3(box.center().x(), box.min.y(), box.center().z());
    joint.position = 0.95 * position / height;
    result.joints.push_back(std::move(joint));
  }
  addTips(result, children);
  findMirrors(result);
  return result;
}

}  // namespace limber
