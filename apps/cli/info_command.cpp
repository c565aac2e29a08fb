// limber info: what is in a file, and whether it can be rigged.
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "command.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_check_report.h"
#include "limber/actions/rig/rig_request.h"
#include "limber/character/anatomy/names/naming_convention.h"
#include "limber/core/counted.h"
#include "limber/core/text/printable.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/read.h"
#include "limber/evaluate/asset_info.h"
#include "limber/report/table.h"

namespace limber::cli {

namespace {

struct InfoArguments {
  std::string input;
  bool json = false, joints = false, conventions = false, rigCheck = false;
  RigRequest rig;  // what --rig-check reads of it
  std::optional<std::string> reading;
};

Json vectorJson(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Json weightsJson(const SkinWeightInfo& weights) {
  return {{"vertices", weights.vertices},
          {"without_weights", weights.withoutWeights},
          {"min", weights.least},
          {"max", weights.greatest},
          {"largest_sum_error", weights.largestSumError},
          {"most_influences", weights.maxInfluences}};
}

Json sizeJson(const SkeletonSize& size) {
  return {{"height", size.height}, {"hips", size.hips ? Json(*size.hips) : Json()}};
}

Json anatomyJson(const Anatomy& anatomy, const std::vector<std::string>& names) {
  Json parts = Json::array();
  for (const Part& part : anatomy.parts) {
    Json entry = {{"kind", nameOf(part.kind)}, {"side", nameOf(part.side)}, {"pair", part.pair}};
    Json joints = Json::array(), branches = Json::array();
    for (const Index joint : part.joints) joints.push_back(names[joint]);
    for (const Index joint : part.branches) branches.push_back(names[joint]);
    entry["joints"] = std::move(joints);
    if (!branches.empty()) entry["branches"] = std::move(branches);
    const auto landmark = [&](const char* name, const std::optional<Index>& joint) {
      if (joint) entry[name] = names[*joint];
    };
    landmark("upper", part.upper);
    landmark("middle", part.middle);
    landmark("hock", part.hock);
    landmark("end", part.end);
    landmark("toes", part.toes);
    if (part.carrier) entry["carrier"] = *part.carrier;
    entry["confidence"] = part.confidence;
    entry["evidence"] = nameOf(part.evidence);
    parts.push_back(std::move(entry));
  }
  Json contradicted = Json::array();
  for (const Index joint : anatomy.contradicted) contradicted.push_back(names[joint]);
  return {{"up", vectorJson(anatomy.axes.up)},
          {"front", vectorJson(anatomy.axes.front)},
          {"ground", anatomy.ground},
          {"size", anatomy.size},
          {"confidence", anatomy.confidence},
          {"convention", anatomy.convention.empty() ? Json() : Json(anatomy.convention)},
          {"contradicted_names", std::move(contradicted)},
          {"parts", std::move(parts)}};
}

Json infoJson(const std::string& file, const AssetInfo& info) {
  Json json = {{"file", file},
               {"format", info.format},
               {"vertices", info.storedVertices},
               {"scene_vertices", info.sceneVertices}};
  const SurfaceInfo surface = info.surface.value_or(SurfaceInfo{});
  json["triangles"] = surface.triangles;
  json["welded_vertices"] = surface.weldedVertices;
  json["pieces"] = surface.pieces;
  json["watertight"] = info.surface && surface.watertight();
  json["open_edges"] = surface.openEdges;
  json["crowded_edges"] = surface.crowdedEdges;
  if (info.bounds.empty()) {
    json["bounds"] = nullptr;
  } else {
    json["bounds"] = {{"min", vectorJson(info.bounds.min)}, {"max", vectorJson(info.bounds.max)}};
  }
  json["nodes"] = info.nodes;
  json["meshes"] = info.meshes;
  json["primitives"] = info.primitives;
  json["materials"] = info.materials;
  json["textures"] = info.textures;
  json["images"] = info.images;
  json["skins"] = info.skins;
  json["joints"] = info.joints.size();
  json["joint_names"] = info.joints;
  json["joint_positions"] = Json::array();
  for (const Vec3& position : info.jointPositions) json["joint_positions"].push_back(vectorJson(position));
  json["skeleton_size"] = info.bodySize ? sizeJson(*info.bodySize) : Json();
  json["anatomy"] = info.anatomy ? anatomyJson(*info.anatomy, info.joints) : Json();
  json["weights"] = info.weights ? weightsJson(*info.weights) : Json();
  json["clips"] = Json::array();
  for (const ClipInfo& clip : info.clips) {
    json["clips"].push_back({{"name", clip.name}, {"seconds", clip.seconds}, {"channels", clip.channels}});
  }
  json["extensions"] = info.extensions;
  json["warnings"] = toJson(info.warnings);
  return json;
}

void printField(std::string_view name, const std::string& value) {
  fmt::print("{:<16}{}\n", name, printable(value));
}

void printSurface(const AssetInfo& info) {
  if (!info.surface) {
    printField("triangles", "none");
    return;
  }
  const SurfaceInfo& surface = *info.surface;
  printField("triangles", fmt::to_string(surface.triangles));
  printField("welded", counted(surface.weldedVertices, "vertex", "vertices") + " at different places");
  printField("pieces", fmt::to_string(surface.pieces));
  printField("watertight", surface.watertight()
                               ? "yes"
                               : fmt::format("no: {} with one triangle, {} with more than two",
                                             counted(surface.openEdges, "edge"), surface.crowdedEdges));
  const Vec3 size = info.bounds.size();
  printField("size", fmt::format("{:.4g} x {:.4g} x {:.4g} m, from ({:.4g}, {:.4g}, {:.4g})", size.x(), size.y(),
                                 size.z(), info.bounds.min.x(), info.bounds.min.y(), info.bounds.min.z()));
}

std::string axisName(const Vec3& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return fmt::format("{}{}", direction[axis] < 0 ? '-' : '+', "XYZ"[axis]);
}

// One line a part: what it is, how sure that is, and its joints.
void printAnatomy(const Anatomy& anatomy, const std::vector<std::string>& names) {
  if (anatomy.parts.empty()) return printField("body", "none is seen in the joints");
  std::vector<std::string> attached;
  printField("body", fmt::format("up {}, front {}, {:.0f} % sure", axisName(anatomy.axes.up),
                                 axisName(anatomy.axes.front), 100 * anatomy.confidence));
  if (!anatomy.convention.empty()) printField("", fmt::format("named as {} names joints", anatomy.convention));
  if (!anatomy.contradicted.empty()) {
    std::vector<std::string> joints;
    for (const Index joint : anatomy.contradicted) joints.push_back(names[joint]);
    printField("", fmt::format("the tree contradicts the names of {}", joinNames(joints)));
  }
  for (const Part& part : anatomy.parts) {
    std::vector<std::string> joints;
    for (const Index joint : part.joints) joints.push_back(names[joint]);
    if (part.kind == PartKind::kAttachment) {
      attached.insert(attached.end(), joints.begin(), joints.end());
      continue;
    }
    const std::string side = part.side == Side::kCenter ? "" : fmt::format("{} ", nameOf(part.side));
    const std::string number = part.pair > 0 ? fmt::format(" {}", part.pair + 1) : "";
    const std::string more = part.branches.empty() ? "" : fmt::format(", and {} beside", part.branches.size());
    printField("", fmt::format("{}{}{} ({:.0f} %): {}{}", side, nameOf(part.kind), number, 100 * part.confidence,
                               joinNames(joints), more));
  }
  if (!attached.empty()) printField("", fmt::format("attachments: {}", joinNames(attached)));
}

void printSkeletonSize(const SkeletonSize& size) {
  const std::string hips = size.hips ? fmt::format(", hips at {:.4g} m", *size.hips) : "";
  printField("skeleton", fmt::format("{:.4g} m high from the lowest joint to the highest{}", size.height, hips));
}

// One line a joint.
void printPositions(const AssetInfo& info) {
  printField("", "positions in rest pose, in metres: x, y, z");
  for (std::size_t j = 0; j < info.joints.size(); ++j) {
    const Vec3& position = info.jointPositions[j];
    printField(
        "", fmt::format("{:<24} {:10.5f} {:10.5f} {:10.5f}", info.joints[j], position.x(), position.y(), position.z()));
  }
}

void printRig(const AssetInfo& info, bool withPositions) {
  printField("joints", fmt::to_string(info.joints.size()));
  if (withPositions && !info.joints.empty()) {
    printPositions(info);
  } else if (!info.joints.empty()) {
    printField("", joinNames(info.joints));
  }
  if (info.bodySize) printSkeletonSize(*info.bodySize);
  if (info.anatomy) printAnatomy(*info.anatomy, info.joints);
  if (!info.weights) return;
  const SkinWeightInfo& weights = *info.weights;
  printField("skin weights",
             fmt::format("{:.3g} to {:.3g}, largest |sum - 1| {:.2g}, at most {}", weights.least, weights.greatest,
                         weights.largestSumError, counted(weights.maxInfluences, "influence")));
  printField("without weights", counted(weights.withoutWeights, "vertex", "vertices"));
}

// What the model is taken for, then a line for each thing that its user can do.
void printRigCheck(const RigCheckReport& report) {
  printField("rig check", summaryOf(report.check));
  for (const Warning& advice : report.advice.items()) {
    const std::string where = advice.where.empty() ? "" : fmt::format(" ({})", advice.where);
    printField("", fmt::format("{}{} [{}]", advice.message, where, advice.kind));
  }
}

void print(const std::string& file, const AssetInfo& info, bool withPositions) {
  printField("file", file);
  printField("format", info.format);
  std::string vertices = fmt::to_string(info.storedVertices);
  if (info.sceneVertices != info.storedVertices) vertices += fmt::format(" stored, {} shown", info.sceneVertices);
  printField("vertices", vertices);
  printSurface(info);
  printField("meshes", fmt::format("{} with {} on {}", info.meshes, counted(info.primitives, "primitive"),
                                   counted(info.nodes, "node")));
  printField("materials", fmt::format("{}, {}, {}", info.materials, counted(info.textures, "texture"),
                                      counted(info.images, "image")));
  printRig(info, withPositions);
  printField("clips", fmt::to_string(info.clips.size()));
  for (const ClipInfo& clip : info.clips) {
    printField("", fmt::format("{}: {:.3f} s, {}", clip.name.empty() ? "(no name)" : clip.name, clip.seconds,
                               counted(clip.channels, "channel")));
  }
  if (!info.extensions.empty()) printField("extensions", joinNames(info.extensions));
}

// For docs/anatomy.md.
void printConventions() {
  Table table{{words("names of"), words("hips, upper leg, lower arm, index finger"), words("documented at")}};
  for (const NamingConvention& convention : namingConventions()) {
    std::vector<std::string> names;
    const auto add = [&](JointRole role, Side side) {
      for (const int pair : {0, 1}) {
        std::string name = conventionName(convention, role, side, 0, pair);
        if (!name.empty()) return names.push_back(fmt::format("`{}`", name));
      }
    };
    add(JointRole::kHips, Side::kCenter);
    add(JointRole::kSpineToHead, Side::kCenter);
    for (const JointRole role : {JointRole::kUpperLeg, JointRole::kLowerArm, JointRole::kIndex}) add(role, Side::kLeft);
    table.add({convention.name, joinNames(names), convention.documentation});
  }
  fmt::print("{}", toMarkdown(table));
}

// What --rig-check asks for, as `limber rig --rigger template` would be.
AutoRigOptions rigOptionsOf(const InfoArguments& options) {
  RigRequest request = options.rig;
  request.rigger = "template";
  request.reading = options.reading;
  return checkedOptions([&] { return optionsOf(request); });
}

void run(const InfoArguments& options) {
  if (options.conventions) return printConventions();
  if (options.input.empty()) throw CLI::RequiredError("FILE");
  std::optional<AutoRigOptions> rig;
  if (options.rigCheck) rig = rigOptionsOf(options);
  Asset asset = readAsset(options.input);
  const AssetInfo info = inspectAsset(asset);
  std::optional<RigCheckReport> check;
  if (rig) {
    check = checkRigging(std::move(asset), *rig);
    check->advice = spellOptions(check->advice, OptionSpelling::kProgram);
  }
  if (options.json) {
    Json json = infoJson(options.input, info);
    if (check) json["rig_check"] = toJson(*check);
    return printJson(json);
  }
  print(options.input, info, options.joints);
  Warnings warnings = info.warnings;
  if (check) {
    printRigCheck(*check);
    warnings.append(check->warnings);
  }
  printWarnings(warnings, false);
}

}  // namespace

void addInfoCommand(CLI::App& program) {
  auto options = std::make_shared<InfoArguments>();
  CLI::App* command = program.add_subcommand("info", "Tell what is in a file");
  command->add_option("FILE", options->input, "the file; - is standard input");
  command->add_flag("--json", options->json, "print JSON");
  command->add_flag("--joints", options->joints,
                    "a line for each joint with its position in rest pose, as rig --pin takes it (--json has them)");
  CLI::Option* check = command->add_flag(
      "--rig-check", options->rigCheck,
      "whether the model can be rigged: its kind of body and pose, what is missing or grown together, what to do");
  command->add_option("--up", options->rig.up, "with --rig-check: the model's up, as +y (default: found)")
      ->type_name("AXIS")
      ->needs(check);
  command->add_option("--front", options->rig.front, "with --rig-check: where the model looks, as +z (default: found)")
      ->type_name("AXIS")
      ->needs(check);
  command->add_option("--reading", options->reading, "with --rig-check: networks of your own, as rig --reading")
      ->type_name("FILE")
      ->needs(check);
  command
      ->add_flag("--conventions", options->conventions,
                 "print the naming conventions whose joints are known for certain, as a table in Markdown")
      ->excludes(check);
  command->footer(
      "Pieces and watertightness are counted after vertices at equal positions are merged; watertight means that\n"
      "every edge has exactly two triangles.\n"
      "\nExamples:\n  limber info dragon.glb --json\n  limber info hero.glb --joints\n"
      "  limber info person.glb --rig-check\n  limber info walk.bvh");
  command->callback([options] { run(*options); });
}

}  // namespace limber::cli
