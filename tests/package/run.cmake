# SPDX-License-Identifier: MIT
# One step of the package tests; installed.cmake calls it with STEP and the variables used below.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

function(skip reason)
  message(STATUS "package test skipped: ${reason}")
endfunction()

set(prefix "${WORK}/prefix")
set(folder "${WORK}/${STEP}")
file(REMOVE_RECURSE "${folder}")
file(MAKE_DIRECTORY "${folder}")
separate_arguments(flag_list UNIX_COMMAND "${FLAGS}")

find_program(CXX_COMPILER NAMES c++ g++ clang++)
if(LANGUAGE STREQUAL "cxx" AND (TOOLCHAIN OR NOT CXX_COMPILER))
  skip("no C++ compiler for the target")
  return()
endif()
# Code for sanitizers goes with the compiler that made it.
get_filename_component(compiler_name "${C_COMPILER}" NAME)
if(compiler_name MATCHES "^clang(-[0-9]+)?$")
  string(REPLACE "clang" "clang++" CXX_COMPILER "${C_COMPILER}")
endif()

# Writes a document's first code block in a language to a file.
function(extract_block document language file)
  file(READ "${SOURCE}/${document}" text)
  if(NOT text MATCHES "\n```${language}\n(([^`]|`[^`])*)```\n")
    message(FATAL_ERROR "${document} has no block of ${language}")
  endif()
  file(WRITE "${file}" "${CMAKE_MATCH_1}")
endfunction()

set(configure ${CMAKE_COMMAND} -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${CONFIG}" "-DCMAKE_PREFIX_PATH=${prefix}"
  "-DKIND=${KIND}" "-DLANGUAGE=${LANGUAGE}")
if(TOOLCHAIN)
  list(APPEND configure "-DCMAKE_TOOLCHAIN_FILE=${TOOLCHAIN}" "-DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=BOTH")
else()
  list(APPEND configure "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_C_FLAGS=${FLAGS}"
    "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}" --no-warn-unused-cli)
endif()

# Configures SOURCE_FOLDER, builds it and runs its tests.
function(build_and_test source_folder)
  run(${configure} -S "${source_folder}" -B "${folder}" ${ARGN})
  run(${CMAKE_COMMAND} --build "${folder}" --config "${CONFIG}")
  run(${CMAKE_CTEST_COMMAND} --test-dir "${folder}" -C "${CONFIG}" --output-on-failure --no-tests=error)
endfunction()

if(STEP STREQUAL "install")
  file(REMOVE_RECURSE "${prefix}")
  run(${CMAKE_COMMAND} --install "${BUILD}" --prefix "${prefix}" --config "${CONFIG}")

elseif(STEP MATCHES "^cmake_")
  build_and_test("${SOURCE}/tests/package/consumer")

elseif(STEP MATCHES "^pkgconfig_" OR STEP STREQUAL "readme_example")
  if(TOOLCHAIN OR NOT PKG_CONFIG)
    skip("pkg-config answers for this machine only, or is not there")
    return()
  endif()
  set(package narc)
  set(source "${SOURCE}/tests/package/consumer/consumer")
  if(KIND MATCHES "^(methods|files|fit)")
    set(source "${SOURCE}/tests/package/consumer/consumer_${CMAKE_MATCH_1}")
    string(REPLACE "_" "-" package "narc-${KIND}")
  elseif(KIND STREQUAL "static")
    set(package narc-static)
  endif()
  file(GLOB_RECURSE pc_file "${prefix}/${package}.pc")
  get_filename_component(pc_folder "${pc_file}" DIRECTORY)
  get_filename_component(library_folder "${pc_folder}" DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} "${pc_folder}:$ENV{PKG_CONFIG_PATH}")
  set(compile "${C_COMPILER}")
  if(STEP STREQUAL "readme_example")
    set(source "${folder}/example.c")
    extract_block(README.md c "${source}")
  elseif(LANGUAGE STREQUAL "cxx")
    string(APPEND source ".cpp")
    set(compile "${CXX_COMPILER}" -std=c++17)
  else()
    string(APPEND source ".c")
  endif()
  execute_process(COMMAND "${PKG_CONFIG}" --cflags ${package} OUTPUT_VARIABLE compile_flags COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND "${PKG_CONFIG}" --libs ${package} OUTPUT_VARIABLE link_flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(compile_flags UNIX_COMMAND "${compile_flags}")
  separate_arguments(link_flags UNIX_COMMAND "${link_flags}")
  # Without that path the program runs only if it needs no shared library of narc.
  if(NOT KIND MATCHES "static$")
    list(APPEND link_flags "-Wl,-rpath,${library_folder}")
  endif()
  run(${compile} ${flag_list} -Wall -Wextra -Werror -c "${source}" -o "${folder}/program.o" ${compile_flags})
  run(${compile} ${flag_list} "${folder}/program.o" -o "${folder}/program" ${link_flags})
  run("${folder}/program")
  if(STEP STREQUAL "readme_example")
    extract_block(README.md text "${folder}/expected.txt")
    execute_process(COMMAND "${folder}/program" OUTPUT_FILE "${folder}/printed.txt")
    run(${CMAKE_COMMAND} -E compare_files "${folder}/expected.txt" "${folder}/printed.txt")
  endif()

elseif(STEP STREQUAL "documented_shapes")
  # The installed command reads the documented shapes file.
  extract_block(docs/formats.md json "${folder}/shapes.json")
  file(GLOB command "${prefix}/bin/narc")
  set(shapes --shapes "${folder}/shapes.json")
  run("${command}" scene ${shapes} --bodies 200 --density 1 --seed 1 --out "${folder}/bodies.csv")
  run("${command}" collide ${shapes} --bodies "${folder}/bodies.csv")

# The last two build the library anew. What they are about does not depend on optimisation.
elseif(STEP STREQUAL "subproject")
  build_and_test("${SOURCE}/tests/package/consumer" -DKIND=subproject "-DNARC_SOURCE=${SOURCE}" "-DNARC_SLEEF=${SLEEF}"
    -DCMAKE_BUILD_TYPE=Debug)
  file(GLOB_RECURSE extra "${folder}/narc/files/*" "${folder}/narc/fit/*" "${folder}/narc/methods/*"
    "${folder}/narc/tests/*" "${folder}/narc/tools/*")
  if(extra)
    message(FATAL_ERROR "a subproject builds more than the library: ${extra}")
  endif()

# A project without a build type: narc is optimised, and what is the project's own is as it was.
elseif(STEP STREQUAL "subproject_flags")
  run(${configure} -S "${SOURCE}/tests/package/consumer" -B "${folder}" -DKIND=subproject "-DNARC_SOURCE=${SOURCE}"
    "-DNARC_SLEEF=${SLEEF}" -DCMAKE_BUILD_TYPE= -DCMAKE_C_FLAGS= -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
  file(READ "${folder}/compile_commands.json" commands)
  string(REGEX MATCHALL "\"command\": [^\n]*" commands "${commands}")
  foreach(command IN LISTS commands)
    string(REGEX MATCH "-c [^\n]*" source "${command}")
    if(source MATCHES "/(soa|dispatch|kernels)/")
      math(EXPR narc_sources "0${narc_sources} + 1")
      if(NOT command MATCHES " -O[23] ")
        message(FATAL_ERROR "not optimised: ${command}")
      endif()
    elseif(command MATCHES " -O| -DNDEBUG")
      message(FATAL_ERROR "the project's own flags changed: ${command}")
    endif()
  endforeach()
  if(NOT narc_sources GREATER 20)
    message(FATAL_ERROR "narc's own sources are not among the commands")
  endif()
  file(STRINGS "${folder}/CMakeCache.txt" cached REGEX "^(CMAKE_BUILD_TYPE|CMAKE_C_FLAGS):")
  foreach(line IN LISTS cached)
    if(NOT line MATCHES "=$")
      message(FATAL_ERROR "the project's cache changed: ${line}")
    endif()
  endforeach()

elseif(STEP STREQUAL "compiler_alone")
  # No pkg-config, no OpenMP, no SLEEF: the library itself must not look for anything.
  run(${configure} -S "${SOURCE}" -B "${folder}" -DCMAKE_BUILD_TYPE=Debug -DNARC_BUILD_FILES=OFF
    -DNARC_BUILD_FIT=OFF -DNARC_BUILD_TOOLS=OFF -DNARC_BUILD_TESTS=OFF
    -DNARC_OPENMP=OFF -DNARC_SLEEF=OFF -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON)
  run(${CMAKE_COMMAND} --build "${folder}" --config "${CONFIG}" --target
    narc_core narc_common narc_isa_scalar narc_methods_core narc_methods_isa_scalar)

else()
  message(FATAL_ERROR "no such step: ${STEP}")
endif()
