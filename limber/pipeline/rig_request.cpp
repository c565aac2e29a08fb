#include "limber/pipeline/rig_request.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/asset/json_access.h"
#include "limber/asset/json_text.h"
#include "limber/pipeline/template_file.h"
#include "limber/rigging/template_rigger.h"
#include "limber/skinning/weight_steps.h"

namespace limber {

namespace {

constexpr const char* kTemplateRigger = "template";
constexpr std::string_view kKeys[] = {"handles",  "maxInfluences", "rigger",      "template",
                                      "skinning", "pieces",        "existingRig", "up",
                                      "front",    "pins",          "upright",     "chains"};

[[noreturn]] void refuseOption(std::string_view option, std::string problem, std::string remedy = {}) {
  throw Error(ErrorCode::kBadArgument, std::move(problem), fmt::format("`{}`", option), std::move(remedy));
}

ExistingRig readExistingRig(const std::string& name) {
  if (name == "refuse") return ExistingRig::kRefuse;
  if (name == "replace") return ExistingRig::kReplace;
  if (name == "keep-skeleton") return ExistingRig::kKeepSkeleton;
  refuseOption("existing-rig", fmt::format("takes refuse, replace or keep-skeleton, not {}", name));
}

// "+y", "-z", "x".
std::optional<Vec3> readAxis(std::string_view option, const std::string& text) {
  if (text.empty()) return std::nullopt;
  const std::size_t at = text[0] == '+' || text[0] == '-' ? 1 : 0;
  if (text.size() == at + 1) {
    const char axis = static_cast<char>(text[at] | 0x20);  // lower case
    if (axis >= 'x' && axis <= 'z') return Vec3((text[0] == '-' ? -1.0 : 1.0) * Vec3::Unit(axis - 'x'));
  }
  refuseOption(option, fmt::format("takes +x, -x, +y, -y, +z or -z, not {}", text));
}

struct GivenOption {
  const char* name;
  bool isGiven;
};

// The first that is given is refused.
void refuseGiven(std::initializer_list<GivenOption> options, const std::string& problem, const std::string& remedy) {
  for (const auto& [name, isGiven] : options) {
    if (isGiven) refuseOption(name, problem, remedy);
  }
}

// What finds joints is of no use where they are kept, what fits a template where there is none.
void checkTogether(const RigRequest& request, const AutoRigOptions& options) {
  const bool isTemplate = options.rigger == kTemplateRigger;
  if (options.existingRig == ExistingRig::kKeepSkeleton) {
    refuseGiven({{"handles", request.handles.has_value()},
                 {"template", request.templateName.has_value()},
                 {"rigger", request.rigger.has_value()},
                 {"pins", !request.pins.empty()},
                 {"up", !request.up.empty()},
                 {"front", !request.front.empty()},
                 {"upright", request.upright},
                 {"chains", request.chains}},
                "is of no use where the model's own skeleton is kept", "leave `existing-rig: keep-skeleton` out");
  }
  if (request.templateName && !isTemplate) {
    refuseOption("template", fmt::format("is of no use with the rigger {}", options.rigger), "leave `rigger` out");
  }
  if (isTemplate && request.handles) refuseOption("handles", "a template has the joints that it has");
  if (isTemplate) return;
  refuseGiven({{"pins", !request.pins.empty()},
               {"up", !request.up.empty()},
               {"front", !request.front.empty()},
               {"upright", request.upright},
               {"chains", request.chains}},
              "takes a template to fit", "name one: `template: auto`");
}

void checkRanges(const RigRequest& request) {
  if (request.handles && (*request.handles < 1 || *request.handles >= kNoIndex)) {
    refuseOption("handles", fmt::format("takes a count from 1 on, not {}", *request.handles));
  }
  if (request.maxInfluences < 1 || request.maxInfluences > kMostSlots) {
    refuseOption("max-influences", fmt::format("takes 1 to {}, not {}", kMostSlots, request.maxInfluences));
  }
  for (const JointPin& pin : request.pins) {
    if (!pin.place.allFinite()) refuseOption("pins", fmt::format("{} is not pinned to finite numbers", pin.joint));
  }
}

void readPins(const JsonView& pins, RigRequest& request) {
  pins.forEachMember([&](std::string_view joint, const JsonView& place) {
    JointPin& pin = request.pins.emplace_back();
    pin.joint = joint;
    if (!place.json().is_array() || place.size() != 3) place.fail("is not a position of three numbers");
    for (int axis = 0; axis < 3; ++axis) pin.place[axis] = place[static_cast<std::size_t>(axis)].asNumber();
  });
}

RigRequest readRequest(const JsonView& json) {
  json.requireObject();
  json.forEachMember([](std::string_view key, const JsonView& value) {
    if (std::find(std::begin(kKeys), std::end(kKeys), key) != std::end(kKeys)) return;
    throw Error(ErrorCode::kBadArgument, "there is no such option", value.path(),
                fmt::format("there are: {}", fmt::join(kKeys, ", ")));
  });
  RigRequest request;
  request.handles = json.index("handles", kNoIndex);
  request.maxInfluences = json.index("maxInfluences", kNoIndex).value_or(request.maxInfluences);
  if (json.member("rigger").exists()) request.rigger = json.text("rigger");
  if (json.member("template").exists()) request.templateName = json.text("template");
  request.skinning = json.text("skinning", request.skinning);
  request.pieces = json.text("pieces", request.pieces);
  request.existingRig = json.text("existingRig", request.existingRig);
  request.up = json.text("up");
  request.front = json.text("front");
  request.upright = json.flag("upright", false);
  request.chains = json.flag("chains", false);
  readPins(json.object("pins"), request);
  return request;
}

}  // namespace

void chooseTemplate(RigRequest& request, const std::string& nameOrFile) {
  request.templateName = nameOrFile;
  if (!std::filesystem::path(nameOrFile).extension().empty()) request.templateSkeleton = readTemplateFile(nameOrFile);
}

RigRequest rigRequestFromJson(std::string_view text) {
  try {
    Warnings duplicates;  // the last one counts
    const Json json = parseJson(text, duplicates);
    return readRequest(JsonView(json));
  } catch (const Error& error) {
    const std::string where = error.where().empty() ? "options" : error.where();
    throw Error(ErrorCode::kBadArgument, error.message(), where, error.remedy());
  }
}

AutoRigOptions optionsOf(const RigRequest& request) {
  AutoRigOptions options;
  options.rigger = request.rigger.value_or(request.templateName ? kTemplateRigger : options.rigger);
  options.existingRig = readExistingRig(request.existingRig);
  checkRanges(request);
  checkTogether(request, options);
  options.skinning = request.skinning;
  options.weights.maxInfluences = request.maxInfluences;
  options.weights.pieces = findPieceMode(request.pieces);
  options.chains = request.chains;
  options.standUpright = request.upright;
  options.rig.handles = request.handles;
  options.rig.up = readAxis("up", request.up);
  options.rig.front = readAxis("front", request.front);
  if (options.rig.up && options.rig.front && std::abs(options.rig.up->dot(*options.rig.front)) > 0.5) {
    refuseOption("front", "must be square to `up`");
  }
  options.rig.pins = request.pins;
  options.rig.templateSkeleton = request.templateSkeleton;
  if (request.templateName) {
    options.rig.templateName = *request.templateName;
    if (!request.templateSkeleton) checkTemplateName(*request.templateName);
  }
  return options;
}

}  // namespace limber
