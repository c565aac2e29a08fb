#include "limber/evaluate/rig/labelled_skeleton.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/character/anatomy/half_body.h"
#include "limber/core/error.h"
#include "limber/core/text/numbers.h"
#include "limber/evaluate/rig/attached_chains.h"

namespace limber {

namespace {

Vec3 vectorFrom(const nlohmann::json& json, const std::string& where) {
  if (!json.is_array() || json.size() != 3) throw Error(ErrorCode::kBadData, "is no vector of three numbers", where);
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

BodyLabels::LabelledPart partFrom(const nlohmann::json& json, const std::string& where) {
  BodyLabels::LabelledPart part;
  const std::optional<PartKind> kind = partKindNamed(json.value("kind", ""));
  const std::optional<Side> side = sideNamed(json.value("side", "center"));
  if (!kind || !side) throw Error(ErrorCode::kBadData, "has a part of no known kind or side", where);
  part.kind = *kind;
  part.side = *side;
  part.pair = json.value("pair", Index{0});
  for (const nlohmann::json& joint : json.at("joints")) part.joints.push_back(joint.get<std::string>());
  part.upper = json.value("upper", "");
  part.middle = json.value("middle", "");
  part.hock = json.value("hock", "");
  part.end = json.value("end", "");
  part.toes = json.value("toes", "");
  return part;
}

PartState firstStateOf(PartKind kind) {
  for (std::size_t s = 0; s < kPartStates; ++s) {
    if (kindOf(static_cast<PartState>(s)) == kind) return static_cast<PartState>(s);
  }
  return PartState::kOther;
}

// A skeleton whose joints may be taken out and put in; made whole again at the end.
struct Editable {
  struct Node {
    Joint joint;
    JointLabel label;
    std::optional<std::size_t> parent;
    bool gone = false;
  };
  std::vector<Node> nodes;  // parents need not come first

  explicit Editable(const LabelledSkeleton& body) {
    for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
      const Joint& joint = body.skeleton.joints[j];
      nodes.push_back(
          {joint, body.labels[j], joint.parent ? std::optional<std::size_t>(*joint.parent) : std::nullopt, false});
    }
  }

  // Its children hang on its parent, where they were.
  void takeOut(std::size_t node) {
    nodes[node].gone = true;
    for (Node& child : nodes) {
      if (child.parent != node) continue;
      child.parent = nodes[node].parent;
      const Affine local = nodes[node].joint.rest.toAffine() * child.joint.rest.toAffine();
      child.joint.rest = decompose(local);
    }
  }

  std::size_t put(const Joint& joint, const JointLabel& label, std::optional<std::size_t> parent) {
    nodes.push_back({joint, label, parent, false});
    return nodes.size() - 1;
  }

  void writeTo(LabelledSkeleton& body) const {
    std::vector<Index> number(nodes.size(), kNoIndex);
    body.skeleton.joints.clear();
    body.labels.clear();
    std::vector<bool> done(nodes.size(), false);
    for (std::size_t left = nodes.size(); left > 0;) {
      const std::size_t before = left;
      for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (done[n]) continue;
        const Node& node = nodes[n];
        if (!node.gone && node.parent && number[*node.parent] == kNoIndex) continue;
        done[n] = true;
        --left;
        if (node.gone) continue;
        number[n] = body.skeleton.jointCount();
        body.skeleton.joints.push_back(node.joint);
        body.skeleton.joints.back().parent = node.parent ? std::optional(number[*node.parent]) : std::nullopt;
        body.labels.push_back(node.label);
      }
      if (left == before) break;
    }
  }
};

std::string freshName(const Editable& edit, const std::string& stem) {
  return fmt::format("{}_{}", stem, edit.nodes.size());
}

void crop(LabelledSkeleton& body, Random& random) {
  // One to three kinds of small things go, as exporters for games leave them out.
  constexpr std::array kGone = {PartKind::kFinger, PartKind::kEar,  PartKind::kJaw,  PartKind::kEye,
                                PartKind::kHair,   PartKind::kTail, PartKind::kProp, PartKind::kOther};
  std::array<bool, kPartKinds> gone{};
  const std::uint64_t count = 1 + random.below(3);
  for (std::uint64_t i = 0; i < count; ++i) gone[static_cast<std::size_t>(kGone[random.below(kGone.size())])] = true;
  const bool toes = random.below(3) == 0, leaves = random.below(3) == 0;
  Editable edit(body);
  std::vector<std::size_t> children(edit.nodes.size(), 0);
  for (const Editable::Node& node : edit.nodes) {
    if (node.parent) ++children[*node.parent];
  }
  for (std::size_t n = edit.nodes.size(); n-- > 0;) {
    const JointLabel& label = edit.nodes[n].label;
    const bool isLeaf = children[n] == 0;
    const bool isTip = isLeaf && edit.nodes[n].parent && edit.nodes[*edit.nodes[n].parent].label.state == label.state;
    if (!isLeaf) continue;
    if (!(gone[static_cast<std::size_t>(kindOf(label.state))] || (toes && label.state == PartState::kLegToes) ||
          (leaves && isTip)))
      continue;
    edit.nodes[n].gone = true;
    if (edit.nodes[n].parent) --children[*edit.nodes[n].parent];
  }
  edit.writeTo(body);
}

void addJoints(LabelledSkeleton& body, Random& random) {
  Editable edit(body);
  const std::size_t before = edit.nodes.size();
  std::vector<std::size_t> children(before, 0);
  for (const Editable::Node& node : edit.nodes) {
    if (node.parent) ++children[*node.parent];
  }
  // Twist joints come with each arm or leg of a body, or with none; now and then a joint more anywhere.
  std::array<bool, kPartStates> twisted{};
  for (bool& each : twisted) each = random.below(3) == 0;
  const double twist = random.uniform(0, 0.1), nub = random.uniform(0, 0.5);
  const char* word = random.below(2) == 0 ? "twist" : "half";
  for (std::size_t n = 0; n < before; ++n) {
    const auto state =
        edit.nodes[n].parent ? static_cast<std::size_t>(edit.nodes[*edit.nodes[n].parent].label.state) : 0;
    const bool onLimb = kindOf(static_cast<PartState>(state)) == PartKind::kLeg ||
                        kindOf(static_cast<PartState>(state)) == PartKind::kArm;
    if (edit.nodes[n].parent && (random.uniform() < twist || (onLimb && twisted[state]))) {
      // Halfway along the bone to it: a twist joint of the parent's segment.
      const std::size_t parent = *edit.nodes[n].parent;
      Joint middle;
      middle.name = freshName(edit, edit.nodes[parent].joint.name + "_" + word);
      middle.rest.translation = 0.5 * edit.nodes[n].joint.rest.translation;
      JointLabel label = edit.nodes[parent].label;
      const bool sameLimb = kindOf(label.state) == kindOf(edit.nodes[n].label.state);
      if (!sameLimb) continue;
      const std::size_t put = edit.put(middle, label, parent);
      edit.nodes[n].parent = put;
      edit.nodes[n].joint.rest.translation *= 0.5;
    }
    if (children[n] == 0 && random.uniform() < nub) {
      Joint end;
      end.name = freshName(edit, edit.nodes[n].joint.name);
      end.rest.translation = random.uniform(0.3, 1) * edit.nodes[n].joint.rest.translation;
      edit.put(end, edit.nodes[n].label, n);
    }
  }
  if (random.below(2) == 0) {
    Joint root;
    root.name = freshName(edit, "Root");
    const std::size_t put = edit.put(root, {}, std::nullopt);
    for (std::size_t n = 0; n < put; ++n) {
      if (!edit.nodes[n].parent) edit.nodes[n].parent = put;
    }
  }
  edit.writeTo(body);
}

// Joints between others in a trunk, neck, tail or finger; helpers.
void removeJoints(LabelledSkeleton& body, Random& random) {
  Editable edit(body);
  std::vector<std::size_t> children(edit.nodes.size(), 0);
  for (const Editable::Node& node : edit.nodes) {
    if (node.parent) ++children[*node.parent];
  }
  const double fraction = random.uniform(0.1, 0.5);
  for (std::size_t n = 0; n < edit.nodes.size(); ++n) {
    const Editable::Node& node = edit.nodes[n];
    if (!node.parent || children[n] != 1 || random.uniform() > fraction) continue;
    const Editable::Node& above = edit.nodes[*node.parent];
    const bool isInside = above.label.state == node.label.state;
    const bool isHelper = node.label.state == PartState::kOther || node.label.state == PartState::kLegBase ||
                          node.label.state == PartState::kArmBase;
    if (isInside || isHelper) edit.takeOut(n);
  }
  edit.writeTo(body);
}

void mirror(LabelledSkeleton& body) {
  for (Joint& joint : body.skeleton.joints) {
    joint.rest.translation.x() = -joint.rest.translation.x();
    joint.rest.rotation.y() = -joint.rest.rotation.y();
    joint.rest.rotation.z() = -joint.rest.rotation.z();
  }
  for (JointLabel& label : body.labels) label.side = opposite(label.side);
  body.axes.up.x() = -body.axes.up.x();
  body.axes.front.x() = -body.axes.front.x();
}

void turn(LabelledSkeleton& body, Random& random) {
  const std::array<Vec3, 3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  Quat whole = Quat::Identity();
  const std::uint64_t quarters = 1 + random.below(3);
  for (std::uint64_t i = 0; i < quarters; ++i) whole = Quat(Eigen::AngleAxisd(kPi / 2, axes[random.below(3)])) * whole;
  for (Joint& joint : body.skeleton.joints) {
    if (joint.parent) continue;
    joint.rest.translation = whole * joint.rest.translation;
    joint.rest.rotation = whole * joint.rest.rotation;
  }
  body.axes.up = whole * body.axes.up;
  body.axes.front = whole * body.axes.front;
}

// Bones of both sides alike; now and then what only some bodies have is several times as long or as short.
void stretch(LabelledSkeleton& body, Random& random) {
  constexpr std::array kVaries = {PartKind::kWing, PartKind::kTail, PartKind::kNeck, PartKind::kFin, PartKind::kEar};
  const PartKind varied = random.below(4) == 0 ? kVaries[random.below(kVaries.size())] : PartKind::kOther;
  const double variation = std::exp(0.5 * random.normal());
  const JointTree tree(body.skeleton);
  const std::vector<Vec3> positions = restPositions(body.skeleton);
  for (const HalfJoint& half : foldBody(tree, positions).joints) {
    const PartKind kind = kindOf(body.labels[half.joint].state);
    const double factor =
        std::exp(0.15 * random.normal()) * (kind == varied && kind != PartKind::kOther ? variation : 1);
    if (!body.skeleton.joints[half.joint].parent) continue;
    body.skeleton.joints[half.joint].rest.translation *= factor;
    if (half.partner) body.skeleton.joints[*half.partner].rest.translation *= factor;
  }
}

void pose(LabelledSkeleton& body, Random& random) {
  const double most = random.uniform(4, 18) * kDegree;
  for (Index j = 0; j < body.skeleton.jointCount(); ++j) {
    const Vec3 axis(random.normal(), random.normal(), random.normal());
    const double angle = most * random.normal() * (body.labels[j].side == Side::kCenter ? 0.3 : 1);
    if (axis.norm() > 1e-6) {
      Quat& rotation = body.skeleton.joints[j].rest.rotation;
      rotation = (rotation * Quat(Eigen::AngleAxisd(angle, axis.normalized()))).normalized();
    }
  }
}

}  // namespace

std::string hashOf(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3ULL;
  return fmt::format("{:016x}", hash);
}

std::vector<BodyLabels> readBodyLabels(std::string_view text) {
  std::vector<BodyLabels> all;
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) throw Error(ErrorCode::kBadData, "the labels are no JSON object of files");
  try {
    for (const auto& [hash, entry] : json.items()) {
      BodyLabels labels;
      labels.hash = hash;
      labels.file = entry.value("file", "");
      labels.flat = entry.value("flat", false);
      labels.axes = {vectorFrom(entry.at("up"), labels.file).normalized(),
                     vectorFrom(entry.at("front"), labels.file).normalized()};
      for (const nlohmann::json& part : entry.at("parts")) labels.parts.push_back(partFrom(part, labels.file));
      all.push_back(std::move(labels));
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorCode::kBadData, fmt::format("the labels are not as they should be: {}", error.what()));
  }
  return all;
}

LabelledSkeleton labelled(const BodyLabels& labels, Skeleton skeleton) {
  LabelledSkeleton body{labels.file, std::move(skeleton), labels.axes, {}, labels.flat};
  body.labels.resize(body.skeleton.jointCount());
  for (const BodyLabels::LabelledPart& part : labels.parts) {
    const bool limb = part.kind == PartKind::kLeg || part.kind == PartKind::kArm;
    PartState state = firstStateOf(part.kind);
    for (const std::string& name : part.joints) {
      const std::optional<Index> joint = body.skeleton.find(name);
      if (!joint)
        throw Error(ErrorCode::kBadData, fmt::format("the labels name a joint '{}' that is not there", name),
                    labels.file);
      if (limb) {
        const bool leg = part.kind == PartKind::kLeg;
        if (name == part.upper) state = leg ? PartState::kLegUpper : PartState::kArmUpper;
        if (name == part.middle) state = leg ? PartState::kLegMiddle : PartState::kArmMiddle;
        if (name == part.hock && leg) state = PartState::kLegHock;
        if (name == part.end) state = leg ? PartState::kLegEnd : PartState::kArmEnd;
        if (name == part.toes && leg) state = PartState::kLegToes;
      }
      body.labels[*joint] = {state, part.side, part.pair};
    }
  }
  return body;
}

std::string_view nameOf(Damage damage) {
  constexpr std::array<std::string_view, kDamages> kNames = {
      "numbered", "mirrored", "turned",       "rescaled",       "stretched",
      "posed",    "cropped",  "joints added", "joints removed", "attachments added"};
  return kNames[static_cast<std::size_t>(damage)];
}

LabelledSkeleton damaged(LabelledSkeleton body, Damage damage, Random& random) {
  switch (damage) {
    case Damage::kNumbered:
      for (Index j = 0; j < body.skeleton.jointCount(); ++j)
        body.skeleton.joints[j].name = fmt::format("joint_{:02}", j);
      break;
    case Damage::kMirrored:
      mirror(body);
      break;
    case Damage::kTurned:
      turn(body, random);
      break;
    case Damage::kRescaled: {
      const double factor = std::exp(random.uniform(-5, 5));
      for (Joint& joint : body.skeleton.joints) joint.rest.translation *= factor;
      break;
    }
    case Damage::kStretched:
      stretch(body, random);
      break;
    case Damage::kPosed:
      pose(body, random);
      break;
    case Damage::kCropped:
      crop(body, random);
      break;
    case Damage::kJointsAdded:
      addJoints(body, random);
      break;
    case Damage::kJointsRemoved:
      removeJoints(body, random);
      break;
    case Damage::kAttached:
      addAttachments(body, random);
      break;
  }
  return body;
}

}  // namespace limber
