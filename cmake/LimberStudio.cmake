# limber_embed_studio(<target> <folder>): the files of a built page become part of a program, as studioFiles() of
# apps/cli/studio/server.h. The assembler reads them, so that megabytes take no time to compile.
function(limber_embed_studio target folder)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${folder} ${folder}/*)
  if(NOT "index.html" IN_LIST files)
    message(FATAL_ERROR "LIMBER_STUDIO needs the built page in ${folder}: ./dev studio makes it")
  endif()
  set(symbols "")
  set(table "")
  set(number 0)
  set(paths "")
  foreach(file IN LISTS files)
    set(name limber_studio_file_${number})
    string(APPEND symbols "asm(\".section .rodata\\n.global ${name}, ${name}_end\\n${name}:\\n.incbin \\\"${folder}/${file}\\\"\\n${name}_end:\\n.byte 0\\n.previous\\n\");\n")
    string(APPEND symbols "extern \"C\" const char ${name}[], ${name}_end[];\n")
    string(APPEND table "      {\"/${file}\", {${name}, static_cast<std::size_t>(${name}_end - ${name})}},\n")
    list(APPEND paths ${folder}/${file})
    math(EXPR number "${number} + 1")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/studio_files.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[// Made by CMake from the built page.
#include "server.h"

@symbols@
namespace limber::cli {

std::span<const StudioFile> studioFiles() {
  static const StudioFile files[] = {
@table@  };
  return files;
}

}  // namespace limber::cli
]])
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${paths}" SKIP_UNITY_BUILD_INCLUSION ON)
  target_sources(${target} PRIVATE ${source})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
endfunction()
