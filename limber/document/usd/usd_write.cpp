#include "limber/document/usd/usd_write.h"

#include <algorithm>

#include <fmt/format.h>

#include "limber/core/text/names.h"
#include "limber/document/stored_archive.h"
#include "limber/document/unique_names.h"
#include "limber/document/usd/usd_crate.h"
#include "limber/document/usd/usd_materials.h"
#include "limber/document/usd/usd_model.h"
#include "limber/document/usd/usd_motion.h"
#include "limber/document/usd/usd_text.h"

namespace limber {

namespace {

// Decimals of text where it is rounded: a half of 1e-3 is 0.03 degrees of a normal, of 1e-5 a fiftieth of a pixel of a
// picture of 4096.
constexpr int kNormalDecimals = 3, kColorDecimals = 4, kUvDecimals = 5, kWeightDecimals = 6;

UsdPrim skeletonPrim(const UsdModel& model, const UsdMotion& motion) {
  UsdPrim prim{"Skeleton", kUsdSkeleton, {"SkelBindingAPI"}, {}, {}};
  prim.addUniform("token[]", "joints", model.joints);
  UniqueNames names;
  std::vector<std::string> jointNames;
  for (const Joint& joint : model.skeleton.joints) jointNames.push_back(names.add(usdLabel(joint.name)));
  const bool areNames =
      std::all_of(jointNames.begin(), jointNames.end(), [](const std::string& name) { return usdName(name) == name; });
  if (!areNames) prim.addUniform("token[]", "jointNames", std::move(jointNames));
  prim.relate("skel:animationSource", {fmt::format("/{}/{}/Motion", kUsdRoot, kUsdSkeleton)});
  prim.addUniform("matrix4d[]", "bindTransforms", restGlobals(model.skeleton));
  std::vector<Affine> locals;  // without a clip as the joints stand: three.js shows no others
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    locals.push_back((model.clip ? model.skeleton.joints[j].rest : model.stance.locals[j]).toAffine());
  }
  prim.addUniform("matrix4d[]", "restTransforms", std::move(locals));
  prim.children.push_back(motion.prim());
  return prim;
}

UsdPrim shapePrim(UsdShape& shape, int decimals) {
  UsdPrim prim{"BlendShape", shape.name, {}, {}, {}};
  prim.display(shape.label);
  prim.addUniform("vector3f[]", "offsets", std::move(shape.offsets)).decimals = decimals;
  if (!shape.normalOffsets.empty()) {
    prim.addUniform("vector3f[]", "normalOffsets", std::move(shape.normalOffsets)).decimals = kNormalDecimals;
  }
  prim.addUniform("int[]", "pointIndices", std::move(shape.vertices));
  return prim;
}

// A value for each vertex, or one for all.
template <typename Value>
void addPrimvar(const char* type, const std::string& name, std::vector<Value> values, int decimals,
                std::size_t vertices, UsdPrim& prim) {
  const bool isConstant = values.size() != vertices;
  UsdProperty& property = prim.add(type, name, std::move(values));
  property.interpolation = isConstant ? "constant" : "vertex";
  property.decimals = decimals;
}

void addShapes(std::vector<UsdShape>& shapes, int decimals, UsdPrim& mesh) {
  std::vector<std::string> names, targets;
  for (const UsdShape& shape : shapes) {
    names.push_back(shape.label);
    targets.push_back(fmt::format("/{}/{}/{}", kUsdRoot, mesh.name, shape.name));
  }
  mesh.addUniform("token[]", "skel:blendShapes", std::move(names));
  mesh.relate("skel:blendShapeTargets", std::move(targets));
  for (UsdShape& shape : shapes) mesh.children.push_back(shapePrim(shape, decimals));
}

// Takes what the mesh holds along.
UsdPrim meshPrim(UsdMesh& mesh, bool hasSkeleton, const gltf::Material* material, const std::string& materialPath,
                 int decimals) {
  const bool moves = hasSkeleton && (mesh.influences > 0 || !mesh.shapes.empty());
  const std::size_t vertices = mesh.points.size();
  UsdPrim prim{"Mesh", mesh.name, {}, {}, {}};
  prim.display(mesh.label);
  if (moves) prim.schemas.push_back("SkelBindingAPI");
  if (material != nullptr) prim.schemas.push_back("MaterialBindingAPI");
  if (material != nullptr && material->doubleSided) prim.addUniform("bool", "doubleSided", true);
  Box box;
  for (const Vec3f& point : mesh.points) box.add(point.cast<double>());
  prim.add("float3[]", "extent", std::vector<Vec3f>{box.min.cast<float>(), box.max.cast<float>()});
  prim.add("int[]", "faceVertexCounts", std::vector<int>(mesh.corners.size() / 3, 3));
  prim.add("int[]", "faceVertexIndices", std::move(mesh.corners));
  prim.add("point3f[]", "points", std::move(mesh.points)).decimals = decimals;
  if (!mesh.normals.empty()) {
    addPrimvar("normal3f[]", "normals", std::move(mesh.normals), kNormalDecimals, vertices, prim);
  }
  for (auto& [set, uvs] : mesh.uvs) {
    addPrimvar("texCoord2f[]", "primvars:" + uvPrimvar(set), std::move(uvs), kUvDecimals, vertices, prim);
  }
  if (!mesh.colors.empty()) {
    addPrimvar("color3f[]", "primvars:displayColor", std::move(mesh.colors), kColorDecimals, vertices, prim);
  }
  if (!mesh.opacities.empty()) {
    addPrimvar("float[]", "primvars:displayOpacity", std::move(mesh.opacities), kColorDecimals, vertices, prim);
  }
  prim.addUniform("token", "subdivisionScheme", "none");
  if (material != nullptr) prim.relate("material:binding", {materialPath});
  if (moves) {
    prim.relate("skel:skeleton", {fmt::format("/{}/{}", kUsdRoot, kUsdSkeleton)});
    prim.add("matrix4d", "primvars:skel:geomBindTransform", Affine::Identity());
  }
  if (moves && mesh.influences > 0) {
    prim.add("int[]", "primvars:skel:jointIndices", std::move(mesh.joints));
    prim.add("float[]", "primvars:skel:jointWeights", std::move(mesh.weights)).decimals = kWeightDecimals;
    for (std::size_t last = prim.properties.size(), i = last - 2; i < last; ++i) {
      prim.properties[i].elementSize = mesh.influences;
      prim.properties[i].interpolation = "vertex";
    }
  }
  if (!mesh.shapes.empty()) addShapes(mesh.shapes, decimals, prim);
  return prim;
}

std::vector<UsdSurface> usdSurfaces(const gltf::Document& document) {
  std::vector<UsdSurface> surfaces;
  for (Index m = 0; m < document.materials.size(); ++m) surfaces.push_back(usdSurface(document, m));
  return surfaces;
}

UsdFiles filesOf(const Asset& asset, const std::vector<UsdSurface>& surfaces, UsdModel model,
                 const UsdOptions& options) {
  UsdFiles files;
  files.form = options.form;
  files.warnings = model.warnings;
  UsdStage stage;
  const UsdMotion motion(model);
  stage.timeCodesPerSecond = motion.timeCodesPerSecond();
  stage.endTimeCode = motion.duration() * stage.timeCodesPerSecond;
  const bool hasSkeleton = motion.isNeeded();
  stage.root.name = kUsdRoot;
  stage.root.type = hasSkeleton ? "SkelRoot" : "Xform";
  if (hasSkeleton) {
    stage.root.schemas = {"SkelBindingAPI"};
    stage.root.children.push_back(skeletonPrim(model, motion));
  }
  std::set<Index> colored;
  for (const UsdMesh& mesh : model.meshes) {
    if (mesh.material && !mesh.colors.empty()) colored.insert(*mesh.material);
  }
  const std::vector<std::string> materials =
      addUsdMaterials(asset, surfaces, colored, options.imageStem, stage.root, files);
  for (UsdMesh& mesh : model.meshes) {
    const gltf::Material* material = mesh.material ? &asset.document.materials[*mesh.material] : nullptr;
    stage.root.children.push_back(meshPrim(mesh, hasSkeleton, material,
                                           material != nullptr ? materials[*mesh.material] : "", model.pointDecimals));
  }
  if (options.form == UsdForm::kCrate) {
    files.stage = usdCrate(stage);
  } else {
    const std::string text = usdText(stage);
    files.stage.assign(text.begin(), text.end());
  }
  return files;
}

}  // namespace

UsdFiles usdFiles(const Asset& asset, const UsdOptions& options) {
  const std::vector<UsdSurface> surfaces = usdSurfaces(asset.document);
  return filesOf(asset, surfaces, readUsdModel(asset, surfaces, options), options);
}

UsdFiles stillUsdFiles(const Asset& asset, const UsdStillSurface& surface) {
  const std::vector<UsdSurface> surfaces = usdSurfaces(asset.document);
  return filesOf(asset, surfaces, readStillUsdModel(asset, surfaces, surface), {});
}

Bytes encodeUsdz(const UsdFiles& files) {
  constexpr std::size_t kAlignment = 64;
  const char* name = files.form == UsdForm::kCrate ? "model.usdc" : "model.usda";
  std::vector<StoredFile> stored = {{name, files.stage}};
  for (const UsdFiles::Image& image : files.images) stored.push_back({image.path, image.bytes});
  return writeStoredArchive(stored, kAlignment);
}

Warnings writeUsd(const Asset& asset, const std::filesystem::path& path, UsdOptions options,
                  std::span<const OutputFile> companions) {
  std::vector<OutputFile> outputs(companions.begin(), companions.end());
  const std::string extension = lowerExtension(path);
  options.form = extension == ".usda" ? UsdForm::kText : UsdForm::kCrate;
  if (extension == ".usdz") {
    const UsdFiles files = usdFiles(asset, options);
    const Bytes archive = encodeUsdz(files);
    outputs.push_back({path, archive});
    writeFiles(outputs);
    return files.warnings;
  }
  options.imageStem = path.stem().string() + "_image";
  const UsdFiles files = usdFiles(asset, options);
  for (const UsdFiles::Image& image : files.images) outputs.push_back({path.parent_path() / image.path, image.bytes});
  outputs.push_back({path, files.stage});  // last, so that it never exists without what it refers to
  writeFiles(outputs);
  return files.warnings;
}

}  // namespace limber
