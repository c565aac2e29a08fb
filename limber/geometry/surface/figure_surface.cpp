#include "limber/geometry/surface/figure_surface.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/Eigenvalues>

#include "limber/core/sort_unique.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/bvh.h"
#include "limber/geometry/mesh/face_orientation.h"
#include "limber/geometry/mesh/winding_number.h"
#include "limber/geometry/surface/inner_copies.h"

namespace limber {

namespace {

constexpr std::size_t kMaxSurroundings = 8;  // components
constexpr double kMaxFlatness = 0.05;        // thickness of a floor or a wall, of its width
constexpr double kMinReach = 1.5;            // width of a floor, of that of the figure along the same axis
constexpr double kMaxSunken = 0.05;          // of the figure's size, below a floor
constexpr double kMaxAway = 1;               // of the figure's size, from a floor
constexpr double kMinThickness = 0.12;       // of the figure along a floor's normal, of its size
constexpr double kMaxFill = 0.5;             // of the figure's box, by its volume
constexpr double kMinColliderFit = 0.6;      // size of the figure along each axis, of that of a box round it
constexpr double kMinInCollider = 0.9;       // of the figure's vertices within a box round it
constexpr double kMaxPedestal = 0.5;         // height of a pedestal, of that of the figure
constexpr double kSole = 0.03;               // of the figure's height, from its lowest point: what rests on a pedestal
constexpr double kMinStride = 0.15;          // of the extent of the feet, the gap between them
constexpr std::size_t kSampled = 200;        // vertices or triangles of a component
constexpr double kStrayArea = 0.01;          // of the figure's largest component: smaller ones may lie anywhere

constexpr std::size_t kMaxShells = 64;       // components, the largest
constexpr double kMinCopyArea = 0.25;        // of the outer surface
constexpr double kMaxCopyArea = 1.1;         // of the outer surface: what has more is no copy, but a figure in a box
constexpr double kMinEnclosed = 0.75;        // of a shell's area within the outer surface
constexpr double kMaxSurfaceFraction = 0.5;  // of the figure's area that has shells
constexpr double kMaxRest = 0.05;            // of the figure's area, of what else lies within
constexpr double kMaxShellDistance = 0.03;   // sizes of the outer surface, of a shell from it in the mean
constexpr double kMaxBareDistance = 0.06;    // sizes of the outer surface, from it to a shell below it
constexpr double kMinCovered = 0.85;         // of the outer surface's area with a shell below it

using Component = SurfaceComponent;

TriMesh meshOf(const TriMesh& mesh, const Component& component) {
  TriMesh part{mesh.positions, {}};
  for (const Index t : component.triangles) part.triangles.push_back(mesh.triangles[t]);
  return part;
}

// Evenly chosen vertices of a component.
std::vector<Vec3> samplesOf(const TriMesh& mesh, std::span<const Index> vertices) {
  std::vector<Vec3> samples;
  const std::size_t count = std::min(kSampled, vertices.size());
  for (std::size_t i = 0; i < count; ++i) samples.push_back(mesh.position(vertices[i * vertices.size() / count]));
  return samples;
}

bool isWithin(const Box& inner, const Box& outer, double margin) {
  return (inner.min.array() >= outer.min.array() - margin).all() &&
         (inner.max.array() <= outer.max.array() + margin).all();
}

// The extent of vertices along three axes, the rows of a matrix.
Box extentAlong(const TriMesh& mesh, const Mat3& axes, std::span<const Index> vertices) {
  Box extent;
  for (const Index v : vertices) extent.add(axes * mesh.position(v));
  return extent;
}

// The principal axes of a component's surface as rows, the one along which it is thinnest first.
Mat3 principalAxes(const TriMesh& mesh, const Component& component) {
  Mat3 moments = Mat3::Zero();
  for (const Index t : component.triangles) {
    const Triangle& corners = mesh.triangles[t];
    const double area = triangleArea(mesh, corners);
    for (std::size_t k = 0; k < 3; ++k) {  // a triangle's second moments are those of the middles of its edges
      const Vec3 middle = 0.5 * (mesh.position(corners[k]) + mesh.position(corners[(k + 1) % 3]));
      const Vec3 arm = middle - component.box.center();
      moments += area * arm * arm.transpose();
    }
  }
  return Eigen::SelfAdjointEigenSolver<Mat3>(moments).eigenvectors().transpose();
}

// The figure in front of its surroundings.
struct Figure {
  std::vector<Index> vertices;
  Box box;
  bool isHollow = false;

  Figure(const TriMesh& mesh, std::span<const Component> components) {
    double volume = 0, largest = 0;
    for (const Component& component : components) largest = std::max(largest, component.area);
    for (const Component& component : components) {
      if (component.area < kStrayArea * largest) continue;
      vertices.insert(vertices.end(), component.vertices.begin(), component.vertices.end());
      box.add(component.box.min);
      box.add(component.box.max);
      const auto corner = [&](Index v) { return Vec3(mesh.position(v) - component.box.center()); };
      double six = 0;
      for (const Index t : component.triangles) {
        const auto& [a, b, c] = mesh.triangles[t];
        six += corner(a).dot(corner(b).cross(corner(c)));
      }
      volume += std::abs(six) / 6;
    }
    isHollow = volume < kMaxFill * box.size().prod();
  }
};

// A floor, a wall or a slab that could be surroundings of something, or a convex component.
struct Backdrop {
  const Component& component;
  Mat3 axes;
  Box extent;
  bool isFlat = false, isConvex = false;

  Backdrop(const TriMesh& mesh, const Component& of) : component(of), axes(principalAxes(mesh, of)) {
    extent = extentAlong(mesh, axes, of.vertices);
    isFlat = extent.size().x() <= kMaxFlatness * std::min(extent.size().y(), extent.size().z());
    isConvex = !isFlat && liesBehindItsFaces(mesh);
  }

  bool surrounds(const TriMesh& mesh, const Figure& figure) const {
    return figure.isHollow && (isFlat ? isFloorOf(mesh, figure) : isColliderOf(mesh, figure));
  }

 private:
  bool liesBehindItsFaces(const TriMesh& mesh) const {
    const std::vector<Vec3> corners = samplesOf(mesh, component.vertices);
    const double tolerance = 1e-3 * extent.diagonal();
    const std::size_t count = std::min(kSampled, component.triangles.size());
    for (std::size_t i = 0; i < count; ++i) {
      const Triangle& t = mesh.triangles[component.triangles[i * component.triangles.size() / count]];
      const Vec3 a = mesh.position(t[0]), normal = (mesh.position(t[1]) - a).cross(mesh.position(t[2]) - a);
      if (!(normal.norm() > 0)) continue;
      double low = 0, high = 0;
      for (const Vec3& corner : corners) {
        const double height = normal.normalized().dot(corner - a);
        low = std::min(low, height);
        high = std::max(high, height);
      }
      if (std::min(-low, high) > tolerance) return false;
    }
    return true;
  }

  bool isFloorOf(const TriMesh& mesh, const Figure& figure) const {
    const Box body = extentAlong(mesh, axes, figure.vertices);
    const double size = figure.box.longestSide();
    for (const int axis : {1, 2}) {
      if (extent.size()[axis] < kMinReach * body.size()[axis]) return false;
      if (body.min[axis] < extent.min[axis] - kMaxSunken * size) return false;
      if (body.max[axis] > extent.max[axis] + kMaxSunken * size) return false;
    }
    const double before = body.min.x() - extent.max.x(), behind = extent.min.x() - body.max.x();
    const double away = std::max(before, behind);
    return away > -kMaxSunken * size && away < kMaxAway * size && body.size().x() > kMinThickness * size;
  }

  bool isColliderOf(const TriMesh& mesh, const Figure& figure) const {
    const Vec3 size = component.box.size();
    if (!isWithin(figure.box, component.box, kMaxSunken * size.maxCoeff())) return false;
    if ((figure.box.size().array() < kMinColliderFit * size.array()).any()) return false;
    const WindingNumber winding(meshOf(mesh, component));
    const std::vector<Vec3> samples = samplesOf(mesh, figure.vertices);
    const auto enclosed = std::count_if(samples.begin(), samples.end(),
                                        [&](const Vec3& sample) { return std::abs(winding.at(sample)) > 0.5; });
    return static_cast<double>(enclosed) >= kMinInCollider * static_cast<double>(samples.size());
  }
};

// How many of the components, which begin with the largest, are surroundings of all the others.
std::size_t backdropsAmong(const TriMesh& mesh, std::span<const Component> components) {
  std::vector<Backdrop> backdrops;
  while (backdrops.size() + 1 < components.size() && backdrops.size() < kMaxSurroundings) {
    const Backdrop backdrop(mesh, components[backdrops.size()]);
    if (!backdrop.isFlat && !backdrop.isConvex) break;
    backdrops.push_back(backdrop);
  }
  for (std::size_t count = backdrops.size(); count > 0; --count) {
    const Figure figure(mesh, components.subspan(count));
    if (std::all_of(backdrops.begin(), backdrops.begin() + static_cast<std::ptrdiff_t>(count),
                    [&](const Backdrop& backdrop) { return backdrop.surrounds(mesh, figure); })) {
      return count;
    }
  }
  return 0;
}

// From where to where something reaches along an axis.
using Reach = std::pair<double, double>;

// Whether what reaches so leaves a gap, as two feet do.
bool leavesGap(std::vector<Reach> reaches) {
  std::sort(reaches.begin(), reaches.end());
  double end = reaches.front().second, widest = 0;
  for (const auto& [from, to] : reaches) {
    widest = std::max(widest, from - end);
    end = std::max(end, to);
  }
  return widest > kMinStride * (end - reaches.front().first);
}

bool isStep(const TriMesh& mesh, const Component& component) {
  const Backdrop backdrop(mesh, component);
  return backdrop.isFlat || backdrop.isConvex;
}

// Whether all others stand on a component with feet, +Y up.
bool restsOn(const TriMesh& mesh, const Component& component, std::span<const Component> others) {
  const Figure figure(mesh, others);
  const double height = figure.box.size().y(), top = component.box.max.y();
  if (!figure.isHollow || component.box.size().y() > kMaxPedestal * height) return false;
  if (std::abs(figure.box.min.y() - top) > kMaxSunken * height) return false;
  std::vector<Reach> x, z;
  for (const Component& other : others) {
    for (const Index t : other.triangles) {
      Box sole;
      for (const Index v : mesh.triangles[t]) {
        if (mesh.position(v).y() < figure.box.min.y() + kSole * height) sole.add(mesh.position(v));
      }
      if (sole.empty()) continue;
      x.push_back({sole.min.x(), sole.max.x()});
      z.push_back({sole.min.z(), sole.max.z()});
      sole.min.y() = sole.max.y() = top;
      if (!isWithin(sole, component.box, 0)) return false;
    }
  }
  return leavesGap(std::move(x)) || leavesGap(std::move(z));
}

// The lowest component, where all others lie above it.
std::optional<std::size_t> lowestOf(std::span<const Component> components) {
  const auto lowest =
      std::min_element(components.begin(), components.end(),
                       [](const Component& a, const Component& b) { return a.box.min.y() < b.box.min.y(); });
  Box all;
  for (const Component& component : components) {
    all.add(component.box.min);
    all.add(component.box.max);
  }
  const double low = lowest->box.max.y() - kMaxSunken * all.size().y();
  for (auto other = components.begin(); other != components.end(); ++other) {
    if (other != lowest && other->box.min.y() < low) return std::nullopt;
  }
  return static_cast<std::size_t>(lowest - components.begin());
}

// What is no part of the figure among the components.
std::vector<Component> surroundingsAmong(const TriMesh& mesh, std::vector<Component> components) {
  const auto count = static_cast<std::ptrdiff_t>(backdropsAmong(mesh, components));
  std::vector<Component> surroundings(components.begin(), components.begin() + count);
  components.erase(components.begin(), components.begin() + count);
  std::vector<Component> steps, others = components;  // of a pedestal, from below
  while (others.size() > 1) {
    const std::optional<std::size_t> lowest = lowestOf(others);
    if (!lowest) break;
    steps.push_back(others[*lowest]);
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(*lowest));
    if (!isStep(mesh, steps.back())) break;
    if (!restsOn(mesh, steps.back(), others)) continue;
    surroundings.insert(surroundings.end(), steps.begin(), steps.end());
    break;
  }
  return surroundings;
}

// How much of a component's area lies within what a winding number is of.
double enclosedFraction(const TriMesh& mesh, const Component& component, const WindingNumber& winding) {
  double area = 0, enclosed = 0;
  for (const AreaSample& sample : areaSamplesOf(mesh, component)) {
    area += sample.area;
    if (std::abs(winding.at(sample.position)) > 0.5) enclosed += sample.area;
  }
  return area > 0 ? enclosed / area : 0;
}

struct Shells {
  std::vector<Component> components, outers;    // outers: those that copies lie within
  std::vector<std::pair<Index, Index>> copies;  // vertices of a shell with those that they are copies of
};

// Whether one component is a copy of another one's surface within it. Where the outer one is thin, as in fingers, a
// copy may come out of it.
bool isInnerShell(const TriMesh& mesh, const Component& inner, const Component& outer) {
  const double size = outer.box.longestSide();
  if (inner.area < kMinCopyArea * outer.area || inner.area > kMaxCopyArea * outer.area) return false;
  if (!isWithin(inner.box, outer.box, kMaxShellDistance * size)) return false;
  const TriMesh outerMesh = meshOf(mesh, outer);
  if (enclosedFraction(mesh, inner, WindingNumber(outerMesh)) < kMinEnclosed) return false;
  const Bvh outerSurface(outerMesh), innerSurface(mesh, inner.triangles);
  double area = 0, distance = 0;
  for (const AreaSample& sample : areaSamplesOf(mesh, inner)) {
    area += sample.area;
    distance += sample.area * outerSurface.nearestPoint(sample.position).distance;
  }
  if (distance > kMaxShellDistance * size * area) return false;
  double outerArea = 0, covered = 0;
  for (const AreaSample& sample : areaSamplesOf(mesh, outer)) {
    outerArea += sample.area;
    if (innerSurface.nearestPoint(sample.position).distance < kMaxBareDistance * size) covered += sample.area;
  }
  return covered >= kMinCovered * outerArea;
}

// Moves the copies of all components out of them.
Shells takeInnerCopies(const TriMesh& mesh, std::vector<Component>& components) {
  Shells shells;
  const std::vector<Component> all = std::exchange(components, {});
  std::vector<bool> isInner(all.size(), false);
  for (const auto& [outer, inner, isVertexByVertex] : innerCopies(mesh, all)) {
    isInner[inner] = true;
    shells.components.push_back(all[inner]);
    shells.outers.push_back(all[outer]);
    if (!isVertexByVertex) continue;
    for (std::size_t k = 0; k < all[inner].vertices.size(); ++k) {
      shells.copies.push_back({all[inner].vertices[k], all[outer].vertices[k]});
    }
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!isInner[i]) components.push_back(all[i]);
  }
  return shells;
}

// Moves inner shells out of the components. Where most of the surface has one, what else lies within a part that has
// one belongs to the shell, too, however little of it is left there.
Shells takeInnerShells(const TriMesh& mesh, std::vector<Component>& components) {
  Shells shells = takeInnerCopies(mesh, components);
  const auto copied = static_cast<std::ptrdiff_t>(shells.outers.size());
  for (std::size_t inner = std::min(kMaxShells, components.size()); inner-- > 1;) {
    const auto end = components.begin() + static_cast<std::ptrdiff_t>(inner);
    const auto outer =
        std::find_if(components.begin(), end, [&](const Component& other) { return isInnerShell(mesh, *end, other); });
    if (outer == end) continue;
    shells.components.push_back(*end);
    shells.outers.push_back(*outer);
    components.erase(end);
  }
  double all = 0, doubled = 0;
  for (const Component& component : components) all += component.area;
  for (const Component& outer : shells.outers) doubled += outer.area;
  if (doubled < kMaxSurfaceFraction * all) return shells;
  std::vector<WindingNumber> within;
  for (const Component& outer : shells.outers) within.emplace_back(meshOf(mesh, outer));
  const auto hasCopy = [&](const Component& component) {
    return std::any_of(shells.outers.begin(), shells.outers.begin() + copied,
                       [&](const Component& outer) { return outer.vertices.front() == component.vertices.front(); });
  };
  const auto isWithinOne = [&](const Component& component) {
    return component.area < kMaxRest * all && !hasCopy(component) &&
           std::any_of(within.begin(), within.end(), [&](const WindingNumber& winding) {
             return enclosedFraction(mesh, component, winding) >= kMinEnclosed;
           });
  };
  const auto rest = std::stable_partition(components.begin(), components.end(),
                                          [&](const Component& component) { return !isWithinOne(component); });
  shells.components.insert(shells.components.end(), rest, components.end());
  components.erase(rest, components.end());
  return shells;
}

// By source vertex whether it belongs to one of the components.
std::vector<bool> sourceVerticesOf(const PreparedMesh& prepared, std::span<const Component> components) {
  std::vector<bool> isOf(prepared.mesh.vertexCount(), false);
  for (const Component& component : components) {
    for (const Index v : component.vertices) isOf[v] = true;
  }
  std::vector<bool> isOfSource;
  for (const Index v : prepared.weldedVertex) isOfSource.push_back(isOf[v]);
  return isOfSource;
}

// The vertices that these source vertices became, ascending.
std::vector<Index> weldedFrom(const std::vector<bool>& isOfSource, const PreparedMesh& prepared) {
  std::vector<Index> vertices;
  for (std::size_t source = 0; source < isOfSource.size(); ++source) {
    if (isOfSource[source]) vertices.push_back(prepared.weldedVertex[source]);
  }
  sortUnique(vertices);
  return vertices;
}

// For each vertex of `innerShell` the one that it is a copy of, or kNoIndex.
//
// copies  vertices of the mesh that was prepared before, `weldedBefore`
std::vector<Index> outerOf(std::span<const Index> innerShell, std::span<const std::pair<Index, Index>> copies,
                           std::span<const Index> weldedBefore, const PreparedMesh& prepared) {
  std::vector<Index> sourceOf(prepared.mesh.vertexCount(), kNoIndex), outer(prepared.mesh.vertexCount(), kNoIndex);
  for (Index source = 0; source < weldedBefore.size(); ++source) {
    if (weldedBefore[source] < sourceOf.size()) sourceOf[weldedBefore[source]] = source;
  }
  for (const auto& [from, to] : copies) {
    outer[prepared.weldedVertex[sourceOf[from]]] = prepared.weldedVertex[sourceOf[to]];
  }
  std::vector<Index> result;
  for (const Index v : innerShell) result.push_back(outer[v]);
  return result;
}

// Beyond a figure alone all vertices of a floor would count as far away from it.
Warnings withFarVerticesOf(const Warnings& whole, const Warnings& figure) {
  constexpr std::string_view kKind = "far-vertices";
  Warnings result;
  for (const Warnings* from : {&whole, &figure}) {
    for (const Warning& warning : from->items()) {
      if ((warning.kind == kKind) == (from == &whole)) {
        result.add(warning.kind, warning.message, warning.where, warning.count);
      }
    }
  }
  return result;
}

void warnOfFaces(const MendedFaces& mended, Warnings& warnings) {
  warnings.add("repeated-faces", "triangles that lie on an earlier one count once", {}, mended.repeated);
  warnings.add(
      "reversed-faces",
      "triangles whose neighbours face the other way are taken the other way round (recalculate the normals in "
      "the file for programs that draw one side of a face)",
      {}, mended.reversed);
}

}  // namespace

FigureSurface figureSurface(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                            std::span<const StoredVertices> stored) {
  FigureSurface result{prepareMesh(positions, triangles, stored), {}, {}, {}};
  PreparedMesh& prepared = result.prepared;
  const MendedFaces mended = mendFaces(prepared.mesh);
  SurfaceComponents components = SurfaceComponents::of(prepared.mesh);
  std::vector<bool> isInner, isAround;
  std::vector<std::pair<Index, Index>> copies;
  bool isAlone = true;
  if (components.list.size() > 1) {
    Shells shells = takeInnerShells(prepared.mesh, components.list);
    const std::vector<Component> surroundings = surroundingsAmong(prepared.mesh, components.list);
    isInner = sourceVerticesOf(prepared, shells.components);
    isAround = sourceVerticesOf(prepared, surroundings);
    isAlone = shells.components.empty() && surroundings.empty();
    copies = std::move(shells.copies);
  }
  if (isAlone) {
    warnOfFaces(mended, prepared.warnings);
    return result;
  }
  std::vector<Triangle> figure;  // alone, for the frame is that of the figure
  std::size_t inner = 0, around = 0;
  for (const Triangle& t : triangles) {
    if (isInner[t[0]]) {
      ++inner;
    } else if (isAround[t[0]]) {
      ++around;
    } else {
      figure.push_back(t);
    }
  }
  const PreparedMesh before = std::exchange(prepared, prepareMesh(positions, figure, stored));
  prepared.warnings = withFarVerticesOf(before.warnings, prepared.warnings);
  warnOfFaces(mendFaces(prepared.mesh), prepared.warnings);
  result.innerShell = weldedFrom(isInner, prepared);
  result.innerShellOuter = outerOf(result.innerShell, copies, before.weldedVertex, prepared);
  result.surroundings = weldedFrom(isAround, prepared);
  prepared.warnings.add("surroundings",
                        "triangles of floors, walls, pedestals or boxes round the figure are no part of it; they "
                        "follow the root joint (take them out of the file if they are not to move)",
                        {}, around);
  prepared.warnings.add("inner-shell", "triangles of a copy of the surface within it take the weights of the outer one",
                        {}, inner);
  return result;
}

}  // namespace limber
