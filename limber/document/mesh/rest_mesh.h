// A model as a mesh alone, for formats that hold nothing else.
#pragma once

#include "limber/document/mesh/mesh_export.h"

namespace limber {

// exportMesh of a model in its rest pose, with blend shapes as the nodes have them; skins that were bound in several
// poses are brought to one. Adds what such formats cannot keep to the warnings: lost-rig, lost-clips, lost-shapes.
// Throws Error kBadData where the scene has no triangle.
ExportMesh exportRestMesh(const Asset& asset, Warnings& warnings);

}  // namespace limber
