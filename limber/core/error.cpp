#include "limber/core/error.h"

#include <algorithm>
#include <utility>

namespace limber {

std::string_view errorCodeName(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadArgument:
      return "bad-argument";
    case ErrorCode::kFile:
      return "file";
    case ErrorCode::kBadData:
      return "bad-data";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kLimit:
      return "limit";
    case ErrorCode::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

namespace {

// One line whatever a file's strings hold: control characters become spaces.
std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

}  // namespace

Error::Error(ErrorCode code, std::string message, std::string where, std::string remedy)
    : code_(code), message_(std::move(message)), where_(std::move(where)), remedy_(std::move(remedy)) {
  line_ = where_.empty() ? message_ : where_ + ": " + message_;
  if (!remedy_.empty()) line_ += " (" + remedy_ + ")";
  line_ = oneLine(std::move(line_));
}

Error Error::within(std::string_view outer) const {
  const std::string location(outer);
  if (location.empty() || where_ == location || where_.rfind(location + ": ", 0) == 0) return *this;
  return Error(code_, message_, where_.empty() ? location : location + ": " + where_, remedy_);
}

std::string warningText(const Warning& warning) {
  return warning.count == 1 ? warning.message : warning.message + " (" + std::to_string(warning.count) + ")";
}

void Warnings::add(std::string_view kind, std::string_view message, std::string_view where, std::size_t count) {
  if (count == 0) return;
  const auto known = std::find_if(items_.begin(), items_.end(), [&](const Warning& w) { return w.kind == kind; });
  if (known != items_.end()) {
    known->count += count;
  } else {
    items_.push_back({std::string(kind), oneLine(std::string(message)), oneLine(std::string(where)), count});
  }
}

void Warnings::append(const Warnings& other) {
  for (const Warning& w : other.items_) add(w.kind, w.message, w.where, w.count);
}

}  // namespace limber
