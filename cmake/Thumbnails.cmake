# Renders Assets/thumbnails and Assets/materials/thumbnails anew: cmake --build build --target thumbnails
# The tool's copy drops what the render says of this machine.
# rt_render_thumbnail(<picture> <what the render writes> <flag>...)
function(rt_render_thumbnail picture written)
    get_filename_component(folder ${picture} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    execute_process(COMMAND ${RT_PROGRAM} --no-config -q --aspect 1 ${ARGN} -o ${RT_SCRATCH}/thumbnail.png
                    COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND ${RT_IMAGE_TOOL} convert ${RT_SCRATCH}/${written} ${picture} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# A scene with the default camera is cut to a square.
execute_process(COMMAND ${RT_PROGRAM} --list-scenes --json OUTPUT_VARIABLE scenes COMMAND_ERROR_IS_FATAL ANY)
string(JSON last LENGTH "${scenes}")
math(EXPR last "${last} - 1")
foreach(i RANGE ${last})
    string(JSON id GET "${scenes}" ${i} id)
    rt_render_thumbnail(${RT_ASSETS}/thumbnails/${id}.png thumbnail.png --scene ${id} --width 64 --spp 1024)
endforeach()

# Each material of the library in the place of the one of a scene. Without noise a picture takes half the bytes.
file(READ ${RT_ASSETS}/scenes/materials/ball.json ball)
file(GLOB libraries ${RT_ASSETS}/materials/*.json)
foreach(library IN LISTS libraries)
    file(READ ${library} content)
    string(JSON last LENGTH "${content}" materials)
    math(EXPR last "${last} - 1")
    foreach(i RANGE ${last})
        string(JSON name MEMBER "${content}" materials ${i})
        string(JSON material GET "${content}" materials "${name}")
        string(JSON scene SET "${ball}" materials material "${material}")
        file(WRITE ${RT_SCRATCH}/thumbnail.json "${scene}")
        string(TOLOWER "${name}" picture) # as MaterialPreset::picture() has it
        string(REGEX REPLACE "[^a-z0-9]+" "-" picture "${picture}")
        string(REGEX REPLACE "^-|-$" "" picture "${picture}")
        rt_render_thumbnail(${RT_ASSETS}/materials/thumbnails/${picture}.png thumbnail.denoised.png
                            --scene ${RT_SCRATCH}/thumbnail.json --width 96 --spp 256 --denoise)
    endforeach()
endforeach()
