# Archives of one object each, with the GLSL compiler and fmt inside: darkroom_static, libdarkroom.a for C++, whose symbols
# are those of darkroom::, and darkroom_c_static, libdarkroom_c.a for C, whose symbols are darkroom_*. All others are local,
# so that it stands beside another glslang, shaderc or fmt in one program. Needs the linker and objcopy of GNU, and shaderc
# as an archive.

set(DARKROOM_STATIC_COMPILER "")
if(TARGET darkroom_shaderc)
  get_target_property(DARKROOM_STATIC_COMPILER darkroom_shaderc INTERFACE_LINK_LIBRARIES)
  list(FILTER DARKROOM_STATIC_COMPILER INCLUDE REGEX "\\.(a|so)$")
endif()
if(DARKROOM_STATIC_COMPILER MATCHES "\\.so")
  message(STATUS "libdarkroom.a is left out: shaderc is a shared library here")
  return()
endif()
# Beside another compiler CMAKE_LINKER may be that of LLVM.
find_program(DARKROOM_GNU_LINKER NAMES ld.bfd ld)
mark_as_advanced(DARKROOM_GNU_LINKER)
set(libraries ${DARKROOM_STATIC_COMPILER})
get_target_property(type darkroom_fmt TYPE)
if(type STREQUAL STATIC_LIBRARY)
  list(APPEND libraries $<TARGET_FILE:darkroom_fmt>)
endif()
set(inner "")
foreach(name ${DARKROOM_INNER})
  list(APPEND inner "!_Z*N8darkroom${name}*" "!_Z*NK8darkroom${name}*")
endforeach()
# darkroom_archive(TARGET OUTPUT FILE EXPORT NAME OURS REGEX KEEP PATTERN... PARTS FOLDER...): KEEP are the symbols that stay
# global, OURS matches them as well.
# Groups are dissolved: the linker would throw a group away where the host has one of the same name, and with it code
# that local symbols refer to. The binding "unique" of some static variables is one that objcopy leaves as it is; these
# get names that nobody else has.
function(darkroom_archive target)
  cmake_parse_arguments(PARSE_ARGV 1 archive "" "OUTPUT;EXPORT;OURS" "KEEP;PARTS")
  set(objects "")
  foreach(part ${archive_PARTS})
    # A precompiled header counts among them.
    list(APPEND objects "$<FILTER:$<TARGET_OBJECTS:darkroom_${part}>,EXCLUDE,\\.(gch|pch)$>")
  endforeach()
  set(keep "")
  foreach(pattern ${archive_KEEP})
    list(APPEND keep --keep-global-symbol ${pattern})
  endforeach()
  set(whole ${PROJECT_BINARY_DIR}/${target}.o)
  add_custom_command(OUTPUT ${whole} COMMAND_EXPAND_LISTS VERBATIM
    COMMAND ${DARKROOM_GNU_LINKER} -r --force-group-allocation -o ${whole} ${objects} --start-group ${libraries} --end-group
    COMMAND ${CMAKE_OBJCOPY} --wildcard ${keep} ${whole}
    COMMAND sh -c "${CMAKE_NM} --defined-only ${whole} |\
 awk '$2 == \"u\" && ($3 !~ /${archive_OURS}/ || $3 ~ /^_Z(GV)?Z*NK?8darkroom(${DARKROOM_INNER_REGEX})/) { print $3, \"${target}.\" $3 }' >${whole}.unique"
    COMMAND ${CMAKE_OBJCOPY} --redefine-syms ${whole}.unique ${whole}
    DEPENDS ${objects} ${libraries} COMMENT "Linking ${target}.o")
  set_source_files_properties(${whole} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  add_library(${target} STATIC ${whole})
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${archive_OUTPUT} EXPORT_NAME ${archive_EXPORT})
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${DARKROOM_GENERATED}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(${target} INTERFACE Vulkan::Headers Threads::Threads ${CMAKE_DL_LIBS})
  add_library(Darkroom::${archive_EXPORT} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY DARKROOM_LIBRARIES ${target})
endfunction()

darkroom_archive(darkroom_static OUTPUT darkroom EXPORT static OURS "^_Z(GV)?Z*NK?8darkroom" PARTS ${DARKROOM_PARTS}
  KEEP "_ZN8darkroom*" "_ZNK8darkroom*" "_ZZN8darkroom*" "_ZZNK8darkroom*" "_ZT?N8darkroom*" "_ZGV*N8darkroom*" ${inner})
set_target_properties(darkroom_static PROPERTIES LINKER_LANGUAGE CXX)
target_link_libraries(darkroom_static INTERFACE ${DARKROOM_EXPECTED})
target_compile_features(darkroom_static INTERFACE cxx_std_20)
darkroom_archive(darkroom_c_static OUTPUT darkroom_c EXPORT c_static OURS "^darkroom_" KEEP "darkroom_*"
  PARTS ${DARKROOM_PARTS} ${looks} c)
# A project in C alone links the C++ runtime by its name.
set_target_properties(darkroom_c_static PROPERTIES LINKER_LANGUAGE C)
target_link_libraries(darkroom_c_static INTERFACE stdc++ m)
