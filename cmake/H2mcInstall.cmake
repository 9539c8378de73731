# SPDX-License-Identifier: MIT
# cmake --install: the program, its manual pages and completions, and below share/h2mc what it comes with, laid out as
# in the repository, so that the pages' links hold.

if(TARGET h2mc)
  install(TARGETS h2mc RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  install(TARGETS h2mc_oiio LIBRARY DESTINATION "${H2MC_MODULE_INSTALL_DIR}")
  foreach(module h2mc_serve h2mc_figures h2mc_mpi)
    if(TARGET ${module})
      install(TARGETS ${module} LIBRARY DESTINATION "${H2MC_MODULE_INSTALL_DIR}")
    endif()
  endforeach()

  # What the program prints of itself, when it is installed.
  set(printed "${CMAKE_BINARY_DIR}/printed")
  install(CODE "set(h2mc_program \"$<TARGET_FILE:h2mc>\")\nset(h2mc_printed \"${printed}\")")
  install(SCRIPT cmake/H2mcPrinted.cmake)
  install(FILES "${printed}/h2mc.bash" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" RENAME h2mc)
  install(FILES "${printed}/h2mc.zsh" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" RENAME _h2mc)
  install(FILES "${printed}/h2mc.fish" DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
  install(DIRECTORY "${printed}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1")
endif()

if(TARGET h2mc_python)
  # Where Debian's interpreter looks below /usr and /usr/local.
  if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
    set(site "lib/python3/dist-packages")
  else()
    set(site "lib/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/dist-packages")
  endif()
  file(RELATIVE_PATH to_modules "/${site}" "/${H2MC_MODULE_INSTALL_DIR}")
  set_target_properties(h2mc_python PROPERTIES INSTALL_RPATH "$ORIGIN/${to_modules}")
  install(TARGETS h2mc_python LIBRARY DESTINATION "${site}")
  install(FILES src/python/h2mc.pyi DESTINATION "${site}")
endif()

set(share "${CMAKE_INSTALL_DATADIR}/h2mc")
install(FILES README.md CONTRIBUTING.md CHANGELOG.md SECURITY.md CITATION.cff LICENSE DESTINATION "${share}")
install(DIRECTORY docs DESTINATION "${share}")
install(DIRECTORY scenes DESTINATION "${share}" PATTERN "__pycache__" EXCLUDE)
