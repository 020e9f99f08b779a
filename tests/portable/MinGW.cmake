# A toolchain for Windows by MinGW, for programs without a window: tests/portable/wine.py builds them by it. Debian has
# few libraries for MinGW; those that are headers come from this system, and calls of codecs meet stand-ins that end the
# program. std::execution::par is serial here, as there is no oneTBB.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
foreach(what IN ITEMS LIBRARY INCLUDE PACKAGE)
    set(CMAKE_FIND_ROOT_PATH_MODE_${what} ONLY)
endforeach()
set(CMAKE_DISABLE_FIND_PACKAGE_PkgConfig ON) # it would tell of this system's libraries
set(CMAKE_PROJECT_RayTracingTwins_INCLUDE ${CMAKE_CURRENT_LIST_DIR}/MinGWLibraries.cmake)
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES RT_HEADERS RT_STANDINS)
