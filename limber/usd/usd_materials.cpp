#include "limber/usd/usd_materials.h"

#include <functional>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "limber/asset/images.h"
#include "limber/asset/unique_names.h"

namespace limber {

namespace {

std::string colorText(const Vec3& color) {
  return fmt::format("({}, {}, {})", usdNumber(color.x()), usdNumber(color.y()), usdNumber(color.z()));
}

// One texture of a material as it is asked for.
struct TextureInput {
  const char* shader;  // the name of its prim
  const char* output;  // "rgb", "r"
  std::string scale, bias;
  bool isColor = false;
};

class MaterialWriter {
 public:
  MaterialWriter(const Asset& asset, const std::string& imageStem, UsdText& text, UsdFiles& files)
      : asset_(asset), document_(asset.document), imageStem_(imageStem), text_(text), files_(files) {}

  std::vector<std::string> write() {
    if (document_.materials.empty()) return {};
    UniqueNames names;
    text_.open("Scope", "Materials");
    for (const gltf::Material& material : document_.materials) {
      const std::string name = names.add(usdName(material.name.empty() ? "material" : material.name));
      paths_.push_back(fmt::format("/{}/Materials/{}", kUsdRoot, name));
      writeMaterial(material, name);
    }
    text_.close();
    return std::move(paths_);
  }

 private:
  void writeMaterial(const gltf::Material& material, const std::string& name) {
    const gltf::MetallicRoughness surface = material.pbrMetallicRoughness.value_or(gltf::MetallicRoughness());
    const Vec4 color = surface.baseColorFactor.value_or(Vec4::Ones());
    const bool blends = material.alphaMode == "BLEND", masks = material.alphaMode == "MASK";
    path_ = paths_.back();
    textures_.clear();
    text_.open("Material", name);
    text_.line(fmt::format("token outputs:surface.connect = <{}/Surface.outputs:surface>", path_));
    text_.open("Shader", "Surface");
    text_.line("uniform token info:id = \"UsdPreviewSurface\"");
    const std::string factors = fmt::format("({}, {}, {}, {})", usdNumber(color.x()), usdNumber(color.y()),
                                            usdNumber(color.z()), usdNumber(color.w()));
    input("color3f", "diffuseColor", surface.baseColorTexture, {"BaseColor", "rgb", factors, {}, true},
          colorText(color.head<3>()));
    if (blends || masks) {
      input("float", "opacity", surface.baseColorTexture, {"BaseColor", "a", factors, {}, true}, usdNumber(color.w()));
    }
    if (masks) text_.line(fmt::format("float inputs:opacityThreshold = {}", usdNumber(material.alphaCutoff)));
    const auto scaled = [](double by) { return fmt::format("({0}, {0}, {0}, 1)", usdNumber(by)); };
    const std::optional<gltf::TextureUse>& rough = surface.metallicRoughnessTexture;
    input("float", "metallic", rough, {"Metallic", "b", scaled(surface.metallicFactor), {}},
          usdNumber(surface.metallicFactor));
    input("float", "roughness", rough, {"Roughness", "g", scaled(surface.roughnessFactor), {}},
          usdNumber(surface.roughnessFactor));
    if (material.normalTexture) {
      input("normal3f", "normal", material.normalTexture, {"Normal", "rgb", "(2, 2, 2, 1)", "(-1, -1, -1, 0)"}, {});
    }
    if (material.occlusionTexture) {
      input("float", "occlusion", material.occlusionTexture, {"Occlusion", "r", {}, {}}, {});
    }
    const Vec3& glow = material.emissiveFactor;
    if (!glow.isZero(0)) {
      const std::string scale =
          fmt::format("({}, {}, {}, 1)", usdNumber(glow.x()), usdNumber(glow.y()), usdNumber(glow.z()));
      input("color3f", "emissiveColor", material.emissiveTexture, {"Emissive", "rgb", scale, {}, true},
            colorText(glow));
    }
    text_.line("token outputs:surface");
    text_.close();
    if (!textures_.empty()) writePlaces();
    for (const auto& [shader, write] : textures_) write();
    text_.close();
  }

  // What all textures of a material read their places on the surface by.
  void writePlaces() {
    text_.open("Shader", "Uv");
    text_.line("uniform token info:id = \"UsdPrimvarReader_float2\"");
    text_.line("string inputs:varname = \"st\"");
    text_.line("float2 outputs:result");
    text_.close();
  }

  // A connection to the texture where it can be had, else the value, if there is one.
  void input(std::string_view type, std::string_view name, const std::optional<gltf::TextureUse>& use,
             const TextureInput& as, const std::string& value) {
    const std::optional<std::string> image = use ? imagePath(use->index) : std::nullopt;
    if (image) {
      text_.line(fmt::format("{} inputs:{}.connect = <{}/{}.outputs:{}>", type, name, path_, as.shader, as.output));
      textures_.try_emplace(as.shader, [this, use = *use, as, image = *image] { writeTexture(use, as, image); });
    } else if (!value.empty()) {
      text_.line(fmt::format("{} inputs:{} = {}", type, name, value));
    }
  }

  void writeTexture(const gltf::TextureUse& use, const TextureInput& as, const std::string& image) {
    const gltf::Texture& texture = document_.textures[use.index];
    const gltf::Sampler sampler = texture.sampler ? document_.samplers[*texture.sampler] : gltf::Sampler();
    const auto wrap = [](Index mode) {
      return mode == gltf::kClampToEdge ? "clamp" : mode == gltf::kMirroredRepeat ? "mirror" : "repeat";
    };
    text_.open("Shader", as.shader);
    text_.line("uniform token info:id = \"UsdUVTexture\"");
    text_.line(fmt::format("asset inputs:file = @{}@", image));
    text_.line(fmt::format("float2 inputs:st.connect = <{}/Uv.outputs:result>", path_));
    text_.line(fmt::format("token inputs:sourceColorSpace = \"{}\"", as.isColor ? "sRGB" : "raw"));
    text_.line(fmt::format("token inputs:wrapS = \"{}\"", wrap(sampler.wrapS)));
    text_.line(fmt::format("token inputs:wrapT = \"{}\"", wrap(sampler.wrapT)));
    if (!as.scale.empty()) text_.line("float4 inputs:scale = " + as.scale);
    if (!as.bias.empty()) text_.line("float4 inputs:bias = " + as.bias);
    for (const char* output : {"float outputs:r", "float outputs:g", "float outputs:b", "float outputs:a"})
      text_.line(output);
    text_.line("float3 outputs:rgb");
    text_.close();
    if (use.extensions.exists()) {
      files_.warnings.add("texture-transforms", "places of textures are written without what extensions say of them",
                          path_);
    }
  }

  // Where the image of a texture lies beside the stage; taken along at the first call for it.
  std::optional<std::string> imagePath(Index texture) {
    const std::optional<Index> source = document_.textures[texture].source;
    if (!source) return std::nullopt;
    const auto [known, isNew] = images_.try_emplace(*source);
    if (!isNew) return known->second;
    std::optional<Bytes> bytes = imageBytes(asset_, *source);
    const std::string_view format = bytes ? imageFormat(*bytes).extension : std::string_view();
    if (format != ".png" && format != ".jpg") {
      files_.warnings.add("missing-images", "textures that are neither PNG nor JPEG are left out",
                          fmt::format("images[{}]", *source));
      return std::nullopt;
    }
    known->second = fmt::format("{}_{}{}", imageStem_, *source, format);
    files_.images.push_back({*known->second, std::move(*bytes)});
    return known->second;
  }

  const Asset& asset_;
  const gltf::Document& document_;
  const std::string& imageStem_;
  UsdText& text_;
  UsdFiles& files_;
  std::vector<std::string> paths_;
  std::map<Index, std::optional<std::string>> images_;     // of the document
  std::string path_;                                       // of the material that is being written
  std::map<std::string, std::function<void()>> textures_;  // its textures, by their prims
};

}  // namespace

std::vector<std::string> writeUsdMaterials(const Asset& asset, const std::string& imageStem, UsdText& text,
                                           UsdFiles& files) {
  return MaterialWriter(asset, imageStem, text, files).write();
}

}  // namespace limber
