#include "limber/reading/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limber/core/error.h"
#include "limber/core/parallel.h"
#include "limber/geometry/mesh/areas.h"
#include "limber/geometry/mesh/components.h"
#include "limber/reading/pcg32.h"

namespace limber {

namespace {

// Least cosine between a normal and the displacement from another point, for that point to bound the ball: the rim has
// points beside it that bound nothing.
constexpr double kMinCosine = 0.3;
constexpr double kMaxRadius = 0.25;    // of the diagonal of the points' box
constexpr double kFlippedRatio = 2.5;  // of median radii, above which normals point inwards
constexpr std::array<float, 3> kFrequencies = {1.5f, 3, 6};

struct RandomPoint {
  Vec3 position, normal;
  Index triangle;
};

struct MeasuredTriangles {
  std::vector<Index> triangles;          // those with an area
  std::vector<double> cumulativeAreas;   // up to and with each of these
  std::vector<double> componentAreas;    // by component
  std::vector<Index> componentOfVertex;  // #V
};

MeasuredTriangles measureTriangles(const TriMesh& mesh) {
  MeasuredTriangles result;
  Index components = 0;
  result.componentOfVertex = vertexComponents(mesh, &components);
  result.componentAreas.assign(components, 0);
  double total = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) {
    const double area = triangleArea(mesh, mesh.triangles[t]);
    if (area == 0) continue;
    total += area;
    result.triangles.push_back(t);
    result.cumulativeAreas.push_back(total);
    result.componentAreas[result.componentOfVertex[mesh.triangles[t][0]]] += area;
  }
  if (!(total > 0 && std::isfinite(total))) {
    throw Error(ErrorCode::kBadData, total == 0 ? "the mesh has no surface" : "the mesh's area is no finite number");
  }
  return result;
}

RandomPoint drawPoint(const TriMesh& mesh, const MeasuredTriangles& measured, Pcg32& random) {
  const double area = random.uniform() * measured.cumulativeAreas.back();
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto& sums = measured.cumulativeAreas;
  const auto found = std::min(std::upper_bound(sums.begin(), sums.end(), area), sums.end() - 1);
  const Index triangle = measured.triangles[static_cast<std::size_t>(found - sums.begin())];
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3 pa = mesh.position(a), pb = mesh.position(b), pc = mesh.position(c);
  return {(1 - u - v) * pa + u * pb + v * pc, (pb - pa).cross(pc - pa).normalized(), triangle};
}

Vec3 meanPosition(const std::vector<RandomPoint>& points) {
  Vec3 sum = Vec3::Zero();
  for (const RandomPoint& point : points) sum += point.position;
  return sum / static_cast<double>(points.size());
}

// Indices of points, the first the farthest from the mean, each further one the farthest from all before it. Of equal
// ones the lowest.
std::vector<std::size_t> farthestFirst(const std::vector<RandomPoint>& points, std::size_t count) {
  const auto distancesTo = [&](const Vec3& center, std::size_t i) {
    return (points[i].position - center).squaredNorm();
  };
  const Vec3 mean = meanPosition(points);
  std::vector<double> distances(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) distances[i] = distancesTo(mean, i);
  std::vector<std::size_t> chosen;
  while (true) {
    chosen.push_back(
        static_cast<std::size_t>(std::max_element(distances.begin(), distances.end()) - distances.begin()));
    if (chosen.size() == count) return chosen;
    const Vec3 last = points[chosen.back()].position;
    const bool first = chosen.size() == 1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double distance = distancesTo(last, i);
      distances[i] = first ? distance : std::min(distances[i], distance);
    }
  }
}

struct TouchingBalls {
  double inner, outer;  // radii
};

// The largest balls that touch a point on either side of its surface and have none of the others inside, but for those
// beside the point.
TouchingBalls touchingBalls(const std::vector<RandomPoint>& points, const RandomPoint& at, double maxRadius) {
  TouchingBalls result = {maxRadius, maxRadius};
  for (const RandomPoint& other : points) {
    const Vec3 displacement = at.position - other.position;
    const double height = displacement.dot(at.normal), squared = displacement.squaredNorm();
    if (!(height * height > kMinCosine * kMinCosine * squared)) continue;
    double& radius = height > 0 ? result.inner : result.outer;
    if (squared < 2 * std::abs(height) * radius) radius = squared / (2 * std::abs(height));
  }
  return result;
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// Radii of the samples' inner balls; turns all normals round where they point inwards.
void measureBalls(const std::vector<RandomPoint>& points, const std::vector<std::size_t>& chosen,
                  SurfaceSamples& result) {
  Box box;
  for (const RandomPoint& point : points) box.add(point.position);
  std::vector<double> inner(chosen.size()), outer(chosen.size());
  parallelFor(chosen.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const TouchingBalls balls = touchingBalls(points, points[chosen[i]], kMaxRadius * box.diagonal());
      inner[i] = balls.inner;
      outer[i] = balls.outer;
    }
  });
  result.normalsFlipped = medianOf(inner) > kFlippedRatio * medianOf(outer);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    result.samples[i].innerRadius = result.normalsFlipped ? outer[i] : inner[i];
    if (result.normalsFlipped) result.samples[i].normal = -result.samples[i].normal;
  }
}

void measureFrame(SurfaceSamples& result) {
  const auto count = static_cast<double>(result.samples.size());
  Vec3 sum = Vec3::Zero();
  for (const SurfaceSample& sample : result.samples) sum += sample.position;
  result.center = sum / count;
  double squares = 0;
  for (const SurfaceSample& sample : result.samples) squares += (sample.position - result.center).squaredNorm();
  result.scale = squares > 0 ? std::sqrt(squares / count) : 1;
}

}  // namespace

SurfaceSamples sampleSurface(const TriMesh& mesh, std::size_t count) {
  if (count < 1 || count > kSurfacePoints) throw Error(ErrorCode::kBadArgument, "a surface has 1 to 4096 samples");
  const MeasuredTriangles measured = measureTriangles(mesh);
  Pcg32 random;
  std::vector<RandomPoint> points;
  points.reserve(kSurfacePoints);
  for (std::size_t i = 0; i < kSurfacePoints; ++i) points.push_back(drawPoint(mesh, measured, random));

  const std::vector<std::size_t> chosen = farthestFirst(points, count);
  SurfaceSamples result;
  for (const std::size_t i : chosen) {
    const Index component = measured.componentOfVertex[mesh.triangles[points[i].triangle][0]];
    const double fraction = measured.componentAreas[component] / measured.cumulativeAreas.back();
    result.samples.push_back({points[i].position, points[i].normal, 0, fraction, points[i].triangle});
  }
  measureBalls(points, chosen, result);
  measureFrame(result);
  return result;
}

SurfaceSamples transformed(SurfaceSamples samples, const Mat3& matrix) {
  for (SurfaceSample& sample : samples.samples) {
    sample.position = (matrix * sample.position).eval();
    sample.normal = (matrix * sample.normal).eval();
  }
  samples.center = (matrix * samples.center).eval();
  return samples;
}

SurfaceSamples mirrored(const SurfaceSamples& samples) {
  return transformed(samples, Vec3(-1, 1, 1).asDiagonal().toDenseMatrix());
}

FloatMatrix sampleFeatures(const SurfaceSamples& samples) {
  FloatMatrix features(samples.samples.size(), kSampleFeatures);
  for (std::size_t i = 0; i < samples.samples.size(); ++i) {
    const SurfaceSample& sample = samples.samples[i];
    float* feature = features.row(i);
    const Vec3f position = samples.toNetwork(sample.position).cast<float>();
    const auto put = [&](const Vec3f& values) { feature = std::copy(values.begin(), values.end(), feature); };
    put(position);
    put(sample.normal.cast<float>());
    put(samples.toNetwork(sample.position - sample.innerRadius * sample.normal).cast<float>());
    *feature++ = static_cast<float>(sample.innerRadius / samples.scale);
    *feature++ = static_cast<float>(sample.componentFraction);
    for (const float frequency : kFrequencies) {
      Vec3f sines, cosines;
      for (int axis = 0; axis < 3; ++axis) {
        const SineCosine value = portableSineCosine(frequency * position[axis]);
        sines[axis] = value.sine;
        cosines[axis] = value.cosine;
      }
      put(sines);
      put(cosines);
    }
  }
  return features;
}

}  // namespace limber
