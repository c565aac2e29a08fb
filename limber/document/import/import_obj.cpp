#include "limber/document/import/import_obj.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "limber/core/error.h"
#include "limber/core/file/read_bounds.h"
#include "limber/document/mesh/obj_lines.h"

namespace limber {

namespace {

// Vertices, texture coordinates and normals, as a corner names them.
using Counts = std::array<std::int64_t, 3>;

class ObjPreparer {
 public:
  explicit ObjPreparer(ByteSpan bytes) : bytes_(bytes) {}

  ObjText prepare() {
    forEachObjLine(bytes_, [&](std::string_view line) {
      const std::string_view kind = nextObjWord(line);
      count(kind, total_);
      countChange(kind, line);
    });
    used_.resize(static_cast<std::size_t>(total_[0]), false);
    result_.text.reserve(bytes_.size() + 12 * used_.size());
    std::size_t faces = 0;
    forEachObjLine(bytes_, [&](std::string_view line) {
      std::string_view rest = line;
      const std::string_view kind = nextObjWord(rest);
      const bool isFace = kind == "f" || kind == "l" || kind == "p";
      if (isFace) {
        addFace(kind, rest);
      } else if (kind == "v") {
        addVertex(rest);
      } else if (kind == "vt" || kind == "vn") {
        result_.text += kind;
        for (std::string_view word = nextObjWord(rest); !word.empty(); word = nextObjWord(rest)) addNumber(word);
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
    if (!hasColors_) result_.colors.clear();
    return std::move(result_);
  }

 private:
  static void count(std::string_view kind, Counts& counts) {
    if (kind == "v") ++counts[0];
    if (kind == "vt") ++counts[1];
    if (kind == "vn") ++counts[2];
  }

  // Assimp makes a mesh at each of these, and looks for an object among all before it.
  void countChange(std::string_view kind, std::string_view name) {
    constexpr std::array<std::string_view, 3> kKinds = {"o", "g", "usemtl"};
    const auto at = static_cast<std::size_t>(std::find(kKinds.begin(), kKinds.end(), kind) - kKinds.begin());
    if (at == kKinds.size() || name == names_[at]) return;
    names_[at] = name;  // no element, hence never of a line that was joined
    const std::uint64_t most = read_bounds::kImportedMeshes.of(bytes_.size() / read_bounds::kBytesImportedMesh);
    if (++changes_[at] <= most) return;
    throw Error(ErrorCode::kLimit, fmt::format("it has more than {} '{}' lines, the most for its size", most, kind), {},
                "join its objects or sort its faces by material, or convert it to GLB");
  }

  // Corners "v/vt/vn", with numbers that count from the file's beginning.
  void addFace(std::string_view kind, std::string_view line) {
    corners_ = kind;
    vertices_.clear();
    for (std::string_view word = nextObjWord(line); !word.empty(); word = nextObjWord(line)) {
      corners_ += ' ';
      if (!addCorner(word)) {
        ++result_.invalidFaces;
        return;
      }
    }
    for (const std::size_t v : vertices_) used_[v] = true;
    result_.text += corners_;
  }

  // False where it names what is not there.
  bool addCorner(std::string_view word) {
    for (std::size_t part = 0; part < 3; ++part) {
      if (part > 0 && !word.starts_with('/')) break;
      if (part > 0) {
        corners_ += '/';
        word.remove_prefix(1);
      }
      if (part > 0 && (word.empty() || word.front() == '/')) continue;  // "1//2", "1/"
      const std::int64_t number = takeObjNumber(word);
      if (number == 0) return false;
      const std::int64_t at = number < 0 ? seen_[part] + number : number - 1;
      const bool isAsked = part == 0 || total_[part] > 0;
      if (isAsked && (at < 0 || at >= total_[part])) return false;
      fmt::format_to(std::back_inserter(corners_), "{}", isAsked ? at + 1 : number);
      if (part == 0) vertices_.push_back(static_cast<std::size_t>(at));
    }
    return true;
  }

  // Assimp takes a word that begins with a point for no number.
  void addNumber(std::string_view word) {
    const std::size_t signs = word.starts_with('-') || word.starts_with('+') ? 1 : 0;
    result_.text += ' ';
    result_.text += word.substr(0, signs);
    if (word.substr(signs).starts_with('.')) result_.text += '0';
    result_.text += word.substr(signs);
  }

  void addVertex(std::string_view line) {
    const ObjVertexWords vertex(line);
    const auto& [words, count] = vertex;
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::array<float, 4> color = {kNone, kNone, kNone, kNone};
    for (std::size_t c = 0; count >= 6 && c < 4; ++c) {
      const std::optional<double> value = c + 3 < count ? objNumberOf(words[c + 3]) : 1;
      if (value) color[c] = static_cast<float>(*value);
    }
    hasColors_ = hasColors_ || count >= 6;
    result_.text += 'v';
    const double w = vertex.w();
    for (std::size_t i = 0; i < 3 && i < count; ++i) {
      const std::optional<double> value = w != 1 ? objNumberOf(words[i]) : std::nullopt;
      addNumber(value ? fmt::format("{}", *value / w) : std::string(words[i]));
    }
    const std::size_t number = result_.colors.size();
    if (count >= 3) {
      fmt::format_to(std::back_inserter(result_.text), " {} {} 0", number % kObjNumberBase, number / kObjNumberBase);
    }
    result_.colors.push_back(color);
  }

  ByteSpan bytes_;
  Counts total_{}, seen_{};
  std::vector<bool> used_;                 // #v
  std::array<std::string_view, 3> names_;  // of the object, group and material at hand
  std::array<std::uint64_t, 3> changes_{};
  bool hasColors_ = false;
  std::string corners_;                // of the face at hand, as it is written
  std::vector<std::size_t> vertices_;  // of the face at hand
  ObjText result_;
};

}  // namespace

ObjText prepareObj(ByteSpan bytes) {
  return ObjPreparer(bytes).prepare();
}

std::size_t countMovedMtlTextures(ByteSpan bytes) {
  std::size_t count = 0;
  forEachObjLine(bytes, [&](std::string_view line) {
    const std::string_view kind = nextObjWord(line);
    if (!kind.starts_with("map_") && kind != "bump" && kind != "norm" && kind != "refl" && kind != "disp") return;
    double usual = 0;
    bool isOption = false, isMoved = false;
    for (std::string_view word = nextObjWord(line); !word.empty(); word = nextObjWord(line)) {
      if (word.front() == '-' && !objNumberOf(word)) {
        isOption = word == "-s" || word == "-o" || word == "-t";
        usual = word == "-s" ? 1 : 0;
      } else if (isOption) {
        const std::optional<double> value = objNumberOf(word);
        isOption = value.has_value();
        isMoved = isMoved || (value && *value != usual);
      }
    }
    if (isMoved) ++count;
  });
  return count;
}

}  // namespace limber
