# SPDX-License-Identifier: MIT
# cpack -G DEB: what cmake --install installs, as a Debian package. scripts/package.sh does all of it.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME h2mc)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
"Renders scenes in which light finds its way through narrow gaps: caustics,
glossy on glossy, lamps behind glass. An implementation of Hessian-Hamiltonian
Monte Carlo light transport; Veach's, multiplexed, Langevin and reversible jump
Metropolis light transport, bidirectional path tracing and path tracing stand
beside it, so that methods can be compared on the same scenes.")
set(CPACK_RESOURCE_FILE_LICENSE "${CMAKE_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)

# As Debian's own tools find out who makes a package.
set(maintainer "the h2mc authors <h2mc@example.invalid>")
if(DEFINED ENV{DEBEMAIL})
  set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(H2MC_MAINTAINER "${maintainer}" CACHE STRING "Who answers for the package: name <address>")
set(CPACK_PACKAGE_CONTACT "${H2MC_MAINTAINER}")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)  # the libraries' packages and versions, by dpkg-shlibdeps

# Where Debian looks for a package's licence.
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/h2mc" RENAME copyright)

# A package is for other machines than this one.
set(H2MC_NO_PACKAGE "")
if(H2MC_NATIVE)
  set(H2MC_NO_PACKAGE "it is compiled for the processor of this machine (H2MC_NATIVE)")
elseif(H2MC_SANITIZE OR NOT CMAKE_BUILD_TYPE MATCHES "^Rel")
  set(H2MC_NO_PACKAGE "it is no release build")
endif()
set(CPACK_PROJECT_CONFIG_FILE "${CMAKE_BINARY_DIR}/package_check.cmake")
if(H2MC_NO_PACKAGE)
  file(WRITE "${CPACK_PROJECT_CONFIG_FILE}"
    "message(FATAL_ERROR \"h2mc: no package of this build: ${H2MC_NO_PACKAGE}; scripts/package.sh makes one\")\n")
else()
  file(WRITE "${CPACK_PROJECT_CONFIG_FILE}" "")
endif()

include(CPack)
