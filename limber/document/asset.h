// A file's content, kept whole, including everything that limber does not touch.
#pragma once

#include <string>
#include <vector>

#include "limber/core/error.h"
#include "limber/core/file/file.h"
#include "limber/document/gltf/gltf.h"

namespace limber {

// A glTF document with the bytes it refers to. Other formats become one on reading.
//
// What limber adds goes after what is there. Every buffer's bytes are in memory; buffers read from a GLB's binary
// chunk, a data URI or a side file are treated alike, and `uri` records which it was. Images beside the file are read
// too, so that a written copy is complete.
//
// Moves cheaply; copying is explicit through clone().
struct Asset {
  struct Buffer {
    Bytes bytes;      // as many as its byteLength in the document
    std::string uri;  // empty: the GLB's binary chunk, or made by limber; the start of a data URI up to its comma (the
                      // document has no more of it either); else a relative path, and the bytes are that file's
  };
  struct SideFile {  // an image that the document names by relative path
    std::string uri;
    Bytes bytes;
  };

  Asset() = default;
  Asset(Asset&&) noexcept = default;
  Asset& operator=(Asset&&) noexcept = default;
  Asset clone() const { return Asset(*this); }

  gltf::Document document;
  std::vector<Buffer> buffers;  // one for each of document.buffers, in order
  std::vector<SideFile> sideFiles;
  std::string name;    // for messages: the file's name
  std::string format;  // "glb", "gltf", "obj", "ply", "stl", "off", "fbx", "dae", "bvh"
  Warnings warnings;   // what reading had to convert, decode or leave out

 private:
  Asset(const Asset&) = default;
};

// Walks the whole document and throws Error kBadData, with the path of the element ("meshes[0].primitives[2].indices"),
// on the first thing that breaks what the rest of limber relies on: every index in range, every accessor inside its
// buffer view and that inside its buffer, no cycle among nodes, one parent at most, finite numbers where numbers are
// wanted, vertex attributes of one primitive equally long, triangle indices below the vertex count.
void checkAsset(const Asset& asset);

}  // namespace limber
