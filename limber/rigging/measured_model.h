// What the template rigger measures of a model, whatever skeleton is asked for.
#pragma once

#include <memory>
#include <optional>

#include "limber/reading/surface_samples.h"
#include "limber/reading/weights_file.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/roles/role_reading.h"

namespace limber {

struct MeasuredModel {
  Index vertices = 0, triangles = 0;  // of the mesh
  std::optional<Vec3> up, front;      // as they were given
  std::shared_ptr<const ReadingWeights> weights;
  std::optional<TriMesh> cleared;  // of stray pieces (withoutStrays); none where the mesh has none
  BodyVolume body;
  SurfaceSamples samples;
  RoleReading reading;      // without known joints
  std::size_t fingers = 0;  // countFingers; 0 where the body is hardly upright
  std::size_t legs = 0;     // countLegs; 0 where the body hardly has many

  const AnatomicalFrame& frame() const { return reading.frame(); }
};

// Reads up, front and networks of the options (shapeWeights where they have none); asks their memory first, and leaves
// the result there. Throws Error as measureBody, sampleSurface and readSamples do.
std::shared_ptr<const MeasuredModel> measureModel(const TriMesh& mesh, const RigOptions& options);

}  // namespace limber
