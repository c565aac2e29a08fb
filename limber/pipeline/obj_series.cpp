#include "limber/pipeline/obj_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "limber/asset/geometry.h"
#include "limber/asset/read.h"
#include "limber/core/counted.h"
#include "limber/core/file.h"
#include "limber/core/names.h"
#include "limber/core/parse_number.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

// What a frame has: where its vertices are, and its faces as one number.
struct ObjFrame {
  std::vector<Vec3f> positions;
  std::uint64_t faces = 0;
};

std::string_view keywordOf(std::string_view& line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  line.remove_prefix(begin);
  const std::size_t length = std::min(line.find_first_of(" \t"), line.size());
  const std::string_view keyword = line.substr(0, length);
  line.remove_prefix(length);
  return keyword;
}

Vec3f vertexOf(std::string_view numbers, const std::string& where) {
  Vec3f result;
  const char *at = numbers.data(), *end = numbers.data() + numbers.size();
  for (int i = 0; i < 3; ++i) {
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
    const std::optional<double> number = parseNumber(at, end);
    result[i] = number ? static_cast<float>(*number) : std::numeric_limits<float>::quiet_NaN();
  }
  if (!result.allFinite()) throw Error(ErrorCode::kBadData, "a vertex is not three finite numbers", where);
  return result;
}

// The vertices that the corners of a face name: of "7/1/3" the first. Texture coordinates and normals may be numbered
// otherwise in each frame.
void mixFace(std::string_view corners, std::size_t vertices, std::uint64_t& hash) {
  const char *at = corners.data(), *end = corners.data() + corners.size();
  const auto mix = [&](std::uint64_t value) {
    hash = (hash ^ value) * 0x9e3779b97f4a7c15ULL;
    hash ^= hash >> 32;
  };
  while (at != end) {
    while (at != end && (*at == ' ' || *at == '\t')) ++at;
    const std::optional<double> corner = parseNumber(at, end);
    if (corner && std::abs(*corner) < 1e9) {
      mix(static_cast<std::uint64_t>(
          static_cast<std::int64_t>(*corner < 0 ? *corner + double(vertices) + 1 : *corner)));
    }
    while (at != end && *at != ' ' && *at != '\t') ++at;
  }
  mix(~std::uint64_t{0});
}

ObjFrame readFrame(const fs::path& path) {
  const Bytes bytes = readFile(path);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  ObjFrame frame;
  while (!text.empty()) {
    const std::size_t length = text.find_first_of("\r\n");
    std::string_view line = text.substr(0, length);
    text.remove_prefix(length == std::string_view::npos ? text.size() : length + 1);
    const std::string_view keyword = keywordOf(line);
    if (keyword == "v") frame.positions.push_back(vertexOf(line, path.filename().string()));
    if (keyword == "f") mixFace(line, frame.positions.size(), frame.faces);
  }
  return frame;
}

// Finds the OBJ vertex at a place. The importer's numbers are those of the text to rounding.
class VertexFinder {
 public:
  explicit VertexFinder(const std::vector<Vec3f>& positions) : positions_(positions) {
    Box box;
    for (const Vec3f& p : positions) box.add(p.cast<double>());
    constexpr double kCell = 1e-5;  // of the diagonal, many times what rounding moves
    size_ = box.diagonal() > 0 ? kCell * box.diagonal() : 1;
    for (Index v = 0; v < positions.size(); ++v) cells_.emplace_back(cellOf(positions[v]), v);
    std::sort(cells_.begin(), cells_.end());
  }

  std::optional<Index> nearest(const Vec3f& place) const {
    const Cell middle = cellOf(place);
    std::optional<Index> best;
    for (int i = 0; i < 27; ++i) {
      const Cell cell = {middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
      for (auto at = std::lower_bound(cells_.begin(), cells_.end(), std::pair(cell, Index{0}));
           at != cells_.end() && at->first == cell; ++at) {
        if (!best || (positions_[at->second] - place).squaredNorm() < (positions_[*best] - place).squaredNorm()) {
          best = at->second;
        }
      }
    }
    return best;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cellOf(const Vec3f& p) const {
    Cell cell = {};
    for (int i = 0; i < 3; ++i) cell[i] = static_cast<std::int64_t>(std::floor(double{p[i]} / size_));
    return cell;
  }

  const std::vector<Vec3f>& positions_;
  double size_ = 1;
  std::vector<std::pair<Cell, Index>> cells_;  // sorted
};

std::vector<Index> verticesOf(const Asset& asset, const std::vector<Vec3f>& positions) {
  const VertexFinder finder(positions);
  std::vector<Index> result;
  for (const Vec3f& place : collectGeometry(asset).positions) {
    const std::optional<Index> vertex = finder.nearest(place);
    if (!vertex) {
      throw Error(ErrorCode::kUnsupported, "its vertices are not found again after reading", asset.name);
    }
    result.push_back(*vertex);
  }
  return result;
}

// "run" of "run_0012.obj".
std::string clipName(const fs::path& file) {
  std::string name = file.stem().string();
  while (!name.empty() && std::string_view("0123456789_-. ").find(name.back()) != std::string_view::npos) {
    name.pop_back();
  }
  return name.empty() ? "animation" : name;
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

// Numbers by their value, everything else by its bytes.
bool comesBefore(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!isDigit(a[i]) || !isDigit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    const auto numberAt = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && isDigit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string x = numberAt(a, i), y = numberAt(b, j);
    if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
  }
  return a.size() - i != b.size() - j ? a.size() - i < b.size() - j : a < b;
}

}  // namespace

std::vector<fs::path> objFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (lowerExtension(it->path()) == ".obj") files.push_back(it->path());
  }
  if (error) throw Error(ErrorCode::kFile, error.message(), folder.string());
  if (files.empty()) throw Error(ErrorCode::kBadData, "holds no .obj file", folder.string());
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return comesBefore(a.filename().string(), b.filename().string());
  });
  return files;
}

ObjSeries readObjSeries(std::span<const fs::path> files, double framesPerSecond) {
  if (!(framesPerSecond > 0) || !std::isfinite(framesPerSecond)) {
    throw Error(ErrorCode::kBadArgument, "the frame rate is not above 0");
  }
  const ObjFrame first = readFrame(files.front());
  ObjSeries series{readAsset(files.front()), {}};
  series.animation.framesPerSecond = framesPerSecond;
  series.animation.pointOf = verticesOf(series.asset, first.positions);
  series.animation.clips = {{clipName(files.front()), 0, static_cast<Index>(files.size())}};
  VertexSequence sequence(static_cast<Index>(first.positions.size()), static_cast<Index>(files.size()));
  sequence.rest = first.positions;
  for (Index f = 0; f < files.size(); ++f) {
    const ObjFrame frame = f == 0 ? first : readFrame(files[f]);
    const std::string name = files[f].filename().string();
    if (frame.positions.size() != first.positions.size()) {
      throw Error(ErrorCode::kBadData,
                  fmt::format("has {} where {} has {}", counted(frame.positions.size(), "vertex", "vertices"),
                              files.front().filename().string(), first.positions.size()),
                  name, "all frames must be one mesh: the same vertices and faces in the same order");
    }
    if (frame.faces != first.faces) {
      throw Error(ErrorCode::kBadData, "has other faces than " + files.front().filename().string(), name,
                  "all frames must be one mesh: the same vertices and faces in the same order");
    }
    for (Index v = 0; v < frame.positions.size(); ++v) sequence.set(v, f, frame.positions[v]);
  }
  refuseStill(sequence, files.front().filename().string());
  series.animation.sequence = std::move(sequence);
  return series;
}

}  // namespace limber
