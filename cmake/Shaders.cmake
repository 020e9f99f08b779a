# Shaders are compiled to SPIR-V and become arrays of C++ headers: nothing is looked up at run time. That they are valid
# is tested (tests/structure/ValidShaders.cmake), which takes longer than to compile them.
find_program(RT_GLSLANG NAMES glslangValidator glslang)
find_program(RT_SPIRV_VAL spirv-val)
mark_as_advanced(RT_GLSLANG RT_SPIRV_VAL)
find_package(Vulkan QUIET)
set(RT_CAN_BUILD_GPU OFF)
set(RT_CAN_BUILD_GUI OFF)
if(Vulkan_FOUND AND RT_GLSLANG)
    set(RT_CAN_BUILD_GPU ON)
    if(TARGET rt::glfw AND TARGET rt::imgui)
        set(RT_CAN_BUILD_GUI ON)
    endif()
endif()

# What a build with RT_BUILD_GPU=ON or RT_BUILD_GUI=ON cannot do without.
function(rt_require_vulkan)
    if(NOT RT_CAN_BUILD_GPU)
        message(FATAL_ERROR "RT_BUILD_GPU and RT_BUILD_GUI need Vulkan's headers and loader and glslangValidator. "
                            "Debian, Ubuntu: apt install libvulkan-dev glslang-tools.")
    endif()
    if(RT_BUILD_GUI AND NOT RT_CAN_BUILD_GUI)
        message(FATAL_ERROR "RT_BUILD_GUI needs GLFW and Dear ImGui. Debian, Ubuntu: apt install libglfw3-dev "
                            "libimgui-dev. vcpkg: vcpkg install glfw3 imgui[glfw-binding,vulkan-binding].")
    endif()
endfunction()

# For each of the files in Shaders/, or in the folder after FROM, X.ext becomes the header "X.ext.h" in an include
# folder of `target`, with the array X_ext of words; "TARGET.shaders.h" includes them all. X.Some.NewVariant.ext, where
# there is no such file, is X.ext with RT_SOME and RT_NEW_VARIANT defined. X.rgen is X.comp as a ray generation shader,
# with RT_PIPELINE defined. A change of any file that a shader includes builds it anew.
function(rt_embed_shaders target)
    cmake_parse_arguments(arg "" "FROM" "" ${ARGN})
    set(sources ${PROJECT_SOURCE_DIR}/Shaders)
    if(arg_FROM)
        set(sources ${PROJECT_SOURCE_DIR}/${arg_FROM})
    endif()
    set(folder ${PROJECT_BINARY_DIR}/shaders)
    file(MAKE_DIRECTORY ${folder})
    set(headers)
    foreach(shader IN LISTS arg_UNPARSED_ARGUMENTS)
        set(source ${sources}/${shader})
        set(defines)
        if(NOT EXISTS ${source})
            string(REPLACE "." ";" parts ${shader})
            list(POP_FRONT parts name)
            list(POP_BACK parts extension)
            list(TRANSFORM parts REPLACE "([a-z])([A-Z])" "\\1_\\2")
            list(TRANSFORM parts TOUPPER)
            list(TRANSFORM parts PREPEND -DRT_)
            set(defines ${parts})
            if(extension STREQUAL "rgen")
                set(extension comp)
                list(APPEND defines -S rgen -DRT_PIPELINE)
            endif()
            set(source ${sources}/${name}.${extension})
        endif()
        set(binary ${folder}/${shader}.spv)
        set(header ${folder}/${shader}.h)
        string(REPLACE "." "_" symbol ${shader})
        set(compile ${RT_GLSLANG} --quiet --target-env vulkan1.2 ${defines} -I${PROJECT_SOURCE_DIR})
        add_custom_command(
            OUTPUT ${binary} ${header}
            COMMAND ${compile} --depfile ${header}.d -o ${binary} ${source}
            COMMAND ${compile} --vn ${symbol} -o ${header} ${source}
            DEPENDS ${source}
            DEPFILE ${header}.d
            COMMENT "Shader ${shader}"
            VERBATIM)
        target_sources(${target} PRIVATE ${header})
        string(APPEND headers "#include \"${shader}.h\"\n")
    endforeach()
    file(CONFIGURE OUTPUT ${folder}/${target}.shaders.h CONTENT "${headers}" @ONLY)
    target_include_directories(${target} PRIVATE ${folder})
endfunction()
