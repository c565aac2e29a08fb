// A scene as one file.
#pragma once

#include <span>

#include "limber/session/scene/scene.h"

namespace limber {

// SessionScene::exportModel, for several members.
Bytes exportScene(std::span<const SceneMember> members, ExportFormat format);

}  // namespace limber
