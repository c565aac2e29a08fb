// The C boundary of the WebAssembly engine: bytes and JSON in, bytes and JSON out. Nothing is thrown across it: an
// error is a result like any other. limber.mjs is the typed face of these functions; nobody else calls them.
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "limber/asset/json_text.h"
#include "limber/asset/read.h"
#include "limber/asset/write.h"
#include "limber/pipeline/auto_rig.h"
#include "limber/pipeline/report_json.h"

namespace {

using limber::Json;

// What a call gives: `account` is JSON, the report or the error; `glb` is empty for an error.
struct CallResult {
  bool ok = false;
  limber::Bytes glb;
  std::string account;
};

[[noreturn]] void refuseOption(const std::string& name) {
  throw limber::Error(limber::ErrorCode::kBadArgument, "no such option, or a value of the wrong kind", name);
}

limber::ExistingRig existingRigNamed(const std::string& name) {
  if (name == "refuse") return limber::ExistingRig::kRefuse;
  if (name == "replace") return limber::ExistingRig::kReplace;
  if (name == "keep-skeleton") return limber::ExistingRig::kKeepSkeleton;
  refuseOption("existingRig");
}

// Larger numbers must not wrap round to small ones.
limber::Index countOf(const std::string& name, const Json& value) {
  const std::uint64_t count = value.get<std::uint64_t>();
  if (count >= limber::kNoIndex) refuseOption(name);
  return static_cast<limber::Index>(count);
}

limber::AutoRigOptions optionsFrom(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) throw limber::Error(limber::ErrorCode::kBadArgument, "options are not a JSON object");
  limber::AutoRigOptions options;
  for (const auto& [name, value] : json.items()) {
    if (name == "handles" && value.is_number_unsigned()) {
      options.rig.handles = countOf(name, value);
    } else if (name == "maxInfluences" && value.is_number_unsigned()) {
      options.weights.maxInfluences = countOf(name, value);
    } else if (name == "rigger" && value.is_string()) {
      options.rigger = value.get<std::string>();
    } else if (name == "skinning" && value.is_string()) {
      options.skinning = value.get<std::string>();
    } else if (name == "existingRig" && value.is_string()) {
      options.existingRig = existingRigNamed(value.get<std::string>());
    } else {
      refuseOption(name);
    }
  }
  return options;
}

CallResult failure(const limber::Error& error) {
  CallResult result;
  result.account = limber::dumpReport({{"code", std::string(limber::errorCodeName(error.code()))},
                                       {"message", error.message()},
                                       {"where", error.where()},
                                       {"remedy", error.remedy()}},
                                      -1);
  return result;
}

CallResult rig(limber::ByteSpan file, std::string_view name, std::string_view optionsText) {
  try {
    limber::Asset asset = limber::readAsset(file, name);
    limber::Progress progress;
    const limber::AutoRigReport report = limber::autoRig(asset, optionsFrom(optionsText), progress);
    return {true, limber::writeGlb(asset), limber::dumpReport(limber::toJson(report), -1)};
  } catch (const limber::Error& error) {
    return failure(error);
  } catch (const std::bad_alloc&) {
    return failure({limber::ErrorCode::kLimit, "not enough memory", std::string(name), "try a smaller model"});
  } catch (const std::exception& error) {
    return failure({limber::ErrorCode::kBadData, error.what(), std::string(name)});
  }
}

}  // namespace

#define LIMBER_EXPORT extern "C" __attribute__((used, visibility("default")))

// The strings need no final zero. The result is the caller's, to be given back to limber_free_result; null where there
// is no memory even to tell what went wrong.
LIMBER_EXPORT CallResult* limber_rig(const std::uint8_t* file, std::size_t fileSize, const char* name,
                                     std::size_t nameSize, const char* options, std::size_t optionsSize) {
  try {
    auto result = std::make_unique<CallResult>();
    *result = rig({file, fileSize}, {name, nameSize}, {options, optionsSize});
    return result.release();
  } catch (...) {
    return nullptr;
  }
}

LIMBER_EXPORT int limber_ok(const CallResult* result) {
  return result->ok;
}
LIMBER_EXPORT const std::uint8_t* limber_glb(const CallResult* result) {
  return result->glb.data();
}
LIMBER_EXPORT std::size_t limber_glb_size(const CallResult* result) {
  return result->glb.size();
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
