# SPDX-License-Identifier: MIT
# What cmake --install writes: headers, the libraries, the CMake package and the pkg-config files.
include(CMakePackageConfigHelpers)

install(FILES soa/narc_export.h soa/narc_columns.h soa/narc_workers.h soa/narc_shapes.h soa/narc_pairs.h soa/narc_scene.h dispatch/narc.h
  dispatch/narc_broad_phase.h dispatch/narc.hpp
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")

# Two export files, because only those who ask for the static library need its dependencies.
set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/narc")
install(TARGETS narc EXPORT narc_shared INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(TARGETS narc_static EXPORT narc_static INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT narc_shared NAMESPACE narc:: FILE narcShared.cmake DESTINATION "${package_directory}")
install(EXPORT narc_static NAMESPACE narc:: FILE narcStatic.cmake DESTINATION "${package_directory}")
# The library of shapes files, where it is built; the static one needs cJSON of its users.
if(TARGET narc_files)
  install(FILES files/narc_files.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  set_target_properties(narc_files PROPERTIES EXPORT_NAME files)
  set_target_properties(narc_files_static PROPERTIES EXPORT_NAME files_static)
  install(TARGETS narc_files EXPORT narc_files INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(TARGETS narc_files_static EXPORT narc_files_static INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT narc_files NAMESPACE narc:: FILE narcFiles.cmake DESTINATION "${package_directory}")
  install(EXPORT narc_files_static NAMESPACE narc:: FILE narcFilesStatic.cmake DESTINATION "${package_directory}")
endif()
# The library of other methods, where it is built.
if(TARGET narc_methods)
  install(FILES methods/narc_methods.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(TARGETS narc_methods EXPORT narc_methods INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(TARGETS narc_methods_static EXPORT narc_methods_static INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT narc_methods NAMESPACE narc:: FILE narcMethods.cmake DESTINATION "${package_directory}")
  install(EXPORT narc_methods_static NAMESPACE narc:: FILE narcMethodsStatic.cmake DESTINATION "${package_directory}")
endif()
# The fitting library, where it is built. What it links itself, its users need not find.
if(TARGET narc_fit)
  install(FILES fit/narc_fit.h DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  set_target_properties(narc_fit PROPERTIES EXPORT_NAME fit)
  install(TARGETS narc_fit EXPORT narc_fit INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(EXPORT narc_fit NAMESPACE narc:: FILE narcFit.cmake DESTINATION "${package_directory}")
endif()

configure_package_config_file(cmake/narcConfig.cmake.in narcConfig.cmake INSTALL_DESTINATION "${package_directory}")
write_basic_package_version_file(narcConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/narcConfig.cmake" "${PROJECT_BINARY_DIR}/narcConfigVersion.cmake"
  DESTINATION "${package_directory}")

# Paths from the folder of narc.pc, so that the installed tree can be moved. Programs that link the shared library need
# no package but this one, therefore SLEEF stands in Libs.private and not in Requires.private.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(pc_prefix "${CMAKE_INSTALL_PREFIX}")
  set(pc_libdir "${CMAKE_INSTALL_LIBDIR}")
else()
  file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig/" "/")
  string(REGEX REPLACE "/$" "" pc_prefix "\${pcfiledir}/${up}")
  set(pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
list(JOIN SLEEF_LDFLAGS " " pc_sleef)
set(packages narc narc-static)
if(TARGET narc_files)
  list(APPEND packages narc-files)
endif()
if(TARGET narc_methods)
  list(APPEND packages narc-methods narc-methods-static)
endif()
if(TARGET narc_fit)
  list(APPEND packages narc-fit)
endif()
foreach(package IN LISTS packages)
  configure_file(cmake/${package}.pc.in ${package}.pc @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endforeach()

# What a reader wants beside the library.
install(FILES LICENSE README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs apps DESTINATION "${CMAKE_INSTALL_DOCDIR}" FILES_MATCHING
  PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN cases EXCLUDE PATTERN tests EXCLUDE PATTERN compat EXCLUDE)
install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" FILES_MATCHING PATTERN "*.[ch]" PATTERN "*.cpp")
