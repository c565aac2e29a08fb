// Files and bytes to an Asset.
#pragma once

#include <functional>
#include <optional>
#include <string_view>

#include "limber/document/asset.h"

namespace limber {

// Opens what a document refers to: nullopt if there is no such file. `path` is relative, decoded, with '/'; one that
// leads out of the document's folder is refused before asking, or by folderResolver. A browser gives its own.
using Resolver = std::function<std::optional<Bytes>(std::string_view path)>;

// Opens plain files, and links to such, in and below the folder; throws Error kBadData on a path that leads out of it.
Resolver folderResolver(const std::filesystem::path& folder);

// The file of that name; "-" is standard input (format told from the content). Format by content first (GLB magic,
// JSON, "ply", ...), by extension where content does not tell. Throws Error, with the file's name in where(). The
// result has passed checkAsset.
Asset readAsset(const std::filesystem::path& path);

// The same from memory. `name` gives the extension and appears in messages. A buffer that cannot be opened is an Error,
// an image is a warning "missing-images" and stays a reference. An FBX file may come in an archive that does not
// compress (stored_archive.h), together with its pictures, under the model's name. Compressed geometry is decompressed,
// with a warning "decompressed"; invalid weights become 0 (weight_repair.h). A motion (BVH, or arrays in SMPL's form)
// becomes nodes with a clip (motionAsset), read without options. Time and memory are bounded by the sizes of the file
// and of what it refers to.
Asset readAsset(ByteSpan bytes, std::string_view name, const Resolver& resolver = {});

// An OBJ file as readAsset reads it, but vertices that it numbers differently stay apart, and the last COLOR_n of each
// primitive tells their numbers: (n % kObjNumberBase, n / kObjNumberBase, 0, 1) for n from 0. For what else the file
// says of its vertices, see obj_vertices.h in pipeline.
Asset readNumberedObj(ByteSpan bytes, std::string_view name, const Resolver& resolver = {});

}  // namespace limber
