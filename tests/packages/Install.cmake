# What cmake --install puts into an empty root runs from there: it finds its assets, whatever the working directory
# is, and needs nothing of the folders that it was built in.
#   cmake -DBUILD=... -DCONFIG=... -DSCRATCH=... -P Install.cmake
cmake_minimum_required(VERSION 3.25)
file(REMOVE_RECURSE ${SCRATCH})
set(root ${SCRATCH}/a/b/c/d/root) # deep: the programs look for Assets in the folders around them
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --config "${CONFIG}" --component programs --prefix ${root}
                OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(file IN ITEMS share/ray-tracing-twins/scenes/irradiance/quad.json share/ray-tracing-twins/scene.schema.json)
    if(NOT EXISTS ${root}/${file})
        message(FATAL_ERROR "${file} is not installed")
    endif()
endforeach()

# Renders a scene file of the assets to `picture`.
function(render picture)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=RT_ASSETS ${ARGN}
                            ${root}/bin/ray-tracing-cpu --no-config -q --scene irradiance/quad.json --width 32 --spp 4
                            -o ${picture}
                    WORKING_DIRECTORY ${SCRATCH} RESULT_VARIABLE result ERROR_VARIABLE error)
    set(result ${result} PARENT_SCOPE)
    set(error "${error}" PARENT_SCOPE)
endfunction()

render(installed.pfm)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "the installed program failed: ${error}")
endif()
# Without its folder it has nothing to find, and with it elsewhere RT_ASSETS names it.
file(RENAME ${root}/share/ray-tracing-twins ${SCRATCH}/elsewhere)
render(none.pfm)
if(result EQUAL 0)
    message(FATAL_ERROR "the program found assets that are not those installed with it")
endif()
render(elsewhere.pfm RT_ASSETS=${SCRATCH}/elsewhere)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "RT_ASSETS was not heeded: ${error}")
endif()
file(SHA256 ${SCRATCH}/installed.pfm first)
file(SHA256 ${SCRATCH}/elsewhere.pfm second)
if(NOT first STREQUAL second)
    message(FATAL_ERROR "the picture depends on where the assets are")
endif()
file(REMOVE_RECURSE ${SCRATCH})
