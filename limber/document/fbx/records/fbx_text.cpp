#include "limber/document/fbx/records/fbx_text.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/text/parse_number.h"
#include "limber/document/fbx/records/fbx_binary.h"

namespace limber {

namespace {

bool isWordEnd(char c) {
  return c == ',' || c == '{' || c == '}' || c == '"' || c == ';' || c == ':' ||
         static_cast<unsigned char>(c) <= static_cast<unsigned char>(' ');
}

std::string withQuotes(std::string_view text) {
  constexpr std::string_view kQuote = "&quot;";
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t next = std::min(text.find(kQuote, at), text.size());
    result += text.substr(at, next - at);
    if (next < text.size()) result += '"';
    at = next + kQuote.size();
  }
  return result;
}

class TextParser {
 public:
  explicit TextParser(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
  }

  FbxFile parse() {
    FbxFile file;
    bool isChecked = false;  // at once, for old ones are written otherwise from there on
    while (skipSpace()) {
      addNode(file.root.children, 1);
      if (isChecked || file.root.children.back().name != "FBXHeaderExtension") continue;
      file.version = version(file.root);
      checkFbxVersion(file.version);
      isChecked = true;
    }
    if (!isChecked) version(file.root);  // throws
    return file;
  }

 private:
  [[noreturn]] void fail(std::string_view what) const {
    throw Error(ErrorCode::kBadData, fmt::format("{} (byte {})", what, at_), {}, "export it again");
  }

  static std::uint32_t version(const FbxNode& root) {
    const FbxNode* header = root.find("FBXHeaderExtension");
    const FbxNode* version = header ? header->find("FBXVersion") : nullptr;
    const auto* number = version && !version->values.empty() ? std::get_if<std::int64_t>(&version->values[0]) : nullptr;
    if (!number || *number < 0 || *number > 99999) {
      throw Error(ErrorCode::kBadData, "does not say of which version it is", {}, "export it again");
    }
    return static_cast<std::uint32_t>(*number);
  }

  char current() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  // Over blanks, line ends and comments; false at the end.
  bool skipSpace() {
    while (at_ < text_.size()) {
      if (text_[at_] == ';') {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (static_cast<unsigned char>(text_[at_]) <= static_cast<unsigned char>(' ')) {
        ++at_;
      } else {
        return true;
      }
    }
    return false;
  }

  // Over blanks on this line.
  void skipBlanks() {
    while (current() == ' ' || current() == '\t' || current() == '\r') ++at_;
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && !isWordEnd(text_[at_])) ++at_;
    if (at_ == begin) fail("a word is missing");
    return text_.substr(begin, at_ - begin);
  }

  void expect(char c) {
    if (!skipSpace() || text_[at_] != c) fail(fmt::format("a '{}' is missing", c));
    ++at_;
  }

  // Name: value, value, ... { records }
  void addNode(std::vector<FbxNode>& list, int depth) {
    if (depth > kDeepestFbxNode) fail("its records are nested too deep");
    FbxNode& node = list.emplace_back();
    node.name = word();
    expect(':');
    skipBlanks();
    if (current() == '*') {
      node.values.push_back(array());
      return;
    }
    addValues(node.values);
    skipBlanks();
    if (current() != '{') return;
    ++at_;
    for (;;) {
      if (!skipSpace()) fail("is cut off");
      if (text_[at_] == '}') break;
      addNode(node.children, depth + 1);
    }
    ++at_;
  }

  void addValues(std::vector<FbxValue>& values) {
    bool isAwaited = false;  // behind a comma the next may stand on another line
    for (;;) {
      if (isAwaited && !skipSpace()) fail("is cut off");
      skipBlanks();
      const char c = current();
      if (c == ',') {  // with nothing before it: "Content: ,"
        ++at_;
        isAwaited = true;
        continue;
      }
      if (at_ >= text_.size() || c == '\n' || c == '{' || c == '}' || c == ';') return;
      values.push_back(value());
      skipBlanks();
      isAwaited = current() == ',';
      if (!isAwaited) return;
      ++at_;
    }
  }

  FbxValue value() {
    if (current() == '"') {
      const std::size_t end = text_.find('"', at_ + 1);
      if (end == text_.npos) fail("a text in quotes does not end");
      const std::string_view inside = text_.substr(at_ + 1, end - at_ - 1);
      at_ = end + 1;
      return withQuotes(inside);
    }
    const std::string_view written = word();
    if (const std::optional<std::int64_t> whole = wholeNumber(written)) return *whole;
    if (const std::optional<double> number = decimal(written)) return *number;
    return std::string(written);
  }

  static std::optional<std::int64_t> wholeNumber(std::string_view text) {
    std::int64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stopped != end) return std::nullopt;
    return value;
  }

  static std::optional<double> decimal(std::string_view text) {
    const char* at = text.data();
    const std::optional<double> value = parseNumber(at, text.data() + text.size());
    const std::string_view rest = text.substr(static_cast<std::size_t>(at - text.data()));
    // As Windows prints what is no number: "1.#QNAN", "-nan(ind)".
    if (value && (rest.starts_with('#') || rest.starts_with('('))) return std::numeric_limits<double>::quiet_NaN();
    return rest.empty() ? value : std::nullopt;
  }

  // *3 { a: 1,2,3 }
  FbxValue array() {
    word();
    expect('{');
    skipSpace();
    std::vector<std::int64_t> wholes;
    std::vector<double> numbers;  // all of them from the first on that is not whole
    if (current() == 'a') {
      ++at_;
      expect(':');
      while (skipSpace() && current() != '}') {
        const std::string_view written = word();
        const std::optional<std::int64_t> whole = numbers.empty() ? wholeNumber(written) : std::nullopt;
        if (whole) {
          wholes.push_back(*whole);
        } else {
          const std::optional<double> number = decimal(written);
          if (!number) fail("an array holds what is no number");
          if (numbers.empty()) numbers.assign(wholes.begin(), wholes.end());
          numbers.push_back(*number);
        }
        skipSpace();
        if (current() == ',') ++at_;
      }
    }
    expect('}');
    if (numbers.empty()) return wholes;
    return numbers;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

FbxFile parseTextFbx(ByteSpan bytes) {
  return TextParser({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).parse();
}

}  // namespace limber
