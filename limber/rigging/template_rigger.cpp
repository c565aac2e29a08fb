#include "limber/rigging/template_rigger.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "limber/core/known_error.h"
#include "limber/core/text/names.h"
#include "limber/geometry/mesh/model_box.h"
#include "limber/rigging/kind_choice.h"
#include "limber/rigging/measured_model.h"
#include "limber/rigging/roles/placed_joints.h"
#include "limber/rigging/roles/refined_roles.h"
#include "limber/rigging/roles/roled_templates.h"
#include "limber/rigging/sphere_mesh_rigger.h"
#include "limber/rigging/templates/standing_skeleton.h"

namespace limber {

namespace {

// Each joint once, and where the model may be: the model's size beyond its box is another unit.
void checkPins(const TriMesh& mesh, const std::vector<JointPin>& pins) {
  const Box box = modelBox(mesh);
  const Vec3 margin = Vec3::Constant(box.longestSide());
  for (auto pin = pins.begin(); pin != pins.end(); ++pin) {
    const auto isSame = [&](const JointPin& other) { return other.joint == pin->joint; };
    if (std::any_of(pins.begin(), pin, isSame)) {
      throw Error(ErrorCode::kBadArgument, "is pinned twice", pin->joint, "give each joint one place");
    }
    const Vec3 low = box.min - margin, high = box.max + margin;
    if ((pin->position.array() < low.array()).any() || (pin->position.array() > high.array()).any()) {
      throw KnownError(ErrorKind::kPinOutside,
                       {ErrorCode::kBadArgument, "is pinned far outside the model", pin->joint,
                        "places are in the file's space and unit; limber info tells its size"},
                       {{"joint", pin->joint}});
    }
  }
}

TemplatePins pinsIn(const TemplateSkeleton& skeleton, const AnatomicalFrame& frame, const std::vector<JointPin>& pins) {
  TemplatePins positions(skeleton.jointCount());
  for (const JointPin& pin : pins) {
    const std::optional<Index> joint = skeleton.find(pin.joint);
    if (!joint) {
      std::string known;
      for (const TemplateJoint& other : skeleton.joints) known += (known.empty() ? "" : ", ") + other.name;
      throw Error(ErrorCode::kBadArgument, fmt::format("the template has no joint '{}' to pin", pin.joint),
                  skeleton.name, "it has: " + known);
    }
    positions[*joint] = frame.toBody(pin.position);
  }
  return positions;
}

// What pins say of the reading.
std::map<std::string, Vec3> knownRoles(const RoledSkeleton& made, const TemplatePins& pins) {
  std::map<std::string, Vec3> known;
  for (std::size_t j = 0; j < pins.size(); ++j) {
    if (made.skeleton.joints[j].role == TemplateRole::kTip) continue;  // its role is that of the joint above
    if (pins[j] && made.roles[j] && made.roles[j]->isRole()) known[made.roles[j]->from] = *pins[j];
  }
  return known;
}

// Pinned joints are some template's: whoever pins one has chosen.
bool leavesTheChoice(const RigOptions& options) {
  return options.templateName == "auto" && !options.templateSkeleton && options.pins.empty();
}

AutoRig withHandles(const TriMesh& mesh, const RigOptions& options, const TemplateMatch& likeliest,
                    Progress& progress) {
  AutoRig rig = rigWithSphereMesh(mesh, options, progress);
  rig.isAbstained = true;
  rig.warnings.add("no-template",
                   fmt::format("the model is like no template (the likeliest is {:.0f} % sure): it gets handles",
                               100 * likeliest.confidence),
                   likeliest.name);
  return rig;
}

// Brings the likeliest kind that has all joints that are pinned to the front; nothing where none has.
void chooseKind(std::vector<TemplateMatch>& matches, const RoleReading& reading, const std::vector<JointPin>& pins) {
  const auto chosen = std::find_if(matches.begin(), matches.end(), [&](const TemplateMatch& match) {
    const RoledSkeleton made = skeletonOfKind(findBodyKind(match.name), reading);
    return std::all_of(pins.begin(), pins.end(), [&](const JointPin& pin) { return made.skeleton.find(pin.joint); });
  });
  if (chosen != matches.end()) std::rotate(matches.begin(), chosen, chosen + 1);
}

}  // namespace

void checkTemplateName(std::string_view name) {
  std::vector<BodyKind> named = {{"auto", "", ""}};
  named.insert(named.end(), bodyKinds().begin(), bodyKinds().end());
  findByName(named, "template", name);
}

AutoRig rigWithTemplate(const TriMesh& mesh, const RigOptions& options, Progress& progress) {
  if (!options.templateSkeleton) checkTemplateName(options.templateName);
  checkPins(mesh, options.pins);
  progress.step("measure body");
  const std::shared_ptr<const MeasuredModel> measured = measureModel(mesh, options);
  const ReadingWeights& weights = *measured->weights;
  const AnatomicalFrame& frame = measured->frame();
  progress.step("read shape");
  RoleReading reading = measured->reading;
  std::vector<TemplateMatch> matches;
  std::string kind = options.templateName;
  if (kind == "auto" && !options.templateSkeleton) {
    matches = matchesOf(reading, weights, measured->fingers, measured->legs);
    if (options.mayAbstain && leavesTheChoice(options) && matches.front().confidence < kLikelyTemplate) {
      AutoRig rig = withHandles(mesh, options, matches.front(), progress);
      dropUnlikely(matches);
      rig.matches = std::move(matches);
      return rig;
    }
    chooseKind(matches, reading, options.pins);
    dropUnlikely(matches);
    kind = matches.front().name;
  }
  const auto skeletonFor = [&] {
    return options.templateSkeleton ? ownWithRoles(*options.templateSkeleton, options.templateName)
                                    : skeletonOfKind(findBodyKind(kind), reading);
  };
  RoledSkeleton made = skeletonFor();
  TemplatePins pins = pinsIn(made.skeleton, frame, options.pins);
  if (!options.pins.empty()) {
    reading = RoleReading(measured->samples, weights, frame, knownRoles(made, pins));
    made = skeletonFor();
    pins = pinsIn(made.skeleton, frame, options.pins);
  }
  if (frame.symmetric() && pinnedEvenly(made.skeleton, pins)) reading.makeSymmetric();
  const std::optional<std::string_view> plan =
      options.templateSkeleton ? planOf(readAnatomy(*options.templateSkeleton)) : findBodyKind(kind).plan;
  refineRoles(plan.value_or("none"), measured->body, reading);
  const std::vector<Vec3> positions = placedJoints(made, reading, pins);

  AutoRig rig;
  rig.skeleton = standingSkeleton(made.skeleton, positions, frame);
  if (measured->cleared) {
    rig.warnings.add("stray-pieces", "triangles that float about the model are left out of account", {},
                     mesh.triangleCount() - measured->cleared->triangleCount());
  }
  rig.up = frame.axes.row(1).transpose();
  if (matches.empty()) {
    matches = {{kind, confidenceOf(plan ? reading.probability(*plan) : 1, made, reading)}};
  }
  rig.doubts = doubtsOf(made, reading, pins);
  const std::vector<TemplateLimb> limbs = limbsOf(made, reading);
  const auto missing = std::count_if(limbs.begin(), limbs.end(), [](const TemplateLimb& l) { return !l.isThere; });
  if (missing > 0) {
    rig.warnings.add("no-place", "limbs of the template have no place in the model", missingLimbs(made.skeleton, limbs),
                     static_cast<std::size_t>(missing));
  }
  if (matches.front().confidence < kLikelyTemplate) {
    rig.warnings.add(
        "low-confidence",
        fmt::format("the model hardly looks like the template (confidence {:.2f})", matches.front().confidence), kind);
  }
  rig.matches = std::move(matches);
  return rig;
}

}  // namespace limber
