// The materials of VRM 0.x as MToon of VRM 1.0.
#pragma once

#include "limber/document/asset.h"

namespace limber {

// "materialProperties" of VRM 0.x as VRMC_materials_mtoon 1.0 of the document's materials, with KHR_materials_unlit for
// readers that do not know MToon; unlit shaders as KHR_materials_unlit alone. Numbers are converted as three-vrm and
// UniVRM do. Materials of other shaders stay as glTF has them; warning "vrm0-materials" where that is not what 0.x
// asked for. Transparent materials are drawn in the order of their render queues, ten at most, as 1.0 has them.
void convertVrm0Materials(Asset& asset, const Json& materialProperties);

}  // namespace limber
