// A series of OBJ files, one for each frame, as one animation.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "limber/actions/motion/vertex_animation.h"
#include "limber/document/asset.h"

namespace limber {

// The OBJ files of a folder in the order of their names, numbers in them by value: frame_2.obj before frame_10.obj.
// Throws Error kFile where the folder cannot be read, kBadData where it holds none.
std::vector<std::filesystem::path> objFilesIn(const std::filesystem::path& folder);

struct ObjSeries {
  Asset asset;  // the first file, with its materials
  VertexAnimation animation;
};

// Reads the first file as a model and of the others where their vertices are, told by their numbers: those of the first
// stay apart where they touch. Its rest pose is the first frame; its points are the file's vertices. One clip, called
// as the first file without the digits at its end.
// Throws as readObjModel does, and Error kBadData, naming the file, where a frame has other faces or another number
// of vertices than the first, where there is a single file, or nothing moves; kLimit for more than a VertexSequence
// holds; kCancelled.
ObjSeries readObjSeries(std::span<const std::filesystem::path> files, double framesPerSecond, Progress& progress);

}  // namespace limber
