# Target `arb`: Arb's ball arithmetic, which comes without a file for CMake. Debian names the library after FLINT, on
# which it is built.

find_path(ARB_INCLUDE_DIR arb.h REQUIRED)
find_library(ARB_LIBRARY NAMES flint-arb arb REQUIRED)
find_library(FLINT_LIBRARY flint REQUIRED)

add_library(arb INTERFACE)
target_include_directories(arb SYSTEM INTERFACE ${ARB_INCLUDE_DIR})
target_link_libraries(arb INTERFACE ${ARB_LIBRARY} ${FLINT_LIBRARY})
