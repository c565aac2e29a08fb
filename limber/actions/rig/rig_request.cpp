#include "limber/actions/rig/rig_request.h"

#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "limber/actions/export/engine_target.h"
#include "limber/actions/option_spelling.h"
#include "limber/actions/rig/template_file.h"
#include "limber/document/gltf/json_access.h"
#include "limber/document/gltf/json_text.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/template_rigger.h"
#include "limber/rigging/weights/weight_steps.h"

namespace limber {

namespace {

constexpr const char* kTemplateRigger = "template";

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
std::optional<Vec3> readAxis(std::string_view option, const std::optional<std::string>& given) {
  if (!given) return std::nullopt;
  const std::string& text = *given;
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
                 {"template", request.chosenTemplate.has_value()},
                 {"rigger", request.rigger.has_value()},
                 {"pins", !request.pins.empty()},
                 {"up", request.up.has_value()},
                 {"front", request.front.has_value()},
                 {"upright", request.upright},
                 {"chains", request.chains},
                 {"reading", request.reading.has_value()}},
                "is of no use where the model's own skeleton is kept", "leave `existing-rig: keep-skeleton` out");
  }
  if (request.chosenTemplate && !isTemplate) {
    refuseOption("template", fmt::format("is of no use with the rigger {}", options.rigger), "leave `rigger` out");
  }
  if (isTemplate && request.handles) refuseOption("handles", "a template has the joints that it has");
  if (isTemplate) return;
  refuseGiven({{"pins", !request.pins.empty()},
               {"up", request.up.has_value()},
               {"front", request.front.has_value()},
               {"upright", request.upright},
               {"chains", request.chains},
               {"reading", request.reading.has_value()}},
              "takes a template to fit", "name one: `template: auto`");
}

void checkRanges(const RigRequest& request) {
  if (request.handles && (*request.handles < 1 || *request.handles >= kNoIndex)) {
    refuseOption("handles", fmt::format("takes a count from 1 on, not {}", *request.handles));
  }
  if (request.maxInfluences < 1 || request.maxInfluences > kMaxSlots) {
    refuseOption("max-influences", fmt::format("takes 1 to {}, not {}", kMaxSlots, request.maxInfluences));
  }
  for (const JointPin& pin : request.pins) {
    if (!pin.position.allFinite()) refuseOption("pins", fmt::format("{} is not pinned to finite numbers", pin.joint));
  }
}

// `find` looks for a name that the user gave for that option.
template <class Find>
auto findNamed(std::string_view option, Find&& find) {
  try {
    return find();
  } catch (const Error& error) {
    refuseOption(option, error.message(), error.remedy());
  }
}

std::string textOf(const JsonView& value) {
  if (!value.json().is_string()) value.fail("must be a string");
  return value.json().get<std::string>();
}

bool flagOf(const JsonView& value) {
  if (!value.json().is_boolean()) value.fail("must be true or false");
  return value.json().get<bool>();
}

void readPins(const JsonView& pins, RigRequest& request) {
  pins.forEachMember([&](std::string_view joint, const JsonView& location) {
    JointPin& pin = request.pins.emplace_back();
    pin.joint = joint;
    if (!location.json().is_array() || location.size() != 3) location.fail("is not a position of three numbers");
    for (int axis = 0; axis < 3; ++axis) pin.position[axis] = location[static_cast<std::size_t>(axis)].asNumber();
  });
}

struct JsonOption {
  std::string_view name;
  void (*read)(const JsonView& value, RigRequest& request);
};

constexpr JsonOption kJsonOptions[] = {
    {"handles", [](const JsonView& value, RigRequest& r) { r.handles = value.asIndex(kNoIndex); }},
    {"max-influences", [](const JsonView& value, RigRequest& r) { r.maxInfluences = value.asIndex(kNoIndex); }},
    {"rigger", [](const JsonView& value, RigRequest& r) { r.rigger = textOf(value); }},
    {"template", [](const JsonView& value, RigRequest& r) { r.chosenTemplate = ChosenTemplate{textOf(value)}; }},
    {"skinning", [](const JsonView& value, RigRequest& r) { r.skinning = textOf(value); }},
    {"pieces", [](const JsonView& value, RigRequest& r) { r.pieces = textOf(value); }},
    {"existing-rig", [](const JsonView& value, RigRequest& r) { r.existingRig = textOf(value); }},
    {"up", [](const JsonView& value, RigRequest& r) { r.up = textOf(value); }},
    {"front", [](const JsonView& value, RigRequest& r) { r.front = textOf(value); }},
    {"pins", readPins},
    {"upright", [](const JsonView& value, RigRequest& r) { r.upright = flagOf(value); }},
    {"chains", [](const JsonView& value, RigRequest& r) { r.chains = flagOf(value); }},
    {"target", [](const JsonView& value, RigRequest& r) { r.target = textOf(value); }},
};

std::string jsonKey(const JsonOption& option) {
  return spellOptions(fmt::format("`{}`", option.name), OptionSpelling::kJavaScript);
}

// The option is to blame for what is wrong inside its value.
void readOption(const JsonOption& option, const JsonView& value, RigRequest& request) {
  try {
    option.read(value, request);
  } catch (const Error& error) {
    std::string inside = error.where().substr(value.path().size());
    if (inside.starts_with('.')) inside.erase(0, 1);
    refuseOption(option.name, inside.empty() ? error.message() : inside + " " + error.message(), error.remedy());
  }
}

RigRequest readRequest(const JsonView& json) {
  json.requireObject();
  RigRequest request;
  json.forEachMember([&](std::string_view key, const JsonView& value) {
    for (const JsonOption& option : kJsonOptions) {
      if (jsonKey(option) == key) return readOption(option, value, request);
    }
    std::vector<std::string> known;
    for (const JsonOption& option : kJsonOptions) known.push_back(fmt::format("`{}`", option.name));
    throw Error(ErrorCode::kBadArgument, "there is no such option", std::string(key),
                fmt::format("there are: {}", fmt::join(known, ", ")));
  });
  return request;
}

}  // namespace

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
  options.rigger = request.rigger.value_or(request.chosenTemplate ? kTemplateRigger : options.rigger);
  options.existingRig = readExistingRig(request.existingRig);
  checkRanges(request);
  checkTogether(request, options);
  options.skinning = request.skinning;
  options.weights.maxInfluences = request.maxInfluences;
  options.weights.pieces = findNamed("pieces", [&] { return findPieceMode(request.pieces); });
  findNamed("target", [&] { return &findTarget(request.target); });
  options.chains = request.chains;
  options.standUpright = request.upright;
  options.rig.handles = request.handles;
  options.rig.up = readAxis("up", request.up);
  options.rig.front = readAxis("front", request.front);
  if (options.rig.up && options.rig.front && std::abs(options.rig.up->dot(*options.rig.front)) > 0.5) {
    refuseOption("front", "is not square to the model's up");
  }
  options.rig.pins = request.pins;
  if (request.chosenTemplate) {
    const auto& [name, skeleton] = *request.chosenTemplate;
    options.rig.templateName = name;
    options.rig.templateSkeleton = skeleton;
    if (!skeleton) findNamed("template", [&] { checkTemplateName(request.chosenTemplate->name); });
  }
  if (request.reading) options.rig.reading = readShapeWeights(*request.reading);
  return options;
}

void finishRig(Asset& asset, const RigRequest& request, AutoRigReport& report) {
  Warnings ofRig = std::exchange(asset.warnings, {});
  toTarget(asset, findTarget(request.target));
  report.warnings.append(asset.warnings);
  ofRig.append(asset.warnings);
  asset.warnings = std::move(ofRig);
}

AutoRigOptions optionsWithOwnTemplate(RigRequest request, std::string_view name,
                                      const std::function<Skeleton()>& read) {
  request.chosenTemplate = ChosenTemplate{std::string(name), Skeleton()};
  AutoRigOptions options = optionsOf(request);
  options.rig.templateSkeleton = read();
  return options;
}

AutoRigOptions optionsWithTemplate(RigRequest request, const std::string& nameOrFile) {
  if (!std::filesystem::path(nameOrFile).extension().empty()) {
    return optionsWithOwnTemplate(std::move(request), nameOrFile, [&] { return readTemplateFile(nameOrFile); });
  }
  request.chosenTemplate = ChosenTemplate{nameOrFile};
  return optionsOf(request);
}

}  // namespace limber
