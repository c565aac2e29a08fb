#include "limber/rigging/roles/part_contacts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "limber/core/shortest_paths.h"
#include "limber/geometry/mesh/vertex_triangles.h"

namespace limber {

namespace {

constexpr double kMinBorder = 0.04;  // heights of a border: shorter ones are where samples of two parts lie close

// The sample that is nearest to each vertex along edges; none on components without a sample.
std::vector<std::optional<std::size_t>> nearestSamples(const TriMesh& mesh, std::span<const SurfaceSample> samples) {
  const Grouped<Index> trianglesAt = trianglesAtVertices(mesh.triangles, mesh.vertexCount());
  std::vector<double> distances(mesh.vertexCount(), std::numeric_limits<double>::infinity());
  std::vector<std::optional<std::size_t>> nearest(mesh.vertexCount());
  std::vector<Index> sources;
  for (std::size_t s = 0; s < samples.size(); ++s) {
    for (const Index v : mesh.triangles[samples[s].triangle]) {
      const double distance = (mesh.position(v) - samples[s].position).norm();
      if (!(distance < distances[v])) continue;
      distances[v] = distance;
      nearest[v] = s;
      sources.push_back(v);
    }
  }
  const auto forEachNeighbour = [&](Index v, const auto& visit) {
    for (const Index next : neighboursOf(v, mesh.triangles, trianglesAt)) {
      visit(next, (mesh.position(next) - mesh.position(v)).norm());
    }
  };
  shortenPaths<Index>(sources, distances, forEachNeighbour, [&](Index from, Index to) { nearest[to] = nearest[from]; });
  return nearest;
}

bool isAnyPart(std::string_view limb) {
  return limb == "other" || limb == "prop" || limb == "ear" || limb == "wing" || limb == "fin" || limb == "mid";
}

// Whether bodies have these next to each other.
bool areNeighbours(std::string_view onePart, std::string_view otherPart) {
  const RoleName one = splitName(onePart), other = splitName(otherPart);
  if (isAnyPart(one.limb) || isAnyPart(other.limb)) return true;
  if (one.limb == other.limb && one.side == other.side) return true;
  const auto isTrunk = [](const RoleName& part) {
    return part.limb == "trunk" || part.limb == "neck" || part.limb == "head" || part.limb == "tail";
  };
  if (isTrunk(one) && isTrunk(other)) return true;
  if (isTrunk(one)) return other.segment == "upper" && one.limb != "head";
  if (isTrunk(other)) return one.segment == "upper" && other.limb != "head";
  return one.segment == "upper" && other.segment == "upper";  // where legs part, and at the shoulders of animals
}

}  // namespace

std::vector<PartContact> grownTogether(const TriMesh& mesh, std::span<const SurfaceSample> samples,
                                       std::span<const std::string_view> partOf, double height) {
  const std::vector<std::optional<std::size_t>> nearest = nearestSamples(mesh, samples);
  std::map<std::pair<std::string, std::string>, double> lengths;
  for (const Triangle& t : mesh.triangles) {
    if (!nearest[t[0]] || !nearest[t[1]] || !nearest[t[2]]) continue;
    std::array<std::string_view, 3> parts;
    for (int i = 0; i < 3; ++i) parts[i] = partOf[*nearest[t[i]]];
    // The border runs between the middles of the two edges that cross it; it is shared by both parts of one corner.
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3, last = (i + 2) % 3;
      if (parts[i] == parts[next] || parts[i] == parts[last] || parts[next] != parts[last]) continue;
      if (areNeighbours(parts[i], parts[next])) continue;
      const auto [one, other] = std::minmax({std::string(parts[i]), std::string(parts[next])});
      lengths[{one, other}] += 0.5 * (mesh.position(t[next]) - mesh.position(t[last])).norm() / height;
    }
  }
  std::vector<PartContact> contacts;
  for (const auto& [parts, length] : lengths) {
    if (length > kMinBorder) contacts.push_back({parts.first, parts.second, length});
  }
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const PartContact& a, const PartContact& b) { return a.length > b.length; });
  return contacts;
}

std::vector<PartContact> grownTogether(const TriMesh& mesh, const RoleReading& reading) {
  const SurfaceSamples samples = transformed(reading.samples(), reading.frame().axes.transpose());
  std::vector<std::string_view> parts;
  for (std::size_t s = 0; s < samples.samples.size(); ++s) parts.push_back(reading.partOf(s));
  return grownTogether(mesh, samples.samples, parts, reading.frame().height);
}

}  // namespace limber
