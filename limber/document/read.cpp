#include "limber/document/read.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <new>

#include "limber/core/file/file_view.h"
#include "limber/core/known_error.h"
#include "limber/core/text/names.h"
#include "limber/document/bvh/bvh_read.h"
#include "limber/document/clip/animation_repair.h"
#include "limber/document/clip/motion_io.h"
#include "limber/document/fbx/import_fbx.h"
#include "limber/document/fbx/records/fbx_parse.h"
#include "limber/document/gltf/check_asset.h"
#include "limber/document/gltf/codecs/codecs.h"
#include "limber/document/gltf/extensions.h"
#include "limber/document/gltf/glb.h"
#include "limber/document/gltf/gltf_document.h"
#include "limber/document/mesh/ply.h"
#include "limber/document/rig/weight_repair.h"
#include "limber/document/stored_archive.h"
#include "limber/document/uri.h"
#ifdef LIMBER_IMPORT
#include "limber/document/import/import_model.h"
#endif

namespace limber {

namespace fs = std::filesystem;

namespace {

// JSON of any kind: limber's other formats never start with a brace.
bool looksLikeJson(ByteSpan bytes) {
  std::size_t at = 0;
  constexpr std::array<std::uint8_t, 3> kByteOrderMark = {0xef, 0xbb, 0xbf};
  if (bytes.size() >= 3 && std::equal(kByteOrderMark.begin(), kByteOrderMark.end(), bytes.begin())) at = 3;
  while (at < bytes.size() && std::isspace(bytes[at])) ++at;
  return at < bytes.size() && bytes[at] == '{';
}

// Text in UTF-16, by its byte order mark or by the zero beside each of its first two letters.
bool looksLikeUtf16(ByteSpan bytes) {
  if (bytes.size() < 4) return false;
  const auto is = [&](std::uint8_t first, std::uint8_t second) { return bytes[0] == first && bytes[1] == second; };
  const auto letter = [&](std::size_t at) {
    return (bytes[at] >= 0x20 && bytes[at] < 0x7f) || std::isspace(bytes[at]);
  };
  if (is(0xff, 0xfe) || is(0xfe, 0xff)) return true;
  return (letter(0) && letter(2) && bytes[1] == 0 && bytes[3] == 0) ||
         (letter(1) && letter(3) && bytes[0] == 0 && bytes[2] == 0);
}

Asset readGltf(ByteSpan bytes, const Resolver& resolver) {
  Asset asset;
  if (looksLikeGlb(bytes)) {
    Warnings warnings;
    const GlbChunks chunks = splitGlb(bytes, warnings);
    asset = readGltfDocument(chunks.json, chunks.binary, resolver);
    asset.warnings.append(warnings);
    asset.format = "glb";
  } else {
    asset = readGltfDocument(bytes, std::nullopt, resolver);
    asset.format = "gltf";
  }
  decompress(asset);
  resolveNodePointers(asset.document, asset.warnings);
  warnOfUnknownExtensions(asset);
  return asset;
}

// An FBX file that a page hands over together with the pictures beside it, which it cannot open one by one.
Asset readFbxArchive(ByteSpan bytes) {
  const std::map<std::string, Bytes> files = readZipArchive(bytes, {});
  const auto model =
      std::find_if(files.begin(), files.end(), [](const auto& file) { return looksLikeFbx(file.second); });
  if (model == files.end()) throw Error(ErrorCode::kBadData, "is an archive without an FBX file");
  return importFbx(model->second, [&](std::string_view path) -> std::optional<Bytes> {
    const auto file = files.find(std::string(path));
    return file == files.end() ? std::nullopt : std::optional<Bytes>(file->second);
  });
}

Asset readAny(ByteSpan bytes, std::string_view name, const Resolver& resolver) {
  if (bytes.empty()) throw KnownError(ErrorKind::kEmptyFile, {ErrorCode::kBadData, "is empty"});
  if (looksLikeGlb(bytes) || looksLikeJson(bytes)) return readGltf(bytes, resolver);
  const std::string extension = lowerExtension(std::string(name));
  // COLLADA is XML, which may well be in UTF-16; the bytes of a binary STL's title are anything.
  if (extension != ".dae" && extension != ".stl" && looksLikeUtf16(bytes)) {
    throw Error(ErrorCode::kUnsupported, "is text in UTF-16", {}, "save it as UTF-8");
  }
  if (extension == ".glb") {
    throw KnownError(ErrorKind::kNoGlb, {ErrorCode::kBadData, "is no GLB: it does not start with \"glTF\""});
  }
  if (extension == ".gltf") throw Error(ErrorCode::kBadData, "is no glTF: it is not a JSON object");
  if (looksLikeFbx(bytes)) return importFbx(bytes, resolver);
  if (extension == ".fbx" && looksLikeZipArchive(bytes)) return readFbxArchive(bytes);
  if (extension == ".fbx") throw Error(ErrorCode::kBadData, "is no FBX file: it does not start as one");
  if (looksLikePly(bytes)) return readPly(bytes, resolver);
#ifdef LIMBER_IMPORT
  return importModel(bytes, name, resolver);
#else
  throw KnownError(ErrorKind::kUnknownFormat, {ErrorCode::kUnsupported,
                                               "is of a format that limber does not read here",
                                               {},
                                               "convert it to GLB, glTF, FBX or PLY, which are read"});
#endif
}

// The skeleton of a motion as nodes, and its clip.
Asset motionFileAsset(const Motion& motion, std::string_view name, const char* format) {
  Asset asset = motionAsset(motion);
  asset.name = name;
  asset.format = format;
  checkAsset(asset);
  return asset;
}

// A rotation of length 0 is none, but everything else of such a file can be read.
void repairRotations(Asset& asset) {
  for (gltf::Node& node : asset.document.nodes) {
    if (!node.rotation || !(node.rotation->squaredNorm() < kMinSquaredRotation)) continue;
    node.rotation.reset();
    asset.warnings.add("invalid-rotations", "nodes with a rotation of length 0 are not rotated", node.name);
  }
}

// What `read` gives, checked; throws with the file's name.
template <typename Read>
Asset finished(std::string_view name, const Read& read) {
  try {
    Asset asset = read();
    asset.name = name;
    repairRotations(asset);
    checkAsset(asset);
    repairWeights(asset);
    startAtZero(asset);
    return asset;
  } catch (const Error& error) {
    throwWithin(error, name);
  } catch (const std::bad_alloc&) {
    throw KnownError(ErrorKind::kOutOfMemory, {ErrorCode::kLimit, "does not fit in memory", std::string(name)});
  }
}

}  // namespace

Resolver folderResolver(const fs::path& folder) {
  return [folder](std::string_view path) -> std::optional<Bytes> {
    const std::string local(path);
    checkLocalPath(local);
    const fs::path location = folder / local;
    std::error_code ignored;
    if (!fs::is_regular_file(location, ignored)) return std::nullopt;
    return readFile(location);
  };
}

Asset readAsset(ByteSpan bytes, std::string_view name, const Resolver& resolver) {
  const std::string extension = lowerExtension(std::string(name));
  if (looksLikeBvh(bytes) || extension == ".bvh") return motionFileAsset(readBvh(bytes, name), name, "bvh");
  if (looksLikeNpz(bytes) || extension == ".npz") return motionFileAsset(readSmplMotion(bytes, name), name, "npz");
  return finished(name, [&] { return readAny(bytes, name, resolver); });
}

Asset readNumberedObj([[maybe_unused]] ByteSpan bytes, std::string_view name,
                      [[maybe_unused]] const Resolver& resolver) {
  return finished(name, [&]() -> Asset {
#ifdef LIMBER_IMPORT
    return importModel(bytes, name, resolver, ObjNumbers::kKept);
#else
    throw Error(ErrorCode::kUnsupported, "is an OBJ file, which limber does not read here");
#endif
  });
}

Asset readAsset(const fs::path& path) {
  const FileView file(path);
  if (path == "-") return readAsset(file.bytes(), "standard input");
  return readAsset(file.bytes(), path.filename().string(), folderResolver(path.parent_path()));
}

}  // namespace limber
