// The kind of body that the learned reading sees in a model, and where it has the joints of that kind's skeleton.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limber/reading/weights_file.h"
#include "limber/rigging/auto_rigger.h"
#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/limb_matches.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

struct ReadTemplate {
  TemplateSkeleton skeleton;    // a template of limber's, or one of a kind of bodies (bodyKinds)
  std::vector<Vec3> positions;  // body space, of all joints
  AnatomicalFrame frame;
  std::vector<TemplateLimb> limbs;
  std::vector<TemplateMatch> matches;  // the kinds that are worth naming, the likeliest first: it is that of `skeleton`
  std::vector<std::string> doubts;     // as in AutoRig
};

// One reading of the shape (limber/reading) tells how the model stands, what kind of body it is and where its joints
// are; the middles and cuts of limbs refine those of people and four-legged animals within the errors that the reading
// expects. None where it is not sure of any kind (kSureTemplate).
//
// mesh, body  the surface and its inside, without stray pieces
// frames      possibleFrames of these
// Throws Error as sampleSurface does. Cost: that of sampleSurface, stanceOf and readSamples (65 ms on one core), and of
// landmarks.
std::optional<ReadTemplate> readTemplate(const TriMesh& mesh, const BodyVolume& body,
                                         const std::vector<AnatomicalFrame>& frames, const ReadingWeights& weights);

}  // namespace limber
