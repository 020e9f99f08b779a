# Fails where clang-tidy finds what .clang-tidy names, in the sources of one target and the headers that they include.
# CONFIG sets files, definitions and includes, as Alone.cmake writes them.
cmake_minimum_required(VERSION 3.25)
if(NOT CLANG_TIDY)
    message(FATAL_ERROR "clang-tidy was not found. Debian, Ubuntu: apt install clang-tidy.")
endif()
include(${CONFIG})

list(FILTER files EXCLUDE REGEX "\\.(generic|x86_64_v[0-9])\\.cpp$") # one text, compiled for several instruction sets
list(LENGTH files count)
if(count EQUAL 0)
    message(STATUS "no file of this target is looked at")
    return()
endif()

include(${CMAKE_CURRENT_LIST_DIR}/ClangOptions.cmake)
execute_process(COMMAND ${CLANG_TIDY} --quiet --warnings-as-errors=* ${files} -- -x c++ ${options}
                RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_QUIET)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "${output}")
endif()
message(STATUS "clang-tidy has nothing to say of ${count} files")
