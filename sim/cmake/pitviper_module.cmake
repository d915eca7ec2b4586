# pitviper_module(name FOLDER dir [ROOMS folders...] [QUICK] DEPENDS targets... LIBRARIES third_party...)
#   One static library per folder, made of every .cpp directly in it and in its ROOMS, with the house's warnings as errors.
#   Headers are included from the repository root ("sim/radiometry/planck.hpp").
#   QUICK: nothing in it runs for long; optimised less, it compiles a third faster.
#   .glsl files of these are compiled into the library as text: see sim/gl/shader_source.hpp.
include(join_sources)
find_program(PITVIPER_CCACHE ccache)
if(PITVIPER_CCACHE)
  # What it needs to know of precompiled headers: they hold no __DATE__ and their macros are what the options say.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${PITVIPER_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${PITVIPER_CCACHE})
endif()

add_library(pitviper_options INTERFACE)
target_include_directories(pitviper_options INTERFACE ${CMAKE_SOURCE_DIR})
target_compile_options(pitviper_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(pitviper_options INTERFACE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds)  # false alarms on std::string (GCC bug 105651)
endif()
if(CMAKE_UNITY_BUILD)
  # A class of one file alone is taken for one of a header, and what one file calls its own hides nothing of another's.
  target_compile_options(pitviper_options INTERFACE -Wno-subobject-linkage -Wno-shadow)
endif()
if(PITVIPER_SANITIZE)
  target_compile_options(pitviper_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    -Wno-maybe-uninitialized)  # false alarms in the standard library under sanitizers (GCC bug 105562)
  target_link_options(pitviper_options INTERFACE -fsanitize=address,undefined)
endif()

# The standard library and glm, which nearly every file includes, are read once for all: a third of the time of a build from nothing. A file still names what
# it uses. One for each way in which modules are optimised.
foreach(way pv_headers pv_headers_quick)
  file(WRITE ${CMAKE_BINARY_DIR}/${way}.cpp "// What modules have in common is in its precompiled header.\n")
  add_library(${way} STATIC ${CMAKE_BINARY_DIR}/${way}.cpp)
  target_link_libraries(${way} PRIVATE pitviper_options ${GLM_TARGET})
  target_compile_options(${way} PRIVATE -fpch-preprocess)
  target_precompile_headers(${way} PRIVATE <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <functional> <map> <memory> <optional> <set> <span> <stdexcept>
    <string> <string_view> <utility> <variant> <vector> <glm/glm.hpp> <glm/gtc/quaternion.hpp>)
endforeach()
target_compile_options(pv_headers_quick PRIVATE $<$<CONFIG:Release>:-O1>)

function(pitviper_module name)
  cmake_parse_arguments(M "QUICK" "FOLDER" "ROOMS;DEPENDS;LIBRARIES" ${ARGN})
  set(folder ${CMAKE_CURRENT_SOURCE_DIR})
  if(M_FOLDER)
    set(folder ${CMAKE_CURRENT_SOURCE_DIR}/${M_FOLDER})
  endif()
  set(folders ${folder})
  foreach(room IN LISTS M_ROOMS)
    list(APPEND folders ${folder}/${room})
  endforeach()
  set(sources "")
  set(shaders "")
  foreach(folder IN LISTS folders)
    file(GLOB own CONFIGURE_DEPENDS ${folder}/*.cpp)
    list(APPEND sources ${own})
    file(GLOB own CONFIGURE_DEPENDS ${folder}/*.glsl ${folder}/glsl/*.glsl)
    list(APPEND shaders ${own})
  endforeach()
  if(shaders)
    set(embedded ${CMAKE_CURRENT_BINARY_DIR}/${name}_shaders.cpp)
    add_custom_command(OUTPUT ${embedded}
      COMMAND ${CMAKE_COMMAND} -DOUT=${embedded} -DROOT=${CMAKE_SOURCE_DIR} -DNAME=${name}
              "-DFILES=${shaders}" -P ${CMAKE_SOURCE_DIR}/sim/cmake/embed_shaders.cmake
      DEPENDS ${shaders} ${CMAKE_SOURCE_DIR}/sim/cmake/embed_shaders.cmake VERBATIM)
    list(APPEND sources ${embedded})
  endif()
  if(NOT sources)
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE pitviper_options ${M_DEPENDS} ${M_LIBRARIES})
    return()
  endif()
  add_library(${name} STATIC ${sources})
  pitviper_join(${name})
  target_link_libraries(${name} PUBLIC pitviper_options ${M_DEPENDS} PRIVATE ${M_LIBRARIES})
  target_compile_options(${name} PRIVATE -fpch-preprocess)
  if(M_QUICK)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
    target_precompile_headers(${name} REUSE_FROM pv_headers_quick)
  else()
    target_precompile_headers(${name} REUSE_FROM pv_headers)
  endif()
endfunction()
