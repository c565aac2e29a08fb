// FBX files that are text; parseFbx is what others call.
#pragma once

#include "limber/fbx/fbx_parse.h"

namespace limber {

FbxFile parseTextFbx(ByteSpan bytes);

}  // namespace limber
