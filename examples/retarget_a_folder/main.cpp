// retarget_a_folder CHARACTER FOLDER MOVING.glb: every .bvh of a folder becomes a clip of the character.
#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <limber/limber.h>

int main(int argc, char** argv) {
  if (argc != 4) return std::fprintf(stderr, "usage: retarget_a_folder CHARACTER FOLDER MOVING.glb\n"), 2;
  try {
    limber::Asset character = limber::readAsset(argv[1]);
    std::vector<std::filesystem::path> motions;
    for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
      if (entry.path().extension() == ".bvh") motions.push_back(entry.path());
    }
    std::sort(motions.begin(), motions.end());

    limber::RetargetAssetOptions options;
    options.method = "limb-ik";  // of retargetMethods()
    limber::Warnings warnings;
    const limber::UprightCharacter upright = limber::standUpright(character, warnings);
    options.turn = upright.turn;  // of a character that lies in its file
    std::size_t failed = 0;
    for (const std::filesystem::path& file : motions) {
      try {
        for (const limber::RetargetedClip& clip :
             limber::retargetOnto(character, upright.character, limber::readMotion(file), options)) {
          std::printf("%s: %u frames, %zu joints follow\n", clip.name.c_str(), clip.frames, clip.map.matches.size());
        }
      } catch (const limber::Error& error) {  // one that does not fit is left out
        std::fprintf(stderr, "%s: %s\n", file.filename().c_str(), error.what());
        ++failed;
      }
    }
    limber::writeAsset(character, argv[3]);
    return failed == motions.size() ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
