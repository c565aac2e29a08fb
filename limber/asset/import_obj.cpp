#include "limber/asset/import_obj.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/parse_number.h"

namespace limber {

namespace {

bool isSpace(char c) {
  return c == ' ' || c == '\t';
}

// Takes the next word off the front of a line; empty at its end or at a comment.
std::string_view nextWord(std::string_view& line) {
  while (!line.empty() && isSpace(line.front())) line.remove_prefix(1);
  if (!line.empty() && line.front() == '#') line = {};
  std::size_t length = 0;
  while (length < line.size() && !isSpace(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  return word;
}

std::string_view kindOf(std::string_view line) {
  return nextWord(line);
}

// A vertex or what is made of vertices.
bool isElement(std::string_view kind) {
  return kind == "v" || kind == "vt" || kind == "vn" || kind == "f" || kind == "l" || kind == "p";
}

// Calls `visit(line)` for each line; the parts of an element that '\' continues are one.
template <typename Visit>
void forEachLine(ByteSpan bytes, const Visit& visit) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto take = [&text] {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : std::min<std::size_t>(text.size(), 1));
    return line;
  };
  std::string joined;
  while (!text.empty()) {
    std::string_view line = take();
    if (line.ends_with('\\') && isElement(kindOf(line))) {
      joined = line;
      while (joined.ends_with('\\')) {
        joined.back() = ' ';
        joined += take();
      }
      line = joined;
    }
    visit(line);
  }
}

// The number at the front of "12/3/4" or "-1", which is taken off; 0, which OBJ never uses, where there is none.
std::int64_t takeNumber(std::string_view& word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  std::int64_t number = 0;
  for (; !word.empty() && word.front() >= '0' && word.front() <= '9'; word.remove_prefix(1)) {
    if (number <= (std::int64_t{1} << 40)) number = 10 * number + (word.front() - '0');
  }
  return negative ? -number : number;
}

// The words of a "v" line behind its kind, at most eight.
std::vector<std::string_view> wordsOf(std::string_view line) {
  constexpr std::size_t kEnough = 8;
  std::vector<std::string_view> words;
  for (std::string_view word = nextWord(line); !word.empty() && words.size() < kEnough; word = nextWord(line)) {
    words.push_back(word);
  }
  return words;
}

std::optional<double> numberOf(std::string_view word) {
  const char* at = word.data();
  return parseNumber(at, word.data() + word.size());
}

// Vertices, texture coordinates and normals, as a corner names them.
using Counts = std::array<std::int64_t, 3>;

class ObjPreparer {
 public:
  explicit ObjPreparer(ByteSpan bytes) : bytes_(bytes) {}

  ObjText prepare() {
    bool hasColors = false;
    forEachLine(bytes_, [&](std::string_view line) {
      const std::string_view kind = nextWord(line);
      count(kind, total_);
      hasColors = hasColors || (kind == "v" && wordsOf(line).size() >= 6);
    });
    used_.resize(static_cast<std::size_t>(total_[0]), false);
    if (hasColors) result_.colors.reserve(used_.size());
    result_.text.reserve(bytes_.size());
    std::size_t faces = 0;
    forEachLine(bytes_, [&](std::string_view line) {
      const std::string_view kind = kindOf(line);
      const bool isFace = kind == "f" || kind == "l" || kind == "p";
      if (isFace && !isValidFace(line)) {
        ++result_.invalidFaces;
      } else if (kind == "v" && hasColors) {
        addColored(line);
      } else if (!kind.empty()) {  // no comments: behind a backslash at their end Assimp goes on
        result_.text += line;
      }
      faces += isFace ? 1 : 0;
      result_.text += '\n';  // also for a face that is left out: messages name lines
      count(kind, seen_);
    });
    if (faces > 0 && result_.invalidFaces == faces) {
      throw Error(ErrorCode::kBadData, "its faces name vertices that are not there", {}, "export it again");
    }
    const auto used = static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
    if (used > 0) result_.looseVertices = used_.size() - used;
    return std::move(result_);
  }

 private:
  static void count(std::string_view kind, Counts& counts) {
    if (kind == "v") ++counts[0];
    if (kind == "vt") ++counts[1];
    if (kind == "vn") ++counts[2];
  }

  // Marks the vertices that it uses, too.
  bool isValidFace(std::string_view line) {
    nextWord(line);
    std::vector<std::size_t> vertices;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      for (std::size_t part = 0; part < 3; ++part) {
        if (part > 0 && !word.starts_with('/')) break;
        if (part > 0) word.remove_prefix(1);
        if (part > 0 && (word.empty() || word.front() == '/')) continue;  // "1//2", "1/"
        const std::int64_t number = takeNumber(word);
        if (number == 0) return false;
        if (total_[part] == 0 && part > 0) continue;  // as nobody asks for it
        const std::int64_t at = number < 0 ? seen_[part] + number : number - 1;
        if (at < 0 || at >= total_[part]) return false;
        if (part == 0) vertices.push_back(static_cast<std::size_t>(at));
      }
    }
    for (const std::size_t v : vertices) used_[v] = true;
    return true;
  }

  // "v x y z [w] [r g b [a]]"
  void addColored(std::string_view line) {
    nextWord(line);
    std::vector<std::string_view> words = wordsOf(line);
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::array<float, 4> color = {kNone, kNone, kNone, kNone};
    for (std::size_t c = 0; words.size() >= 6 && c < 4; ++c) {
      const std::optional<double> value = c + 3 < words.size() ? numberOf(words[c + 3]) : 1;
      if (value) color[c] = static_cast<float>(*value);
    }
    result_.text += 'v';
    const double w = words.size() == 4 ? numberOf(words[3]).value_or(1) : 1;
    for (std::size_t i = 0; i < 3 && i < words.size(); ++i) {
      result_.text += ' ';
      const std::optional<double> value = w != 1 && w != 0 ? numberOf(words[i]) : std::nullopt;
      result_.text += value ? fmt::format("{}", *value / w) : std::string(words[i]);
    }
    const std::size_t number = result_.colors.size();
    result_.text += fmt::format(" {} {} 0", number % kObjColorBase, number / kObjColorBase);
    result_.colors.push_back(color);
  }

  ByteSpan bytes_;
  Counts total_{}, seen_{};
  std::vector<bool> used_;  // #v
  ObjText result_;
};

}  // namespace

ObjText prepareObj(ByteSpan bytes) {
  return ObjPreparer(bytes).prepare();
}

std::size_t countMovedMtlTextures(ByteSpan bytes) {
  std::size_t count = 0;
  forEachLine(bytes, [&](std::string_view line) {
    const std::string_view kind = nextWord(line);
    if (!kind.starts_with("map_") && kind != "bump" && kind != "norm" && kind != "refl" && kind != "disp") return;
    double usual = 0;
    bool isOption = false, isMoved = false;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      if (word.front() == '-' && !numberOf(word)) {
        isOption = word == "-s" || word == "-o" || word == "-t";
        usual = word == "-s" ? 1 : 0;
      } else if (isOption) {
        const std::optional<double> value = numberOf(word);
        isOption = value.has_value();
        isMoved = isMoved || (value && *value != usual);
      }
    }
    if (isMoved) ++count;
  });
  return count;
}

}  // namespace limber
