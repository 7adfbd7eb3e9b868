# What every target of the project shares: packages, warnings, the precompiled standard headers.

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(Threads REQUIRED)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  # ccache keeps what is compiled with precompiled headers only if told so.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros
                                  CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} ${CCACHE_PROGRAM})
endif()
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()

add_library(legible_common INTERFACE)
target_include_directories(legible_common INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(legible_common INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror
                       $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-restrict>) # GCC 12 false alarms in Eigen and libstdc++
# An uninitialised matrix shows as NaN at once in Debug instead of as a plausible number.
target_compile_definitions(legible_common INTERFACE $<$<CONFIG:Debug>:EIGEN_INITIALIZE_MATRICES_BY_NAN>)
target_link_libraries(legible_common INTERFACE Eigen3::Eigen)
if(LEGIBLE_SANITIZE)
  target_compile_options(legible_common INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                         -fno-omit-frame-pointer -Wno-error) # GCC's flow warnings misread instrumented code
  target_link_options(legible_common INTERFACE -fsanitize=address,undefined)
endif()

# legible_library(NAME SOURCES … [PUBLIC …] [PRIVATE …] [PRECOMPILE <header> …]): one static library a folder.
function(legible_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;PRECOMPILE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  target_link_libraries(${name} PUBLIC legible_common ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  target_precompile_headers(${name} PRIVATE <Eigen/Dense> <array> <cmath> <string> <vector> ${ARG_PRECOMPILE})
endfunction()
