# Installation and the package config (find_package(splitfusion)). The tools
# are installed where they are built, in tools/.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/splitfusion")

install(TARGETS splitfusion EXPORT splitfusionTargets
        ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(DIRECTORY lib cost_functions pipelines
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/splitfusion"
        FILES_MATCHING PATTERN "*.h"
        PATTERN internal EXCLUDE)
install(FILES "${SPLITFUSION_INCLUDE_DIR}/splitfusion/method_hash.h"
        DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/splitfusion")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT tools)

install(EXPORT splitfusionTargets NAMESPACE splitfusion::
        DESTINATION "${package_dir}")
if(SPLITFUSION_BUILD_TOOLS)
  install(EXPORT splitfusionRunTargets NAMESPACE splitfusion::
          DESTINATION "${package_dir}")
endif()
configure_package_config_file(
  cmake/splitfusionConfig.cmake.in
  "${PROJECT_BINARY_DIR}/splitfusionConfig.cmake"
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/splitfusionConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/splitfusionConfig.cmake"
              "${PROJECT_BINARY_DIR}/splitfusionConfigVersion.cmake"
              cmake/LibraryDependencies.cmake
        DESTINATION "${package_dir}")

# cpack: the programs as a tarball that can be unpacked anywhere, for machines
# that have the libraries (docs/cluster.md) and no root.
set(CPACK_GENERATOR TGZ)
set(CPACK_COMPONENTS_ALL tools)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_PACKAGE_FILE_NAME
    "splitfusion-${PROJECT_VERSION}-${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}")
set(CPACK_VERBATIM_VARIABLES ON)
include(CPack)
