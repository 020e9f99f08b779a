# What --version tells of this build (Common/Core/BuildInfo.cpp).
find_program(RT_GIT git)
mark_as_advanced(RT_GIT)

# rt_add_build_info(<target>): needs to know what is built, so it comes after all options.
function(rt_add_build_info target)
    set(features ${RT_KERNEL_ISAS})
    foreach(feature IN ITEMS GPU GUI)
        if(RT_BUILD_${feature})
            list(APPEND features ${feature})
        endif()
    endforeach()
    if(RT_WITH_MPI)
        list(APPEND features MPI)
    endif()
    foreach(format IN ITEMS tiff webp draco meshoptimizer pugixml)
        if(TARGET rt::${format})
            list(APPEND features ${format})
        endif()
    endforeach()
    list(JOIN features " " features)
    set(compilers "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
    if(RT_GLSLANG)
        execute_process(COMMAND ${RT_GLSLANG} --version OUTPUT_VARIABLE glslang ERROR_QUIET)
        if(glslang MATCHES "Glslang Version: [0-9]*:?([0-9.]+)")
            string(APPEND compilers ", glslang ${CMAKE_MATCH_1}")
        endif()
    endif()

    set(folder ${PROJECT_BINARY_DIR}/facts)
    set(command ${CMAKE_COMMAND} -DRT_GIT=${RT_GIT} -DRT_ROOT=${PROJECT_SOURCE_DIR} -DRT_HEADER=${folder}/BuildFacts.h
                -DRT_VERSION=${PROJECT_VERSION} "-DRT_FEATURES=${features}" "-DRT_COMPILERS=${compilers}"
                -P ${PROJECT_SOURCE_DIR}/cmake/WriteBuildFacts.cmake)
    execute_process(COMMAND ${command}) # for whoever compiles a file alone
    add_custom_target(rt-build-facts COMMAND ${command} BYPRODUCTS ${folder}/BuildFacts.h VERBATIM)
    add_dependencies(${target} rt-build-facts)
    target_include_directories(${target} PRIVATE ${folder})
    # Each commit, and each version, compiles this alone.
    set_source_files_properties(${PROJECT_SOURCE_DIR}/Common/Core/BuildInfo.cpp PROPERTIES
                                SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
