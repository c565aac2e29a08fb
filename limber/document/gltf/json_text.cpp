#include "limber/document/gltf/json_text.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace limber {

namespace {

// Writing and comparing recurse once a level, so depth is bounded here, once for all.
constexpr std::size_t kMaxDepth = 200;
// Lookup in an ordered object is linear; this keeps it harmless.
constexpr std::size_t kMaxKeys = 65536;

using Member = std::pair<std::string, Json>;

// Few keys are compared with each other, which asks for no memory.
bool hasEqualKeys(const std::vector<Member>& members) {
  constexpr std::size_t kFew = 16;
  if (members.size() > kFew) {
    std::vector<std::string_view> keys;
    keys.reserve(members.size());
    for (const Member& member : members) keys.push_back(member.first);
    std::sort(keys.begin(), keys.end());
    return std::adjacent_find(keys.begin(), keys.end()) != keys.end();
  }
  for (std::size_t i = 1; i < members.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (members[i].first == members[k].first) return true;
    }
  }
  return false;
}

// Takes out all but the last of each group of equal keys; returns how many.
std::size_t dropShadowed(std::vector<Member>& members) {
  if (!hasEqualKeys(members)) return 0;
  std::vector<std::size_t> order(members.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return members[a].first < members[b].first; });
  std::vector<bool> shadowed(members.size(), false);
  for (std::size_t i = 1; i < order.size(); ++i) {
    shadowed[order[i - 1]] = members[order[i - 1]].first == members[order[i]].first;
  }
  std::vector<Member> kept;
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (!shadowed[i]) kept.push_back(std::move(members[i]));
  }
  const std::size_t dropped = members.size() - kept.size();
  members = std::move(kept);
  return dropped;
}

// Builds a document from the parser's events. Members are gathered apart and moved into their object once it is
// complete: inserting one by one would search all keys each time and copy what is there on each growth.
class Builder : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(Warnings& warnings) : warnings_(warnings) {}

  Json take() { return std::move(root_); }
  const std::string& problem() const { return problem_; }
  ErrorCode problemCode() const { return problemCode_; }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(true); }
  bool start_array(std::size_t) override { return open(false); }

  bool key(string_t& value) override {
    std::vector<Member>& members = open_.back().members;
    if (members.size() == kMaxKeys) return stop(fmt::format("an object has more than {} keys", kMaxKeys));
    members.emplace_back(std::move(value), nullptr);
    return true;
  }

  bool end_object() override {
    Json object = Json::object();
    std::vector<Member>& members = open_.back().members;
    const std::size_t dropped = dropShadowed(members);
    warnings_.add("duplicate-keys", "keys stand twice in one object; the last one counts", {}, dropped);
    // The vector below an ordered_map: its own emplace would search for the key again.
    Json::object_t::Container& target = object.get_ref<Json::object_t&>();
    target.reserve(members.size());
    for (Member& member : members) target.emplace_back(std::move(member.first), std::move(member.second));
    return close(std::move(object));
  }

  bool end_array() override { return close(Json(std::move(open_.back().elements))); }

  bool parse_error(std::size_t position, const std::string&, const Json::exception& reason) override {
    // The reason's text starts with an identifier in brackets and, mostly, the position.
    std::string text = reason.what();
    for (const char* end : {"] ", ": "}) {
      if (const std::size_t at = text.find(end); at != std::string::npos) text.erase(0, at + 2);
    }
    problem_ = fmt::format("is not valid JSON at byte {}: {}", position, text);
    return false;
  }

 private:
  struct Open {
    bool isObject;
    std::vector<Member> members;
    Json::array_t elements;
  };

  bool add(Json value) {
    if (open_.empty()) {
      root_ = std::move(value);
    } else if (open_.back().isObject) {
      open_.back().members.back().second = std::move(value);
    } else {
      open_.back().elements.push_back(std::move(value));
    }
    return true;
  }

  bool open(bool isObject) {
    if (open_.size() == kMaxDepth) return stop(fmt::format("JSON is nested deeper than {} levels", kMaxDepth));
    open_.push_back({isObject, {}, {}});
    return true;
  }

  bool close(Json value) {
    open_.pop_back();
    return add(std::move(value));
  }

  bool stop(std::string problem) {
    problem_ = std::move(problem);
    problemCode_ = ErrorCode::kLimit;
    return false;
  }

  Warnings& warnings_;
  Json root_;
  std::vector<Open> open_;
  std::string problem_;
  ErrorCode problemCode_ = ErrorCode::kBadData;
};

}  // namespace

Json parseJson(std::string_view text, Warnings& warnings) {
  Builder builder(warnings);
  if (!Json::sax_parse(text.begin(), text.end(), &builder)) throw Error(builder.problemCode(), builder.problem());
  return builder.take();
}

std::string dumpJson(const Json& json, int indent) {
  try {
    return json.dump(indent);
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kBadData, "a name or other text is not UTF-8");
  }
}

std::string dumpReport(const Json& json, int indent) {
  std::string text = json.dump(indent, ' ', false, Json::error_handler_t::replace);
  const auto isControl = [](std::string_view at) {  // beyond those that JSON escapes anyway
    return at[0] == '\x7f' || (at.size() > 1 && at[0] == '\xc2' && static_cast<unsigned char>(at[1]) < 0xa0);
  };
  std::string plain;
  std::size_t done = 0;
  for (std::size_t i = text.find_first_of("\x7f\xc2"); i < text.size(); i = text.find_first_of("\x7f\xc2", i + 1)) {
    if (!isControl(std::string_view(text).substr(i))) continue;
    plain.append(text, done, i - done);
    const bool isDelete = text[i] == '\x7f';
    plain += fmt::format("\\u{:04x}", static_cast<unsigned char>(text[isDelete ? i : i + 1]));
    done = i + (isDelete ? 1 : 2);
  }
  return done == 0 ? text : plain.append(text, done);
}

Json toJson(const Warnings& warnings) {
  Json list = Json::array();
  for (const Warning& w : warnings.items()) {
    list.push_back({{"kind", w.kind}, {"message", w.message}, {"where", w.where}, {"count", w.count}});
  }
  return list;
}

}  // namespace limber
