# Makes sample_scenes.cpp of the lists of commands in samples/scenes.
file(GLOB scenes CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/samples/scenes/*.json)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${scenes})
list(SORT scenes)
set(entries "")
foreach(scene ${scenes})
  get_filename_component(name ${scene} NAME_WE)
  file(READ ${scene} commands)
  string(APPEND entries "    {\"${name}\", R\"scene(${commands})scene\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/sample_scenes.cpp @ONLY CONTENT [[// Made by CMake from samples/scenes.
#include "sample_scenes.h"

namespace limber::cli {

std::span<const SampleScene> sampleScenes() {
  static constexpr SampleScene kScenes[] = {
@entries@  };
  return kScenes;
}

}  // namespace limber::cli
]])
