# One folder, one target: darkroom_module(NAME LIBRARIES...) builds every .cpp of the calling folder and its rooms except
# tests into the static library darkroom_NAME, and links what it may depend on. Tests beside the code are collected in the
# property DARKROOM_TEST_SOURCES and built by tests/CMakeLists.txt.

enable_testing()
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# The files of a room are compiled as one; with -DCMAKE_UNITY_BUILD=OFF each by itself.
if(NOT DEFINED CMAKE_UNITY_BUILD OR NOT PROJECT_IS_TOP_LEVEL)
  set(CMAKE_UNITY_BUILD ON)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
# What other checkouts of the tree have compiled counts, too: paths below the tree are relative in the cache, and
# precompiled headers are known by what they were made of (ccache manual, "Precompiled headers"). By the files themselves:
# preprocessed, a header whose comments changed is the same, but not the one that a precompiled header says it has read.
find_program(DARKROOM_CCACHE ccache)
mark_as_advanced(DARKROOM_CCACHE)
if(DARKROOM_CCACHE AND (PROJECT_IS_TOP_LEVEL OR NOT CMAKE_CXX_COMPILER_LAUNCHER))
  set(launcher ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1 CCACHE_DEPEND=1
    CCACHE_SLOPPINESS=pch_defines,time_macros ${DARKROOM_CCACHE})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${launcher})
  set(CMAKE_C_COMPILER_LAUNCHER ${launcher})
endif()

# The engine alone does without.
if(DARKROOM_APPS OR DARKROOM_SCRIPT OR DARKROOM_HUD)
  find_package(PkgConfig REQUIRED)
else()
  find_package(PkgConfig QUIET)
endif()
find_package(Threads REQUIRED)
# What another project above has brought is taken, whatever by: targets of these names.
if(NOT TARGET fmt::fmt-header-only)
  find_package(fmt REQUIRED)
endif()
# Some systems have the headers without the loader, which the library opens itself.
if(NOT TARGET Vulkan::Headers)
  find_package(VulkanHeaders CONFIG QUIET)
endif()
if(NOT TARGET Vulkan::Headers)
  find_package(Vulkan REQUIRED)
endif()
# The header of Result. Debian has it where every compiler looks; where its package tells another folder, all take that.
if(NOT TARGET tl::expected)
  find_package(tl-expected QUIET GLOBAL)
endif()
set(DARKROOM_EXPECTED $<TARGET_NAME_IF_EXISTS:tl::expected>)

add_library(darkroom_options INTERFACE)
target_link_libraries(darkroom_options INTERFACE ${DARKROOM_EXPECTED})
# Of a room that is compiled as one, gcc takes the types of anonymous namespaces for those of a header.
target_compile_options(darkroom_options INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
if(PROJECT_IS_TOP_LEVEL)
  target_compile_options(darkroom_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
    -Wno-missing-field-initializers)
else()
  # What another project chose is for its own code: without exceptions the library does not compile, with hidden symbols
  # it exports none, and where all numbers are taken for finite it accepts what it should refuse.
  set(CMAKE_CXX_VISIBILITY_PRESET default)
  set(CMAKE_VISIBILITY_INLINES_HIDDEN OFF)
  set(CMAKE_CXX_CLANG_TIDY "")
  target_compile_options(darkroom_options INTERFACE -w -fexceptions -frtti -fno-fast-math)
endif()
# Without -fno-trapping-math and -fno-math-errno the CPU references stay scalar; neither changes a result.
target_compile_options(darkroom_options INTERFACE -fno-trapping-math -fno-math-errno)
if(WIN32)
  # Windows 10, whose header is to leave the names min and max alone.
  target_compile_definitions(darkroom_options INTERFACE NOMINMAX WIN32_LEAN_AND_MEAN _WIN32_WINNT=0x0A00)
endif()
if(DARKROOM_SANITIZE STREQUAL thread)
  target_compile_options(darkroom_options INTERFACE -fsanitize=thread)
  target_link_options(darkroom_options INTERFACE -fsanitize=thread)
elseif(DARKROOM_SANITIZE)
  # What is left out doubles the time of the build, and AddressSanitizer sees most of it.
  target_compile_options(darkroom_options INTERFACE -fsanitize=address,undefined
    -fno-sanitize=vptr,null,alignment,object-size -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(darkroom_options INTERFACE -fsanitize=address,undefined)
endif()
if(DARKROOM_FUZZERS)
  # Counts what inputs reach.
  target_compile_options(darkroom_options INTERFACE -fsanitize=fuzzer-no-link)
endif()
if(DARKROOM_SANITIZE)
  # What is reported is traced back to the driver, which must still be loaded then.
  target_sources(darkroom_options INTERFACE
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${PROJECT_SOURCE_DIR}/tests/keep_libraries.cpp>)
endif()

set(DARKROOM_GENERATED ${PROJECT_BINARY_DIR}/generated)
# What includes are relative to, beside include/: the houses. Not programs/, whose darkroom/ is not <darkroom/...>.
set(DARKROOM_HOUSES engine files run scenes edit proof)
list(TRANSFORM DARKROOM_HOUSES PREPEND ${PROJECT_SOURCE_DIR}/)

# Sets `code` to the C++ files of the calling folder and of its rooms, and adds their tests to DARKROOM_TEST_SOURCES: what
# ends with _test.cpp, test_support*.cpp, and rooms whose name begins with test_. What ends with _posix or _windows is
# for these systems alone.
function(darkroom_sources code)
  file(GLOB sources CONFIGURE_DEPENDS *.cpp */*.cpp)
  set(other_system windows)
  if(WIN32)
    set(other_system posix)
  endif()
  list(FILTER sources EXCLUDE REGEX "_${other_system}(_test)?\\.cpp$")
  set(tests ${sources})
  set(is_test "(_test|/test_support[a-z_]*|/test_[a-z_]+/[a-z_]+)\\.cpp$")
  list(FILTER tests INCLUDE REGEX ${is_test})
  list(FILTER sources EXCLUDE REGEX ${is_test})
  set_property(GLOBAL APPEND PROPERTY DARKROOM_TEST_SOURCES ${tests})
  set(${code} ${sources} PARENT_SCOPE)
endfunction()

# The files of a room (a folder) are compiled as one: most of the time is in the headers, which they share. Sources are
# all full paths.
function(darkroom_compile_by_room target)
  foreach(source ${ARGN})
    cmake_path(GET source PARENT_PATH room)
    cmake_path(RELATIVE_PATH room BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    string(MAKE_C_IDENTIFIER ${room} room)
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${room})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
endfunction()

# A program that is run while the tree is built, from one file: for the system that builds, whatever it builds for. Sets
# `command` to what runs it, and a custom command depends on.
function(darkroom_build_program command name source)
  if(NOT CMAKE_CROSSCOMPILING)
    add_executable(${name} ${source})
    target_link_libraries(${name} PRIVATE darkroom_options)
    set(${command} ${name} PARENT_SCOPE)
    return()
  endif()
  find_program(DARKROOM_BUILD_COMPILER NAMES c++ g++ clang++ REQUIRED)
  set(program ${PROJECT_BINARY_DIR}/build_programs/${name})
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/build_programs)
  add_custom_command(OUTPUT ${program} DEPENDS ${source} VERBATIM
    COMMAND ${DARKROOM_BUILD_COMPILER} -std=c++20 -O2 -o ${program} ${source})
  set(${command} ${program} PARENT_SCOPE)
endfunction()

function(darkroom_module name)
  darkroom_sources(sources)
  add_library(darkroom_${name} STATIC ${sources})
  darkroom_compile_by_room(darkroom_${name} ${sources})
  target_include_directories(darkroom_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include ${DARKROOM_HOUSES}
    ${DARKROOM_GENERATED}/include)
  target_link_libraries(darkroom_${name} PUBLIC ${ARGN} PRIVATE darkroom_options)
endfunction()

# Compiles modules that are there with less than the -O3 of a release.
function(darkroom_optimize level)
  foreach(name ${ARGN})
    if(TARGET darkroom_${name})
      target_compile_options(darkroom_${name} PRIVATE $<$<CONFIG:Release>:${level}>)
    endif()
  endforeach()
endfunction()

# Has `output` made, a C++ initialiser for each file that matches one of PATTERNS below `folder`: its name there, behind
# `prefix`, and its text. It is made again when one of them changes, without configuring.
function(darkroom_embed target output folder prefix)
  list(TRANSFORM ARGN PREPEND ${folder}/)
  file(GLOB files RELATIVE ${folder} CONFIGURE_DEPENDS ${ARGN})
  set(paths ${files})
  list(TRANSFORM paths PREPEND ${folder}/)
  list(JOIN files "," names)
  set(script ${PROJECT_SOURCE_DIR}/cmake/DarkroomEmbed.cmake)
  add_custom_command(OUTPUT ${output} DEPENDS ${paths} ${script} VERBATIM
    COMMENT "Embedding ${names}"
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DFOLDER=${folder} -DPREFIX=${prefix} -DFILES=${names} -P ${script})
  target_sources(${target} PRIVATE ${output})
endfunction()
