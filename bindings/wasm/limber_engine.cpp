// The C boundary of the WebAssembly engine: bytes and JSON in, bytes and JSON out. limber.mjs is the typed face of
// these functions; nobody else calls them.
#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "call_result.h"
#include "limber/actions/export/engine_target.h"
#include "limber/actions/report_json.h"
#include "limber/actions/rig/rig_request.h"
#include "limber/actions/rig/template_file.h"
#include "limber/core/known_error.h"
#include "limber/deform/deformer.h"
#include "limber/document/clip/pose_file.h"
#include "limber/document/mesh/ply.h"
#include "limber/document/read.h"
#include "limber/document/write.h"
#include "limber/motion/retarget/retarget_method.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/roles/body_kinds.h"
#include "limber/samples/motions/sample_motions.h"
#include "limber/samples/motions/sample_poses.h"
#include "limber/skeleton/ik/ik_solver.h"
#include "page_progress.h"

namespace {

using limber::Json;
using limber::wasm::CallResult;
using limber::wasm::guarded;

// As the program reads the file that --template names.
limber::AutoRigOptions optionsFrom(const limber::RigRequest& request, limber::ByteSpan templateFile,
                                   std::string_view templateName) {
  if (templateName.empty()) return limber::optionsOf(request);
  return limber::optionsWithOwnTemplate(request, templateName,
                                        [&] { return limber::readTemplateFile(templateFile, templateName); });
}

template <class Table>
Json list(const Table& table) {
  Json names = Json::array();
  for (const auto& named : table) {
    names.push_back({{"name", std::string(named.name)}, {"summary", std::string(named.summary)}});
  }
  return names;
}

}  // namespace

// The strings need no final zero. A template in a file of its own: its name is empty where there is none. The result is
// the caller's, to be given back to limber_free_result; null where there is no memory even to tell what went wrong.
LIMBER_EXPORT CallResult* limber_rig(const std::uint8_t* file, std::size_t fileSize, const char* name,
                                     std::size_t nameSize, const char* options, std::size_t optionsSize,
                                     const std::uint8_t* templateFile, std::size_t templateFileSize,
                                     const char* templateName, std::size_t templateNameSize) {
  return guarded({name, nameSize}, [&]() -> CallResult {
    const limber::RigRequest request = limber::rigRequestFromJson({options, optionsSize});
    const limber::AutoRigOptions rig =
        optionsFrom(request, {templateFile, templateFileSize}, {templateName, templateNameSize});
    limber::Asset asset = limber::readAsset({file, fileSize}, {name, nameSize});
    limber::wasm::PageProgress progress;
    limber::AutoRigReport report = limber::autoRig(asset, rig, *progress);
    limber::finishRig(asset, request, report);
    return {true, limber::writeGlb(asset), limber::dumpReport(limber::toJson(report), -1)};
  });
}

// The networks that read shapes, for all that is rigged from now on.
LIMBER_EXPORT CallResult* limber_set_shape_weights(const std::uint8_t* file, std::size_t fileSize, const char* name,
                                                   std::size_t nameSize) {
  return guarded({name, nameSize}, [&]() -> CallResult {
    try {
      limber::setShapeWeights({file, fileSize});
    } catch (const limber::Error& error) {
      limber::throwWithin(error, {name, nameSize});
    }
    return {true, {}, "{}"};
  });
}

// Fails where a PLY file is cut off. Pages read the format by other means, which would not notice.
LIMBER_EXPORT CallResult* limber_check_ply(const std::uint8_t* file, std::size_t fileSize, const char* name,
                                           std::size_t nameSize) {
  return guarded({name, nameSize}, [&]() -> CallResult {
    try {
      limber::readPly({file, fileSize}, {});
    } catch (const limber::Error& error) {
      limber::throwWithin(error, {name, nameSize});
    }
    return {true, {}, "{}"};
  });
}

// Every table of methods, by what they do.
LIMBER_EXPORT CallResult* limber_methods() {
  return guarded({}, []() -> CallResult {
    const Json json = {{"rigger", list(limber::riggerMethods())},
                       {"skinning", list(limber::weightMethods())},
                       {"deformer", list(limber::deformers())},
                       {"solver", list(limber::ikMethods())},
                       {"retargeting", list(limber::retargetMethods())}};
    return {true, {}, limber::dumpReport(json, -1)};
  });
}

// What else a rig is chosen by: templates, how pieces are bound, and what it is made for.
LIMBER_EXPORT CallResult* limber_rig_choices() {
  return guarded({}, []() -> CallResult {
    const Json json = {{"template", list(limber::bodyKinds())},
                       {"pieces", list(limber::pieceModes())},
                       {"target", list(limber::engineTargets())}};
    return {true, {}, limber::dumpReport(json, -1)};
  });
}

// The motions that the engine makes itself; the seconds are those of one repetition.
LIMBER_EXPORT CallResult* limber_sample_motions() {
  return guarded({}, []() -> CallResult {
    Json motions = Json::array();
    for (const limber::SampleMotion& motion : limber::sampleMotions()) {
      motions.push_back(
          {{"name", std::string(motion.name)}, {"summary", std::string(motion.summary)}, {"seconds", motion.seconds}});
    }
    return {true, {}, limber::dumpReport(motions, -1)};
  });
}

// The poses that the engine makes itself, each with the text of its file.
LIMBER_EXPORT CallResult* limber_sample_poses() {
  return guarded({}, []() -> CallResult {
    Json poses = Json::array();
    for (const limber::SamplePose& pose : limber::samplePoses()) {
      poses.push_back({{"name", std::string(pose.name)},
                       {"summary", std::string(pose.summary)},
                       {"pose", limber::poseToJson(limber::makeSamplePose(pose.name))}});
    }
    return {true, {}, limber::dumpReport(poses, -1)};
  });
}

// For a program around the engine: errors name options as that of limber does.
LIMBER_EXPORT void limber_spell_options_as_program() {
  limber::wasm::optionSpelling = limber::OptionSpelling::kProgram;
}

LIMBER_EXPORT int limber_ok(const CallResult* result) {
  return result->ok;
}
LIMBER_EXPORT const std::uint8_t* limber_bytes(const CallResult* result) {
  return result->bytes.data();
}
LIMBER_EXPORT std::size_t limber_bytes_size(const CallResult* result) {
  return result->bytes.size();
}
LIMBER_EXPORT const char* limber_account(const CallResult* result) {
  return result->account.data();
}
LIMBER_EXPORT std::size_t limber_account_size(const CallResult* result) {
  return result->account.size();
}
LIMBER_EXPORT void limber_free_result(CallResult* result) {
  delete result;
}
