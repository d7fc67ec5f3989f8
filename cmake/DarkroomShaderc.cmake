# The target darkroom_shaderc: shaderc, linked in whichever way works here. The shared library of Debian 12 (2023.2) lacks
# symbols and crashes in code generation, so the static ones come first: alone, then with the parts of glslang and
# SPIRV-Tools that are installed (newer ones have no libOGLCompiler), and the shared library last. Where DARKROOM_COMPILER
# is AUTO, it becomes ON or OFF here.

include(CheckCXXSourceCompiles)

find_path(DARKROOM_SHADERC_INCLUDE shaderc/shaderc.hpp)
find_library(DARKROOM_SHADERC_COMBINED NAMES libshaderc_combined.a)
find_library(DARKROOM_SHADERC_SHARED NAMES shaderc shaderc_shared)
macro(darkroom_no_shaderc)
  if(NOT DARKROOM_COMPILER STREQUAL AUTO)
    message(FATAL_ERROR ${ARGN})
  endif()
  message(STATUS "Darkroom has no compiler of GLSL, its kernels come from baked files: " ${ARGN})
  set(DARKROOM_COMPILER OFF)
  return()
endmacro()
if(NOT DARKROOM_SHADERC_INCLUDE)
  darkroom_no_shaderc("shaderc/shaderc.hpp not found: install libshaderc-dev")
endif()

set(DARKROOM_GLSLANG_PARTS)
foreach(part glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler SPIRV SPIRV-Tools-opt SPIRV-Tools)
  find_library(DARKROOM_PART_${part} NAMES lib${part}.a)
  mark_as_advanced(DARKROOM_PART_${part})
  if(DARKROOM_PART_${part})
    list(APPEND DARKROOM_GLSLANG_PARTS ${DARKROOM_PART_${part}})
  endif()
endforeach()

function(darkroom_try_shaderc result)
  set(CMAKE_REQUIRED_INCLUDES ${DARKROOM_SHADERC_INCLUDE})
  set(CMAKE_REQUIRED_LIBRARIES ${ARGN} Threads::Threads)
  check_cxx_source_compiles("
    #include <shaderc/shaderc.hpp>
    int main() {
      const shaderc::Compiler compiler;
      const shaderc::CompileOptions options;
      return static_cast<int>(compiler.CompileGlslToSpv(\"\", shaderc_compute_shader, \"\", options).GetNumErrors());
    }" ${result})
endfunction()

set(DARKROOM_SHADERC_LIBRARIES)
if(DARKROOM_SHADERC_COMBINED)
  darkroom_try_shaderc(DARKROOM_SHADERC_LINKS_ALONE ${DARKROOM_SHADERC_COMBINED})
  if(DARKROOM_SHADERC_LINKS_ALONE)
    set(DARKROOM_SHADERC_LIBRARIES ${DARKROOM_SHADERC_COMBINED})
  else()
    darkroom_try_shaderc(DARKROOM_SHADERC_LINKS_WITH_PARTS ${DARKROOM_SHADERC_COMBINED} ${DARKROOM_GLSLANG_PARTS})
    if(DARKROOM_SHADERC_LINKS_WITH_PARTS)
      set(DARKROOM_SHADERC_LIBRARIES ${DARKROOM_SHADERC_COMBINED} ${DARKROOM_GLSLANG_PARTS})
    endif()
  endif()
endif()
if(NOT DARKROOM_SHADERC_LIBRARIES AND DARKROOM_SHADERC_SHARED)
  darkroom_try_shaderc(DARKROOM_SHADERC_LINKS_SHARED ${DARKROOM_SHADERC_SHARED})
  if(DARKROOM_SHADERC_LINKS_SHARED)
    set(DARKROOM_SHADERC_LIBRARIES ${DARKROOM_SHADERC_SHARED})
  endif()
endif()
if(NOT DARKROOM_SHADERC_LIBRARIES)
  darkroom_no_shaderc("no shaderc library links: install libshaderc-dev, glslang-dev and spirv-tools")
endif()
set(DARKROOM_COMPILER ON)

add_library(darkroom_shaderc INTERFACE)
target_include_directories(darkroom_shaderc SYSTEM INTERFACE ${DARKROOM_SHADERC_INCLUDE})
target_link_libraries(darkroom_shaderc INTERFACE ${DARKROOM_SHADERC_LIBRARIES} Threads::Threads)

# The SPIR-V cache keeps apart what different compilers made; shaderc cannot be asked for its version at run time.
if(PkgConfig_FOUND)
  pkg_check_modules(DARKROOM_SHADERC_PACKAGE QUIET shaderc)
endif()
set(DARKROOM_SHADERC_VERSION "${DARKROOM_SHADERC_PACKAGE_VERSION}")
file(CONFIGURE OUTPUT ${DARKROOM_GENERATED}/include/gpu/shaderc_version.hpp CONTENT
"// SPDX-License-Identifier: MIT
#pragma once
// Written by cmake/DarkroomShaderc.cmake.

#include <string_view>

namespace darkroom::gpu {

inline constexpr std::string_view shaderc_version = \"@DARKROOM_SHADERC_VERSION@\";

}  // namespace darkroom::gpu
" @ONLY)
