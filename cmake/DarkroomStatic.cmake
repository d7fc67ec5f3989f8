# The target darkroom_static: libdarkroom.a, one object of all that libdarkroom.so is made of, the GLSL compiler and fmt
# included. All symbols but those of darkroom:: are local to it, so that it stands beside another glslang, shaderc or
# fmt in one program. Needs the linker and objcopy of GNU, and shaderc as an archive.

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
set(objects "")
foreach(part ${DARKROOM_PARTS})
  # A precompiled header counts among them.
  list(APPEND objects "$<FILTER:$<TARGET_OBJECTS:darkroom_${part}>,EXCLUDE,\\.(gch|pch)$>")
endforeach()

# Groups are dissolved: the linker would throw a group away where the host has one of the same name, and with it code
# that local symbols refer to. The binding "unique" of some static variables is one that objcopy leaves as it is; these
# get names that nobody else has.
set(whole ${CMAKE_BINARY_DIR}/darkroom_static.o)
add_custom_command(OUTPUT ${whole} COMMAND_EXPAND_LISTS VERBATIM
  COMMAND ${DARKROOM_GNU_LINKER} -r --force-group-allocation -o ${whole} ${objects} --start-group ${libraries} --end-group
  COMMAND ${CMAKE_OBJCOPY} --wildcard --keep-global-symbol "_ZN8darkroom*" --keep-global-symbol "_ZNK8darkroom*"
    --keep-global-symbol "_ZZN8darkroom*" --keep-global-symbol "_ZZNK8darkroom*"
    --keep-global-symbol "_ZT?N8darkroom*" --keep-global-symbol "_ZGV*N8darkroom*" ${whole}
  COMMAND sh -c "${CMAKE_NM} --defined-only ${whole} |\
 awk '$2 == \"u\" && $3 !~ /^_Z(GV)?Z*NK?8darkroom/ { print $3, \"darkroom.\" $3 }' >${whole}.unique"
  COMMAND ${CMAKE_OBJCOPY} --redefine-syms ${whole}.unique ${whole}
  DEPENDS ${objects} ${libraries} COMMENT "Linking darkroom_static.o")
set_source_files_properties(${whole} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
add_library(darkroom_static STATIC ${whole})
set_target_properties(darkroom_static PROPERTIES OUTPUT_NAME darkroom EXPORT_NAME static LINKER_LANGUAGE CXX)
target_include_directories(darkroom_static INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
  $<BUILD_INTERFACE:${DARKROOM_GENERATED}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(darkroom_static INTERFACE cxx_std_20)
target_link_libraries(darkroom_static INTERFACE Vulkan::Headers Threads::Threads ${CMAKE_DL_LIBS})
add_library(Darkroom::static ALIAS darkroom_static)
set_property(GLOBAL APPEND PROPERTY DARKROOM_LIBRARIES darkroom_static)
