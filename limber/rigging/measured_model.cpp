#include "limber/rigging/measured_model.h"

#include <utility>

#include "limber/geometry/surface/stray_pieces.h"
#include "limber/reading/learned_reading.h"
#include "limber/reading/shape_weights.h"
#include "limber/rigging/kind_choice.h"
#include "limber/rigging/roles/finger_count.h"
#include "limber/rigging/roles/leg_count.h"
#include "limber/rigging/roles/likeliest_frame.h"

namespace limber {

std::shared_ptr<const MeasuredModel> measureModel(const TriMesh& mesh, const RigOptions& options) {
  const std::shared_ptr<const ReadingWeights> weights = options.reading ? options.reading : shapeWeights();
  if (options.memory && options.memory->measured) {
    const MeasuredModel& known = *options.memory->measured;
    const bool isSame = known.vertices == mesh.vertexCount() && known.triangles == mesh.triangleCount();
    const bool isAskedAlike = known.up == options.up && known.front == options.front && known.weights == weights;
    if (isSame && isAskedAlike) return options.memory->measured;
  }
  std::optional<TriMesh> cleared = withoutStrays(mesh);
  const TriMesh& surface = cleared ? *cleared : mesh;
  BodyVolume body = measureBody(surface);
  SurfaceSamples samples = sampleSurface(surface, weights->sampleCount());
  RoleReading reading = readInLikeliestFrame(possibleFrames(surface, body, options.up, options.front),
                                             stanceOf(samples, *weights), samples, *weights);
  const std::size_t fingers = reading.probability("upright") > kWorthNaming ? countFingers(surface, reading) : 0;
  const std::size_t legs = reading.probability("many") > kWorthNaming ? countLegs(body, reading) : 0;
  const auto model = std::make_shared<const MeasuredModel>(
      MeasuredModel{mesh.vertexCount(), mesh.triangleCount(), options.up, options.front, weights, std::move(cleared),
                    std::move(body), std::move(samples), std::move(reading), fingers, legs});
  if (options.memory) options.memory->measured = model;
  return model;
}

}  // namespace limber
