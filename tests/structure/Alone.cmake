# Every source and header compiles alone, without warnings: what it uses it includes. Builds merge sources, up to
# forty, and so hide an include that is missing as long as a neighbour has it.
#
# Compiling each by itself takes long, most of it for the same headers again and again. So Clang reads a header once,
# whoever includes it, as a part of a module. Who includes it sees that part of the module, and what that includes
# itself, but nothing else: such a use is an error that names the header, "declaration of 'Frame' must be imported from
# module 'Headers.Common/...'". There are three steps:
#   Libraries   the headers of other projects make one module, of which all is seen at once: the lack of an include of
#               these stays unnoticed where another one of them is there
#   Headers     ours make another one
#   <target>    each source, with the definitions and include folders of its target; targets beside each other
#
# Headers are part of every change, as many files include them. Sources take ten minutes of processor time even so, at
# night: that one of them lacks an include stops nobody whose build merges them.
#
# Only here are warnings errors: users' compilers are of many versions. Clang on Linux is what this was tried with.
find_program(RT_ALONE_CLANG clang++)
mark_as_advanced(RT_ALONE_CLANG)
if(NOT RT_ALONE_CLANG OR NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
    message(STATUS "no clang++ on Linux: that sources and headers compile alone is not tested")
    return()
endif()
set(alone ${CMAKE_CURRENT_BINARY_DIR}/alone)

# rt_alone_step(<name> <kind> <milliseconds> TARGETS <whose definitions and folders> FILES <file>...)
function(rt_alone_step name kind milliseconds)
    cmake_parse_arguments(arg "" "" "TARGETS;FILES" ${ARGN})
    set(definitions "")
    set(includes "")
    foreach(target IN LISTS arg_TARGETS)
        list(APPEND definitions "$<TARGET_PROPERTY:${target},COMPILE_DEFINITIONS>")
        list(APPEND includes "$<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>")
    endforeach()
    set(config ${alone}/${name}.$<CONFIG>.cmake)
    file(GENERATE OUTPUT ${config} CONTENT "set(files [==[${arg_FILES}]==])
set(definitions [==[${definitions}]==])
set(includes [==[${includes}]==])
")
    rt_add_script_test(alone.${name} AloneStep.cmake -DCOMPILER=${RT_ALONE_CLANG} -DROOT=${PROJECT_SOURCE_DIR}
                       -DNAME=${name} -DKIND=${kind} -DCONFIG=${config} -DSCRATCH=${alone})
    set_tests_properties(structure.alone.${name} PROPERTIES COST ${milliseconds})
endfunction()

# ---- which files there are, and whose --------------------------------------------------------------------------------
set(roots Common Python RayTracingCPU RayTracingGPU tests)
list(TRANSFORM roots PREPEND ${PROJECT_SOURCE_DIR}/)
list(TRANSFORM roots APPEND /*.h OUTPUT_VARIABLE headerGlobs)
list(TRANSFORM roots APPEND /*.cpp OUTPUT_VARIABLE sourceGlobs)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${headerGlobs})
file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${sourceGlobs})
# Fuzz targets have sources of their own each; DockApi.h adds to a library's header. Simd.h includes one of those that
# define the same for an instruction set each, and probes are shaders.
set(others "/tests/(fuzz|structure/planted|cross/probes)/|/DockApi\\.h$|/Simd(Avx|Avx2|Avx512|Sse4|Neon|Generic)\\.h$")
# What is left out of this build: a target that it has not, and its folder.
foreach(left IN ITEMS rt-vulkan:Common/Vulkan rt-gui:Common/Gui rt-gpu:RayTracingGPU rt-python:Python
                      ray-tracing-mpi:Common/Mpi
                      rt-cross-tests:tests/cross rt-gui-tests:tests/gui rt-fault-layer:tests/layer
                      rt-fault-calls:tests/layer rays-bench:tests/bench)
    string(REPLACE ":" ";" left ${left})
    list(GET left 0 target)
    list(GET left 1 folder)
    if(NOT TARGET ${target})
        string(APPEND others "|/${folder}/")
    endif()
endforeach()
if(NOT TARGET rt::embree)
    string(APPEND others "|/AccelBenchScenes\\.h$")
endif()
foreach(isa IN ITEMS generic x86_64_v2 x86_64_v3 x86_64_v4)
    if(NOT isa IN_LIST RT_KERNEL_ISAS)
        string(APPEND others "|\\.${isa}\\.cpp$")
    endif()
endforeach()
list(FILTER headers EXCLUDE REGEX "${others}")
list(FILTER sources EXCLUDE REGEX "${others}")

set(targets "")
foreach(folder IN ITEMS . tests tests/bench)
    if(RT_BUILD_BENCH OR NOT folder STREQUAL "tests/bench")
        get_property(some DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} PROPERTY BUILDSYSTEM_TARGETS)
        list(APPEND targets ${some})
    endif()
endforeach()
set(compiled "") # targets whose definitions and folders the first two steps have
set(tidyGroups "")
foreach(target IN LISTS targets)
    get_target_property(type ${target} TYPE)
    if(NOT type MATCHES "LIBRARY|EXECUTABLE" OR type STREQUAL "INTERFACE_LIBRARY")
        continue()
    endif()
    get_target_property(own ${target} SOURCES)
    get_target_property(folder ${target} SOURCE_DIR)
    set(files "")
    foreach(file IN LISTS own)
        cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${folder})
        if(file IN_LIST sources)
            list(REMOVE_ITEM sources ${file}) # that two programs have it is enough for one
            list(APPEND files ${file})
        endif()
    endforeach()
    list(APPEND compiled ${target})
    if(files)
        list(LENGTH files count)
        math(EXPR milliseconds "1000 + ${count} * 500")
        rt_alone_step(${target} sources ${milliseconds} TARGETS ${target} FILES ${files})
        set_tests_properties(structure.alone.${target} PROPERTIES FIXTURES_REQUIRED "aloneLibraries;aloneHeaders"
                             LABELS "structure;nightly")
        set(group programs)
        if(folder MATCHES "/tests(/bench)?$")
            set(group ${target}) # whose names need not be unique among all tests
        elseif(target MATCHES "^(rt-(core|image|accel|scene|render|cpu|probe)|ray-tracing-cpu)$")
            set(group engine)
        endif()
        list(APPEND tidyGroups ${group})
        list(APPEND tidyConfigs.${group} ${alone}/${target}.$<CONFIG>.cmake)
    endif()
endforeach()
list(REMOVE_DUPLICATES tidyGroups)
foreach(group IN LISTS tidyGroups)
    rt_tidy_test(tidy ${group} "${tidyConfigs.${group}}" ${butAtNight})
    rt_tidy_test(tidyAtNight ${group} "${tidyConfigs.${group}}" -*,${atNight})
    set_tests_properties(structure.tidyAtNight.${group} PROPERTIES LABELS "structure;nightly")
    # Tests at night: theirs are half of all sources, and what is slow in them slows nobody down.
    if(NOT group MATCHES "^(engine|programs)$")
        set_tests_properties(structure.tidy.${group} PROPERTIES LABELS "structure;nightly")
    endif()
endforeach()
if(sources)
    message(FATAL_ERROR "no target compiles ${sources}")
endif()

file(GLOB_RECURSE all ${headerGlobs} ${sourceGlobs})
list(FILTER all EXCLUDE REGEX "${others}")
rt_alone_step(Libraries libraries 60000 TARGETS ${compiled} FILES ${all})
set_tests_properties(structure.alone.Libraries PROPERTIES FIXTURES_SETUP aloneLibraries)
rt_alone_step(Headers headers 50000 TARGETS ${compiled} FILES ${headers})
set_tests_properties(structure.alone.Headers PROPERTIES FIXTURES_REQUIRED aloneLibraries FIXTURES_SETUP aloneHeaders)

rt_alone_step(findsPlanted sources 1000 TARGETS rt-core FILES ${CMAKE_CURRENT_SOURCE_DIR}/planted/Alone.cpp)
set_tests_properties(structure.alone.findsPlanted PROPERTIES FIXTURES_REQUIRED "aloneLibraries;aloneHeaders"
                     PASS_REGULAR_EXPRESSION "'RenderError' must be imported from module 'Headers.Common/Core/Error.h'")
