# Headers of the standard library, GLM and GoogleTest take compilers longer than most files of the project. They are compiled once
# for all libraries and programs, and once for all tests. No header of the project is among them: what a file needs of the
# project it includes. That it includes what it needs of the others is seen where this is off: with MSVC, which wants the
# same definitions in all targets, and in the presets of sanitizers and fuzz targets.
set(RT_CAN_PRECOMPILE ON)
if(MSVC)
    set(RT_CAN_PRECOMPILE OFF)
endif()
option(RT_PRECOMPILE_HEADERS "Compile headers of others once for all files" ${RT_CAN_PRECOMPILE})

set(RT_STANDARD_HEADERS
    <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <cstring> <filesystem> <fstream> <functional> <limits> <map>
    <memory> <mutex> <numeric> <optional> <set> <span> <sstream> <string> <string_view> <thread> <utility> <variant>
    <vector> <glm/glm.hpp>)

if(RT_PRECOMPILE_HEADERS AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Without the first ccache keeps nothing that was compiled with them. The second warns of std::string's own code, which GCC 12
    # no longer knows to be a system's: false alarms of the kind of GCC bug 105329.
    add_compile_options(-fpch-preprocess -Wno-array-bounds)
endif()

# rt_precompile_headers(<target> [REUSE_FROM <other>] [<header>...]): RT_STANDARD_HEADERS and the given ones, or those of another.
function(rt_precompile_headers target)
    cmake_parse_arguments(arg "" "REUSE_FROM" "" ${ARGN})
    if(NOT RT_PRECOMPILE_HEADERS OR target STREQUAL arg_REUSE_FROM)
        return()
    endif()
    if(arg_REUSE_FROM)
        target_precompile_headers(${target} REUSE_FROM ${arg_REUSE_FROM})
    else()
        target_precompile_headers(${target} PRIVATE ${RT_STANDARD_HEADERS} ${arg_UNPARSED_ARGUMENTS})
    endif()
endfunction()
