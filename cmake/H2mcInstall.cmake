# SPDX-License-Identifier: MIT
# cmake --install: the program, and below share/h2mc what it comes with, laid out as in the repository, so that the
# pages' links hold.

if(TARGET h2mc)
  install(TARGETS h2mc RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
  install(TARGETS h2mc_oiio LIBRARY DESTINATION "${H2MC_MODULE_INSTALL_DIR}")
endif()

set(share "${CMAKE_INSTALL_DATADIR}/h2mc")
install(FILES README.md CONTRIBUTING.md CHANGELOG.md SECURITY.md CITATION.cff LICENSE DESTINATION "${share}")
install(DIRECTORY docs DESTINATION "${share}")
install(DIRECTORY scenes DESTINATION "${share}" PATTERN "__pycache__" EXCLUDE)
