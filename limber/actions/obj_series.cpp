#include "limber/actions/obj_series.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "limber/core/counted.h"
#include "limber/core/error.h"
#include "limber/core/file/file.h"
#include "limber/core/text/names.h"
#include "limber/document/mesh/obj_vertices.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

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

VertexSequence sequenceFor(const ObjVertices& first, std::span<const fs::path> files) {
  try {
    VertexSequence sequence = VertexSequence::forFrames(first.positions.size(), files.size());
    sequence.rest = first.positions;
    return sequence;
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), files.front().filename().string(), "give fewer files");
  }
}

void checkSameMesh(const ObjVertices& first, const ObjVertices& frame, const std::string& firstName,
                   const std::string& name) {
  constexpr const char* kRemedy = "all frames must be one mesh: the same vertices and faces in the same order";
  if (frame.positions.size() != first.positions.size()) {
    throw Error(ErrorCode::kBadData,
                fmt::format("has {} where {} has {}", counted(frame.positions.size(), "vertex", "vertices"), firstName,
                            first.positions.size()),
                name, kRemedy);
  }
  if (frame.corners != first.corners) {
    throw Error(ErrorCode::kBadData, "has other faces than " + firstName, name, kRemedy);
  }
}

void setFrame(const ObjVertices& frame, Index f, VertexSequence& sequence) {
  for (Index v = 0; v < frame.positions.size(); ++v) sequence.set(v, f, frame.positions[v]);
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

ObjSeries readObjSeries(std::span<const fs::path> files, double framesPerSecond, Progress& progress) {
  if (files.empty()) throw Error(ErrorCode::kBadArgument, "there is no OBJ file");
  if (!(framesPerSecond > 0) || !std::isfinite(framesPerSecond)) {
    throw Error(ErrorCode::kBadArgument, "the frame rate is not above 0");
  }
  progress.update(0);
  const fs::path& file = files.front();
  ObjModel first = readObjModel(readFile(file), file.filename().string(), folderResolver(file.parent_path()));
  ObjSeries series{std::move(first.asset), {}};
  series.animation.pointOf = std::move(first.vertexOf);
  series.animation.clips = {{clipName(file), 0, static_cast<Index>(files.size()), framesPerSecond}};
  VertexSequence sequence = sequenceFor(first.vertices, files);
  for (Index f = 0; f < files.size(); ++f) {
    progress.update(static_cast<double>(f) / static_cast<double>(files.size()));
    if (f == 0) {
      setFrame(first.vertices, f, sequence);
      continue;
    }
    const std::string name = files[f].filename().string();
    const ObjVertices frame = readObjVertices(readFile(files[f]), name);
    checkSameMesh(first.vertices, frame, file.filename().string(), name);
    setFrame(frame, f, sequence);
  }
  refuseStill(sequence, file.filename().string());
  series.animation.sequence = std::move(sequence);
  return series;
}

}  // namespace limber
