# SPDX-License-Identifier: MIT
# Writes h2mc_version.h into the build tree. Run as a script (cmake -P) it rewrites the header, but only where its text
# changes; included, it sets up the rule that does so after each commit, so that neither configuring again nor building
# again compiles anything anew. Link h2mc_version to include the header.

if(CMAKE_SCRIPT_MODE_FILE)
  set(hash "")
  find_program(GIT_EXECUTABLE git)
  if(GIT_EXECUTABLE)
    execute_process(COMMAND "${GIT_EXECUTABLE}" rev-parse --short=10 HEAD WORKING_DIRECTORY "${SOURCE_DIR}"
                    OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
    if(failed)
      set(hash "")
    endif()
  endif()
  set(full "${VERSION}")
  if(hash)
    string(APPEND full "+${hash}")
  endif()
  file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
#pragma once
// Written by cmake/H2mcVersion.cmake.
#define H2MC_VERSION "@VERSION@"
#define H2MC_GIT_HASH "@hash@"
#define H2MC_VERSION_STRING "@full@"
]])
  return()
endif()

set(h2mc_generated_dir "${CMAKE_BINARY_DIR}/generated")
set(header "${h2mc_generated_dir}/h2mc_version.h")

# Git appends to this log whenever HEAD moves. Outside a repository the header is written once.
set(head_log "")
find_program(GIT_EXECUTABLE git)
mark_as_advanced(GIT_EXECUTABLE)
if(GIT_EXECUTABLE AND EXISTS "${CMAKE_SOURCE_DIR}/.git")
  execute_process(COMMAND "${GIT_EXECUTABLE}" rev-parse --git-path logs/HEAD WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
                  OUTPUT_VARIABLE head_log OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(head_log)
    get_filename_component(head_log "${head_log}" ABSOLUTE BASE_DIR "${CMAKE_SOURCE_DIR}")
  endif()
  if(NOT EXISTS "${head_log}")
    set(head_log "")
  endif()
endif()

set(stamp "${h2mc_generated_dir}/version.stamp")
add_custom_command(
  OUTPUT "${stamp}"
  BYPRODUCTS "${header}"
  COMMAND "${CMAKE_COMMAND}" "-DSOURCE_DIR=${CMAKE_SOURCE_DIR}" "-DVERSION=${PROJECT_VERSION}" "-DOUTPUT=${header}"
          -P "${CMAKE_CURRENT_LIST_FILE}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
  DEPENDS ${head_log} "${CMAKE_CURRENT_LIST_FILE}"
  COMMENT "Version" VERBATIM)
add_custom_target(h2mc_version_header DEPENDS "${stamp}")

add_library(h2mc_version INTERFACE)
target_include_directories(h2mc_version INTERFACE "${h2mc_generated_dir}")
add_dependencies(h2mc_version h2mc_version_header)
