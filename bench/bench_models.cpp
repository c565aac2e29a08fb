#include "bench_models.h"

#include <algorithm>
#include <cmath>

#include "limber/core/text/numbers.h"
#include "limber/document/gltf/accessor.h"
#include "limber/document/write.h"

namespace limber::bench {

namespace {

struct Limb {
  Vec3 a, b;
  double radiusA, radiusB;

  double area() const {
    return kPi * ((radiusA + radiusB) * (b - a).norm() + 2 * (radiusA * radiusA + radiusB * radiusB));
  }
};

// A little off any mirror symmetry, so that the general case is measured.
const std::vector<Limb>& limbs() {
  static const std::vector<Limb> kLimbs = {{{-0.20, 0.42, 0.00}, {0.16, 0.45, 0.01}, 0.095, 0.085},
                                           {{0.16, 0.45, 0.01}, {0.28, 0.62, 0.02}, 0.06, 0.045},
                                           {{0.28, 0.62, 0.02}, {0.33, 0.66, 0.02}, 0.065, 0.06},
                                           {{0.33, 0.66, 0.02}, {0.43, 0.61, 0.03}, 0.05, 0.025},
                                           {{0.31, 0.70, 0.05}, {0.30, 0.79, 0.09}, 0.02, 0.01},
                                           {{0.31, 0.70, -0.01}, {0.30, 0.78, -0.05}, 0.02, 0.01},
                                           {{-0.22, 0.45, 0.00}, {-0.35, 0.52, 0.01}, 0.05, 0.035},
                                           {{-0.35, 0.52, 0.01}, {-0.45, 0.66, 0.02}, 0.035, 0.022},
                                           {{-0.45, 0.66, 0.02}, {-0.50, 0.78, 0.00}, 0.022, 0.012},
                                           {{-0.20, 0.38, 0.07}, {-0.21, 0.21, 0.09}, 0.055, 0.035},
                                           {{-0.21, 0.21, 0.09}, {-0.19, 0.05, 0.09}, 0.035, 0.028},
                                           {{-0.19, 0.05, 0.09}, {-0.14, 0.03, 0.09}, 0.03, 0.025},
                                           {{-0.20, 0.38, -0.07}, {-0.22, 0.21, -0.09}, 0.055, 0.035},
                                           {{-0.22, 0.21, -0.09}, {-0.20, 0.05, -0.09}, 0.035, 0.028},
                                           {{-0.20, 0.05, -0.09}, {-0.15, 0.03, -0.09}, 0.03, 0.025},
                                           {{0.14, 0.40, 0.06}, {0.15, 0.21, 0.08}, 0.05, 0.033},
                                           {{0.15, 0.21, 0.08}, {0.14, 0.05, 0.08}, 0.033, 0.027},
                                           {{0.14, 0.40, -0.06}, {0.13, 0.21, -0.08}, 0.05, 0.033},
                                           {{0.13, 0.21, -0.08}, {0.13, 0.05, -0.08}, 0.033, 0.027}};
  return kLimbs;
}

// A capsule of rings about its axis, with a vertex at each end: rings * around + 2 vertices.
void appendLimb(const Limb& limb, Index rings, Index around, TriMesh& mesh) {
  const Vec3 axis = (limb.b - limb.a).normalized();
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  const Index first = mesh.vertexCount();
  const auto point = [&](double along, double turn) {  // along: 0 at one end, 1 at the other
    const double angle = along * kPi;
    const Vec3 center = limb.a + std::clamp(1.5 * along - 0.25, 0.0, 1.0) * (limb.b - limb.a);
    const double radius = limb.radiusA + along * (limb.radiusB - limb.radiusA);
    const Vec3 out = std::cos(turn) * u + std::sin(turn) * v;
    return Vec3f((center + radius * (std::sin(angle) * out - std::cos(angle) * axis)).cast<float>());
  };
  for (Index ring = 1; ring <= rings; ++ring)
    for (Index i = 0; i < around; ++i) mesh.positions.push_back(point(ring / (rings + 1.0), 2 * kPi * i / around));
  const Index bottom = mesh.vertexCount(), top = bottom + 1;
  mesh.positions.push_back(point(0, 0));
  mesh.positions.push_back(point(1, 0));
  for (Index i = 0; i < around; ++i) {
    const Index next = (i + 1) % around, last = first + (rings - 1) * around;
    mesh.triangles.push_back({bottom, first + next, first + i});
    mesh.triangles.push_back({top, last + i, last + next});
    for (Index row = first; row < last; row += around) {
      mesh.triangles.push_back({row + i, row + next, row + around + next});
      mesh.triangles.push_back({row + i, row + around + next, row + around + i});
    }
  }
}

}  // namespace

TriMesh robot(Index vertices) {
  double area = 0;
  for (const Limb& limb : limbs()) area += limb.area();
  TriMesh mesh;
  for (const Limb& limb : limbs()) {
    const double fraction = vertices * limb.area() / area;
    const double length = (limb.b - limb.a).norm() + limb.radiusA + limb.radiusB;
    const double girth = kPi * (limb.radiusA + limb.radiusB);
    const Index around = std::max<Index>(6, static_cast<Index>(std::lround(std::sqrt(fraction * girth / length))));
    appendLimb(limb, std::max<Index>(3, static_cast<Index>(std::lround(fraction / around))), around, mesh);
  }
  return mesh;
}

void writeMeshGlb(const TriMesh& mesh, const std::filesystem::path& path) {
  Asset asset;
  std::vector<float> positions;
  for (const Vec3f& p : mesh.positions) positions.insert(positions.end(), {p.x(), p.y(), p.z()});
  gltf::Primitive primitive;
  primitive.attributes.set("POSITION", addFloatAccessor(asset, positions, 3, kVertexTarget, true));
  const auto* indices = reinterpret_cast<const std::uint8_t*>(mesh.triangles.data());
  const AccessorInfo info{3 * mesh.triangleCount(), 1, ComponentType::kU32};
  primitive.indices = addAccessor(asset, info, {indices, mesh.triangles.size() * sizeof(Triangle)}, kIndexTarget);
  gltf::Document& document = asset.document;
  document.meshes.emplace_back().primitives.push_back(std::move(primitive));
  gltf::Node& node = document.nodes.emplace_back();
  node.name = "model";
  node.mesh = 0;
  document.scenes.emplace_back().nodes = {0};
  document.scene = 0;
  writeAsset(asset, path);
}

}  // namespace limber::bench
