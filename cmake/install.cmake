# SPDX-License-Identifier: MIT
# What cmake --install writes: headers, the libraries, the CMake package and the pkg-config files; and Debian packages of
# the components, by cpack. Components: narc_runtime, the shared libraries that need nothing of other projects but SLEEF
# and OpenMP; narc_tools, the command and the libraries that it stands on; narc_development, all else.
include(CMakePackageConfigHelpers)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME narc_development)
set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/narc")

# narc_install(TARGET COMPONENT FILE [HEADER ...]): a library, narc::TARGET in the export file FILE. Each has a file,
# because only those who ask for a library need its dependencies.
function(narc_install target component file)
  install(FILES ${ARGN} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
  install(TARGETS ${target} EXPORT ${target} INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
    RUNTIME COMPONENT ${component} LIBRARY COMPONENT ${component} NAMELINK_COMPONENT narc_development)
  install(EXPORT ${target} NAMESPACE narc:: FILE ${file}.cmake DESTINATION "${package_directory}")
endfunction()

narc_install(narc narc_runtime narcShared
  include/narc_export.h include/narc_columns.h include/narc_workers.h include/narc_shapes.h include/narc_pairs.h include/narc_scene.h include/narc_chains.h
  include/narc.h include/narc_broad_phase.h include/narc_contacts.h include/narc_layouts.h include/narc.hpp)
narc_install(narc_static narc_development narcStatic)
# The others where they are built. The static library of shapes files needs cJSON of its users; what the fitting library
# links itself, its users need not find.
set(packages narc narc-static)
if(TARGET narc_files)
  set_target_properties(narc_files PROPERTIES EXPORT_NAME files)
  set_target_properties(narc_files_static PROPERTIES EXPORT_NAME files_static)
  narc_install(narc_files narc_tools narcFiles include/narc_files.h)
  narc_install(narc_files_static narc_development narcFilesStatic)
  list(APPEND packages narc-files)
endif()
if(TARGET narc_methods)
  narc_install(narc_methods narc_runtime narcMethods include/narc_methods.h)
  narc_install(narc_methods_static narc_development narcMethodsStatic)
  list(APPEND packages narc-methods narc-methods-static)
endif()
if(TARGET narc_fit)
  set_target_properties(narc_fit PROPERTIES EXPORT_NAME fit)
  narc_install(narc_fit narc_tools narcFit include/narc_fit.h)
  list(APPEND packages narc-fit)
endif()
if(TARGET narc_tool)
  install(TARGETS narc_tool RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT narc_tools)
  install(FILES "${PROJECT_BINARY_DIR}/tools/narc.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT narc_tools)
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
list(JOIN NARC_STACK_FLAGS " " pc_stack)
foreach(package IN LISTS packages)
  configure_file(cmake/${package}.pc.in ${package}.pc @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endforeach()

# What a reader wants beside the library. The other components depend on the first.
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT narc_runtime)
install(FILES README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY docs apps DESTINATION "${CMAKE_INSTALL_DOCDIR}" FILES_MATCHING
  PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg" PATTERN cases EXCLUDE PATTERN tests EXCLUDE PATTERN compat EXCLUDE)
install(DIRECTORY examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" FILES_MATCHING PATTERN "*.[ch]" PATTERN "*.cpp")

# Of libraries that the command holds.
if(NARC_LICENCES)
  install(DIRECTORY "${NARC_LICENCES}" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT narc_tools)
endif()

# cpack: libnarc0.3, libnarc-dev and narc-tools, which need what the objects in them are linked with. For Windows one
# archive of all.
if(PROJECT_IS_TOP_LEVEL AND WIN32)
  set(CPACK_GENERATOR ZIP)
  include(CPack)
elseif(PROJECT_IS_TOP_LEVEL)
  set(CPACK_GENERATOR DEB)
  set(CPACK_PACKAGE_CONTACT "narc <narc@localhost>")
  set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
  set(CPACK_DEB_COMPONENT_INSTALL ON)
  set(CPACK_COMPONENTS_ALL narc_runtime narc_development)
  set(CPACK_COMPONENT_NARC_DEVELOPMENT_DEPENDS narc_runtime)
  if(TARGET narc_files)
    list(APPEND CPACK_COMPONENTS_ALL narc_tools)
    list(APPEND CPACK_COMPONENT_NARC_DEVELOPMENT_DEPENDS narc_tools)
    set(CPACK_COMPONENT_NARC_TOOLS_DEPENDS narc_runtime)
  endif()
  set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}" "${PROJECT_BINARY_DIR}/methods"
    "${PROJECT_BINARY_DIR}/files" "${PROJECT_BINARY_DIR}/fit")
  set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
  set(CPACK_DEBIAN_NARC_RUNTIME_PACKAGE_NAME "libnarc${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
  set(CPACK_DEBIAN_NARC_RUNTIME_PACKAGE_SECTION libs)
  set(CPACK_DEBIAN_NARC_DEVELOPMENT_PACKAGE_NAME libnarc-dev)
  set(CPACK_DEBIAN_NARC_DEVELOPMENT_PACKAGE_SECTION libdevel)
  set(CPACK_DEBIAN_NARC_TOOLS_PACKAGE_NAME narc-tools)
  if(NARC_SVG AND TARGET narc_fit) # loaded where a drawing is read
    set(CPACK_DEBIAN_NARC_TOOLS_PACKAGE_DEPENDS librsvg2-2)
  endif()
  # Of the static libraries.
  set(CPACK_DEBIAN_NARC_DEVELOPMENT_PACKAGE_DEPENDS pkg-config)
  if(NARC_SLEEF)
    string(APPEND CPACK_DEBIAN_NARC_DEVELOPMENT_PACKAGE_DEPENDS ", libsleef-dev")
  endif()
  if(TARGET narc_files)
    string(APPEND CPACK_DEBIAN_NARC_DEVELOPMENT_PACKAGE_DEPENDS ", libcjson-dev")
  endif()
  include(CPack)
endif()
