# SPDX-License-Identifier: MIT
# Tests of the installed tree: programs that use it as a stranger would.
set(work "${PROJECT_BINARY_DIR}/package")
set(package_script ${CMAKE_COMMAND} "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DBUILD=${PROJECT_BINARY_DIR}" "-DWORK=${work}"
  "-DCONFIG=$<CONFIG>" "-DC_COMPILER=${CMAKE_C_COMPILER}" "-DFLAGS=${CMAKE_C_FLAGS}" "-DGENERATOR=${CMAKE_GENERATOR}"
  "-DTOOLCHAIN=${CMAKE_TOOLCHAIN_FILE}" "-DSLEEF=${NARC_SLEEF}" "-DPKG_CONFIG=${PKG_CONFIG_EXECUTABLE}")

# Steps in run.cmake. One that needs what this machine does not have says so and counts as skipped.
function(add_step step)
  add_test(NAME package_${step} COMMAND ${package_script} -DSTEP=${step} ${ARGN}
    -P "${CMAKE_CURRENT_SOURCE_DIR}/run.cmake")
  set_tests_properties(package_${step} PROPERTIES SKIP_REGULAR_EXPRESSION "package test skipped"
    FIXTURES_REQUIRED narc_installed)
endfunction()

add_step(install)
set_tests_properties(package_install PROPERTIES FIXTURES_REQUIRED "" FIXTURES_SETUP narc_installed)
set(kinds shared static methods methods_static)
if(TARGET narc_files)
  list(APPEND kinds files)
  add_step(cmake_files_static_c -DKIND=files_static -DLANGUAGE=c)
endif()
if(TARGET narc_fit)
  list(APPEND kinds fit)
endif()
foreach(kind IN LISTS kinds)
  foreach(language c cxx)
    add_step(cmake_${kind}_${language} -DKIND=${kind} -DLANGUAGE=${language})
    add_step(pkgconfig_${kind}_${language} -DKIND=${kind} -DLANGUAGE=${language})
  endforeach()
endforeach()
# Each program of examples/.
file(GLOB examples RELATIVE "${PROJECT_SOURCE_DIR}/examples" "${PROJECT_SOURCE_DIR}/examples/*.c*")
foreach(example IN LISTS examples)
  file(STRINGS "${PROJECT_SOURCE_DIR}/examples/${example}" main REGEX "^int main\\(")
  if(main)
    get_filename_component(name "${example}" NAME_WE)
    add_step(example_${name} "-DPROGRAM=${example}")
  endif()
endforeach()
if(PROJECT_IS_TOP_LEVEL AND UNIX AND NOT APPLE AND NOT CMAKE_CROSSCOMPILING)
  add_step(deb)
endif()
if(NARC_BUILD_TOOLS AND NOT CMAKE_CROSSCOMPILING)
  add_step(documented_shapes)
  add_step(app_dem)
endif()
# Most compile the library anew, which another processor's compiler does not make more of a test.
if(NOT CMAKE_CROSSCOMPILING)
  add_step(meson_cmake -DKIND=cmake)
  add_step(meson_pkgconfig -DKIND=pkg-config)
  add_step(meson_subproject -DKIND=subproject)
  add_step(subproject)
  add_step(compiler_alone)
  if(NOT CMAKE_CONFIGURATION_TYPES)
    add_step(subproject_flags)
  endif()
  set_property(TEST package_subproject package_meson_subproject package_compiler_alone APPEND PROPERTY LABELS slow)
endif()
