#include "limber/preview/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/core/text/numbers.h"
#include "limber/preview/corner_normals.h"
#include "limber/preview/image/palette.h"
#include "limber/preview/overlay.h"
#include "limber/preview/part_scene.h"
#include "limber/preview/rasterizer.h"
#include "limber/preview/studio_light.h"

namespace limber {

namespace {

constexpr int kSmallest = 16, kLargest = 8192;
constexpr double kDotsBehind = 0.15;  // how much an opaque model covers the dots at its joints
constexpr double kShadowStrength = 0.62;
constexpr double kGroundFade = 2.0;  // radii of the model, where the ground's shadow has faded

// A mesh ready to be shaded: attributes by corner or by vertex.
struct Surface {
  const ProjectedMesh* mesh = nullptr;
  std::span<const Vec3f> positions;
  std::span<const Vec3f> cornerNormals;  // #F * 3, or empty
  std::span<const Vec3f> vertexNormals;  // where cornerNormals is empty
  std::span<const Vec3f> colors;         // by vertex
  const Scene* materials = nullptr;      // the scene whose materials count besides
};

// One piece of surface inside a pixel: samples that agree in normal and depth are shaded once.
struct Fragment {
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero(), color = Vec3::Zero();
  double samples = 0;
  Vec3 shaded = Vec3::Zero();
  double opacity = 1;

  void add(const Fragment& other) {
    position += other.position;
    normal += other.normal;
    color += other.color;
    samples += 1;
  }
  void average() {
    position /= samples;
    color /= samples;
    const double length = normal.norm();
    normal = length > 1e-9 ? Vec3(normal / length) : Vec3(Vec3::UnitY());
  }
};

struct PixelFragments {
  std::array<Fragment, kSamplesPerPixel> fragments;
  std::size_t count = 0;
  std::array<std::int8_t, kSamplesPerPixel> ofSample;  // -1: nothing there
};

// A colour that covers part of what is behind it, which is multiplied in already.
struct Cover {
  Vec3 color = Vec3::Zero();
  double opacity = 0;

  void putOver(const Vec3& front, double frontOpacity) {
    color += frontOpacity * (front - color);
    opacity += frontOpacity * (1 - opacity);
  }
};

class Painter {
 public:
  Painter(const Scene& scene, const PreviewOptions& options);
  Image paint() const;

 private:
  void paintTile(int column, int row, TileSamples& model, TileSamples& overlay, Image& image) const;
  void paintPixel(int x, int y, std::size_t sampleBase, const TileSamples& model, const TileSamples& overlay,
                  std::uint8_t* pixel) const;
  PixelFragments gather(const Surface& surface, const TileSamples& samples, std::size_t base, int x, int y) const;
  Fragment attributesAt(const Surface& surface, Index triangle, std::int32_t x, std::int32_t y) const;
  void shadeModel(Fragment& fragment) const;
  void shadeOverlay(Fragment& fragment) const;
  Cover background(double x, double y) const;
  double groundShadow(double x, double y) const;

  const PreviewOptions& options_;
  std::vector<Vec3f> normals_, colors_;
  ShapeMesh shapes_;
  Camera camera_;
  StudioLight light_;
  ProjectedMesh model_, overlay_;
  Surface modelSurface_, overlaySurface_;
  bool translucent_ = false;
  bool seeThrough_ = false;  // some materials are
  Vec3 groundMiddle_ = Vec3::Zero();
  double groundReach_ = 1;
};

Camera cameraFor(const Scene& scene, const PreviewOptions& options) {
  Box frame;
  Camera camera;
  if (options.frame) {
    frame = *options.frame;
    std::array<Vec3f, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        corners[i][axis] = static_cast<float>((i >> axis & 1) ? frame.max[axis] : frame.min[axis]);
      }
    }
    camera = frameCamera(corners, options.view, options.width, options.height);
  } else {
    for (const Vec3f& position : scene.positions) frame.add(position.cast<double>());
    camera = frameCamera(scene.positions, options.view, options.width, options.height);
  }
  const Mat3 turn = Eigen::AngleAxisd(options.turn * kDegree, Vec3::UnitY()).toRotationMatrix();
  camera.eye = frame.center() + turn * (camera.eye - frame.center());
  camera.axes = camera.axes * turn.transpose();
  return camera;
}

std::size_t channelsOf(const PreviewOptions& options) {
  return options.backdrop.kind == Backdrop::Kind::kTransparent ? 4 : 3;
}

// A fixed frame has a floor of its own: who jumps leaves it.
double groundOf(const Scene& scene, const PreviewOptions& options) {
  if (options.frame) return options.frame->min.y();
  double lowest = scene.positions.front().y();
  for (const Vec3f& p : scene.positions) lowest = std::min(lowest, double{p.y()});
  return lowest;
}

Painter::Painter(const Scene& scene, const PreviewOptions& options)
    : options_(options),
      normals_(cornerNormals(scene.positions, scene.triangles)),
      colors_(surfaceColors(scene, options)),
      shapes_(overlayShapes(scene, options)),
      camera_(cameraFor(scene, options)),
      light_(scene.positions, scene.triangles, options.view.azimuth + options.turn, groundOf(scene, options)),
      model_(scene.positions, scene.triangles, camera_),
      overlay_(shapes_.positions, shapes_.triangles, camera_) {
  const bool hasMaterials = options.show == PreviewShow::kModel && !scene.materials.empty();
  modelSurface_ = {&model_, scene.positions, normals_, {}, colors_, hasMaterials ? &scene : nullptr};
  overlaySurface_ = {&overlay_, shapes_.positions, {}, shapes_.normals, shapes_.colors, nullptr};
  if (hasMaterials) {
    seeThrough_ = std::any_of(scene.materials.begin(), scene.materials.end(),
                              [](const SceneMaterial& material) { return !material.isOpaque; });
  }
  translucent_ = options.show == PreviewShow::kHandles || options.show == PreviewShow::kBones ||
                 options.show == PreviewShow::kAnatomy;
  Box box;
  for (const Vec3f& p : scene.positions) box.add(p.cast<double>());
  groundMiddle_ = box.center();
  groundMiddle_.y() = light_.groundHeight();
  groundReach_ = std::max(1e-9, 0.5 * box.diagonal()) * kGroundFade;
}

const SceneMaterial* materialAt(const Scene& scene, Index triangle) {
  const Index material = scene.materialOf[triangle];
  return material == kNoIndex ? nullptr : &scene.materials[material];
}

Vec2f uvAt(const Scene& scene, const Triangle& triangle, const Vec3& weights) {
  Vec2f uv = Vec2f::Zero();
  for (std::size_t c = 0; c < 3; ++c) {
    uv += static_cast<float>(weights[static_cast<Eigen::Index>(c)]) * scene.uvs[triangle[c]];
  }
  return uv;
}

// Cut-outs as they are cut; what is half transparent covers half of the samples, other ones from triangle to triangle,
// so that layers over each other let ever less through.
bool coversSample(const Scene& scene, const ProjectedMesh& mesh, Index number, std::int32_t x, std::int32_t y,
                  std::size_t sample) {
  const SceneMaterial* const material = materialAt(scene, number);
  if (!material || material->isOpaque) return true;
  double alpha = material->opacity;
  if (material->texture) {
    alpha *= material->texture->alphaAt(uvAt(scene, scene.triangles[number], mesh.barycentric(number, x, y)));
  }
  if (material->cutoff) return alpha >= *material->cutoff;
  return alpha * kSamplesPerPixel > static_cast<double>((sample + 3 * number) % kSamplesPerPixel) + 0.5;
}

Image Painter::paint() const {
  Image image{options_.width, options_.height, {}, channelsOf(options_)};
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * image.channels);
  const int columns = (image.width + kTileSize - 1) / kTileSize, rows = (image.height + kTileSize - 1) / kTileSize;
  parallelFor(std::size_t(columns) * std::size_t(rows), 4, [&](std::size_t begin, std::size_t end) {
    TileSamples model, overlay;
    for (std::size_t tile = begin; tile < end; ++tile) {
      paintTile(int(tile) % columns, int(tile) / columns, model, overlay, image);
    }
  });
  return image;
}

void Painter::paintTile(int column, int row, TileSamples& model, TileSamples& overlay, Image& image) const {
  model.clear();
  overlay.clear();
  SampleCover covers;
  if (seeThrough_) {
    covers = [this](Index triangle, std::int32_t x, std::int32_t y, std::size_t sample) {
      return coversSample(*modelSurface_.materials, model_, triangle, x, y, sample);
    };
  }
  rasterizeTile(model_, column, row, model, covers);
  rasterizeTile(overlay_, column, row, overlay);
  for (int y = 0; y < kTileSize && row * kTileSize + y < image.height; ++y) {
    for (int x = 0; x < kTileSize && column * kTileSize + x < image.width; ++x) {
      const int px = column * kTileSize + x, py = row * kTileSize + y;
      const std::size_t base = (std::size_t(y) * kTileSize + std::size_t(x)) * kSamplesPerPixel;
      const std::size_t index = std::size_t(py) * std::size_t(image.width) + std::size_t(px);
      paintPixel(px, py, base, model, overlay, image.pixels.data() + index * image.channels);
    }
  }
}

// The texture's colour at a point of a triangle; white where it has none. One level serves the whole triangle: that in
// which a pixel of the picture has about two in each direction, of which the samples in it see most.
Vec3 textureColor(const Surface& surface, Index number, const Vec3& weights) {
  const Scene& scene = *surface.materials;
  const SceneMaterial* const material = materialAt(scene, number);
  if (!material || !material->texture) return Vec3::Ones();
  const Texture& texture = *material->texture;
  const Triangle& triangle = scene.triangles[number];
  const Vec2f &a = scene.uvs[triangle[0]], &b = scene.uvs[triangle[1]], &c = scene.uvs[triangle[2]];
  const auto area = [](double x1, double y1, double x2, double y2) { return std::abs(x1 * y2 - x2 * y1); };
  const auto vertices = surface.mesh->vertices();
  const auto &pa = vertices[triangle[0]], &pb = vertices[triangle[1]], &pc = vertices[triangle[2]];
  constexpr double kSubpixelArea = 256.0 * 256.0;
  const double seen = area(double(pb.x) - pa.x, double(pb.y) - pa.y, double(pc.x) - pa.x, double(pc.y) - pa.y);
  const double texels =
      area(b.x() - a.x(), b.y() - a.y(), c.x() - a.x(), c.y() - a.y()) * texture.width() * texture.height();
  const double level = seen > 0 && texels > 0 ? 0.5 * std::log2(texels * kSubpixelArea / seen) - 1 : 0.0;
  return texture.sample(uvAt(scene, triangle, weights), level);
}

Fragment Painter::attributesAt(const Surface& surface, Index number, std::int32_t x, std::int32_t y) const {
  const Triangle& triangle = surface.mesh->triangles()[number];
  const Vec3 weights = surface.mesh->barycentric(number, x, y);
  Fragment fragment;
  for (std::size_t c = 0; c < 3; ++c) {
    const double w = weights[static_cast<Eigen::Index>(c)];
    const Vec3f& normal = surface.cornerNormals.empty() ? surface.vertexNormals[triangle[c]]
                                                        : surface.cornerNormals[std::size_t{number} * 3 + c];
    fragment.position += w * surface.positions[triangle[c]].cast<double>();
    fragment.normal += w * normal.cast<double>();
    fragment.color += w * surface.colors[triangle[c]].cast<double>();
  }
  if (surface.materials) fragment.color = fragment.color.cwiseProduct(textureColor(surface, number, weights));
  const Vec3 a = surface.positions[triangle[0]].cast<double>();
  const Vec3 face =
      (surface.positions[triangle[1]].cast<double>() - a).cross(surface.positions[triangle[2]].cast<double>() - a);
  // The visible side counts, whatever the winding of the file's triangles.
  if (face.dot(camera_.eye - fragment.position) < 0) fragment.normal = -fragment.normal;
  return fragment;
}

PixelFragments Painter::gather(const Surface& surface, const TileSamples& samples, std::size_t base, int x,
                               int y) const {
  PixelFragments result;
  result.ofSample.fill(-1);
  for (std::size_t s = 0; s < kSamplesPerPixel; ++s) {
    const Index triangle = samples.triangle[base + s];
    if (triangle == kNoIndex) continue;
    const Fragment sample =
        attributesAt(surface, triangle, x * 256 + kSampleOffsets[s][0] * 16, y * 256 + kSampleOffsets[s][1] * 16);
    std::size_t group = 0;
    for (; group < result.count; ++group) {
      const Fragment& other = result.fragments[group];
      const Vec3 mean = other.position / other.samples;
      const bool level = (mean - sample.position).squaredNorm() < 0.0001 * (mean - camera_.eye).squaredNorm();
      if (level && other.normal.dot(sample.normal) > 0.9 * other.normal.norm() * sample.normal.norm()) break;
    }
    if (group == result.count) ++result.count;
    result.fragments[group].add(sample);
    result.ofSample[s] = static_cast<std::int8_t>(group);
  }
  for (std::size_t g = 0; g < result.count; ++g) result.fragments[g].average();
  return result;
}

void Painter::shadeModel(Fragment& fragment) const {
  const Vec3 toViewer = (camera_.eye - fragment.position).normalized();
  const StudioLight::Shade shade = translucent_ ? light_.shadeUnshadowed(fragment.normal, toViewer)
                                                : light_.shade(fragment.position, fragment.normal, toViewer);
  const double grazing = 1 - std::clamp(fragment.normal.dot(toViewer), 0.0, 1.0);
  const double fresnel = 0.04 + 0.5 * grazing * grazing * grazing * grazing * grazing;
  fragment.shaded = fragment.color.cwiseProduct(shade.diffuse) + fresnel * 4 * shade.specular;
  if (translucent_) fragment.opacity = 0.26 + 0.55 * grazing * grazing;
}

void Painter::shadeOverlay(Fragment& fragment) const {
  const Vec3 toViewer = (camera_.eye - fragment.position).normalized();
  const StudioLight::Shade shade = light_.shadeUnshadowed(fragment.normal, toViewer);
  fragment.shaded = fragment.color.cwiseProduct(shade.diffuse) + 0.25 * shade.specular;
}

// The studio is bright, and a little darker towards the corners. Pixels, from the upper left corner.
Cover backdropAt(double x, double y, const PreviewOptions& options) {
  if (options.backdrop.kind == Backdrop::Kind::kTransparent) return {};
  if (options.backdrop.kind == Backdrop::Kind::kColor) return {options.backdrop.color, 1};
  const double across = 2 * x / options.width - 1, down = 2 * y / options.height - 1;
  const double vignette = 1 - 0.012 * (across * across + down * down);
  const double level = (0.925 - 0.045 * (0.5 + 0.5 * down)) * vignette;
  return {level * Vec3(0.985, 0.995, 1.01), 1};
}

// How dark the model's shadow makes the ground there, 0 to 1.
double Painter::groundShadow(double x, double y) const {
  const Vec3 ray = camera_.ray(x, y);
  if (ray.y() >= -1e-6) return 0;
  const Vec3 ground = camera_.eye + ray * ((light_.groundHeight() - camera_.eye.y()) / ray.y());
  const double away = (ground - groundMiddle_).norm() / groundReach_;
  if (away >= 1 || ray.dot(ground - camera_.eye) < 0) return 0;
  const double fade = 1 - away * away;
  return kShadowStrength * fade * fade * (1 - light_.groundLight(ground));
}

Cover Painter::background(double x, double y) const {
  Cover cover = backdropAt(x, y, options_);
  double shadow = groundShadow(x, y);
  // A transparent picture is laid over others in sRGB, where the same darkness is another fraction.
  if (cover.opacity == 0) shadow = 1 - srgbByte(1 - shadow) / 255.0;
  cover.putOver(Vec3::Zero(), shadow);
  return cover;
}

// Keeps colours up to 0.6 as they are and rolls what is brighter off towards 1.
double rollOff(double value) {
  return value < 0.6 ? value : 1 - 0.16 / (value - 0.2);
}

// `color` has the opacity multiplied in.
void writePixel(const Vec3& color, double opacity, std::size_t channels, std::uint8_t* pixel) {
  if (channels == 3) {
    for (int c = 0; c < 3; ++c) pixel[c] = srgbByte(color[c]);
    return;
  }
  for (int c = 0; c < 3; ++c) pixel[c] = opacity > 0 ? srgbByte(color[c] / opacity) : std::uint8_t{0};
  pixel[3] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(opacity, 0.0, 1.0)));
}

void Painter::paintPixel(int x, int y, std::size_t base, const TileSamples& modelSamples,
                         const TileSamples& overlaySamples, std::uint8_t* pixel) const {
  PixelFragments model = gather(modelSurface_, modelSamples, base, x, y);
  PixelFragments overlay = gather(overlaySurface_, overlaySamples, base, x, y);
  for (std::size_t g = 0; g < model.count; ++g) shadeModel(model.fragments[g]);
  for (std::size_t g = 0; g < overlay.count; ++g) shadeOverlay(overlay.fragments[g]);
  bool open = false;
  for (std::size_t s = 0; s < kSamplesPerPixel; ++s) {
    open = open || (overlay.ofSample[s] < 0 && (translucent_ || model.ofSample[s] < 0));
  }
  const Cover behind = open ? background(x + 0.5, y + 0.5) : Cover{};

  // Whatever is inside is seen through the whole model, even where it sticks out: one look for all handles.
  Cover sum;
  for (std::size_t s = 0; s < kSamplesPerPixel; ++s) {
    Cover cover = behind;
    const bool inside = overlay.ofSample[s] >= 0;
    if (inside) cover.putOver(overlay.fragments[std::size_t(overlay.ofSample[s])].shaded.unaryExpr(&rollOff), 1);
    if (model.ofSample[s] >= 0) {
      const Fragment& front = model.fragments[std::size_t(model.ofSample[s])];
      cover.putOver(front.shaded.unaryExpr(&rollOff), inside && !translucent_ ? kDotsBehind : front.opacity);
    }
    sum.color += cover.color;
    sum.opacity += cover.opacity;
  }
  writePixel(sum.color / kSamplesPerPixel, sum.opacity / kSamplesPerPixel, channelsOf(options_), pixel);
}

void checkPictureSize(const PreviewOptions& options) {
  if (options.width < kSmallest || options.height < kSmallest || options.width > kLargest ||
      options.height > kLargest) {
    throw Error(ErrorCode::kBadArgument, "a picture is 16 to 8192 pixels wide and high");
  }
}

}  // namespace

PreviewShow parsePreviewShow(std::string_view name) {
  if (name == "model") return PreviewShow::kModel;
  if (name == "handles") return PreviewShow::kHandles;
  if (name == "weights") return PreviewShow::kWeights;
  if (name == "bones") return PreviewShow::kBones;
  if (name == "anatomy") return PreviewShow::kAnatomy;
  if (name == "parts") return PreviewShow::kParts;
  if (name == "stretch") return PreviewShow::kStretch;
  throw Error(ErrorCode::kBadArgument, "there is no picture of \"" + std::string(name) + "\"", "",
              "use model, handles, weights, bones, anatomy, parts or stretch");
}

Backdrop parseBackdrop(std::string_view text) {
  if (text == "studio") return {};
  if (text == "transparent") return {Backdrop::Kind::kTransparent, Vec3::Zero()};
  std::array<unsigned, 3> bytes;
  char rest = 0;
  const bool isColor = text.size() == 7 && std::sscanf(std::string(text).c_str(), "#%2x%2x%2x%c", &bytes[0], &bytes[1],
                                                       &bytes[2], &rest) == 3;
  if (!isColor) {
    throw Error(ErrorCode::kBadArgument, "there is no background \"" + std::string(text) + "\"", "",
                "use studio, transparent, or a colour such as #ffffff");
  }
  const Vec3f color = linearFromSrgb(int(bytes[0]), int(bytes[1]), int(bytes[2]));
  return {Backdrop::Kind::kColor, color.cast<double>()};
}

Image render(const Scene& scene, const PreviewOptions& options) {
  checkPictureSize(options);
  if (scene.positions.empty()) throw Error(ErrorCode::kBadArgument, "there is nothing to show");
  if (options.show == PreviewShow::kParts) return Painter(coloredByParts(scene, options.partOf), options).paint();
  return Painter(scene, options).paint();
}

Image renderBackdrop(const PreviewOptions& options) {
  checkPictureSize(options);
  Image image{options.width, options.height, {}, channelsOf(options)};
  image.pixels.resize(std::size_t(image.width) * std::size_t(image.height) * image.channels);
  std::uint8_t* pixel = image.pixels.data();
  for (int y = 0; y < options.height; ++y) {
    for (int x = 0; x < options.width; ++x, pixel += image.channels) {
      const Cover cover = backdropAt(x + 0.5, y + 0.5, options);
      writePixel(cover.color, cover.opacity, image.channels, pixel);
    }
  }
  return image;
}

}  // namespace limber
