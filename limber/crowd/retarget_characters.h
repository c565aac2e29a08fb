// The same motions onto many characters, one after the other.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "limber/actions/export/write_model.h"
#include "limber/actions/motion/clip_edits.h"
#include "limber/actions/motion/retarget_asset.h"
#include "limber/core/progress.h"

namespace limber {

struct CharactersJob {
  std::vector<std::filesystem::path> characters;
  std::vector<Motion> motions;     // read once, for all
  std::filesystem::path folder;    // where files go; made where it is not there
  std::string extension = ".glb";  // of the files, one of modelExtensions()
  bool isSeparate = false;         // a file for each motion of a character, not one with all its clips
  RetargetAssetOptions retarget;   // `matches` and `turn` are set here
  ClipEdits edits;
  WriteModelOptions write;
};

// Characters (of separate files: files) that failed with one message.
struct CharacterFailures {
  std::string problem;
  std::size_t count = 0;
  std::filesystem::path example;  // the first of the list
};

struct CharactersReport {
  std::size_t files = 0;                    // written
  std::size_t failed = 0;                   // files that are not
  std::size_t matches = 0;                  // of skeletons that were made
  std::vector<CharacterFailures> failures;  // by their messages, in the order of the list
  Warnings warnings;                        // of the characters that came out
};

// The characters of a list, a path a line: beside the list where they are relative ("-": standard input, where the
// program runs), as listLines reads them. Throws Error kFile, kBadData where there is none.
std::vector<std::filesystem::path> readCharacterList(const std::filesystem::path& list);

// What the files are called: "hero.glb", of separate ones "hero_walk.glb" for each motion in turn, after the names of
// both files; where two would have one name (upper and lower case alike), the second of the list is "hero_2.glb".
std::vector<std::string> characterFileNames(std::span<const std::filesystem::path> characters,
                                            std::span<const Motion> motions, const std::string& extension,
                                            bool isSeparate);

// Reads each character once, retargets, writes and forgets it: memory is that of the motions and of as many characters
// as there are threads. A character that cannot be read, moved or written costs itself alone. The files are the same
// for any number of threads. Throws Error kBadArgument where no character, no motion, or a format that keeps too few
// clips is asked for, kFile where the folder cannot be made, StorageError where nothing can be written
// there any more, and kCancelled.
CharactersReport retargetCharacters(const CharactersJob& job, Progress& progress);

}  // namespace limber
