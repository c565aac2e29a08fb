#include "limber/document/fbx/records/fbx_parse.h"

#include <algorithm>

#include "limber/document/fbx/records/fbx_binary.h"
#include "limber/document/fbx/records/fbx_text.h"

namespace limber {

bool looksLikeFbx(ByteSpan bytes) {
  if (isBinaryFbx(bytes)) return true;
  constexpr std::size_t kHead = 4096;  // comments may come before the first record
  const std::string_view head(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), kHead));
  return head.starts_with("; FBX") || head.find("FBXHeaderExtension") != head.npos;
}

FbxFile parseFbx(ByteSpan bytes) {
  return isBinaryFbx(bytes) ? parseBinaryFbx(bytes) : parseTextFbx(bytes);
}

}  // namespace limber
