// Two halves: the child process reads with Assimp, converts, and returns a GLB with its warnings; this process reads
// that like any other GLB that it does not trust.
#include "limber/document/import/import_model.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <nlohmann/json.hpp>

#include "limber/core/file/read_bounds.h"
#include "limber/core/srgb.h"
#include "limber/core/text/names.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/gltf/gltf_document.h"
#include "limber/document/import/import_dae.h"
#include "limber/document/import/import_io.h"
#include "limber/document/import/import_obj.h"
#include "limber/document/import/import_sandbox.h"
#include "limber/document/import/import_scene.h"
#include "limber/document/import/import_skin.h"
#include "limber/document/import/import_text.h"
#include "limber/document/write.h"

namespace limber {

namespace {

struct Format {
  const char* extension;  // as Assimp knows it
  const char* label;
};
constexpr Format kFormats[] = {{"obj", "OBJ"}, {"stl", "STL"}, {"off", "OFF"}, {"dae", "DAE"}};

const Format* formatNamed(std::string_view extension) {
  const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                  [&](const Format& format) { return extension == format.extension; });
  return found == std::end(kFormats) ? nullptr : found;
}

constexpr std::size_t kStlHeader = 84;  // bytes of binary STL: a text of 80, and the number of triangles

// A binary STL says nothing of itself but the number of its triangles, 50 bytes each. `bytes` has the header.
std::uint64_t binaryStlLength(ByteSpan bytes) {
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + kStlHeader - sizeof triangles, sizeof triangles);
  return kStlHeader + 50 * std::uint64_t{triangles};
}

bool isBinaryStl(ByteSpan bytes) {
  return bytes.size() >= kStlHeader && bytes.size() == binaryStlLength(bytes);
}

const Format* formatByContent(ByteSpan bytes) {
  constexpr std::size_t kHead = 4096;  // a COLLADA file may begin with a long comment
  std::string head(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kHead));
  const auto starts = [&](std::string_view text) { return head.rfind(text, 0) == 0; };
  const auto holds = [&](std::string_view text) { return head.find(text) != std::string::npos; };
  if (holds("<COLLADA")) return formatNamed("dae");
  if (starts("OFF") || starts("COFF") || starts("NOFF") || starts("CNOFF")) return formatNamed("off");
  const bool hasTriangles = bytes.size() > kStlHeader;
  if ((isBinaryStl(bytes) && hasTriangles) || (starts("solid") && holds("facet"))) return formatNamed("stl");
  return nullptr;
}

// Text with a line that begins as an OBJ's vertex does: the last guess, for standard input.
bool looksLikeObj(ByteSpan bytes) {
  const std::string head(reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 65536));
  return head.find('\0') == std::string::npos && (head.rfind("v ", 0) == 0 || head.find("\nv ") != std::string::npos);
}

const Format& formatOf(ByteSpan bytes, std::string_view name) {
  if (const Format* format = formatByContent(bytes)) return *format;
  const std::string extension = lowerExtension(std::string(name));
  if (const Format* format = extension.empty() ? nullptr : formatNamed(extension.substr(1))) return *format;
  if (looksLikeObj(bytes)) return *formatNamed("obj");
  throw Error(ErrorCode::kUnsupported, "is of a format that limber does not read", {},
              "it reads GLB, glTF, VRM, FBX, DAE, OBJ, PLY, STL and OFF, and motions as BVH, VRMA and, of SMPL, .npz");
}

// What a file's own lengths and directions are in metres and +Y up.
struct Convention {
  double scale = 1;
  Mat3 axes = Mat3::Identity();
};

// Assimp puts a COLLADA file's unit and up axis into the top of its tree.
Convention daeConvention(aiScene& scene) {
  Convention result;
  const Affine top = scaledAffine(scene.mRootNode->mTransformation, 1);
  const double scale = std::cbrt(std::abs(top.linear().determinant()));
  if (!(scale > 0) || !std::isfinite(scale)) return result;
  result.scale = scale;
  result.axes = top.linear() / scale;
  scene.mRootNode->mTransformation = aiMatrix4x4();
  return result;
}

// STL's normals are those of its facets, as any reader makes them from the corners, and often zero or wrong. Without
// them facets share their corners, and glTF draws them flat.
void dropNormals(aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    delete[] scene.mMeshes[m]->mNormals;
    scene.mMeshes[m]->mNormals = nullptr;
  }
}

void warnOfConversion(Asset& asset, const Convention& convention) {
  if (std::abs(convention.scale - 1) > 1e-6) {
    asset.warnings.add("converted-units",
                       fmt::format("lengths are converted to metres (1 unit was {:g} m)", convention.scale));
  }
  if (!convention.axes.isApprox(Mat3::Identity(), 1e-6)) {
    asset.warnings.add("converted-axes", "directions are converted to Y up");
  }
}

// Assimp takes STL for binary by its length alone, and otherwise for text. Headers of binary ones may begin with
// "solid", too, but their count of triangles has a byte that is 0 (up to 16 million of them), as no text has. Returns
// the file without the bytes after its triangles.
ByteSpan checkedStl(ByteSpan bytes) {
  if (isBinaryStl(bytes)) return bytes;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.substr(0, kStlHeader).find('\0') != std::string_view::npos) {
    if (bytes.size() > kStlHeader && bytes.size() > binaryStlLength(bytes)) {
      return bytes.first(static_cast<std::size_t>(binaryStlLength(bytes)));
    }
    throw Error(ErrorCode::kBadData, "its length is not that of the triangles it announces: it is cut off, or no STL");
  }
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start != std::string_view::npos && text.substr(start, 5) == "solid") return bytes;
  throw Error(ErrorCode::kBadData, "it does not begin with 'solid', as STL in text does");
}

// Assimp's own message, without what is said around it already, and with the file's own name.
Error importError(std::string message, const std::string& mainName, std::string_view name) {
  if (message.find("bad_alloc") != std::string::npos) {
    return Error(ErrorCode::kLimit, "it asks for more memory than a file of its size may", {},
                 "convert it to GLB, or split it");
  }
  if (const std::size_t at = message.find(mainName); at != std::string::npos) {
    message.replace(at, mainName.size(), name);
  }
  const std::size_t colon = message.find(": ");
  if (colon <= 4) message.erase(0, colon + 2);  // "OBJ: "
  while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
  return Error(ErrorCode::kBadData, message.empty() ? "the importer does not say why" : validUtf8(message));
}

// Gives the vertices the colours that prepareObj put aside; `numbers` says whether theirs stay, behind these.
void restoreObjColors(aiScene& scene, const ObjText& obj, ObjNumbers numbers) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    aiMesh& mesh = *scene.mMeshes[m];
    aiColor4D* const numbered = std::exchange(mesh.mColors[0], nullptr);
    if (!numbered) continue;
    unsigned sets = 0;
    if (!obj.colors.empty()) {
      aiColor4D* const colors = mesh.mColors[sets++] = new aiColor4D[mesh.mNumVertices];
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const std::optional<std::size_t> number = objNumber(numbered[v].r, numbered[v].g, obj.colors.size());
        if (!number) throw Error(ErrorCode::kBadData, "its vertices are not found again after reading");
        const std::array<float, 4>& c = obj.colors[*number];
        colors[v] = aiColor4D(c[0], c[1], c[2], c[3]);
      }
    }
    if (numbers == ObjNumbers::kKept) {
      mesh.mColors[sets] = numbered;
    } else {
      delete[] numbered;
    }
  }
}

// `colors` (r, g, b, a of each vertex of a file) as glTF has them. Files have them as sRGB; where any is above 1 they
// are bytes. Vertices without one are white.
void convertColors(std::span<const std::span<float, 4>> colors) {
  float most = 0, maxAlpha = 0;
  for (const std::span<float, 4> c : colors) {
    for (const float x : c.first<3>()) most = x > most ? x : most;
    maxAlpha = c[3] > maxAlpha ? c[3] : maxAlpha;
  }
  const auto unit = [](float x, float largest) {
    if (!std::isfinite(x)) return 1.0;
    return std::clamp(largest > 1 ? x / 255.0 : double{x}, 0.0, 1.0);
  };
  for (const std::span<float, 4> c : colors) {
    for (float& x : c.first<3>()) x = static_cast<float>(linearOf(unit(x, most)));
    c[3] = static_cast<float>(unit(c[3], maxAlpha));
  }
}

void convertColors(aiScene& scene) {
  std::vector<std::span<float, 4>> colors;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned set = 0; set < mesh.GetNumColorChannels(); ++set) {
      for (unsigned v = 0; v < mesh.mNumVertices; ++v) colors.emplace_back(&mesh.mColors[set][v].r, 4);
    }
  }
  convertColors(colors);
}

// What Assimp is given of a file, and what is known of it beside.
struct Prepared {
  ByteSpan raw;  // for Assimp where there is no text for it
  ObjText obj;
  DaeText dae;
  std::size_t trailing = 0;  // bytes that are left out

  ByteSpan bytes() const { return !obj.text.empty() ? asBytes(obj.text) : !dae.text.empty() ? asBytes(dae.text) : raw; }
};

Prepared prepare(ByteSpan bytes, std::string_view extension) {
  Prepared result;
  result.raw = extension == "stl" ? checkedStl(bytes) : bytes;
  result.trailing = bytes.size() - result.raw.size();
  if (extension == "obj") {
    result.obj = prepareObj(bytes);
    convertColors(std::vector<std::span<float, 4>>(result.obj.colors.begin(), result.obj.colors.end()));
  }
  if (extension == "dae") result.dae = prepareDae(bytes);
  return result;
}

// Counts what Assimp reports of indices that are out of range while this lives: for them its reader of OFF takes the
// last vertex.
class IndexErrorCount {
 public:
  IndexErrorCount() {
    Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(count_), Assimp::Logger::Err);  // owns it from here
  }
  ~IndexErrorCount() { Assimp::DefaultLogger::kill(); }
  IndexErrorCount(const IndexErrorCount&) = delete;
  IndexErrorCount& operator=(const IndexErrorCount&) = delete;

  std::size_t count() const { return count_; }

 private:
  class Stream : public Assimp::LogStream {
   public:
    explicit Stream(std::size_t& count) : count_(count) {}
    void write(const char* message) override {
      if (std::string_view(message).find("index is out of range") != std::string_view::npos) ++count_;
    }

   private:
    std::size_t& count_;
  };

  std::size_t count_ = 0;
};

void warnOfPrepared(Asset& asset, const Prepared& file, const ImportIo& io) {
  asset.warnings.add("loose-vertices", "vertices that no face uses are left out", {}, file.obj.looseVertices);
  asset.warnings.add("invalid-faces", "faces that name vertices that are not there are left out", {},
                     file.obj.invalidFaces);
  asset.warnings.add("texture-transforms", "textures that are moved, turned or scaled lie as if they were not", {},
                     io.movedTextures());
  asset.warnings.add("key-interpolation",
                     "tracks with steps or curves between their keys (STEP, BEZIER, ...) go straight from key to key",
                     {}, file.dae.curvedSamplers);
  asset.warnings.add("trailing-bytes", "bytes behind the last triangle are left out", {}, file.trailing);
}

std::uint64_t importedMeshes(std::size_t size) {
  return read_bounds::kImportedMeshes.of(size / read_bounds::kBytesImportedMesh);
}

Asset readWithAssimp(ByteSpan bytes, std::string_view name, const Format& format, const Resolver& resolver,
                     ObjNumbers numbers) {
  const Prepared file = prepare(bytes, format.extension);
  const std::string mainName = std::string("model.") + format.extension;
  auto* io = new ImportIo(file.bytes(), mainName, resolver);
  const IndexErrorCount indexErrors;
  Assimp::Importer importer;
  importer.SetIOHandler(io);                                            // owns it from here
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);  // no made-up mesh where there is only motion
  const aiScene* scene = importer.ReadFile(mainName, aiProcess_Triangulate);
  if (!scene || !scene->mRootNode) throw importError(importer.GetErrorString(), mainName, name);

  if (scene->mNumMeshes > importedMeshes(bytes.size())) {
    throw Error(ErrorCode::kLimit,
                fmt::format("it has {} meshes, and a file of its size may have {}", scene->mNumMeshes,
                            importedMeshes(bytes.size())),
                {}, "join its meshes, or convert it to GLB");
  }

  auto& edited = const_cast<aiScene&>(*scene);  // the importer owns it and is done with it
  if (format.extension == std::string_view("stl")) dropNormals(edited);
  if (format.extension == std::string_view("obj")) {
    restoreObjColors(edited, file.obj, numbers);
  } else {
    convertColors(edited);
  }
  Convention convention;
  if (format.extension == std::string_view("dae")) convention = daeConvention(edited);
  Asset asset = convertScene(*scene, *io, convention.scale, convention.axes);
  warnOfConversion(asset, convention);
  warnOfPrepared(asset, file, *io);
  asset.warnings.add("invalid-corners", "corners of faces that name vertices that are not there get the last one", {},
                     indexErrors.count());
  if (format.extension == std::string_view("obj") && io->missingFile()) {
    asset.warnings.add("missing-materials", "the file of the materials is not there or outside the model's folder",
                       validUtf8(*io->missingFile()));
  }
  return asset;
}

// The document and its warnings in one message: a length in eight bytes, the warnings as JSON, the GLB.
Bytes pack(Asset asset) {
  Json warnings = Json::array();
  for (const Warning& w : asset.warnings.items()) warnings.push_back({w.kind, w.message, w.where, w.count});
  const std::string text = warnings.dump(-1, ' ', false, Json::error_handler_t::replace);
  const Bytes glb = writeGlb(asset);
  asset = Asset();  // before there is a third copy
  const std::uint64_t length = text.size();
  Bytes message(sizeof length + text.size() + glb.size());
  std::memcpy(message.data(), &length, sizeof length);
  std::copy(text.begin(), text.end(), message.begin() + sizeof length);
  std::copy(glb.begin(), glb.end(), message.end() - static_cast<std::ptrdiff_t>(glb.size()));
  return message;
}

Asset unpack(ByteSpan message) {
  std::uint64_t length = 0;
  if (message.size() < sizeof length) throw Error(ErrorCode::kBadData, "the importer gave no answer");
  std::memcpy(&length, message.data(), sizeof length);
  message = message.subspan(sizeof length);
  if (length > message.size()) throw Error(ErrorCode::kBadData, "the importer gave half an answer");
  const Json warnings = Json::parse(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length));

  Warnings ignored;
  const GlbChunks chunks = splitGlb(message.subspan(length), ignored);
  Asset asset = readGltfDocument(chunks.json, chunks.binary, {});
  for (const Json& w : warnings) {
    asset.warnings.add(w.at(0).get<std::string>(), w.at(1).get<std::string>(), w.at(2).get<std::string>(),
                       w.at(3).get<std::size_t>());
  }
  return asset;
}

// A text file of a megabyte takes Assimp about a tenth of a second; hostile ones get twenty times that, and eight
// seconds at most until 16 megabytes. Large scenes of tens of thousands of objects take it a second for each two.
SandboxLimits limitsFor(std::size_t size) {
  SandboxLimits limits;
  const double megabytes = static_cast<double>(size) / (1 << 20);
  limits.memory = static_cast<std::size_t>(read_bounds::kAssimp.larger(size));
  limits.seconds = std::min(1 + 2 * megabytes, 8.0) + std::max(megabytes - 16, 0.0);
  return limits;
}

}  // namespace

Asset importModel(ByteSpan bytes, std::string_view name, const Resolver& resolver, ObjNumbers numbers) {
  const Format& format = formatOf(bytes, name);
  try {
    const Bytes message = runIsolated([&] { return pack(readWithAssimp(bytes, name, format, resolver, numbers)); },
                                      limitsFor(bytes.size()));
    Asset asset = unpack(message);
    asset.format = format.extension;
    return asset;
  } catch (const Error& error) {
    throw Error(error.code(), fmt::format("cannot be read as {}: {}", format.label, error.message()), error.where(),
                error.remedy());
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kBadData, fmt::format("cannot be read as {}", format.label));
  }
}

}  // namespace limber
