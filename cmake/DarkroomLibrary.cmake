# What an engine links. In C, and from every other language: libdarkroom.so, all of core, glsl, gpu, graph, plan,
# compose, effects, custom and looks, which exports darkroom_* and nothing else. In C++: libdarkroom_cpp.so, the same
# without looks, libdarkroom_looks.so, which reads looks (TOML) and table files, libdarkroom_script.so, a console and
# controllers in Lua, and libdarkroom_hud.so, documents of the interface. The first of each are archives as well,
# libdarkroom_c.a and libdarkroom.a (DARKROOM_STATIC). In the tree and installed they are Darkroom::c and c_static, and
# Darkroom::darkroom, looks, script, hud and static. Included after the folders they are made of; installed by cmake/install/library.
# Two libraries of the same objects, because a C++ interface over the C one would write every class a second time.

# What libdarkroom_cpp.so and the libraries on top of it export: the project's C++ symbols, but for those of namespaces that
# no public header asks for. Others stay inside, so that a host may have its own glslang, shaderc or fmt. By mangled names,
# in which a name stands behind its length: unmangled, a template of the standard library that returns one of our types
# begins as ours do.
set(DARKROOM_INNER 3gpu 4plan 5graph 6custom 7compose)
list(JOIN DARKROOM_INNER "|" DARKROOM_INNER_REGEX)
# Of two globs that match, the linker takes the one that exports: what is not to match is left out letter by letter.
set(beginnings "")
foreach(name ${DARKROOM_INNER})
  string(LENGTH ${name} length)
  math(EXPR last "${length} - 1")
  foreach(at RANGE ${last})
    string(SUBSTRING ${name} 0 ${at} beginning)
    string(SUBSTRING ${name} ${at} 1 letter)
    list(APPEND beginnings .${beginning})
    string(APPEND after.${beginning} ${letter})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES beginnings)
set(map "{\n  global:\n")
foreach(kind N NK ZN ZNK T?N T?NK GV*N)
  foreach(beginning ${beginnings})
    string(REPLACE "." "_Z${kind}8darkroom" pattern ${beginning})
    string(APPEND map "    ${pattern}[!${after${beginning}}]*;\n")
  endforeach()
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/darkroom.map CONTENT "${map}  local: *;\n};\n" @ONLY)

# Of the library's symbols the host sees those that the version script lets through. On Windows the functions of C are
# marked in their header, and those of C++ are listed from the objects of its PARTS.
function(darkroom_export_own_symbols name map)
  if(WIN32)
    if(map MATCHES "darkroom_c[.]map$")
      return()
    endif()
    list(TRANSFORM ARGN REPLACE "(.+)" "$<FILTER:$<TARGET_OBJECTS:darkroom_\\1>,EXCLUDE,[.][gp]ch$>" OUTPUT_VARIABLE objects)
    set(list ${PROJECT_BINARY_DIR}/${name}.objects)
    set(exports ${PROJECT_BINARY_DIR}/${name}.def)
    file(GENERATE OUTPUT ${list} CONTENT "$<JOIN:${objects},\n>\n")
    set(script ${PROJECT_SOURCE_DIR}/cmake/DarkroomExports.cmake)
    add_custom_command(OUTPUT ${exports} DEPENDS ${objects} ${list} ${script} VERBATIM
      COMMENT "Listing what ${name} exports"
      COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DOBJECTS=${list} -DINNER=${DARKROOM_INNER_REGEX} -DOUTPUT=${exports}
        -P ${script})
    target_sources(${name} PRIVATE ${exports})
    return()
  endif()
  set_target_properties(${name} PROPERTIES LINK_DEPENDS ${map})
  # Calls from one function of the library to another take no detour for a host that might have one of that name.
  target_link_options(${name} PRIVATE LINKER:--version-script=${map} LINKER:-Bsymbolic-functions)
  if(NOT DARKROOM_SANITIZE)
    # A library that is used here and not named would be a surprise for the host.
    target_link_options(${name} PRIVATE LINKER:-z,defs)
  endif()
endfunction()

# Objects, not archives: all of a folder goes in, and what it links comes from the folder's own target. The names of
# this project are dropped from that list, their objects are already there.
function(darkroom_shared_library name)
  cmake_parse_arguments(PARSE_ARGV 1 library "" "OUTPUT;EXPORT;MAP" "PARTS")
  add_library(${name} SHARED)
  foreach(part ${library_PARTS})
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:darkroom_${part}>)
    target_link_libraries(${name} PRIVATE
      "$<FILTER:$<TARGET_PROPERTY:darkroom_${part},LINK_LIBRARIES>,EXCLUDE,^darkroom_(core|glsl|no_glsl|gpu|graph|plan|compose|effects|custom|toml|tables|looks|script|confined|hud|c)$>")
  endforeach()
  set_target_properties(${name} PROPERTIES OUTPUT_NAME ${library_OUTPUT} EXPORT_NAME ${library_EXPORT}
    LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  darkroom_export_own_symbols(${name} ${library_MAP} ${library_PARTS})
  target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${DARKROOM_GENERATED}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  if(NOT library_EXPORT STREQUAL c)
    target_compile_features(${name} INTERFACE cxx_std_20)
  endif()
  add_library(Darkroom::${library_EXPORT} ALIAS ${name})
  set_property(GLOBAL APPEND PROPERTY DARKROOM_LIBRARIES ${name})
endfunction()

set(DARKROOM_PARTS core ${DARKROOM_GLSL} gpu graph plan compose effects custom)
darkroom_shared_library(darkroom_shared OUTPUT darkroom_cpp EXPORT darkroom MAP ${PROJECT_BINARY_DIR}/darkroom.map PARTS ${DARKROOM_PARTS})
set(looks "")
if(TARGET darkroom_looks)
  set(looks toml tables looks)
endif()
darkroom_shared_library(darkroom_c_shared OUTPUT darkroom EXPORT c MAP ${PROJECT_SOURCE_DIR}/cmake/darkroom_c.map PARTS ${DARKROOM_PARTS} ${looks} c)
# The headers name Vulkan types; a host calls Vulkan through whatever loader it has.
target_link_libraries(darkroom_shared INTERFACE Vulkan::Headers ${DARKROOM_EXPECTED})
target_link_libraries(darkroom_c_shared INTERFACE Vulkan::Headers)
if(TARGET darkroom_looks)
  darkroom_shared_library(darkroom_looks_shared OUTPUT darkroom_looks EXPORT looks MAP ${PROJECT_BINARY_DIR}/darkroom.map PARTS toml tables looks)
  target_link_libraries(darkroom_looks_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(TARGET darkroom_script)
  darkroom_shared_library(darkroom_script_shared OUTPUT darkroom_script EXPORT script MAP ${PROJECT_BINARY_DIR}/darkroom.map PARTS script)
  target_link_libraries(darkroom_script_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(TARGET darkroom_hud)
  darkroom_shared_library(darkroom_hud_shared OUTPUT darkroom_hud EXPORT hud MAP ${PROJECT_BINARY_DIR}/darkroom.map PARTS confined hud)
  target_link_libraries(darkroom_hud_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(DARKROOM_STATIC)
  include(DarkroomStatic)
endif()
