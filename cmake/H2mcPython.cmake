# SPDX-License-Identifier: MIT
# The Python module h2mc, where pybind11 and an interpreter with NumPy and its headers are found. Python_EXECUTABLE
# chooses the interpreter; it works with that version of Python alone.

set(H2MC_PYTHON AUTO CACHE STRING "The Python module: AUTO (where it can be built), ON, OFF")
set_property(CACHE H2MC_PYTHON PROPERTY STRINGS AUTO ON OFF)
set(H2MC_PYTHON_FOUND OFF)
if(H2MC_PYTHON STREQUAL OFF OR H2MC_SANITIZE)
  return()
endif()

# The first interpreter that has NumPy: the one in PATH need not be Debian's, whose packages these are.
if(NOT Python_EXECUTABLE)
  foreach(candidate python3 /usr/bin/python3)
    execute_process(COMMAND "${candidate}" -c "import numpy, sys; print(sys.executable)" RESULT_VARIABLE failed
                    OUTPUT_VARIABLE found ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed)
      set(Python_EXECUTABLE "${found}" CACHE FILEPATH "The interpreter that the module h2mc is for")
      break()
    endif()
  endforeach()
endif()
set(PYBIND11_FINDPYTHON ON)
if(Python_EXECUTABLE)
  find_package(Python COMPONENTS Interpreter Development.Module QUIET)
  find_package(pybind11 CONFIG QUIET)
endif()
if(Python_Development.Module_FOUND AND pybind11_FOUND)
  set(H2MC_PYTHON_FOUND ON)
  message(STATUS "Python ${Python_VERSION}, pybind11 ${pybind11_VERSION}")
elseif(H2MC_PYTHON STREQUAL ON)
  message(FATAL_ERROR "The Python module needs pybind11, NumPy and Python's headers: the Debian packages "
                      "pybind11-dev, python3-numpy, libpython3-dev")
else()
  message(STATUS "No Python module: it needs the Debian packages pybind11-dev, python3-numpy, libpython3-dev")
endif()
