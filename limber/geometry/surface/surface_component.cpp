#include "limber/geometry/surface/surface_component.h"

#include <algorithm>

#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"

namespace limber {

SurfaceComponents SurfaceComponents::of(const TriMesh& mesh) {
  Index count = 0;
  const std::vector<Index> componentOf = vertexComponents(mesh, &count);
  std::vector<Index> ofTriangle;
  for (const Triangle& t : mesh.triangles) ofTriangle.push_back(componentOf[t[0]]);
  SurfaceComponents result{numbersByGroup(componentOf, count), numbersByGroup(ofTriangle, count), {}};
  for (Index c = 0; c < count; ++c) {
    SurfaceComponent component{result.vertices.of(c), result.triangles.of(c), {}, 0};
    if (component.triangles.empty()) continue;
    for (const Index v : component.vertices) component.box.add(mesh.position(v));
    for (const Index t : component.triangles) component.area += triangleArea(mesh, mesh.triangles[t]);
    result.list.push_back(component);
  }
  std::stable_sort(result.list.begin(), result.list.end(), [](const SurfaceComponent& a, const SurfaceComponent& b) {
    return a.box.diagonal() > b.box.diagonal();
  });
  return result;
}

std::vector<AreaSample> areaSamplesOf(const TriMesh& mesh, const SurfaceComponent& component, std::size_t count) {
  std::vector<AreaSample> samples;
  count = std::min(count, component.triangles.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& t = mesh.triangles[component.triangles[i * component.triangles.size() / count]];
    samples.push_back({(mesh.position(t[0]) + mesh.position(t[1]) + mesh.position(t[2])) / 3, triangleArea(mesh, t)});
  }
  return samples;
}

}  // namespace limber
