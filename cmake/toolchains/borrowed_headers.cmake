# For a compiler of another system that has no packages of its own: what is the same everywhere is taken from this one.
# Headers of Vulkan, fmt and libexpected, and GoogleTest's sources. Named by CMAKE_PROJECT_darkroom_INCLUDE, so that the
# tree itself finds packages as ever. Links in a folder of their own: in /usr/include they stand beside headers of this
# system's C library, which another compiler must not see.
set(borrowed ${CMAKE_BINARY_DIR}/borrowed)
file(MAKE_DIRECTORY ${borrowed}/include ${borrowed}/lib ${borrowed}/fmt ${borrowed}/gtest)
foreach(folder vulkan vk_video fmt tl)
  if(NOT EXISTS /usr/include/${folder})
    message(FATAL_ERROR "/usr/include/${folder} is not there: packages libvulkan-dev, libfmt-dev and libexpected-dev")
  endif()
  file(CREATE_LINK /usr/include/${folder} ${borrowed}/include/${folder} SYMBOLIC)
endforeach()

# The loader's import library, of all functions that the headers declare; the DLL is the system's.
file(STRINGS ${borrowed}/include/vulkan/vulkan_core.h functions REGEX "VKAPI_CALL vk[A-Za-z0-9]+\\(")
list(TRANSFORM functions REPLACE ".*VKAPI_CALL (vk[A-Za-z0-9]+).*" "\\1")
list(JOIN functions "\n" functions)
file(CONFIGURE OUTPUT ${borrowed}/vulkan-1.def CONTENT "LIBRARY vulkan-1.dll\nEXPORTS\n@functions@\n" @ONLY)
set(Vulkan_INCLUDE_DIR ${borrowed}/include CACHE PATH "")
set(Vulkan_LIBRARY ${borrowed}/lib/libvulkan-1.a CACHE FILEPATH "")
if(NOT EXISTS ${Vulkan_LIBRARY})
  execute_process(COMMAND ${CMAKE_DLLTOOL} -d ${borrowed}/vulkan-1.def -l ${Vulkan_LIBRARY} COMMAND_ERROR_IS_FATAL ANY)
endif()

file(STRINGS ${borrowed}/include/fmt/core.h version REGEX "^#define FMT_VERSION [0-9]+")
string(REGEX REPLACE ".* " "" version "${version}")
math(EXPR major "${version} / 10000")
math(EXPR minor "${version} / 100 % 100")
file(CONFIGURE OUTPUT ${borrowed}/fmt/fmt-config-version.cmake @ONLY CONTENT
"set(PACKAGE_VERSION @major@.@minor@)
set(PACKAGE_VERSION_COMPATIBLE TRUE)
")
file(CONFIGURE OUTPUT ${borrowed}/fmt/fmt-config.cmake @ONLY CONTENT
"add_library(fmt::fmt-header-only INTERFACE IMPORTED)
target_compile_definitions(fmt::fmt-header-only INTERFACE FMT_HEADER_ONLY=1)
target_include_directories(fmt::fmt-header-only INTERFACE @borrowed@/include)
")
set(fmt_DIR ${borrowed}/fmt CACHE PATH "")

# Its targets are named as those of its package.
file(CONFIGURE OUTPUT ${borrowed}/gtest/GTestConfig.cmake @ONLY CONTENT
"set(INSTALL_GTEST OFF)
set(BUILD_GMOCK OFF)
add_subdirectory(/usr/src/googletest @borrowed@/googletest EXCLUDE_FROM_ALL)
")
set(GTest_DIR ${borrowed}/gtest CACHE PATH "")
