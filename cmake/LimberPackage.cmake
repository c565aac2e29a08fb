# The umbrella target limber::limber, and the package that find_package(limber) finds after `cmake --install`.
include(CMakePackageConfigHelpers)

get_property(modules GLOBAL PROPERTY LIMBER_MODULES)
add_library(limber_everything INTERFACE)
add_library(limber::limber ALIAS limber_everything)
set_target_properties(limber_everything PROPERTIES EXPORT_NAME limber)
target_link_libraries(limber_everything INTERFACE ${modules})
install(TARGETS limber_everything EXPORT limberTargets COMPONENT development)

# Nothing but limber/limber.h and what it includes is for other programs.
install(CODE "
  set(SOURCE \"${PROJECT_SOURCE_DIR}\")
  set(DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")
  include(\"${CMAKE_CURRENT_LIST_DIR}/public_headers.cmake\")" COMPONENT development)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/limber)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/limberConfig.cmake.in ${PROJECT_BINARY_DIR}/limberConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/limberConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT limberTargets NAMESPACE limber:: DESTINATION ${package_folder} COMPONENT development)
install(FILES ${PROJECT_BINARY_DIR}/limberConfig.cmake ${PROJECT_BINARY_DIR}/limberConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)
