# What `cpack` makes of an installed limber: limber.deb with the program, liblimber-dev.deb with the library, and a .tar.gz of
# the program, to which tools/make_packages.sh adds the shared libraries. That script also makes the pages of the manual,
# the completions and the notices, in the folder below, before it calls cpack.
set(LIMBER_MANUAL ${PROJECT_BINARY_DIR}/manual)
foreach(component program development)
  install(DIRECTORY ${LIMBER_MANUAL}/${component}/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT ${component} OPTIONAL)
endforeach()

set(CPACK_PACKAGE_CONTACT "limber maintainers <maintainers@limber.invalid>")
set(CPACK_PACKAGE_VENDOR limber)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL program development)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME limber)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "A static mesh goes in; a rigged, skinned, posed or moving character comes out.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME liblimber-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "The C++20 library: headers, static libraries,\nand what find_package(limber) finds.")
# What limberConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, nlohmann-json3-dev, libassimp-dev, \
libmeshoptimizer-dev, libdraco-dev, libpng-dev, libjpeg-dev, libtbb-dev, libssl-dev")

set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_ARCHIVE_PROGRAM_FILE_NAME limber-${PROJECT_VERSION}-linux-${CMAKE_SYSTEM_PROCESSOR})
include(CPack)
