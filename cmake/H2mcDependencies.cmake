# SPDX-License-Identifier: MIT
# Every library the renderer stands on. All are packages of Debian 12; scripts/packages.txt lists them.

find_package(Threads REQUIRED)

find_package(embree 3 CONFIG QUIET)
if(NOT embree_FOUND)
  find_package(embree 4 CONFIG REQUIRED)
endif()
string(REGEX MATCH "^[0-9]+" H2MC_EMBREE_MAJOR "${embree_VERSION}")
message(STATUS "Embree ${embree_VERSION}")

# Debian's Imath reports at length that its Python bindings, which nobody asked for, are absent.
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(OpenImageIO MODULE REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
unset(CMAKE_MESSAGE_LOG_LEVEL)
message(STATUS "OpenImageIO ${OpenImageIO_VERSION}, OpenEXR ${OpenEXR_VERSION}")

find_package(TBB CONFIG REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(pugixml CONFIG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(fmt CONFIG REQUIRED)
find_package(spdlog CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)
find_package(Boost 1.74 REQUIRED)  # headers alone: Student's distribution

# What the program can do without.

# Pages while a render goes on (--serve). Debian's cpp-httplib comes with pkg-config's
# file alone, which says what the library was compiled with; others have CMake's.
find_package(httplib CONFIG QUIET)
find_package(PkgConfig QUIET)
if(NOT TARGET httplib::httplib AND PKG_CONFIG_FOUND)
  pkg_check_modules(H2MC_HTTPLIB QUIET IMPORTED_TARGET cpp-httplib)
  if(H2MC_HTTPLIB_FOUND)
    add_library(httplib::httplib ALIAS PkgConfig::H2MC_HTTPLIB)
  endif()
endif()
if(NOT TARGET httplib::httplib)
  message(STATUS "No --serve: it needs the Debian packages libcpp-httplib-dev and pkg-config")
endif()

# Figures for papers (h2mc compare).
if(PKG_CONFIG_FOUND)
  pkg_check_modules(H2MC_CAIRO QUIET IMPORTED_TARGET cairo-pdf cairo-svg)
endif()
if(NOT H2MC_CAIRO_FOUND)
  message(STATUS "No figures by h2mc compare: they need the Debian packages libcairo2-dev and pkg-config")
endif()

# Renders by several processes. Debian's name for the MPI that is installed, then those of the two that there are.
if(PKG_CONFIG_FOUND AND H2MC_MPI)
  pkg_search_module(H2MC_MPI QUIET IMPORTED_TARGET mpi-c ompi-c mpich)
endif()
if(H2MC_MPI AND NOT H2MC_MPI_FOUND)
  message(STATUS "No renders by mpirun: they need the Debian packages libopenmpi-dev and pkg-config")
endif()
