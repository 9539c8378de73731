# SPDX-License-Identifier: MIT
# Run by cmake --install: h2mc_program writes its completions and manual pages into the folder h2mc_printed.

function(h2mc_print file)
  execute_process(COMMAND "${h2mc_program}" ${ARGN} OUTPUT_FILE "${file}" RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "h2mc: \"${h2mc_program} ${ARGN}\" failed: ${failed}")
  endif()
endfunction()

file(REMOVE_RECURSE "${h2mc_printed}")
file(MAKE_DIRECTORY "${h2mc_printed}")
foreach(shell bash zsh fish)
  h2mc_print("${h2mc_printed}/h2mc.${shell}" completion ${shell})
endforeach()
h2mc_print("${h2mc_printed}/man.log" man -o "${h2mc_printed}/man")
