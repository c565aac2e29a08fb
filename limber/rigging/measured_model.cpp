#include "limber/rigging/measured_model.h"

#include "limber/geometry/surface/stray_pieces.h"
#include "limber/reading/learned_reading.h"
#include "limber/reading/shape_weights.h"
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
  auto model = std::make_shared<MeasuredModel>();
  model->vertices = mesh.vertexCount();
  model->triangles = mesh.triangleCount();
  model->up = options.up;
  model->front = options.front;
  model->weights = weights;
  model->cleared = withoutStrays(mesh);
  const TriMesh& surface = model->cleared ? *model->cleared : mesh;
  model->body = measureBody(surface);
  model->samples = sampleSurface(surface, weights->sampleCount());
  model->frame = likeliestFrame(possibleFrames(surface, model->body, options.up, options.front),
                                stanceOf(model->samples, *weights));
  if (options.memory) options.memory->measured = model;
  return model;
}

}  // namespace limber
