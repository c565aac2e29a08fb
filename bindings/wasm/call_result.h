// What every call across the C boundary gives. Nothing is thrown across it: an error is a result like any other.
#pragma once

#include <exception>
#include <new>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "limber/actions/option_spelling.h"
#include "limber/core/known_error.h"
#include "limber/document/gltf/json_text.h"

#define LIMBER_EXPORT extern "C" __attribute__((used, visibility("default")))

namespace limber::wasm {

// `account` is JSON: what the call tells, or the error. `bytes` is empty for an error.
struct CallResult {
  bool ok = false;
  Bytes bytes;
  std::string account;
};

// How errors name options.
inline OptionSpelling optionSpelling = OptionSpelling::kJavaScript;

inline CallResult failure(const Error& error) {
  const Error reported = spellOptions(error, optionSpelling);
  Json account = {{"code", std::string(errorCodeName(reported.code()))},
                  {"message", reported.message()},
                  {"where", reported.where()},
                  {"remedy", reported.remedy()}};
  if (const auto* known = dynamic_cast<const KnownError*>(&error)) {
    account["kind"] = std::string(errorKindName(known->kind()));
    account["values"] = Json::object();
    for (const ErrorValue& value : known->values()) account["values"][value.name] = value.value;
  }
  CallResult result;
  result.account = dumpReport(account, -1);
  return result;
}

// Runs `call`, which gives a CallResult, and turns what it throws into one. Null where there is no memory even for
// that.
template <class Call>
CallResult* guarded(std::string_view name, Call&& call) noexcept {
  try {
    try {
      return new CallResult(call());
    } catch (const Error& error) {
      return new CallResult(failure(error));
    } catch (const std::bad_alloc&) {
      return new CallResult(failure(KnownError(ErrorKind::kOutOfMemory, {ErrorCode::kLimit, "not enough memory",
                                                                         std::string(name), "try a smaller model"})));
    } catch (const std::exception& error) {
      return new CallResult(failure(Error(ErrorCode::kBadData, error.what(), std::string(name))));
    }
  } catch (...) {
    return nullptr;
  }
}

}  // namespace limber::wasm
