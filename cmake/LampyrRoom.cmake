# lampyr_room(NAME SOURCES… LINK …): a folder of the house as a static library `lampyr_NAME`, with the project's warnings.
# What it links is what it may include: arrows run down only.
add_library(lampyr_settings INTERFACE)
target_include_directories(lampyr_settings INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
  $<INSTALL_INTERFACE:include/lampyr>)
target_compile_features(lampyr_settings INTERFACE cxx_std_20)
target_link_libraries(lampyr_settings INTERFACE glm::glm)

# Not exported: how we build our own code. -fno-math-errno and -fno-trapping-math change no result.
# -fno-semantic-interposition: nothing replaces our functions at run time, so they may be inlined within their file.
add_library(lampyr_warnings INTERFACE)
target_compile_options(lampyr_warnings INTERFACE
  -Wall -Wextra -Wdouble-promotion -fno-math-errno -fno-trapping-math -fno-semantic-interposition)
# What another compiler warns of besides stops no build with it.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(lampyr_warnings INTERFACE -Werror)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 reports overlaps and overflows that cannot be, in `"text" + std::string` (GCC bug 105651, 105329).
  target_compile_options(lampyr_warnings INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
    -Wno-array-bounds)
endif()
if(LAMPYR_NATIVE)
  target_compile_options(lampyr_warnings INTERFACE -march=native)
endif()
if(LAMPYR_SANITIZE)
  # Instrumented code looks uninitialised to g++ 12 where it is not.
  target_compile_options(lampyr_warnings INTERFACE -fsanitize=${LAMPYR_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  target_link_options(lampyr_warnings INTERFACE -fsanitize=${LAMPYR_SANITIZE})
endif()

# Headers that nearly every file reads, parsed once: half of the time that compiling takes. Files include what they use
# all the same: other builds (fuzzers, ThreadSanitizer, plugins) go without.
set(LAMPYR_COMMON_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <map> <memory> <optional> <set>
  <span> <sstream> <string> <variant> <vector> ${PROJECT_SOURCE_DIR}/src/math/vec.h)
if(LAMPYR_PRECOMPILE)
  file(WRITE ${CMAKE_BINARY_DIR}/precompiled.cpp.new "")
  file(COPY_FILE ${CMAKE_BINARY_DIR}/precompiled.cpp.new ${CMAKE_BINARY_DIR}/precompiled.cpp ONLY_IF_DIFFERENT)
  add_library(lampyr_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled.cpp)
  target_link_libraries(lampyr_precompiled PRIVATE lampyr_settings lampyr_warnings)
  target_precompile_headers(lampyr_precompiled PRIVATE ${LAMPYR_COMMON_HEADERS})
endif()

function(lampyr_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(lampyr_${name} STATIC ${ROOM_SOURCES})
  target_link_libraries(lampyr_${name}
    PUBLIC lampyr_settings ${ROOM_LINK}
    PRIVATE $<BUILD_INTERFACE:lampyr_warnings> ${ROOM_PRIVATE_LINK})
  if(LAMPYR_PRECOMPILE)
    target_precompile_headers(lampyr_${name} REUSE_FROM lampyr_precompiled)
  endif()
  set_property(GLOBAL APPEND PROPERTY LAMPYR_ROOMS lampyr_${name})
endfunction()

# lampyr_plugin_host(TARGET): an executable that loads plugins. They bring no copy of the rooms (lights/plugin/plugin_api.h
# says why) and use those of the executable: it holds the lights and all that they know in full, also what it does not
# use itself, and exports the symbols of namespace lampyr. Not those of the libraries below, which would replace others'.
function(lampyr_plugin_host target)
  set_target_properties(${target} PROPERTIES LINK_LIBRARY_OVERRIDE
    "WHOLE_ARCHIVE,lampyr_base,lampyr_math,lampyr_sampling,lampyr_scene,lampyr_geometry,lampyr_film,lampyr_textures,lampyr_materials,lampyr_lights")
  set(list ${PROJECT_SOURCE_DIR}/cmake/plugin_symbols.list)
  target_link_options(${target} PRIVATE LINKER:--dynamic-list=${list})
  set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${list})
endfunction()
