# SPDX-License-Identifier: MIT
# Tests of what is built and installed: symbols, and programs that use the installed tree as a stranger would.

# ---------------------------------------------------------------------------- symbols and instructions
foreach(isa IN LISTS NARC_ISA_NAMES)
  add_test(NAME symbols_${isa} COMMAND ${CMAKE_COMMAND} "-DNM=${CMAKE_NM}" "-DOBJECTS=$<TARGET_OBJECTS:narc_isa_${isa}>"
    -DEXPECTED=narc_kernels_${isa} -P "${PROJECT_SOURCE_DIR}/tests/test_symbols.cmake")
endforeach()
add_test(NAME symbols_library COMMAND ${CMAKE_COMMAND} "-DNM=${CMAKE_NM}" "-DLIBRARY=$<TARGET_FILE:narc>"
  "-DHEADERS=${PROJECT_SOURCE_DIR}/soa/narc_shapes.h;${PROJECT_SOURCE_DIR}/dispatch/narc.h;${PROJECT_SOURCE_DIR}/dispatch/narc_methods.h"
  -P "${PROJECT_SOURCE_DIR}/tests/test_symbols.cmake")
if(TARGET narc_fit)
  add_test(NAME symbols_fit COMMAND ${CMAKE_COMMAND} "-DNM=${CMAKE_NM}" "-DLIBRARY=$<TARGET_FILE:narc_fit>"
    "-DHEADERS=${PROJECT_SOURCE_DIR}/fit/narc_fit.h" -P "${PROJECT_SOURCE_DIR}/tests/test_symbols.cmake")
endif()

# What runs before the processor check has no instruction that needs it; AVX registers are ymm and zmm, and the 128-bit
# forms of AVX instructions begin with v. (Objects for link-time optimisation hold no instructions yet.)
set(baseline_objects $<TARGET_OBJECTS:narc_isa_scalar>)
if(NOT CMAKE_INTERPROCEDURAL_OPTIMIZATION)
  list(APPEND baseline_objects $<TARGET_OBJECTS:narc_core>)
endif()
if("avx2" IN_LIST NARC_ISA_NAMES)
  add_test(NAME instructions_baseline COMMAND ${CMAKE_COMMAND} "-DOBJDUMP=${CMAKE_OBJDUMP}"
    "-DOBJECTS=${baseline_objects}"
    "-DFORBIDDEN=%[yz]mm|\tv[a-z0-9]+ .*%xmm" -P "${PROJECT_SOURCE_DIR}/tests/test_symbols.cmake")
  add_test(NAME instructions_avx2 COMMAND ${CMAKE_COMMAND} "-DOBJDUMP=${CMAKE_OBJDUMP}"
    "-DOBJECTS=$<TARGET_OBJECTS:narc_isa_avx2>" "-DFORBIDDEN=%zmm|%k[0-7]"
    -P "${PROJECT_SOURCE_DIR}/tests/test_symbols.cmake")
endif()

# ---------------------------------------------------------------------------- the installed tree
if(NOT NARC_INSTALL)
  return()
endif()
set(work "${PROJECT_BINARY_DIR}/package")
set(package_script ${CMAKE_COMMAND} "-DSOURCE=${PROJECT_SOURCE_DIR}" "-DBUILD=${PROJECT_BINARY_DIR}" "-DWORK=${work}"
  "-DCONFIG=$<CONFIG>" "-DC_COMPILER=${CMAKE_C_COMPILER}" "-DFLAGS=${CMAKE_C_FLAGS}" "-DGENERATOR=${CMAKE_GENERATOR}"
  "-DTOOLCHAIN=${CMAKE_TOOLCHAIN_FILE}" "-DSLEEF=${NARC_SLEEF}" "-DPKG_CONFIG=${PKG_CONFIG_EXECUTABLE}")

# Steps in tests/package/run.cmake. One that needs what this machine does not have says so and counts as skipped.
function(add_package_test step)
  add_test(NAME package_${step} COMMAND ${package_script} -DSTEP=${step} ${ARGN}
    -P "${PROJECT_SOURCE_DIR}/tests/package/run.cmake")
  set_tests_properties(package_${step} PROPERTIES SKIP_REGULAR_EXPRESSION "package test skipped"
    FIXTURES_REQUIRED narc_installed)
endfunction()

add_package_test(install)
set_tests_properties(package_install PROPERTIES FIXTURES_REQUIRED "" FIXTURES_SETUP narc_installed)
set(kinds shared static)
if(TARGET narc_fit)
  list(APPEND kinds fit)
endif()
foreach(kind IN LISTS kinds)
  foreach(language c cxx)
    add_package_test(cmake_${kind}_${language} -DKIND=${kind} -DLANGUAGE=${language})
    add_package_test(pkgconfig_${kind}_${language} -DKIND=${kind} -DLANGUAGE=${language})
  endforeach()
endforeach()
add_package_test(readme_example)
if(NARC_BUILD_TOOLS AND NOT CMAKE_CROSSCOMPILING)
  add_package_test(readme_shapes)
endif()
add_package_test(subproject)
add_package_test(compiler_alone)
