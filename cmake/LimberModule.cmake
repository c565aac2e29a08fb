# limber_module(<name> [FOLDERS <folder>...] [USES <module>...] [PUBLIC <target>...] [PRIVATE <target>...]
#               [TEST_LIBRARIES <target>...] [FUZZED])
#
# A folder below limber/ with the folders in it that FOLDERS names is one library target limber_<name>, alias
# limber::<name>. Every *.cpp of these folders belongs to it, except *_test.cpp, which become the test program
# limber_<name>_tests. USES names the modules that this one may include from: a header of any other module is not found,
# so a wrong dependency does not build (each module publishes its headers through its own include tree). FUZZED modules
# read what fuzz targets feed them, and let libFuzzer see which way each input takes; this makes code two to three times
# as slow.
function(limber_module name)
  cmake_parse_arguments(ARG "FUZZED" "" "FOLDERS;USES;PUBLIC;PRIVATE;TEST_LIBRARIES" ${ARGN})
  set(folders . ${ARG_FOLDERS})
  list(TRANSFORM folders APPEND "/*.cpp" OUTPUT_VARIABLE patterns)
  list(TRANSFORM patterns PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  file(GLOB sources CONFIGURE_DEPENDS ${patterns})
  set(tests ${sources})
  list(FILTER tests INCLUDE REGEX "_test\\.cpp$")
  list(FILTER sources EXCLUDE REGEX "_test\\.cpp$")

  # The module's own include tree: build/.../include/<name>/limber/... has a link to each of its headers.
  set(tree ${PROJECT_BINARY_DIR}/include/${name})
  foreach(folder IN LISTS folders)
    file(GLOB headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.h
         ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/testing/*.h)
    foreach(header IN LISTS headers)
      get_filename_component(place ${tree}/${header} DIRECTORY)
      file(MAKE_DIRECTORY ${place})
      if(NOT EXISTS ${tree}/${header})
        file(CREATE_LINK ${PROJECT_SOURCE_DIR}/${header} ${tree}/${header} SYMBOLIC)
      endif()
    endforeach()
  endforeach()

  set(target limber_${name})
  add_library(${target} STATIC ${sources})
  add_library(limber::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${tree}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  limber_compile_options(${target})
  list(TRANSFORM ARG_USES PREPEND limber_)
  target_link_libraries(${target} PUBLIC ${ARG_USES} ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  limber_precompile(${target} LIBRARY)
  limber_unity(${target} 28)
  if(LIMBER_FUZZ AND ARG_FUZZED)
    target_compile_options(${target} PRIVATE -fsanitize-coverage=inline-8bit-counters,indirect-calls,trace-cmp,pc-table)
  endif()

  install(TARGETS ${target} EXPORT limberTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY LIMBER_MODULES ${target})

  if(LIMBER_TESTS AND tests)
    add_executable(${target}_tests ${tests})
    limber_compile_options(${target}_tests)
    limber_test_helpers(${target}_tests)
    limber_precompile(${target}_tests TESTS)
    limber_unity(${target}_tests 28)
    target_link_libraries(${target}_tests PRIVATE ${target} ${ARG_TEST_LIBRARIES} GTest::gmock GTest::gtest_main)
    add_dependencies(limber_unit_tests ${target}_tests)
    gtest_discover_tests(${target}_tests TEST_PREFIX "${name}." DISCOVERY_TIMEOUT 120 PROPERTIES LABELS unit)
  endif()
endfunction()

# limber_precompile(<target> LIBRARY|TESTS): where LIMBER_PRECOMPILE is on, the headers that take longest come precompiled,
# once for all targets of that kind. They are a matter of time only: every source includes what it needs, as the dev and
# lint presets see. They belong to a target of their own that defines no more than all others do, as g++ asks for.
set(limber_eigen_definitions EIGEN_DONT_VECTORIZE EIGEN_MPL2_ONLY)
function(limber_precompile target kind)
  if(NOT LIMBER_PRECOMPILE)
    return()
  endif()
  string(TOLOWER limber_precompiled_${kind} owner)
  if(NOT TARGET ${owner})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${owner}.cpp CONTENT "")  # written only where it is not there yet
    add_library(${owner} OBJECT ${PROJECT_BINARY_DIR}/${owner}.cpp)
    target_compile_features(${owner} PRIVATE cxx_std_20)
    target_compile_definitions(${owner} PRIVATE ${limber_eigen_definitions})
    target_link_libraries(${owner} PRIVATE Eigen3::Eigen)
    target_include_directories(${owner} SYSTEM PRIVATE
      $<TARGET_PROPERTY:nlohmann_json::nlohmann_json,INTERFACE_INCLUDE_DIRECTORIES>)
    limber_compile_options(${owner})
    target_precompile_headers(${owner} PRIVATE <algorithm> <functional> <map> <memory> <optional> <span> <string>
      <vector> <Eigen/Core> <Eigen/Geometry> <nlohmann/json.hpp>)
    if(kind STREQUAL TESTS)
      limber_test_helpers(${owner})
      target_link_libraries(${owner} PRIVATE GTest::gmock)
      target_precompile_headers(${owner} PRIVATE <gtest/gtest.h> <gmock/gmock.h>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${owner})
  # ccache reads what was precompiled, so whoever uses it has to find that.
  target_include_directories(${target} SYSTEM PRIVATE
    $<TARGET_PROPERTY:nlohmann_json::nlohmann_json,INTERFACE_INCLUDE_DIRECTORIES>)
endfunction()

# limber_unity(<target> <most>): where LIMBER_UNITY is on, its sources are compiled at most so many at a time, in the
# order of their names and in batches of about one size: what they include takes most of their time. Names in the
# anonymous namespaces of a target must differ. The dev and lint presets compile each source by itself.
function(limber_unity target most)
  if(NOT LIMBER_UNITY)
    return()
  endif()
  get_target_property(sources ${target} SOURCES)
  set(batched 0)
  foreach(source IN LISTS sources)
    get_source_file_property(apart ${source} SKIP_UNITY_BUILD_INCLUSION)
    get_source_file_property(options ${source} COMPILE_OPTIONS)
    if(NOT apart AND NOT options)
      math(EXPR batched "${batched} + 1")
    endif()
  endforeach()
  math(EXPR batches "(${batched} + ${most} - 1) / ${most}")
  if(batches GREATER 0)
    math(EXPR size "(${batched} + ${batches} - 1) / ${batches}")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${size})
  endif()
endfunction()

# The options that every target of ours is compiled with. Floating point is kept the same on every machine
# (no contraction), so that the same input gives the same bytes. Code is position-independent throughout, so that a
# binding links the same libraries as the program; programs are compiled as libraries are, so that one precompiled
# header fits both. WebAssembly links at one place only.
function(limber_compile_options target)
  target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wshadow -Wnon-virtual-dtor)
  if(NOT EMSCRIPTEN)
    target_compile_options(${target} PRIVATE -fPIC)
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # Functions are inlined as in code that is not position-independent; and the compiler collects its garbage less
    # often, which takes a sixth of its time off the largest batches.
    target_compile_options(${target} PRIVATE -fno-semantic-interposition --param=ggc-min-expand=300)
  elseif(LIMBER_PRECOMPILE)
    # Without its time inside, a header precompiled again is the same file, and ccache knows what was made with it.
    target_compile_options(${target} PRIVATE "SHELL:-Xclang -fno-pch-timestamp")
  endif()
  if(LIMBER_FUZZ)
    # Addresses are checked by calls, which takes a quarter less time to compile than checks in place.
    target_compile_options(${target} PRIVATE "SHELL:-mllvm -asan-instrumentation-with-call-threshold=0")
  endif()
  if(LIMBER_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# What a test program sees besides the code that it tests: tests/shared_data.h. Its own sources take far longer to be
# compiled than to run, and are optimised little; what they test is optimised as it is for users. Under sanitizers they
# are not optimised and have no debug information, which takes less than half the time: traces have lines of what is
# tested, functions of tests.
function(limber_test_helpers target)
  if(LIMBER_FUZZ)
    target_compile_options(${target} PRIVATE -O0 -g0)
  else()
    target_compile_options(${target} PRIVATE -O1)
  endif()
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  # The checkout's path is known to one source alone, so that ccache knows the others wherever the checkout lies. Lines
  # that failed are told as below it.
  target_compile_options(${target} PRIVATE -fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
  if(NOT TARGET limber_source_folder)
    add_library(limber_source_folder OBJECT ${PROJECT_SOURCE_DIR}/tests/source_folder.cpp)
    target_compile_features(limber_source_folder PRIVATE cxx_std_20)
    target_compile_definitions(limber_source_folder PRIVATE LIMBER_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  endif()
  target_link_libraries(${target} PRIVATE limber_source_folder)
endfunction()
