#include "limber/actions/export/write_model.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "limber/core/text/names.h"
#include "limber/document/gltf/gltf_files.h"
#include "limber/document/stored_archive.h"
#include "limber/document/usd/usd_write.h"
#include "limber/document/vrm/vrm_write.h"
#include "limber/document/write.h"

namespace limber {

namespace {

namespace fs = std::filesystem;

struct ModelFormat {
  std::string_view extension;
  bool holdsOneClip;
  Warnings (*write)(const Asset& asset, const fs::path& path, const WriteModelOptions& options);
  EncodedModel (*encode)(const Asset& asset, const WriteModelOptions& options);
};

Warnings writeAsGltf(const Asset& asset, const fs::path& path, const WriteModelOptions& options) {
  writeAsset(asset, path, options.companions);
  return {};
}

EncodedModel encodeAsGlb(const Asset& asset, const WriteModelOptions&) {
  return {writeGlb(asset), {}};
}

EncodedModel encodeAsGltf(const Asset& asset, const WriteModelOptions&) {
  const GltfFiles files = gltfFiles(asset, "model.gltf");
  std::vector<StoredFile> stored = {{"model.gltf", asBytes(files.json)}};
  for (const GltfFiles::File& file : files.beside) stored.push_back({file.path.string(), file.bytes});
  return {writeStoredArchive(stored), {}};
}

UsdOptions usdOptions(const WriteModelOptions& options) {
  UsdOptions usd;
  usd.clip = options.clip;
  return usd;
}

Warnings writeAsUsd(const Asset& asset, const fs::path& path, const WriteModelOptions& options) {
  return writeUsd(asset, path, usdOptions(options), options.companions);
}

// A USDZ is a stored archive of them.
template <UsdForm form>
EncodedModel encodeAsUsd(const Asset& asset, const WriteModelOptions& options) {
  UsdOptions usd = usdOptions(options);
  usd.form = form;
  const UsdFiles files = usdFiles(asset, usd);
  return {encodeUsdz(files), files.warnings};
}

EncodedModel encodeAsFbx(const Asset& asset, const WriteModelOptions& options) {
  FbxOptions fbx;
  fbx.unit = options.fbxUnit.value_or(findTarget(options.target).fbxUnit);
  fbx.up = options.fbxUp;
  FbxExport file = encodeFbx(asset, fbx);
  return {std::move(file.bytes), std::move(file.warnings)};
}

EncodedModel encodeAsVrm(const Asset& asset, const WriteModelOptions& options) {
  Asset person = asset.clone();
  person.warnings = {};
  makeVrm(person, options.vrm);
  return {writeGlb(person), std::move(person.warnings)};
}

// A format that is one file, beside its companions.
template <EncodedModel (*encode)(const Asset&, const WriteModelOptions&)>
Warnings writeAsOneFile(const Asset& asset, const fs::path& path, const WriteModelOptions& options) {
  EncodedModel model = encode(asset, options);
  std::vector<OutputFile> outputs(options.companions.begin(), options.companions.end());
  outputs.push_back({path, model.bytes});
  writeFiles(outputs);
  return std::move(model.warnings);
}

// A format is a line here.
constexpr std::array kFormats = {
    ModelFormat{".glb", false, writeAsGltf, encodeAsGlb},
    ModelFormat{".gltf", false, writeAsGltf, encodeAsGltf},
    ModelFormat{".fbx", false, writeAsOneFile<encodeAsFbx>, encodeAsFbx},
    ModelFormat{".vrm", false, writeAsOneFile<encodeAsVrm>, encodeAsVrm},
    ModelFormat{".usda", true, writeAsUsd, encodeAsUsd<UsdForm::kText>},
    ModelFormat{".usdc", true, writeAsUsd, encodeAsUsd<UsdForm::kCrate>},
    ModelFormat{".usdz", true, writeAsUsd, encodeAsUsd<UsdForm::kCrate>},
};

const ModelFormat* findFormat(std::string_view extension) {
  const auto found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const auto& format) { return format.extension == extension; });
  return found == kFormats.end() ? nullptr : &*found;
}

const ModelFormat& formatOf(std::string_view extension, const std::string& where) {
  if (const ModelFormat* format = findFormat(extension)) return *format;
  throw Error(ErrorCode::kBadArgument, "is no format that models are written in", where,
              fmt::format("there are: {}", fmt::join(modelExtensions(), ", ")));
}

// The asset as target and format want it; a copy only where something changes.
class Prepared {
 public:
  Prepared(const Asset& asset, const ModelFormat& format, const WriteModelOptions& options) : asset_(&asset) {
    const EngineTarget& target = findTarget(options.target);
    const bool dropsClips = options.isStill && format.holdsOneClip && !asset.document.animations.empty();
    if (target.isPlain() && !dropsClips) return;
    copy_ = asset.clone();
    copy_.warnings = {};
    if (dropsClips) copy_.document.animations.clear();
    toTarget(copy_, target, options.reading);
    warnings_ = std::move(copy_.warnings);
    asset_ = &copy_;
  }

  const Asset& asset() const { return *asset_; }
  const Warnings& warnings() const { return warnings_; }

 private:
  Asset copy_;
  const Asset* asset_;
  Warnings warnings_;
};

}  // namespace

std::vector<std::string_view> modelExtensions() {
  std::vector<std::string_view> extensions;
  for (const ModelFormat& format : kFormats) extensions.push_back(format.extension);
  return extensions;
}

std::string modelOutputHelp() {
  const std::vector<std::string_view> all = modelExtensions();
  const std::span<const std::string_view> first = std::span<const std::string_view>(all).first(all.size() - 1);
  return fmt::format("the {} or {} to write; - is standard output (GLB)", fmt::join(first, ", "), all.back());
}

bool holdsOneClip(const fs::path& path) {
  const ModelFormat* format = findFormat(lowerExtension(path));
  return format != nullptr && format->holdsOneClip;
}

Warnings writeModel(const Asset& asset, const fs::path& path, const WriteModelOptions& options) {
  const ModelFormat& format = path == "-" ? kFormats.front() : formatOf(lowerExtension(path), path.string());
  const Prepared prepared(asset, format, options);
  Warnings warnings = prepared.warnings();
  warnings.append(format.write(prepared.asset(), path, options));
  return warnings;
}

EncodedModel encodeModel(const Asset& asset, std::string_view extension, const WriteModelOptions& options) {
  const ModelFormat& format = formatOf(extension, std::string(extension));
  const Prepared prepared(asset, format, options);
  EncodedModel result = format.encode(prepared.asset(), options);
  Warnings warnings = prepared.warnings();
  warnings.append(result.warnings);
  result.warnings = std::move(warnings);
  return result;
}

}  // namespace limber
