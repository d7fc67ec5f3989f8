# What an engine links: libdarkroom.so, one shared object of core, glsl, gpu, graph, plan, compose, effects and
# custom, libdarkroom_looks.so, which reads looks (TOML) and table files, libdarkroom_script.so, a console and
# controllers in Lua, and libdarkroom_hud.so, documents of the interface; or libdarkroom.a, the first as an archive
# (DARKROOM_STATIC). In the tree and installed they are Darkroom::darkroom, looks, script, hud and static. Included after
# the folders they are made of; installed by cmake/install/library.

# Objects, not archives: all of a folder goes in, and what it links comes from the folder's own target. The names of
# this project are dropped from that list, their objects are already there.
function(darkroom_shared_library name)
  cmake_parse_arguments(PARSE_ARGV 1 library "" "OUTPUT;EXPORT" "PARTS")
  add_library(${name} SHARED)
  foreach(part ${library_PARTS})
    target_sources(${name} PRIVATE $<TARGET_OBJECTS:darkroom_${part}>)
    target_link_libraries(${name} PRIVATE
      "$<FILTER:$<TARGET_PROPERTY:darkroom_${part},LINK_LIBRARIES>,EXCLUDE,^darkroom_(core|glsl|no_glsl|gpu|graph|plan|compose|effects|custom|toml|tables|looks|script|confined|hud)$>")
  endforeach()
  set_target_properties(${name} PROPERTIES OUTPUT_NAME ${library_OUTPUT} EXPORT_NAME ${library_EXPORT}
    LINKER_LANGUAGE CXX VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/darkroom.map)
  target_link_options(${name} PRIVATE LINKER:--version-script=${PROJECT_SOURCE_DIR}/cmake/darkroom.map)
  if(NOT DARKROOM_SANITIZE)
    # A library that is used here and not named would be a surprise for the host.
    target_link_options(${name} PRIVATE LINKER:-z,defs)
  endif()
  target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${DARKROOM_GENERATED}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${name} INTERFACE cxx_std_20)
  add_library(Darkroom::${library_EXPORT} ALIAS ${name})
  set_property(GLOBAL APPEND PROPERTY DARKROOM_LIBRARIES ${name})
endfunction()

set(DARKROOM_PARTS core ${DARKROOM_GLSL} gpu graph plan compose effects custom)
darkroom_shared_library(darkroom_shared OUTPUT darkroom EXPORT darkroom PARTS ${DARKROOM_PARTS})
# The headers name Vulkan types; a host calls Vulkan through whatever loader it has.
target_link_libraries(darkroom_shared INTERFACE Vulkan::Headers)
if(TARGET darkroom_looks)
  darkroom_shared_library(darkroom_looks_shared OUTPUT darkroom_looks EXPORT looks PARTS toml tables looks)
  target_link_libraries(darkroom_looks_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(TARGET darkroom_script)
  darkroom_shared_library(darkroom_script_shared OUTPUT darkroom_script EXPORT script PARTS script)
  target_link_libraries(darkroom_script_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(TARGET darkroom_hud)
  darkroom_shared_library(darkroom_hud_shared OUTPUT darkroom_hud EXPORT hud PARTS confined hud)
  target_link_libraries(darkroom_hud_shared PUBLIC darkroom_shared PRIVATE darkroom_fmt)
endif()
if(DARKROOM_STATIC)
  include(DarkroomStatic)
endif()
