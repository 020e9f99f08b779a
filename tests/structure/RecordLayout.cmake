# Writes OUTPUT: C++ that asserts, for each record of TYPES, the size and offsets that a SPIR-V buffer of it has.
file(READ ${TYPES} text)
string(REGEX MATCHALL "struct [A-Za-z0-9]+ {" records "${text}")
list(TRANSFORM records REPLACE "struct ([A-Za-z0-9]+) {" "\\1")

cmake_path(GET TYPES FILENAME header)
set(shader "#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include \"Common/Shared/Base/${header}\"
layout(local_size_x = 1) in;
")
foreach(record IN LISTS records)
    string(APPEND shader "layout(scalar, binding = 0) readonly buffer Buffer${record} { ${record} all${record}[]; };\n")
endforeach()
file(WRITE ${SHADER} "${shader}void main() {}\n")

execute_process(COMMAND ${GLSLANG} -S comp --target-env vulkan1.3 --quiet -I${ROOT} -o ${SHADER}.spv ${SHADER}
                COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SPIRV_VAL} --target-env vulkan1.3 --scalar-block-layout ${SHADER}.spv COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${SPIRV_DIS} --no-color ${SHADER}.spv OUTPUT_VARIABLE assembly COMMAND_ERROR_IS_FATAL ANY)

set(asserts "")
foreach(record IN LISTS records)
    if(NOT assembly MATCHES "OpDecorate %_runtimearr_${record} ArrayStride ([0-9]+)")
        message(FATAL_ERROR "${header}: no array of ${record} in the SPIR-V")
    endif()
    string(APPEND asserts "static_assert(sizeof(${record}) == ${CMAKE_MATCH_1});\n")
    string(REGEX MATCHALL "OpMemberName %${record} [0-9]+ \"[A-Za-z0-9]+\"" members "${assembly}")
    if(NOT members)
        message(FATAL_ERROR "${header}: no members of ${record} in the SPIR-V")
    endif()
    foreach(member IN LISTS members)
        string(REGEX REPLACE ".* ([0-9]+) \"(.*)\"" "\\1;\\2" member "${member}")
        list(GET member 0 index)
        list(GET member 1 name)
        if(NOT assembly MATCHES "OpMemberDecorate %${record} ${index} Offset ([0-9]+)")
            message(FATAL_ERROR "${header}: no offset of ${record}::${name} in the SPIR-V")
        endif()
        string(APPEND asserts "static_assert(offsetof(${record}, ${name}) == ${CMAKE_MATCH_1});\n")
    endforeach()
endforeach()

file(WRITE ${OUTPUT} "// Generated from the SPIR-V of ${header}.
#include <cstddef>

#include \"Common/Shared/Base/${header}\"

using namespace rt::shared;

${asserts}")
