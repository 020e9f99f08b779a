# Included by the tests of this folder: installs the modules into ${SCRATCH}/prefix, alone.
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
set(prefix ${SCRATCH}/prefix)
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --config "${CONFIG}" --component development
                        --prefix ${prefix}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)

# configure(<project> <option>...): its build is in ${SCRATCH}/<name of the project's folder>; sets `result` and `said`.
function(configure project)
    cmake_path(GET project FILENAME name)
    execute_process(COMMAND ${CMAKE_COMMAND} -S ${project} -B ${SCRATCH}/${name} -G ${GENERATOR}
                            -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix} ${ARGN}
                    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE error)
    set(result ${result} PARENT_SCOPE)
    # CMake breaks lines of its messages.
    string(REGEX REPLACE "[ \n]+" " " said "${output}${error}")
    set(said "${said}" PARENT_SCOPE)
endfunction()
