# SPDX-License-Identifier: MIT
# What can be chosen, and the flags that follow from it. The flags are set for the whole tree: vector types travel
# between the libraries, so every file has to be compiled for the same instruction set.

option(H2MC_NATIVE "Compile for the processor of this machine (-march=native)" ON)
set(H2MC_ARCH "" CACHE STRING
    "Instruction set when H2MC_NATIVE is off, such as x86-64-v3; empty for the compiler's own")
option(H2MC_WERROR "Treat warnings as errors" OFF)
set(H2MC_DERIVATIVE_EDGES 4 CACHE STRING
    "Longest paths that have the plain derivative beside the local one, 4 to 8 edges")
set(H2MC_SANITIZE "" CACHE STRING "Sanitizers to build with, such as address,undefined")
option(H2MC_MPI "Renders by mpirun, where MPI is found" ON)
option(H2MC_BUILD_TESTS "Build the tests, where GoogleTest is found" ON)
set(H2MC_TEST_FOLDERS "ad;unit;derivative;statistical;stress;image;threads" CACHE STRING
    "Which folders of tests to build; there is fuzz too")
option(H2MC_BUILD_FUZZERS "Build the programs of tests/fuzz with libFuzzer, by clang" OFF)
option(H2MC_BUILD_BENCHMARKS "Build the benchmarks, where Google Benchmark is found" ON)
set(H2MC_DATA_DIR "${CMAKE_SOURCE_DIR}/../shared/data" CACHE PATH
    "Published scenes and reference images, for the tests")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
  set_property(CACHE CMAKE_BUILD_TYPE PROPERTY STRINGS Release Debug RelWithDebInfo)
endif()

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_compile_options(-Wall -Wextra -Wno-psabi)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  add_compile_options(-Wno-restrict)  # GCC 12 sees overlaps in std::string's operator+ (GCC bug 105651)
endif()
if(H2MC_WERROR)
  add_compile_options(-Werror)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    add_compile_options(-Wno-error=maybe-uninitialized)  # a guess that depends on what was inlined
  endif()
endif()

# Never -ffast-math or -Ofast: they allow the compiler to delete the checks for values that are not finite.
add_compile_options(-fno-math-errno -fno-trapping-math)

if(H2MC_NATIVE)
  add_compile_options(-march=native)
elseif(H2MC_ARCH)
  add_compile_options("-march=${H2MC_ARCH}")
endif()

if(H2MC_SANITIZE)
  add_compile_options("-fsanitize=${H2MC_SANITIZE}" -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options("-fsanitize=${H2MC_SANITIZE}")
endif()
