# Which libraries of others the build takes (Libraries.cmake says how they are found).
include(${CMAKE_CURRENT_LIST_DIR}/Libraries.cmake)
find_package(Threads REQUIRED)

# rt_require(<name>...): the configuration ends with the names of the packages that have it when there is none.
function(rt_require)
    foreach(name IN LISTS ARGN)
        rt_find(${name})
        if(NOT TARGET rt::${name})
            rt_advice(advice ${name})
            message(FATAL_ERROR "${advice} Or run ./build.sh, which installs everything.")
        endif()
    endforeach()
endfunction()

# rt_link_optional(<target> PRIVATE|INTERFACE <dependency>...)
# What sources do with a dependency that may not be there stands behind RT_HAS_<NAME>.
function(rt_link_optional target scope)
    foreach(name IN LISTS ARGN)
        if(TARGET rt::${name})
            string(TOUPPER ${name} upper)
            target_link_libraries(${target} ${scope} rt::${name})
            target_compile_definitions(${target} ${scope} RT_HAS_${upper})
        endif()
    endforeach()
endfunction()

rt_require(glm spdlog json cli11 stb tinygltf png jpeg openexr)
# Of textures in these formats, of compressed glTF, of packed pbrt files and of MaterialX, which can be left out.
foreach(name IN ITEMS tiff webp draco meshoptimizer zlib pugixml)
    rt_find(${name})
endforeach()
# Of the window, which can be left out. ImGui with its backends for GLFW and Vulkan.
rt_find(glfw)
rt_find(imgui)

# Of renders on several machines, which can be left out.
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI QUIET COMPONENTS CXX)

# libstdc++ runs std::execution::par serially unless oneTBB is there, and libc++ has no policies at all: only Microsoft's
# library needs nothing.
add_library(rt-parallel INTERFACE)
add_library(rt::parallel ALIAS rt-parallel)
target_link_libraries(rt-parallel INTERFACE Threads::Threads)
if(NOT MSVC)
    rt_require(tbb)
    target_link_libraries(rt-parallel INTERFACE rt::tbb)
endif()

if(RT_BUILD_TESTS)
    rt_require(gtest gtest_main)
endif()
if(RT_BUILD_BENCH)
    rt_require(benchmark)
endif()
# Embree 3 is an oracle of tests and a yardstick of benchmarks; what compares with it is built only where it is installed
# (Debian 13 has Embree 4).
if(RT_BUILD_TESTS OR RT_BUILD_BENCH)
    rt_find(embree)
endif()
