#include "limber/geometry/solve/laplacian.h"

#include <algorithm>
#include <numeric>

#include "limber/geometry/solve/intrinsic_triangulation.h"

namespace limber {

namespace {

struct ColumnEntry {
  int row;
  double weight;
};

// Calls visit(low, high, weight, length) for each edge that has a positive weight, also those from a vertex to itself.
template <class Visit>
void forEachWeightedEdge(const IntrinsicTriangulation& t, const Visit& visit) {
  for (Index h = 0; h < t.sideCount(); ++h) {
    const Index twin = t.twin[h];
    const Index a = t.from[h], b = t.from[twin];
    if (twin < h) continue;
    // Half the sum of cotangents; half of that again where the cover has each triangle twice.
    const double weight = (t.twoSided[a] ? 0.25 : 0.5) * (t.cotangent[h] + t.cotangent[twin]);
    if (weight > 0) visit(std::min(a, b), std::max(a, b), weight, t.length[h]);
  }
}

// Sorts the entries of one column by row and adds up those of the same row. Returns how many are left.
int mergeColumn(ColumnEntry* entries, int count) {
  std::sort(entries, entries + count, [](const ColumnEntry& a, const ColumnEntry& b) {
    return a.row != b.row ? a.row < b.row : a.weight < b.weight;
  });
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    if (kept > 0 && entries[kept - 1].row == entries[i].row) {
      entries[kept - 1].weight += entries[i].weight;
    } else {
      entries[kept++] = entries[i];
    }
  }
  return kept;
}

Eigen::SparseMatrix<double> assembleStiffness(const IntrinsicTriangulation& t, int vertexCount) {
  std::vector<int> first(vertexCount + std::size_t{1}, 0);
  forEachWeightedEdge(t, [&](Index low, Index high, double, double) { first[low + 1] += low != high; });
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<ColumnEntry> entries(first.back());
  std::vector<int> end(first.begin(), first.end() - 1);
  std::vector<double> diagonal(vertexCount, 0);
  forEachWeightedEdge(t, [&](Index low, Index high, double weight, double) {
    if (low == high) return;  // says that the vertex equals itself
    entries[end[low]++] = {static_cast<int>(high), weight};
    diagonal[low] += weight;
    diagonal[high] += weight;
  });

  Eigen::SparseMatrix<double> stiffness(vertexCount, vertexCount);
  int* outer = stiffness.outerIndexPtr();
  outer[0] = 0;
  for (int v = 0; v < vertexCount; ++v) {
    outer[v + 1] = outer[v] + 1 + mergeColumn(entries.data() + first[v], end[v] - first[v]);
  }
  stiffness.resizeNonZeros(outer[vertexCount]);
  for (int v = 0; v < vertexCount; ++v) {
    int at = outer[v];
    stiffness.innerIndexPtr()[at] = v;
    stiffness.valuePtr()[at] = diagonal[v];
    for (const ColumnEntry* e = entries.data() + first[v]; ++at < outer[v + 1]; ++e) {
      stiffness.innerIndexPtr()[at] = e->row;
      stiffness.valuePtr()[at] = -e->weight;
    }
  }
  return stiffness;
}

}  // namespace

Laplacian robustLaplacian(const TriMesh& mesh, const std::vector<Index>& piece) {
  IntrinsicTriangulation triangulation = tuftedCover(mesh, piece);
  delaunayFlips(triangulation);
  Laplacian result;
  result.mass = Eigen::VectorXd::Zero(mesh.vertexCount());
  forEachWeightedEdge(triangulation, [&](Index a, Index b, double weight, double length) {
    result.mass[a] += 0.25 * weight * length * length;
    result.mass[b] += 0.25 * weight * length * length;
  });
  result.stiffness = assembleStiffness(triangulation, static_cast<int>(mesh.vertexCount()));
  return result;
}

}  // namespace limber
