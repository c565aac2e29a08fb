#include "limber/usd/usd_write.h"

#include <fmt/format.h>

#include "limber/asset/stored_archive.h"
#include "limber/core/names.h"
#include "limber/usd/usd_materials.h"
#include "limber/usd/usd_model.h"
#include "limber/usd/usd_motion.h"
#include "limber/usd/usd_text.h"

namespace limber {

namespace {

void writeSkeleton(const UsdModel& model, const UsdMotion& motion, UsdText& text) {
  text.open("Skeleton", "Skeleton", {"SkelBindingAPI"});
  text.tokens("uniform token[] joints", model.joints);
  text.line(fmt::format("rel skel:animationSource = </{}/Skeleton/Motion>", kUsdRoot));
  text.matrices("uniform matrix4d[] bindTransforms", restGlobals(model.skeleton));
  std::vector<Affine> locals;
  for (const Joint& joint : model.skeleton.joints) locals.push_back(joint.rest.toAffine());
  text.matrices("uniform matrix4d[] restTransforms", locals);
  motion.write(text);
  text.close();
}

void writeShape(const UsdShape& shape, UsdText& text) {
  text.open("BlendShape", shape.name);
  text.array("uniform vector3f[] offsets", shape.offsets);
  if (!shape.normalOffsets.empty()) text.array("uniform vector3f[] normalOffsets", shape.normalOffsets);
  text.array("uniform int[] pointIndices", shape.vertices);
  text.close();
}

void writeMesh(const UsdMesh& mesh, bool hasSkeleton, const gltf::Material* material, const std::string& materialPath,
               UsdText& text) {
  const bool moves = hasSkeleton && (mesh.influences > 0 || !mesh.shapes.empty());
  std::vector<std::string_view> schemas;
  if (moves) schemas.push_back("SkelBindingAPI");
  if (material != nullptr) schemas.push_back("MaterialBindingAPI");
  text.open("Mesh", mesh.name, schemas);
  if (material != nullptr && material->doubleSided) text.line("uniform bool doubleSided = 1");
  Box box;
  for (const Vec3f& point : mesh.points) box.add(point.cast<double>());
  const std::vector<Vec3f> extent = {Vec3f(box.min.cast<float>()), Vec3f(box.max.cast<float>())};
  text.array("float3[] extent", extent);
  text.array("int[] faceVertexCounts", std::vector<int>(mesh.corners.size() / 3, 3));
  text.array("int[] faceVertexIndices", mesh.corners);
  text.array("point3f[] points", mesh.points);
  if (!mesh.normals.empty()) text.array("normal3f[] normals", mesh.normals, {"interpolation = \"vertex\""});
  if (!mesh.uvs.empty()) text.array("texCoord2f[] primvars:st", mesh.uvs, {"interpolation = \"vertex\""});
  text.line("uniform token subdivisionScheme = \"none\"");
  if (material != nullptr) text.line(fmt::format("rel material:binding = <{}>", materialPath));
  if (moves) {
    text.line(fmt::format("rel skel:skeleton = </{}/Skeleton>", kUsdRoot));
    text.line("matrix4d primvars:skel:geomBindTransform = ((1,0,0,0),(0,1,0,0),(0,0,1,0),(0,0,0,1))");
  }
  if (moves && mesh.influences > 0) {
    const std::vector<std::string> layout = {fmt::format("elementSize = {}", mesh.influences),
                                             "interpolation = \"vertex\""};
    text.array("int[] primvars:skel:jointIndices", mesh.joints, layout);
    text.array("float[] primvars:skel:jointWeights", mesh.weights, layout);
  }
  if (!mesh.shapes.empty()) {
    std::vector<std::string> names;
    std::string targets;
    for (const UsdShape& shape : mesh.shapes) {
      names.push_back(shape.name);
      targets += fmt::format("{}</{}/{}/{}>", targets.empty() ? "" : ", ", kUsdRoot, mesh.name, shape.name);
    }
    text.tokens("uniform token[] skel:blendShapes", names);
    text.line(fmt::format("rel skel:blendShapeTargets = [{}]", targets));
    for (const UsdShape& shape : mesh.shapes) writeShape(shape, text);
  }
  text.close();
}

}  // namespace

UsdFiles usdFiles(const Asset& asset, const UsdOptions& options) {
  const UsdModel model = readUsdModel(asset, options);
  UsdFiles files;
  files.warnings = model.warnings;
  UsdText text(files.text);
  const UsdMotion motion(model);
  files.text = "#usda 1.0\n(\n";
  text.line(fmt::format("  defaultPrim = \"{}\"", kUsdRoot));
  text.line("  metersPerUnit = 1");
  text.line("  upAxis = \"Y\"");
  if (const double duration = motion.duration(); duration > 0) {
    text.line("  startTimeCode = 0");
    text.line(fmt::format("  endTimeCode = {}", usdNumber(duration * motion.timeCodesPerSecond())));
    text.line(fmt::format("  timeCodesPerSecond = {}", usdNumber(motion.timeCodesPerSecond())));
  }
  text.line(")");
  const bool hasSkeleton = motion.isNeeded();
  if (hasSkeleton) {
    text.open("SkelRoot", kUsdRoot, {"SkelBindingAPI"});
    writeSkeleton(model, motion, text);
  } else {
    text.open("Xform", kUsdRoot);
  }
  const std::vector<std::string> materials = writeUsdMaterials(asset, options.imageStem, text, files);
  for (const UsdMesh& mesh : model.meshes) {
    const gltf::Material* material = mesh.material ? &asset.document.materials[*mesh.material] : nullptr;
    writeMesh(mesh, hasSkeleton, material, material != nullptr ? materials[*mesh.material] : "", text);
  }
  text.close();
  return files;
}

Bytes encodeUsdz(const UsdFiles& files) {
  constexpr std::size_t kAlignment = 64;
  std::vector<StoredFile> stored = {{"model.usda", asBytes(files.text)}};
  for (const UsdFiles::Image& image : files.images) stored.push_back({image.path, image.bytes});
  return writeStoredArchive(stored, kAlignment);
}

bool isUsdFormat(const std::filesystem::path& path) {
  const std::string extension = lowerExtension(path);
  return extension == ".usda" || extension == ".usdz";
}

Warnings writeUsd(const Asset& asset, const std::filesystem::path& path, UsdOptions options) {
  if (lowerExtension(path) == ".usdz") {
    const UsdFiles files = usdFiles(asset, options);
    const Bytes archive = encodeUsdz(files);
    writeFiles(std::vector<OutputFile>{{path, archive}});
    return files.warnings;
  }
  options.imageStem = path.stem().string() + "_image";
  const UsdFiles files = usdFiles(asset, options);
  std::vector<OutputFile> outputs;
  for (const UsdFiles::Image& image : files.images) outputs.push_back({path.parent_path() / image.path, image.bytes});
  outputs.push_back({path, asBytes(files.text)});  // last, so that it never stands there without what it refers to
  writeFiles(outputs);
  return files.warnings;
}

}  // namespace limber
