// A scene across the C boundary, whose chosen member is "the session": commands in JSON in, the state in JSON and
// arrays out. limber.mjs is the typed face of these functions; nobody else calls them.
#include <algorithm>
#include <cstdint>
#include <memory>

#include "call_result.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_check_report.h"
#include "limber/deform/direct_delta_mush.h"
#include "limber/document/bvh/bvh_write.h"
#include "limber/document/gltf/json_text.h"
#include "limber/document/live/live_text.h"
#include "limber/document/mesh/mesh_export.h"
#include "limber/session/drag/measures.h"
#include "limber/session/drag/surface_parts.h"
#include "limber/session/edit/clip_curves.h"
#include "limber/session/scene/scene.h"
#include "limber/session/scene/scene_state.h"
#include "limber/skeleton/clip/keys/keyframes.h"
#include "page_progress.h"
#include "surface_bytes.h"

namespace {

using limber::Bytes;
using limber::Index;
using limber::Json;
using limber::wasm::bytesOf;
using limber::wasm::CallResult;
using limber::wasm::guarded;
using limber::wasm::PageProgress;
using limber::wasm::surfaceOf;
using limber::wasm::weightsArray;

// The normals that a page shades surfaces with, as bound; of the rigs that were asked for last.
class ShadingNormals {
 public:
  const std::vector<limber::Vec3f>& of(const std::shared_ptr<const limber::RiggedModel>& rig) {
    for (const Kept& kept : kept_) {
      if (kept.rig == rig) return kept.normals;
    }
    constexpr std::size_t kMaxKept = 4;
    if (kept_.size() == kMaxKept) kept_.erase(kept_.begin());
    kept_.push_back({rig, limber::exportMesh(rig->asset(), rig->geometry()).normals});
    return kept_.back().normals;
  }

 private:
  struct Kept {
    std::shared_ptr<const limber::RiggedModel> rig;
    std::vector<limber::Vec3f> normals;
  };
  std::vector<Kept> kept_;
};

struct SessionHandle {
  limber::SessionScene scene;
  mutable ShadingNormals normals = {};

  const limber::Session& session() const { return scene.session(); }
};

std::string textOf(const Json& json) {
  return limber::dumpReport(json, -1);
}

template <class Vector>
void append(std::vector<float>& values, const Vector& vector) {
  for (Eigen::Index i = 0; i < vector.size(); ++i) values.push_back(static_cast<float>(vector[i]));
}

// Column by column.
void append(std::vector<float>& values, const limber::Affine& affine) {
  for (int column = 0; column < 4; ++column) append(values, affine.matrix().col(column));
}

// #J matrices.
std::vector<float> skinArray(const limber::Session& session) {
  std::vector<float> values;
  for (const limber::Affine& skin : session.skinMatrices()) append(values, skin);
  return values;
}

// #J times where the joint is, and its radius.
std::vector<float> handleArray(const limber::SessionState& state) {
  std::vector<float> values;
  const std::vector<limber::Affine> globals = limber::poseGlobals(state.rig->skeleton(), state.pose);
  for (Index j = 0; j < globals.size(); ++j) {
    append(values, globals[j].translation());
    values.push_back(static_cast<float>(state.rig->radii[j]));
  }
  return values;
}

// #J times its turn from the rest pose, degrees about x, y and z, and its rotation in the world: x, y, z, w.
std::vector<float> turnArray(const limber::SessionState& state) {
  std::vector<float> values;
  const std::vector<limber::Affine> globals = limber::poseGlobals(state.rig->skeleton(), state.pose);
  for (Index j = 0; j < globals.size(); ++j) {
    const limber::Transform& rest = state.rig->skeleton().joints[j].rest;
    append(values, limber::pointFromRest(state.pose.locals[j], rest).turn);
    append(values, limber::decompose(globals[j]).rotation.coeffs());
  }
  return values;
}

// #J times how many times as large it is as in its rest pose, along all axes.
std::vector<float> scaleArray(const limber::SessionState& state) {
  std::vector<float> values;
  const std::vector<limber::Joint>& joints = state.rig->skeleton().joints;
  for (Index j = 0; j < joints.size(); ++j) {
    values.push_back(static_cast<float>(state.pose.locals[j].scale.norm() / joints[j].rest.scale.norm()));
  }
  return values;
}

Json tangentsJson(const limber::SessionState& state, Index joint) {
  Json list = Json::array();
  for (const limber::CurveTangent& at : limber::curveTangents(state.movement, state.rig->skeleton(), joint)) {
    const auto& [turn, offset] = at.slope;
    list.push_back({{"seconds", at.seconds},
                    {"kind", std::string(limber::keyTangentsName(at.tangents))},
                    {"turn", {turn.x(), turn.y(), turn.z()}},
                    {"offset", {offset.x(), offset.y(), offset.z()}}});
  }
  return list;
}

limber::Command commandOf(const char* json, std::size_t size) {
  limber::Warnings warnings;
  return limber::commandFromJson(limber::parseJson({json, size}, warnings));
}

Json hitJson(const std::optional<limber::SurfaceHit>& hit) {
  if (!hit) return nullptr;
  return {{"dab", {hit->dab.triangle, hit->dab.u, hit->dab.v}},
          {"position", {hit->position.x(), hit->position.y(), hit->position.z()}},
          {"normal", {hit->normal.x(), hit->normal.y(), hit->normal.z()}},
          {"joint", hit->joint},
          {"inside", {hit->inside.x(), hit->inside.y(), hit->inside.z()}}};
}

// What bends the surface that a page draws.
enum class DrawnBy {
  kWeights,  // of limber_session_model
  kRows,     // of limber_session_deformation
  kEngine    // limber_session_posed, for every frame
};

DrawnBy drawnBy(const limber::SessionState& state, const limber::Deformer& deformer) {
  if (deformer.name == limber::kLinearBlendDeformer.name) return DrawnBy::kWeights;
  constexpr std::size_t kMaxEntries = 2048 * 400;  // of 5 texels, in the least that WebGL 2 has room for
  constexpr std::size_t kJointsOfEntry = 4, kMaxJoints = limber::DirectDeltaMushOptions().maxJoints;
  const limber::SkinWeights& weights = state.rig->weights;
  const std::size_t most = (std::max<std::size_t>(weights.slots, kMaxJoints) + kJointsOfEntry - 1) / kJointsOfEntry;
  return deformer.rows && most * weights.vertexCount() <= kMaxEntries ? DrawnBy::kRows : DrawnBy::kEngine;
}

// {"form": "weights"}, {"form": "engine"} or {"form": "rows", "vertices", "entries"} with the rows as floats: of each
// vertex its position (x, y, z), then of each its first entry and their count; of each entry its four joints and 16
// moments.
CallResult deformationOf(const limber::SessionState& state) {
  const limber::Deformer& deformer = limber::findDeformer(state.deformer);
  const DrawnBy drawn = drawnBy(state, deformer);
  if (drawn != DrawnBy::kRows) return {true, {}, textOf({{"form", drawn == DrawnBy::kEngine ? "engine" : "weights"}})};
  const std::shared_ptr<const limber::DeformRows> rows = limber::deformRows(*state.rig, deformer);
  std::vector<float> values;
  for (const Index row : rows->rowOf) {
    const float* position = rows->positions.data() + 4 * std::size_t{row};
    values.insert(values.end(), position, position + 3);
  }
  for (const Index row : rows->rowOf) {
    values.push_back(static_cast<float>(rows->begin[row]));
    values.push_back(static_cast<float>(rows->begin[row + 1] - rows->begin[row]));
  }
  const std::size_t entries = rows->joints.size() / 4;
  for (std::size_t entry = 0; entry < entries; ++entry) {
    for (std::size_t i = 4 * entry; i < 4 * entry + 4; ++i) values.push_back(static_cast<float>(rows->joints[i]));
    const float* moments = rows->moments.data() + 16 * entry;
    values.insert(values.end(), moments, moments + 16);
  }
  return {true, bytesOf(values), textOf({{"form", "rows"}, {"vertices", rows->rowOf.size()}, {"entries", entries}})};
}

// Positions, then normals, of a surface that the engine bends; nothing where the page does.
CallResult posedOf(const limber::SessionState& state, ShadingNormals& normals) {
  const limber::Deformer& deformer = limber::findDeformer(state.deformer);
  if (drawnBy(state, deformer) != DrawnBy::kEngine) return {true, {}, "{}"};
  const limber::PosedSurface surface = limber::posedSurface(*state.rig, state.pose, deformer, normals.of(state.rig));
  Bytes bytes = bytesOf(surface.positions);
  const Bytes behind = bytesOf(surface.normals);
  bytes.insert(bytes.end(), behind.begin(), behind.end());
  return {true, std::move(bytes), "{}"};
}

// The pinned joints; at a clip's time these are the feet that are planted then.
std::string pinnedOf(const limber::SessionState& state) {
  Json pinned = Json::array();
  for (const limber::PinnedTarget& target : state.targets) pinned.push_back(target.joint);
  return textOf({{"pinned", pinned}});
}

// A drag's updates and a clip's times come once a frame and change nothing but the pose, and which feet are planted.
CallResult stateAfter(const limber::SessionScene& scene, const limber::Command& command) {
  const bool frame =
      std::holds_alternative<limber::UpdateDrag>(command) || std::holds_alternative<limber::TurnDrag>(command) ||
      std::holds_alternative<limber::ScaleDrag>(command) || std::holds_alternative<limber::MoveDrag>(command) ||
      std::holds_alternative<limber::SetTime>(command) || std::holds_alternative<limber::SetClock>(command);
  return {true, bytesOf(skinArray(scene.session())),
          frame ? pinnedOf(scene.session().state()) : textOf(limber::sceneState(scene))};
}

Json hitJson(const std::optional<limber::PickHit>& hit) {
  if (!hit) return nullptr;
  return {{"joint", hit->joint},
          {"on_handle", hit->onHandle},
          {"position", {hit->position.x(), hit->position.y(), hit->position.z()}},
          {"distance", hit->distance},
          {"inside", {hit->inside.x(), hit->inside.y(), hit->inside.z()}}};
}

// The skeleton with the chosen clip; where none is, with the pose as its only frame.
Bytes motionOf(const limber::SessionState& state) {
  limber::Motion motion;
  motion.name = "limber";
  motion.skeleton = state.rig->skeleton();
  if (const limber::Clip* clip = state.movement.clip()) {
    motion.clips.push_back(*clip);
    motion.framesPerSecond = limber::measuredFrameRate(*clip).value_or(motion.framesPerSecond);
  } else {
    motion.clips.emplace_back().name = "pose";
    limber::setKey(motion.clips.back(), motion.skeleton, state.pose, 0);
  }
  return limber::writeBvh(motion);
}

Bytes exported(const limber::SessionScene& scene, std::string_view format) {
  if (format == "glb") return scene.exportModel(limber::ExportFormat::kGlb);
  if (format == "obj") return scene.exportModel(limber::ExportFormat::kObj);
  if (format == "stl") return scene.exportModel(limber::ExportFormat::kStl);
  if (format == "ply") return scene.exportModel(limber::ExportFormat::kPly);
  if (format == "usdz") return scene.exportModel(limber::ExportFormat::kUsdz);
  if (format == "bvh") return motionOf(scene.session().state());
  if (format == "session") return scene.session().saveSession();
  throw limber::Error(limber::ErrorCode::kBadArgument, "no format is called '" + std::string(format) + "'", {},
                      "there are: glb, obj, stl, ply, usdz, bvh, session");
}

}  // namespace

LIMBER_EXPORT SessionHandle* limber_session_new() {
  return new (std::nothrow) SessionHandle;
}
// Null where a joint is being dragged, where nothing is open, and without memory.
LIMBER_EXPORT SessionHandle* limber_session_fork(const SessionHandle* handle) {
  try {
    return new SessionHandle{limber::SessionScene(handle->session().fork())};
  } catch (const std::exception&) {
    return nullptr;
  }
}
LIMBER_EXPORT void limber_session_free(SessionHandle* handle) {
  delete handle;
}

// Bytes of all but limber_session_export and _model: the skin matrices. The strings need no final zero.
LIMBER_EXPORT CallResult* limber_session_open(SessionHandle* handle, int limbsFollow, const std::uint8_t* file,
                                              std::size_t fileSize, const char* name, std::size_t nameSize) {
  return guarded({name, nameSize}, [&] {
    PageProgress progress;
    handle->scene.open({file, fileSize}, {name, nameSize}, *progress, limbsFollow != 0);
    return stateAfter(handle->scene, limber::OpenFile{});
  });
}

LIMBER_EXPORT CallResult* limber_session_run(SessionHandle* handle, const char* json, std::size_t size) {
  return guarded({}, [&] {
    const limber::Command command = commandOf(json, size);
    PageProgress progress;
    handle->scene.run(command, *progress);
    return stateAfter(handle->scene, command);
  });
}

// The same as the command add_file.
LIMBER_EXPORT CallResult* limber_session_add(SessionHandle* handle, int limbsFollow, int asProp,
                                             const std::uint8_t* file, std::size_t fileSize, const char* name,
                                             std::size_t nameSize) {
  return guarded({name, nameSize}, [&] {
    PageProgress progress;
    const limber::AddFile command{{name, nameSize}, limbsFollow != 0, asProp != 0};
    handle->scene.add({file, fileSize}, command, *progress);
    return stateAfter(handle->scene, command);
  });
}

// 16 numbers for each member: its own space in that of the scene.
LIMBER_EXPORT CallResult* limber_session_places(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    std::vector<float> values;
    for (std::size_t m = 0; m < handle->scene.members().size(); ++m) append(values, handle->scene.toScene(m));
    return {true, bytesOf(values), "{}"};
  });
}

// As limber_session_model and _skin, of any member.
LIMBER_EXPORT CallResult* limber_session_member_model(const SessionHandle* handle, Index member) {
  return guarded({}, [&] { return surfaceOf(*handle->scene.members()[member].session->state().rig); });
}
LIMBER_EXPORT CallResult* limber_session_member_skin(const SessionHandle* handle, Index member) {
  return guarded({}, [&]() -> CallResult {
    return {true, bytesOf(skinArray(*handle->scene.members()[member].session)), "{}"};
  });
}
LIMBER_EXPORT CallResult* limber_session_member_deformation(const SessionHandle* handle, Index member) {
  return guarded({}, [&] { return deformationOf(handle->scene.members()[member].session->state()); });
}
LIMBER_EXPORT CallResult* limber_session_member_posed(const SessionHandle* handle, Index member) {
  return guarded({}, [&] { return posedOf(handle->scene.members()[member].session->state(), handle->normals); });
}

// The member whose surface the ray meets first, or null.
LIMBER_EXPORT CallResult* limber_session_pick_member(const SessionHandle* handle, double ox, double oy, double oz,
                                                     double dx, double dy, double dz) {
  return guarded({}, [&]() -> CallResult {
    const std::optional<limber::SceneHit> hit = handle->scene.pick({{ox, oy, oz}, {dx, dy, dz}});
    return {true, {}, hit ? textOf({{"member", hit->member}, {"joint", hit->hit.joint}}) : "null"};
  });
}

LIMBER_EXPORT CallResult* limber_session_add_motion(SessionHandle* handle, int retarget, const std::uint8_t* file,
                                                    std::size_t fileSize, const char* name, std::size_t nameSize) {
  return guarded({name, nameSize}, [&] {
    const limber::AddMotion command{std::string(name, nameSize), retarget != 0};
    handle->scene.addMotion({file, fileSize}, command);
    return stateAfter(handle->scene, command);
  });
}

LIMBER_EXPORT CallResult* limber_session_transfer_rig(SessionHandle* handle, const std::uint8_t* file,
                                                      std::size_t fileSize, const char* name, std::size_t nameSize) {
  return guarded({name, nameSize}, [&] {
    PageProgress progress;
    const limber::TransferRig command{std::string(name, nameSize)};
    handle->scene.transferRig({file, fileSize}, command, *progress);
    return stateAfter(handle->scene, command);
  });
}

// A motion that comes live: its skeleton as limber/document/live/live_text.h has it, then seven numbers for each of its
// joints.
LIMBER_EXPORT CallResult* limber_session_live_begin(SessionHandle* handle, const char* skeleton, std::size_t size) {
  return guarded({}, [&]() -> CallResult {
    handle->scene.beginLive(limber::liveSkeletonFrom({skeleton, size}));
    return {true, {}, "{}"};
  });
}
LIMBER_EXPORT CallResult* limber_session_live_frame(SessionHandle* handle, double seconds, const std::uint8_t* values,
                                                    std::size_t size) {
  return guarded({}, [&]() -> CallResult {
    handle->scene.showLive(limber::livePoseFrom({values, size}), seconds);
    return {true, bytesOf(skinArray(handle->session())), pinnedOf(handle->session().state())};
  });
}
LIMBER_EXPORT CallResult* limber_session_live_end(SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    handle->scene.endLive();
    return {true, bytesOf(skinArray(handle->session())), pinnedOf(handle->session().state())};
  });
}
// What has come of it, as a BVH.
LIMBER_EXPORT CallResult* limber_session_live_recorded(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, limber::writeBvh(handle->session().recordedLive()), "{}"}; });
}

// Three numbers for each joint of the skeleton that the chosen clip comes from.
LIMBER_EXPORT CallResult* limber_session_source_joints(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    std::vector<float> values;
    for (const limber::Vec3& position : limber::sourceJoints(handle->session().state().movement))
      append(values, position);
    return {true, bytesOf(values), "{}"};
  });
}

// The chosen clip at even moments, at most `most` of them: three numbers for each joint, moment after moment.
LIMBER_EXPORT CallResult* limber_session_paths(const SessionHandle* handle, double framesPerSecond, std::size_t most) {
  return guarded({}, [&]() -> CallResult {
    const limber::SessionState& state = handle->session().state();
    const std::vector<double> moments = limber::evenMoments(state.movement, framesPerSecond, most);
    std::vector<float> values;
    for (const limber::Vec3& at : limber::jointPaths(state.movement, state.rig->skeleton(), moments)) {
      append(values, at);
    }
    return {true, bytesOf(values), textOf({{"moments", moments}})};
  });
}

// Likewise one joint's turn and offset, at its keys too: six numbers for each moment.
LIMBER_EXPORT CallResult* limber_session_curve(const SessionHandle* handle, Index joint, double framesPerSecond,
                                               std::size_t most) {
  return guarded({}, [&]() -> CallResult {
    const limber::SessionState& state = handle->session().state();
    const std::vector<double> moments = limber::curveMoments(state.movement, joint, framesPerSecond, most);
    std::vector<float> values;
    for (const limber::CurvePoint& point : limber::jointCurve(state.movement, state.rig->skeleton(), joint, moments)) {
      append(values, point.turn);
      append(values, point.offset);
    }
    return {true, bytesOf(values), textOf({{"moments", moments}, {"tangents", tangentsJson(state, joint)}})};
  });
}

LIMBER_EXPORT CallResult* limber_session_pick(const SessionHandle* handle, double ox, double oy, double oz, double dx,
                                              double dy, double dz, double slope) {
  return guarded({}, [&]() -> CallResult {
    return {true, {}, textOf(hitJson(handle->session().pick({{ox, oy, oz}, {dx, dy, dz}}, slope)))};
  });
}

// Where a brush meets the surface.
LIMBER_EXPORT CallResult* limber_session_surface(const SessionHandle* handle, double ox, double oy, double oz,
                                                 double dx, double dy, double dz) {
  return guarded({}, [&]() -> CallResult {
    return {true, {}, textOf(hitJson(handle->session().pickSurface({{ox, oy, oz}, {dx, dy, dz}})))};
  });
}

// The weights that there are, and those that a stroke would leave.
LIMBER_EXPORT CallResult* limber_session_weights(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    return {true, weightsArray(handle->session().state().rig->weights), "{}"};
  });
}
LIMBER_EXPORT CallResult* limber_session_preview(const SessionHandle* handle, const char* json, std::size_t size) {
  return guarded({}, [&]() -> CallResult {
    const limber::Command command = commandOf(json, size);
    const auto* stroke = std::get_if<limber::PaintWeights>(&command);
    if (!stroke) throw limber::Error(limber::ErrorCode::kBadArgument, "only painting has a preview");
    return {true, weightsArray(handle->session().previewPaint(*stroke)), "{}"};
  });
}

// A part for each triangle, in 32 bits, and what the parts are called.
LIMBER_EXPORT CallResult* limber_session_parts(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    const limber::SurfaceParts parts = limber::surfaceParts(handle->session().state());
    return {true, bytesOf(parts.partOf), textOf({{"names", parts.names}})};
  });
}

LIMBER_EXPORT CallResult* limber_session_skin(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, bytesOf(skinArray(handle->session())), "{}"}; });
}

LIMBER_EXPORT CallResult* limber_session_handles(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, bytesOf(handleArray(handle->session().state())), "{}"}; });
}

LIMBER_EXPORT CallResult* limber_session_turns(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, bytesOf(turnArray(handle->session().state())), "{}"}; });
}

LIMBER_EXPORT CallResult* limber_session_scales(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, bytesOf(scaleArray(handle->session().state())), "{}"}; });
}

LIMBER_EXPORT CallResult* limber_session_model(const SessionHandle* handle) {
  return guarded({}, [&] { return surfaceOf(*handle->session().state().rig); });
}

// How the surface is deformed in drawing, and its current positions where the engine deforms it.
LIMBER_EXPORT CallResult* limber_session_deformation(const SessionHandle* handle) {
  return guarded({}, [&] { return deformationOf(handle->session().state()); });
}
LIMBER_EXPORT CallResult* limber_session_posed(const SessionHandle* handle) {
  return guarded({}, [&] { return posedOf(handle->session().state(), handle->normals); });
}

LIMBER_EXPORT CallResult* limber_session_export(const SessionHandle* handle, const char* format, std::size_t size) {
  return guarded({}, [&]() -> CallResult { return {true, exported(handle->scene, {format, size}), "{}"}; });
}

// The model in a format (".glb", ".usdz"), as a target expects it; warnings come with it. `clip`: of formats that hold
// one; empty: none.
LIMBER_EXPORT CallResult* limber_session_save_model(const SessionHandle* handle, const char* extension,
                                                    std::size_t extensionSize, const char* target,
                                                    std::size_t targetSize, const char* clip, std::size_t clipSize) {
  return guarded({}, [&]() -> CallResult {
    limber::WriteModelOptions options;
    options.target = {target, targetSize};
    options.isStill = clipSize == 0;
    if (!options.isStill) options.clip = {clip, clipSize};
    limber::EncodedModel model = handle->scene.saveModel({extension, extensionSize}, options);
    return {true, std::move(model.bytes), textOf({{"warnings", limber::toJson(model.warnings)}})};
  });
}

// The pose that is shown, as the text of a file.
LIMBER_EXPORT CallResult* limber_session_pose(const SessionHandle* handle, const char* name, std::size_t size) {
  return guarded({}, [&]() -> CallResult {
    return {true, {}, textOf({{"pose", handle->session().savePose({name, size})}})};
  });
}

LIMBER_EXPORT CallResult* limber_session_measures(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    return {true, {}, textOf(limber::measuresToJson(limber::measureSession(handle->session())))};
  });
}

// Whether the model, without a rig of its own, can get a named skeleton. What is read of the shape serves rigging, too.
LIMBER_EXPORT CallResult* limber_session_rig_check(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult {
    limber::AutoRigOptions options;
    options.rig.memory = handle->session().state().memory;
    limber::RigCheckReport report = limber::checkRigging(handle->session().source().clone(), options);
    report.advice = limber::spellOptions(report.advice, limber::wasm::optionSpelling);
    return {true, {}, textOf(limber::toJson(report))};
  });
}

LIMBER_EXPORT CallResult* limber_session_record(const SessionHandle* handle) {
  return guarded({}, [&]() -> CallResult { return {true, {}, limber::commandsToJson(handle->scene.record())}; });
}
