# Sets DARKROOM_PYTHON_PROGRAM, an interpreter for which the package darkroom is built, and DARKROOM_PYTHON_FACTS: its
# headers, those of pybind11, and how a module's name ends. It is the first with numpy, pybind11 and setuptools, so that
# one of a user's own that stands before the system's is passed over where it lacks them. Empty: none, or not asked for.
# DARKROOM_PYTHON_PYBIND11 names a folder of headers in place of that pybind11's.

set(facts "")
set(program "")
if(DARKROOM_PYTHON STREQUAL "AUTO")
  set(is_wanted OFF)
  if(DARKROOM_TESTS AND DARKROOM_LOOKS AND DARKROOM_COMPILER AND NOT DARKROOM_SANITIZE AND NOT DARKROOM_TEST_FOLDERS)
    set(is_wanted ON)
  endif()
else()
  set(is_wanted ${DARKROOM_PYTHON})
endif()
if(is_wanted)
  set(asks "import sysconfig, numpy, pybind11, setuptools, wheel; print(sysconfig.get_path('include'), pybind11.get_include(), sysconfig.get_config_var('EXT_SUFFIX'), sep=';')")
  foreach(candidate ${DARKROOM_PYTHON_INTERPRETER} python3 /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "${asks}" OUTPUT_VARIABLE facts OUTPUT_STRIP_TRAILING_WHITESPACE
      ERROR_QUIET RESULT_VARIABLE result)
    if(result EQUAL 0)
      list(GET facts 0 headers)
      if(EXISTS ${headers}/Python.h)
        set(program ${candidate})
        break()
      endif()
    endif()
  endforeach()
  if(NOT program AND DARKROOM_PYTHON STREQUAL "ON")
    message(FATAL_ERROR "DARKROOM_PYTHON=ON: no python3 has its headers (python3-dev), numpy, pybind11, setuptools and "
      "wheel; DARKROOM_PYTHON_INTERPRETER names one")
  endif()
endif()
if(program AND DARKROOM_PYTHON_PYBIND11)
  list(REMOVE_AT facts 1)
  list(INSERT facts 1 ${DARKROOM_PYTHON_PYBIND11})
endif()
set(DARKROOM_PYTHON_PROGRAM ${program})
set(DARKROOM_PYTHON_FACTS ${facts})
