// The pose of a body, where it is not the template's.
#pragma once

#include "limber/rigging/templates/template_fit.h"

namespace limber {

// Bends the template of a fit that is pinned or doubtful, as long as that makes it cheaper: to where its joints were
// found, somewhat smaller and larger, embedding it anew each time (as iterated closest points do); then one limb after
// the other to ends of the body that no bone comes near. Fits that are good as they stand are left alone, and so are
// even bodies; without pins a pose must be much cheaper, and cheap.
//
// embedder  that the fit was found with
// Cost: some whole-body solves and embeddings for each bend.
void searchPose(TemplateEmbedder& embedder, TemplateFit& fit);

}  // namespace limber
