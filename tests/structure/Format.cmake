# Fails unless every source and header is as .clang-format has it: cmake -DCLANG_FORMAT=... -DROOT=... -P Format.cmake
# Releases of clang-format differ in a few constructs (pointers to members, clauses after `requires`, lambdas of one
# statement that are arguments). Where 14 and 19 do, the code is written otherwise, so that both agree on every file.
if(NOT CLANG_FORMAT)
    message(FATAL_ERROR "clang-format was not found. Debian, Ubuntu: apt install clang-format.")
endif()
foreach(folder IN ITEMS Common Python RayTracingCPU RayTracingGPU Shaders examples tests)
    file(GLOB_RECURSE found ${ROOT}/${folder}/*.cpp ${ROOT}/${folder}/*.h)
    list(APPEND files ${found})
endforeach()
execute_process(COMMAND ${CLANG_FORMAT} --dry-run -Werror ${files} RESULT_VARIABLE code ERROR_VARIABLE complaints)
list(LENGTH files count)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "Run clang-format -i on these:\n${complaints}")
endif()
message(STATUS "${count} files are as .clang-format has them")
