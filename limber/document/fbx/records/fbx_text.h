// FBX files that are text; parseFbx is what others call.
#pragma once

#include "limber/document/fbx/records/fbx_parse.h"

namespace limber {

FbxFile parseTextFbx(ByteSpan bytes);

}  // namespace limber
