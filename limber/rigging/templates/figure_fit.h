// A figure that was found in a body, as a fit of the humanoid template.
#pragma once

#include "limber/rigging/figure/figure_match.h"
#include "limber/rigging/templates/template_fit.h"

namespace limber {

// Whether a figure tells where the joints of this template are: it has the trunk, the arms and the legs of VRM's
// humanoid.
bool isHumanoid(const TemplateSkeleton& skeleton);

// What pins of a humanoid template (#J, body space) say of a figure, in the mesh's space: those of the spine, of
// fingers and the like say nothing.
std::vector<FigurePin> figurePins(const TemplateSkeleton& skeleton, const TemplatePins& pins,
                                  const AnatomicalFrame& frame);

// The humanoid template with its joints in the figure, except where they are pinned; its front is the figure's, its
// cost depends on how well the figure matches. A limb that hardly matches is left unmatched (TemplateLimb::hasMatch).
//
// pins   #J, in the body space of `frame`
// frame  of the body: its up direction, the ground, its height
TemplateFit fitOfFigure(const TemplateSkeleton& skeleton, const MatchedFigure& figure, const TemplatePins& pins,
                        const AnatomicalFrame& frame);

}  // namespace limber
