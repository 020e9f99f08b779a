# Fails when a header below SHARED does not compile alone by COMPILER, LANGUAGE C++ or GLSL, in the folder ROOT; names each that
# doesn't. SCRATCH is a folder for what is written.
file(MAKE_DIRECTORY ${SCRATCH})
set(options -std=c++20 -Wall -Wextra -Wpedantic -Werror -DGLM_FORCE_INLINE -I${ROOT})
if(LANGUAGE STREQUAL "C++") # GLM is read once
    execute_process(COMMAND ${COMPILER} ${options} -x c++-header ${ROOT}/Common/Shared/Base/Shim.h -o ${SCRATCH}/Shim.h.gch
                    COMMAND_ERROR_IS_FATAL ANY)
endif()

file(GLOB_RECURSE headers RELATIVE ${ROOT} ${SHARED}/*.h)
list(LENGTH headers count)
if(count EQUAL 0)
    message(FATAL_ERROR "no header below ${SHARED}")
endif()
set(failed "")
foreach(header IN LISTS headers)
    if(LANGUAGE STREQUAL "C++")
        # One that includes another shared header comes to Shim.h in the end; those that include none get no help.
        file(STRINGS ${ROOT}/${header} includes REGEX "^#include \"Common/Shared/")
        set(shim "")
        if(includes)
            set(shim -include ${SCRATCH}/Shim.h)
        endif()
        set(source ${SCRATCH}/Alone.cpp)
        file(WRITE ${source} "#include \"${header}\"\n")
        set(command ${COMPILER} ${options} -fsyntax-only ${shim} ${source})
    else()
        set(source ${SCRATCH}/Alone.comp)
        file(WRITE ${source} "#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include \"${header}\"
layout(local_size_x = 1) in;
void main() {}
")
        set(command ${COMPILER} -S comp --target-env vulkan1.3 -I${ROOT} -o ${source}.spv ${source})
    endif()
    execute_process(COMMAND ${command} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT result EQUAL 0)
        string(APPEND failed "${header} does not compile alone:\n${output}\n")
    endif()
endforeach()
if(failed)
    message(FATAL_ERROR "${failed}")
endif()
