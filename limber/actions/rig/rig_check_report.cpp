#include "limber/actions/rig/rig_check_report.h"

#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "limber/actions/rig/accessories.h"
#include "limber/actions/rig/figure_geometry.h"
#include "limber/actions/rig/figure_to_rig.h"
#include "limber/document/rig/rig_io.h"

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
    {"mid", "limb", "middle leg"},
};

std::vector<std::string> adviceOn(const RigCheckReport& report) {
  const RigCheck& check = report.check;
  const TemplateMatch& likeliest = check.kinds.front();
  std::vector<std::string> advice;
  if (likeliest.confidence < kLikelyTemplate) {
    advice.push_back(
        fmt::format("It is like no body that is known (likeliest: {}, {:.0f} %): it gets handles; --template NAME fits "
                    "a skeleton all "
                    "the same",
                    likeliest.name, 100 * likeliest.confidence));
    return advice;
  }
  if (!check.isSure) {
    advice.push_back(fmt::format("It may be another kind than {}: --template NAME says which it is", likeliest.name));
  }
  const bool isPerson = check.pose.has_value();
  for (const PartContact& contact : check.grownTogether) {
    advice.push_back(
        fmt::format("The {} is grown onto the {}: they will move together, unless they are cut apart or modelled apart",
                    describePart(contact.one, isPerson), describePart(contact.other, isPerson)));
  }
  if (!check.missing.empty()) {
    advice.push_back(
        fmt::format("These limbs are not seen, and get joints that hold nothing: {}", fmt::join(check.missing, ", ")));
  }
  if (!check.isUpright) advice.push_back("It stands along another axis than +Y: --upright turns it");
  if (check.pose == BodyPose::kOther) {
    advice.push_back("It is posed: where limbs touch, look at their weights first");
  }
  if (!check.doubts.empty()) {
    advice.push_back(
        fmt::format("Most in doubt: {}; --pin JOINT=x,y,z tells where one is", fmt::join(check.doubts, ", ")));
  }
  return advice;
}

}  // namespace

std::string describePart(std::string_view part, bool isPerson) {
  std::string side;
  if (part.ends_with(".L")) side = "left ";
  if (part.ends_with(".R")) side = "right ";
  if (!side.empty()) part.remove_suffix(2);
  for (const PartWords& words : kWords) {
    if (words.part == part) return side + std::string(isPerson ? words.ofPerson : words.ofAnimal);
  }
  return side + std::string(part);
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
  const Accessories accessories = findAccessories(asset, figure.geometry());
  const FigureSurface body = accessories.empty()
                                 ? FigureSurface()
                                 : figureOf(figure.geometry(), bodyTriangles(figure.geometry(), accessories));
  report.check = checkRigging((accessories.empty() ? figure.figure : body).prepared.mesh, options.rig);
  report.advice = adviceOn(report);
  return report;
}

}  // namespace limber
