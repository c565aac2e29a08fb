// The positions of a template's joints inside a model.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "limber/rigging/body/anatomical_frame.h"
#include "limber/rigging/body/body_volume.h"
#include "limber/rigging/templates/template_skeleton.h"

namespace limber {

using TemplatePins = std::vector<std::optional<Vec3>>;  // given positions in body space, one for each joint

// Whether every pin has its mirror image: of the joint of the other side, of its own in the middle.
bool pinnedEvenly(const TemplateSkeleton& skeleton, const TemplatePins& pins);

struct TemplateEmbedding {
  std::vector<Vec3> positions;  // body space, one for each joint of the template
  std::vector<double> costs;    // before refinement, of each joint and the bone that leads to it; 0 for joints between
  double cost = 0;              // mean over the placed joints; about 1 for a body that is like the template
};

struct EmbeddingOptions {
  std::size_t maxSpheres = 1000;  // that are looked at, 1 or more
  bool refine = true;             // joints may leave the spheres for positions nearby that cost less
};

// Embeds the placed joints at medial spheres and ends of the model, all at once, so that the sum of penalties is the
// least that there is: for a bone's length and direction against the template's, for its length outside the model, for
// positions off the middle of a part, far from those in the template, on the wrong side, and for tips that are no end
// of the model. As penalties tie only a joint to the one above, the best embedding follows by dynamic programming over
// the tree (Felzenszwalb, Huttenlocher 2005) where Baran and Popović (2007) search best-first. As theirs it is then
// refined: the same penalties are lowered further by small steps of single joints. A symmetric body gets a symmetric
// embedding: its middle and one side are embedded, the other side is their mirror image.
//
// A class, since bones between all pairs of positions are measured once for all variants of a template.
class TemplateEmbedder {
 public:
  // Of this body, which must outlive it.
  //
  // skeleton  says which joints there are
  // pins      #J; Error kBadArgument where they are not
  // Cost: O(S^2) paths through the body, for S spheres.
  TemplateEmbedder(const TemplateSkeleton& skeleton, const BodyVolume& body, const AnatomicalFrame& frame,
                   const TemplatePins& pins, const EmbeddingOptions& options = {});
  ~TemplateEmbedder();
  TemplateEmbedder(TemplateEmbedder&&) noexcept;
  TemplateEmbedder& operator=(TemplateEmbedder&&) noexcept;

  const BodyVolume& body() const { return *body_; }
  const AnatomicalFrame& frame() const { return frame_; }
  const TemplatePins& pins() const { return pins_; }

  // variants  one template, or the same with joints at other positions; one embedding for each
  // Throws Error kBadArgument where variants do not have the same joints. Cost: O(J S^2) each.
  std::vector<TemplateEmbedding> embed(std::span<const TemplateVariant> variants);

 private:
  class Search;

  const BodyVolume* body_;
  AnatomicalFrame frame_;
  TemplatePins pins_;
  std::unique_ptr<Search> search_;
};

}  // namespace limber
