// URIs as glTF uses them: data inside the document, or files beside it.
#pragma once

#include <string>
#include <string_view>

#include "limber/core/file/file.h"

namespace limber {

bool isDataUri(std::string_view uri);

// "data:application/octet-stream;base64,AAAA" in its two parts. Throws Error kBadData on what is not base64.
struct DataUri {
  std::string header;  // up to and with the comma
  Bytes bytes;
};
DataUri decodeDataUri(std::string_view uri);

std::string encodeBase64(ByteSpan bytes);

// The relative path, with '/', that a URI reference names. Throws Error kBadData on anything that is not a plain path
// to something in or below the document's folder: a scheme, a host, an absolute path, "..", a control character.
std::string localPath(std::string_view uri);

// The same for a path that is none of a URI: nothing in it is decoded. Throws Error kBadData likewise.
void checkLocalPath(const std::string& path);

// The inverse: a relative path as a URI reference.
std::string percentEncode(std::string_view path);

}  // namespace limber
