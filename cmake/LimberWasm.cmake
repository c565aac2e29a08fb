# With emscripten the system's header-only libraries are used, but /usr/include itself must not be searched: its C
# library headers are the machine's, not WebAssembly's. Each library gets an include folder of its own that holds a
# link to it, and the target that its package would have given.
function(limber_system_headers target folder)
  find_path(${folder}_parent ${folder} PATHS /usr/include /usr/local/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH
    REQUIRED)
  set(tree ${PROJECT_BINARY_DIR}/system/${folder})
  file(MAKE_DIRECTORY ${tree})
  file(CREATE_LINK ${${folder}_parent}/${folder} ${tree}/${folder} SYMBOLIC)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${tree})
endfunction()

# What fmt compiles once elsewhere, its headers hold as well.
limber_system_headers(fmt::fmt fmt)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)
limber_system_headers(nlohmann_json::nlohmann_json nlohmann)
limber_system_headers(FastFloat::fast_float fast_float)
find_path(eigen_folder Eigen/Core PATHS /usr/include/eigen3 /usr/local/include/eigen3 NO_DEFAULT_PATH
  NO_CMAKE_FIND_ROOT_PATH REQUIRED)
add_library(Eigen3::Eigen INTERFACE IMPORTED GLOBAL)
target_include_directories(Eigen3::Eigen SYSTEM INTERFACE ${eigen_folder})

# Small code is what a page waits for: only what is small is inlined (its cost is counted as LLVM does; -O3 says 250), and no
# loop is unrolled. At 40 a sixth smaller, packed a tenth, and 7 % slower by ./dev bench --web. -Os makes it a third
# smaller and fourteen times as slow, since it leaves Eigen's expressions as calls.
add_compile_options(-O2 -fno-unroll-loops "SHELL:-mllvm -inline-threshold=40")
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)
