#include "limber/actions/report_json.h"

#include <nlohmann/json.hpp>

#include "limber/actions/rig/rig_check_report.h"
#include "limber/actions/rig/rig_from_animation.h"
#include "limber/document/gltf/json_text.h"

namespace limber {

Json stagesJson(const std::vector<StageTime>& stages) {
  Json list = Json::array();
  for (const StageTime& stage : stages) {
    Json entry = {{"name", stage.name}, {"seconds", stage.seconds}};
    if (!stage.steps.empty()) entry["steps"] = stagesJson(stage.steps);
    list.push_back(std::move(entry));
  }
  return list;
}

Json toJson(const AutoRigReport& report) {
  Json json;
  json["methods"] = {{"rigger", report.rigger.empty() ? Json() : Json(report.rigger)}, {"skinning", report.skinning}};
  json["counts"] = {{"vertices", report.sourceVertices},
                    {"welded_vertices", report.weldedVertices},
                    {"triangles", report.triangles},
                    {"pieces", report.pieces},
                    {"joints", report.joints},
                    {"max_influences", report.maxInfluences},
                    {"removed_joints", report.removedJoints},
                    {"removed_clips", report.removedClips}};
  json["seconds"] = totalSeconds(report.stages);
  json["stages"] = stagesJson(report.stages);
  json["suggestions"] = Json::array();
  for (const HandleSuggestion& suggestion : report.suggestions) {
    json["suggestions"].push_back({{"handles", suggestion.handles}, {"score", suggestion.score}});
  }
  if (!report.matches.empty()) json["templates"] = Json::array();
  for (const TemplateMatch& match : report.matches) {
    json["templates"].push_back({{"name", match.name}, {"confidence", match.confidence}});
  }
  if (!report.chains.empty()) json["chains"] = report.chains;
  if (!report.doubts.empty()) json["doubts"] = report.doubts;
  json["bridged"] = Json::array();
  for (const BridgedNode& node : report.bridged) {
    json["bridged"].push_back({{"node", node.name}, {"vertices", node.vertices}, {"bridged", node.bridged}});
  }
  json["warnings"] = toJson(report.warnings);
  return json;
}

Json toJson(const AnimationRigReport& report) {
  Json json;
  json["methods"] = {{"rigger", "animation"}, {"skinning", "animation"}};
  json["counts"] = {{"vertices", report.sourceVertices}, {"points", report.points},
                    {"frames", report.frames},           {"clips", report.clips},
                    {"joints", report.joints},           {"max_influences", report.maxInfluences}};
  json["error_percent"] = 100 * report.error;
  json["seconds"] = totalSeconds(report.stages);
  json["stages"] = stagesJson(report.stages);
  json["warnings"] = toJson(report.warnings);
  return json;
}

Json toJson(const RigCheckReport& report) {
  const RigCheck& check = report.check;
  Json json;
  json["kinds"] = Json::array();
  for (const TemplateMatch& kind : check.kinds) {
    json["kinds"].push_back({{"name", kind.name}, {"confidence", kind.confidence}});
  }
  json["sure"] = check.isSure;
  json["pose"] = check.pose ? Json(nameOf(*check.pose)) : Json();
  json["missing"] = check.missing;
  json["grown_together"] = Json::array();
  for (const PartContact& contact : check.grownTogether) {
    json["grown_together"].push_back({{"parts", describeParts(check, contact)}, {"length", contact.length}});
  }
  json["doubts"] = check.doubts;
  json["upright"] = check.isUpright;
  json["pieces"] = report.pieces;
  json["inner_shell_vertices"] = report.innerShellVertices;
  json["has_rig"] = report.hasRig;
  json["advice"] = toJson(report.advice);
  json["warnings"] = toJson(report.warnings);
  return json;
}

}  // namespace limber
