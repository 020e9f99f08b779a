# Renders Assets/thumbnails anew: cmake --build build --target thumbnails
# A scene with the default camera is cut to a square. The tool's copy drops what the render says of this machine.
execute_process(COMMAND ${RT_PROGRAM} --list-scenes --json OUTPUT_VARIABLE scenes COMMAND_ERROR_IS_FATAL ANY)
string(JSON last LENGTH ${scenes})
math(EXPR last "${last} - 1")
file(MAKE_DIRECTORY ${RT_FOLDER})
foreach(i RANGE ${last})
    string(JSON id GET ${scenes} ${i} id)
    execute_process(COMMAND ${RT_PROGRAM} --no-config -q --scene ${id} --width 64 --aspect 1 --spp 1024
                            -o ${RT_SCRATCH}/thumbnail.png COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${RT_IMAGE_TOOL} convert ${RT_SCRATCH}/thumbnail.png ${RT_FOLDER}/${id}.png
                    COMMAND_ERROR_IS_FATAL ANY)
endforeach()
