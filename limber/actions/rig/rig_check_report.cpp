#include "limber/actions/rig/rig_check_report.h"

#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "limber/actions/rig/figure_to_rig.h"
#include "limber/document/rig/rig_io.h"
#include "limber/rigging/kind_choice.h"
#include "limber/rigging/roles/joint_roles.h"

namespace limber {

namespace {

struct PartWords {
  std::string_view part, ofPerson, ofAnimal;
};
constexpr PartWords kWords[] = {
    {"fore_upper", "upper arm", "upper front leg"},
    {"fore_lower", "forearm", "lower front leg"},
    {"fore_end", "hand", "front foot"},
    {"hind_upper", "thigh", "upper hind leg"},
    {"hind_lower", "shin", "lower hind leg"},
    {"hind_end", "foot", "hind foot"},
};

// "left hand"; other parts are called as the networks call them.
std::string describePart(std::string_view part, bool hasArms) {
  const std::string_view sideName = splitName(part).side;
  const std::string side = sideName.empty() ? "" : sideName == ".L" ? "left " : "right ";
  part.remove_suffix(sideName.size());
  for (const PartWords& words : kWords) {
    if (words.part == part) return side + std::string(hasArms ? words.ofPerson : words.ofAnimal);
  }
  return side + std::string(part);
}

std::string_view describePose(BodyPose pose) {
  switch (pose) {
    case BodyPose::kT:
      return "arms level (T pose)";
    case BodyPose::kA:
      return "arms lowered (A pose)";
    case BodyPose::kHanging:
      return "arms at the sides";
    case BodyPose::kOther:
      break;
  }
  return "in another pose than T or A";
}

bool isLikely(const RigCheck& check) {
  return check.kinds.front().confidence >= kLikelyTemplate;
}

// "left hand and left thigh, right hand and right thigh"
std::string describeContacts(const RigCheck& check) {
  std::vector<std::string> pairs;
  for (const PartContact& contact : check.grownTogether) {
    pairs.push_back(fmt::format("{}", fmt::join(describeParts(check, contact), " and ")));
  }
  return fmt::format("{}", fmt::join(pairs, ", "));
}

void adviseOnKind(const RigCheck& check, Warnings& advice) {
  const TemplateMatch& likeliest = check.kinds.front();
  const double percent = 100 * likeliest.confidence;
  if (!isLikely(check)) {
    advice.add("no-template",
               fmt::format("the model is like no kind of body (the likeliest is {:.0f} % sure): it gets handles; "
                           "`template: {}` fits a skeleton all the same",
                           percent, likeliest.name),
               likeliest.name);
  } else if (!check.isSure) {
    advice.add("unsure-template",
               fmt::format("the kind of body is {:.0f} % sure: `template` names another one", percent), likeliest.name);
  }
}

void adviseOnUp(const RigCheck& check, bool isGiven, Warnings& advice) {
  if (check.isUpright) return;
  if (check.isSure || isGiven) {
    advice.add("not-upright", "the model's up axis is not +Y: `upright` rotates the model");
  } else {
    advice.add("maybe-not-upright", "the model's up axis may not be +Y: with `up`, `upright` rotates the model");
  }
}

Warnings adviceOn(const RigCheckReport& report, const RigOptions& options) {
  const RigCheck& check = report.check;
  Warnings advice;
  if (report.hasRig) {
    advice.add("has-rig",
               "the model has a rig of its own: `existing-rig: replace` takes it out first, `existing-rig: "
               "keep-skeleton` makes only its weights anew");
  }
  adviseOnKind(check, advice);
  if (!check.grownTogether.empty()) {
    advice.add("grown-together", "parts that are grown together move together, unless they are cut or modelled apart",
               describeContacts(check), check.grownTogether.size());
  }
  if (!check.missing.empty()) {
    advice.add("no-place", "limbs of the template have no place in the model: `pins` gives them one",
               fmt::format("{}", fmt::join(check.missing, ", ")), check.missing.size());
  }
  if (!isLikely(check)) return advice;  // handles need no more
  adviseOnUp(check, options.up.has_value(), advice);
  if (check.pose == BodyPose::kOther) {
    advice.add("posed", "the model is in a pose: check the weights where its limbs touch");
  }
  if (!check.doubts.empty()) {
    advice.add("doubtful-joints", "the positions of joints are in doubt: `pins` corrects them",
               fmt::format("{}", fmt::join(check.doubts, ", ")), check.doubts.size());
  }
  return advice;
}

}  // namespace

std::array<std::string, 2> describeParts(const RigCheck& check, const PartContact& contact) {
  const std::string_view plan = findBodyKind(check.kinds.front().name).plan;
  const bool hasArms = plan == "upright" || plan == "dinosaur";
  return {describePart(contact.one, hasArms), describePart(contact.other, hasArms)};
}

std::string summaryOf(const RigCheck& check) {
  const TemplateMatch& likeliest = check.kinds.front();
  std::string kind = fmt::format("{}, {:.0f} % sure", likeliest.name, 100 * likeliest.confidence);
  std::vector<std::string> obstacles;
  if (!isLikely(check)) {
    kind = fmt::format("like no kind of body (likeliest: {})", kind);
    obstacles.emplace_back("it gets handles");
  }
  for (const PartContact& contact : check.grownTogether) {
    const auto [one, other] = describeParts(check, contact);
    obstacles.push_back(fmt::format("{} is grown onto the {}", one, other));
  }
  for (const std::string& limb : check.missing) obstacles.push_back(fmt::format("{} is missing", limb));
  if (!check.isUpright && isLikely(check)) obstacles.emplace_back("its up axis is not +Y");
  return fmt::format("{}{}{}{}{}", kind, check.pose ? ", " : "", check.pose ? describePose(*check.pose) : "",
                     obstacles.empty() ? "" : " - ", fmt::join(obstacles, "; "));
}

RigCheckReport checkRigging(Asset asset, const AutoRigOptions& options) {
  RigCheckReport report;
  report.hasRig = hasRig(asset);
  AutoRigOptions withoutRig = options;
  withoutRig.existingRig = ExistingRig::kReplace;
  AutoRigReport read;
  Progress progress;
  const FigureToRig figure = readFigureToRig(asset, withoutRig, read, progress);
  report.pieces = read.pieces;
  report.innerShellVertices = static_cast<Index>(figure.figure.innerShell.size());
  report.warnings = std::move(read.warnings);
  const RiggerInput input = riggerInput(asset, figure, options.rig, true);
  report.check = checkRigging(input.surfaceOf(figure).mesh, input.options);
  report.advice = adviceOn(report, options.rig);
  return report;
}

}  // namespace limber
