#include "limber/document/fbx/records/fbx_node.h"

namespace limber {

const FbxNode* FbxNode::find(std::string_view child) const {
  for (const FbxNode& node : children) {
    if (node.name == child) return &node;
  }
  return nullptr;
}

}  // namespace limber
