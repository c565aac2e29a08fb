#include "limber/document/usd/usd_materials.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "limber/document/images.h"
#include "limber/document/unique_names.h"

namespace limber {

namespace {

class MaterialWriter {
 public:
  MaterialWriter(const Asset& asset, const std::string& imageStem, UsdFiles& files)
      : asset_(asset), document_(asset.document), imageStem_(imageStem), files_(files) {}

  // `path`: of the prim that is made.
  UsdPrim write(const UsdSurface& surface, bool isColored, std::string name, std::string path) {
    UsdPrim material{"Material", std::move(name), {}, {}, {}};
    path_ = std::move(path);
    colorInput_ = surface.colorInput;
    textures_.clear();
    readers_.clear();
    uses_.clear();
    material.connect("token", "outputs:surface", path_ + "/Surface.outputs:surface");
    UsdPrim shader = shaderOf("Surface", "UsdPreviewSurface");
    for (const UsdInput& input : surface.inputs) addInput(input, isColored, shader);
    shader.add("token", "outputs:surface");
    material.children.push_back(std::move(shader));
    for (std::vector<UsdPrim>* parts : {&readers_, &textures_}) {
      std::move(parts->begin(), parts->end(), std::back_inserter(material.children));
    }
    for (const std::string& extension : surface.unsaid) {
      files_.warnings.add("material-extensions", "what some extensions say of materials is left out",
                          fmt::format("{}: {}", path_, extension));
    }
    return material;
  }

 private:
  static UsdPrim shaderOf(std::string name, const char* id) {
    UsdPrim shader{"Shader", std::move(name), {}, {}, {}};
    shader.addUniform("token", "info:id", id);
    return shader;
  }

  // A connection to the vertices' colours or to the texture where it can be had, else the value, if there is one.
  void addInput(const UsdInput& input, bool isColored, UsdPrim& shader) {
    const std::string name = "inputs:" + input.name;
    const bool isColor = input.name == colorInput_;
    if (isColored && (isColor || input.name == "opacity")) {
      shader.connect(input.type, name,
                     reader(isColor ? "VertexColor" : "VertexOpacity", isColor ? "float3" : "float",
                            isColor ? "displayColor" : "displayOpacity", input.value));
      return;
    }
    const std::optional<std::string> image = input.texture ? imagePath(input.texture->texture) : std::nullopt;
    if (image) {
      shader.connect(input.type, name, textureShader(*input.texture, *image, input.name) + input.channel);
    } else if (!std::holds_alternative<std::monostate>(input.value)) {
      shader.add(input.type, name, input.value);
    }
  }

  // What reads a primvar; the path of its result.
  std::string reader(const std::string& name, const std::string& type, const std::string& primvar,
                     const UsdValue& fallback) {
    const bool isThere =
        std::any_of(readers_.begin(), readers_.end(), [&](const UsdPrim& prim) { return prim.name == name; });
    if (!isThere) {
      UsdPrim& prim = readers_.emplace_back(shaderOf(name, ("UsdPrimvarReader_" + type).c_str()));
      prim.add("string", "inputs:varname", primvar);
      if (!std::holds_alternative<std::monostate>(fallback)) prim.add(type, "inputs:fallback", fallback);
      prim.add(type, "outputs:result");
    }
    return fmt::format("{}/{}.outputs:result", path_, name);
  }

  // The path of the output that gives the texture's coordinates.
  std::string locationOf(const UsdTexture& texture, const std::string& textureName) {
    const std::string primvar = uvPrimvar(texture.uvSet);
    std::string uv = reader("Uv" + primvar.substr(2), "float2", primvar, {});
    if (!texture.transform) return uv;
    const std::string name = textureName + "Place";
    UsdPrim& transform = readers_.emplace_back(shaderOf(name, "UsdTransform2d"));
    transform.connect("float2", "inputs:in", std::move(uv));
    transform.add("float", "inputs:rotation", texture.transform->degrees);
    transform.add("float2", "inputs:scale", texture.transform->scale);
    transform.add("float2", "inputs:translation", texture.transform->translation);
    transform.add("float2", "outputs:result");
    return fmt::format("{}/{}.outputs:result", path_, name);
  }

  // The path of a texture's outputs, without their names; equal uses of a texture have one shader.
  std::string textureShader(const UsdTexture& use, const std::string& image, const std::string& inputName) {
    for (std::size_t i = 0; i < textures_.size(); ++i) {
      if (uses_[i] == use) return fmt::format("{}/{}.outputs:", path_, textures_[i].name);
    }
    const gltf::Texture& texture = document_.textures[use.texture];
    const gltf::Sampler sampler = texture.sampler ? document_.samplers[*texture.sampler] : gltf::Sampler();
    const auto wrap = [](Index mode) {
      return mode == gltf::kClampToEdge ? "clamp" : mode == gltf::kMirroredRepeat ? "mirror" : "repeat";
    };
    UsdPrim prim = shaderOf(inputName + "Texture", "UsdUVTexture");
    prim.add("asset", "inputs:file", image);
    prim.connect("float2", "inputs:st", locationOf(use, prim.name));
    prim.add("token", "inputs:sourceColorSpace", use.isColor ? "sRGB" : "raw");
    prim.add("token", "inputs:wrapS", wrap(sampler.wrapS));
    prim.add("token", "inputs:wrapT", wrap(sampler.wrapT));
    if (use.scale != Vec4f::Ones()) prim.add("float4", "inputs:scale", use.scale);
    if (!use.bias.isZero(0)) prim.add("float4", "inputs:bias", use.bias);
    for (const char* channel : {"r", "g", "b", "a"}) prim.add("float", std::string("outputs:") + channel);
    prim.add("float3", "outputs:rgb");
    std::string path = fmt::format("{}/{}.outputs:", path_, prim.name);
    uses_.push_back(use);
    textures_.push_back(std::move(prim));
    return path;
  }

  // Where the image of a texture lies beside the stage; taken along at the first call for it.
  std::optional<std::string> imagePath(Index texture) {
    const std::optional<Index> source = document_.textures[texture].source;
    if (!source) {  // in a format that an extension of the texture knows
      if (lost_.insert(texture).second) tellOfMissing(fmt::format("textures[{}]", texture));
      return std::nullopt;
    }
    const auto [known, isNew] = images_.try_emplace(*source);
    if (!isNew) return known->second;
    std::optional<Bytes> bytes = imageBytes(asset_, *source);
    const std::string_view format = bytes ? imageFormat(*bytes).extension : std::string_view();
    if (format != ".png" && format != ".jpg") {
      tellOfMissing(fmt::format("images[{}]", *source));
      return std::nullopt;
    }
    known->second = fmt::format("{}_{}{}", imageStem_, *source, format);
    files_.images.push_back({*known->second, std::move(*bytes)});
    return known->second;
  }

  void tellOfMissing(const std::string& where) {
    files_.warnings.add("unsupported-images", "textures that are neither PNG nor JPEG are left out", where);
  }

  const Asset& asset_;
  const gltf::Document& document_;
  const std::string& imageStem_;
  UsdFiles& files_;
  std::map<Index, std::optional<std::string>> images_;  // of the document
  std::set<Index> lost_;                                // textures without an image
  // Of the material that is being written:
  std::string path_, colorInput_;
  std::vector<UsdPrim> readers_, textures_;
  std::vector<UsdTexture> uses_;  // of textures_
};

}  // namespace

std::string uvPrimvar(Index uvSet) {
  return uvSet == 0 ? "st" : fmt::format("st{}", uvSet);
}

std::vector<std::string> addUsdMaterials(const Asset& asset, const std::vector<UsdSurface>& surfaces,
                                         const std::set<Index>& colored, const std::string& imageStem, UsdPrim& root,
                                         UsdFiles& files) {
  std::vector<std::string> paths;
  if (surfaces.empty()) return paths;
  UsdPrim scope{"Scope", kUsdMaterials, {}, {}, {}};
  MaterialWriter writer(asset, imageStem, files);
  UniqueNames names;
  for (Index m = 0; m < surfaces.size(); ++m) {
    const std::string& given = asset.document.materials[m].name;
    std::string name = names.add(usdName(given.empty() ? "material" : given));
    paths.push_back(fmt::format("/{}/{}/{}", kUsdRoot, scope.name, name));
    scope.children.push_back(writer.write(surfaces[m], colored.count(m) > 0, std::move(name), paths.back()));
    scope.children.back().display(given);
  }
  root.children.push_back(std::move(scope));
  return paths;
}

}  // namespace limber
