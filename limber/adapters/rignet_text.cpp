#include "limber/adapters/rignet_text.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "limber/core/text/parse_number.h"
#include "limber/core/text/split_text.h"
#include "limber/document/utf8.h"

namespace limber {

namespace {

constexpr Index kMaxSlots = 8;

struct Link {
  std::string_view parent, child;
  std::size_t line;
};

struct VertexLine {
  Index vertex;
  std::vector<std::string_view> words;  // NAME w NAME w ...
  std::size_t line;
};

struct TextJoint {
  std::string_view name;
  Vec3 position;
  std::optional<std::size_t> parent;  // into the joints as they come
};

// Reads line by line what each line says, and puts it together when all is there.
class RignetReader {
 public:
  RignetReader(std::string_view name, Index vertexCount) : name_(name), vertexCount_(vertexCount) {}

  RignetRig read(std::string_view text) {
    for (const std::string_view line : splitAt(text, '\n')) {
      ++line_;
      readLine(wordsIn(line, " \t\r"));
    }
    if (joints_.empty()) fail("has no joint");
    for (const Link& link : links_) connect(link);
    RignetRig rig;
    rig.skeleton = orderedSkeleton(rig.warnings);
    if (!vertices_.empty()) rig.weights = weightsOf(rig.skeleton);
    return rig;
  }

 private:
  [[noreturn]] void fail(const std::string& message, std::size_t line = 0) const {
    throw Error(ErrorCode::kBadData, message, line > 0 ? fmt::format("{}: line {}", name_, line) : std::string(name_));
  }

  double numberOf(std::string_view word, std::size_t line) const {
    const std::optional<double> number = finiteNumber(word);
    if (!number) fail(fmt::format("'{}' is no number", shown(word)), line);
    return *number;
  }

  // Garbage can be long and no text at all.
  static std::string shown(std::string_view word) {
    constexpr std::size_t kShown = 40;
    return validUtf8(word.substr(0, kShown));
  }

  void readLine(const std::vector<std::string_view>& words) {
    if (words.empty()) return;
    const std::string_view what = words.front();
    if (what == "joints" || what == "joint") {
      expect(words, 5, "joints NAME x y z");
      addJoint(words);
    } else if (what == "root") {
      expect(words, 2, "root NAME");
      if (!root_.empty() && root_ != words[1]) fail("names a second root", line_);
      root_ = words[1];
      rootLine_ = line_;
    } else if (what == "hier") {
      expect(words, 3, "hier PARENT CHILD");
      links_.push_back({words[1], words[2], line_});
    } else if (what == "skin") {
      if (words.size() < 2 || words.size() % 2 != 0) fail("is not 'skin VERTEX NAME w NAME w ...'", line_);
      addVertex(words);
    } else {
      fail(fmt::format("begins with '{}', not with joints, root, hier or skin", shown(what)), line_);
    }
  }

  void expect(const std::vector<std::string_view>& words, std::size_t count, std::string_view form) const {
    if (words.size() != count) fail(fmt::format("is not '{}'", form), line_);
  }

  void addJoint(const std::vector<std::string_view>& words) {
    if (validUtf8(words[1]) != words[1]) fail("has a name that is no UTF-8", line_);
    if (!jointOf_.emplace(words[1], joints_.size()).second) {
      fail(fmt::format("names the joint '{}' a second time", shown(words[1])), line_);
    }
    TextJoint& joint = joints_.emplace_back();
    joint.name = words[1];
    for (int axis = 0; axis < 3; ++axis) joint.position[axis] = numberOf(words[2 + axis], line_);
  }

  void addVertex(const std::vector<std::string_view>& words) {
    const double number = numberOf(words[1], line_);
    if (number < 0 || number != std::floor(number)) fail(fmt::format("'{}' is no vertex", shown(words[1])), line_);
    if (number >= vertexCount_) {
      fail(fmt::format("binds vertex {}, but the model that was handed over has {}", shown(words[1]), vertexCount_),
           line_);
    }
    vertices_.push_back({static_cast<Index>(number), {words.begin() + 2, words.end()}, line_});
  }

  std::size_t jointCalled(std::string_view name, std::size_t line) const {
    const auto found = jointOf_.find(name);
    if (found == jointOf_.end()) fail(fmt::format("names the joint '{}', which has no place", shown(name)), line);
    return found->second;
  }

  void connect(const Link& link) {
    TextJoint& child = joints_[jointCalled(link.child, link.line)];
    const std::size_t parent = jointCalled(link.parent, link.line);
    if (child.parent && *child.parent != parent) {
      fail(fmt::format("gives the joint '{}' a second parent", shown(link.child)), link.line);
    }
    child.parent = parent;
  }

  // Depth first from the root, then from those that hang on nothing, each in the file's order.
  Skeleton orderedSkeleton(Warnings& warnings) {
    std::vector<std::vector<std::size_t>> children(joints_.size());
    std::vector<std::size_t> roots;
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (joints_[j].parent) {
        children[*joints_[j].parent].push_back(j);
      } else {
        roots.push_back(j);
      }
    }
    if (!root_.empty()) {
      const std::size_t root = jointCalled(root_, rootLine_);
      if (joints_[root].parent) fail(fmt::format("the root '{}' has a parent", shown(root_)), rootLine_);
      std::stable_partition(roots.begin(), roots.end(), [&](std::size_t j) { return j == root; });
    }
    Skeleton skeleton;
    indexOf_.assign(joints_.size(), std::nullopt);
    std::vector<std::size_t> open(roots.rbegin(), roots.rend());
    while (!open.empty()) {
      const std::size_t j = open.back();
      open.pop_back();
      addTo(skeleton, j);
      open.insert(open.end(), children[j].rbegin(), children[j].rend());
    }
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      if (!indexOf_[j]) fail(fmt::format("the joint '{}' is below itself", shown(joints_[j].name)));
    }
    if (roots.size() > 1) {
      warnings.add("loose-joints", "joints hang on nothing and are roots of their own",
                   std::string(joints_[roots[1]].name), roots.size() - 1);
    }
    return skeleton;
  }

  void addTo(Skeleton& skeleton, std::size_t j) {
    const TextJoint& from = joints_[j];
    Joint& joint = skeleton.joints.emplace_back();
    joint.name = from.name;
    joint.rest.translation = from.position;
    if (from.parent) {
      joint.parent = indexOf_[*from.parent];
      joint.rest.translation -= joints_[*from.parent].position;
    }
    indexOf_[j] = skeleton.jointCount() - 1;
  }

  SkinWeights weightsOf(const Skeleton& skeleton) const {
    SkinWeights weights;
    weights.slots = std::min(kMaxSlots, skeleton.jointCount());
    weights.joints.assign(std::size_t{vertexCount_} * weights.slots, 0);
    weights.weights.assign(std::size_t{vertexCount_} * weights.slots, 0.0f);
    std::vector<bool> isBound(vertexCount_, false);
    std::vector<std::pair<double, Index>> influences;
    for (const VertexLine& line : vertices_) {
      if (isBound[line.vertex]) fail(fmt::format("binds vertex {} a second time", line.vertex), line.line);
      isBound[line.vertex] = true;
      readInfluences(line, influences);
      for (std::size_t slot = 0; slot < std::min<std::size_t>(influences.size(), weights.slots); ++slot) {
        const std::size_t at = std::size_t{line.vertex} * weights.slots + slot;
        weights.weights[at] = static_cast<float>(influences[slot].first);
        weights.joints[at] = influences[slot].second;
      }
    }
    normalizeWeights(weights);
    return weights;
  }

  // Strongest first.
  void readInfluences(const VertexLine& line, std::vector<std::pair<double, Index>>& influences) const {
    influences.clear();
    for (std::size_t i = 0; i < line.words.size(); i += 2) {
      const Index joint = *indexOf_[jointCalled(line.words[i], line.line)];
      const double weight = numberOf(line.words[i + 1], line.line);
      if (weight < 0) fail(fmt::format("has the weight {}", shown(line.words[i + 1])), line.line);
      const auto same =
          std::find_if(influences.begin(), influences.end(), [&](const auto& s) { return s.second == joint; });
      if (same != influences.end()) fail(fmt::format("has '{}' a second time", shown(line.words[i])), line.line);
      if (weight > 0) influences.emplace_back(weight, joint);
    }
    std::sort(influences.begin(), influences.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
  }

  std::string_view name_, root_;
  Index vertexCount_;
  std::size_t line_ = 0, rootLine_ = 0;
  std::vector<TextJoint> joints_;
  std::map<std::string_view, std::size_t> jointOf_;
  std::vector<std::optional<Index>> indexOf_;  // in the skeleton
  std::vector<Link> links_;
  std::vector<VertexLine> vertices_;
};

}  // namespace

RignetRig readRignetText(std::string_view text, std::string_view name, Index vertexCount) {
  return RignetReader(name, vertexCount).read(text);
}

}  // namespace limber
