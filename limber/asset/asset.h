// What a file held, kept whole: the home of everything that limber does not touch.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "limber/core/error.h"
#include "limber/core/file.h"

namespace limber {

using Json = nlohmann::ordered_json;  // keeps the order of keys as read

// A glTF document with the bytes it refers to. Other formats become one on reading.
//
// The JSON is kept as read; what limber adds goes behind what is there. Every buffer's bytes are held in memory;
// buffers that came out of a GLB's binary chunk, a data URI or a file beside are alike here, `uri` says which. Images
// beside the file are read too, so that a written copy is complete.
//
// Moves cheaply; copying is explicit through clone().
class Asset {
 public:
  struct Buffer {
    Bytes bytes;      // as many as its "byteLength" in the JSON
    std::string uri;  // empty: the GLB's binary chunk, or made by limber; the start of a data URI up to its comma (the
                      // JSON has no more of it either); else a relative path, and the bytes are that file's
  };
  struct SideFile {  // an image that the document names by relative path
    std::string uri;
    Bytes bytes;
  };

  Asset();
  Asset(Asset&&) noexcept;
  Asset& operator=(Asset&&) noexcept;
  ~Asset();
  Asset clone() const;

  Json& json() { return *json_; }
  const Json& json() const { return *json_; }

  std::vector<Buffer> buffers;  // one for each of json()["buffers"], in order
  std::vector<SideFile> sideFiles;
  std::string name;    // for messages: the file's name
  std::string format;  // "glb", "gltf", "obj", "ply", "stl", "off", "fbx", "dae", "bvh"
  Warnings warnings;   // what reading had to convert, decode or leave out

 private:
  std::unique_ptr<Json> json_;
};

// Walks the whole document and throws Error kBadData, with the path of the element ("meshes[0].primitives[2].indices"),
// on the first thing that breaks what the rest of limber relies on: every index in range, every accessor inside its
// buffer view and that inside its buffer, no cycle among nodes, one parent at most, finite numbers where numbers are
// wanted, vertex attributes of one primitive equally long, triangle indices below the vertex count.
void checkAsset(const Asset& asset);

}  // namespace limber
