# Fails where clang-tidy finds what .clang-tidy names, in the sources of some targets and the headers that they include.
# CONFIGS, with commas between them, set files, definitions and includes of one each, as Alone.cmake writes them; CHECKS
# changes which checks look, as an option of clang-tidy.
#
# One source, MERGED, which this writes, includes all of them: headers, which take most of the time, are read and looked
# at once. So what is local to a source needs a name that no other source has: an error that says "redefinition" asks
# for one.
cmake_minimum_required(VERSION 3.25)
if(NOT CLANG_TIDY)
    message(FATAL_ERROR "clang-tidy was not found. Debian, Ubuntu: apt install clang-tidy.")
endif()
string(REPLACE "," ";" configs "${CONFIGS}")
foreach(config IN LISTS configs)
    include(${config})
    list(APPEND allFiles ${files})
    list(APPEND allDefinitions ${definitions})
    list(APPEND allIncludes ${includes})
endforeach()
set(files ${allFiles})
set(definitions ${allDefinitions})
set(includes ${allIncludes})

# One text is compiled for several instruction sets: here for the one that needs no options of the compiler.
list(TRANSFORM files REPLACE "\\.x86_64_v[0-9]\\.cpp$" ".generic.cpp")
list(REMOVE_DUPLICATES files)
list(FILTER files EXCLUDE REGEX "/EmbeddedShaders\\.cpp$") # a few lines, but megabytes of numbers
set(text "")
set(number 0)
foreach(file IN LISTS files) # each may have a main()
    math(EXPR number "${number} + 1")
    string(APPEND text "#define main main${number}\n#include \"${file}\"\n#undef main\n")
endforeach()
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
