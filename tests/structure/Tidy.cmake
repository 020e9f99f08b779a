# Fails where clang-tidy finds what .clang-tidy names, in the sources of one target and the headers that they include.
# CONFIG sets files, definitions and includes, as Alone.cmake writes them; CHECKS changes
# which of them look, as an option of clang-tidy.
#
# One source, MERGED, which this writes, includes all of them: headers, which take most of the time, are read and looked
# at once for a target. So what is local to a source needs a name that no other source of its target has.
cmake_minimum_required(VERSION 3.25)
if(NOT CLANG_TIDY)
    message(FATAL_ERROR "clang-tidy was not found. Debian, Ubuntu: apt install clang-tidy.")
endif()
include(${CONFIG})

# One text is compiled for several instruction sets: here for the one that needs no options of the compiler.
list(TRANSFORM files REPLACE "\\.x86_64_v[0-9]\\.cpp$" ".generic.cpp")
list(REMOVE_DUPLICATES files)
list(FILTER files EXCLUDE REGEX "/EmbeddedShaders\\.cpp$") # a few lines, but megabytes of numbers
list(TRANSFORM files REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE lines)
list(JOIN lines "" text)
file(WRITE ${MERGED} "${text}")
include(${CMAKE_CURRENT_LIST_DIR}/ClangOptions.cmake)
execute_process(COMMAND ${CLANG_TIDY} --quiet --config-file=${ROOT}/.clang-tidy --warnings-as-errors=*
                        --checks=-bugprone-suspicious-include,${CHECKS} ${MERGED} -- -x c++ ${options}
                RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_QUIET)
if(NOT code EQUAL 0)
    message(NOTICE "${output}") # whose lines an error would break
    message(FATAL_ERROR "clang-tidy: see above")
endif()
list(LENGTH files count)
message(STATUS "clang-tidy has nothing to say of ${count} files")
