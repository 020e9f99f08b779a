# What find_package says of components that there are not; that all libraries link; that only headers which are public
# are installed, and what they include, too. (That headers compile alone is tested where they stand, by structure.alone,
# and here at night, by Headers.cmake.)
#   cmake -DBUILD=... -DCONFIG=... -DROOT=... -DSCRATCH=... -DGENERATOR=... -DCOMPILER=... -P Components.cmake
include(${CMAKE_CURRENT_LIST_DIR}/Prefix.cmake)

# expect(<arguments of find_package> <what it says> <whether it ends the configuration, 0 or 1> <option>...)
function(expect arguments pattern ends)
    file(WRITE ${SCRATCH}/finder/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(finder LANGUAGES CXX)
find_package(RayTracingTwins ${arguments})
message(STATUS \"found: \${RayTracingTwins_FOUND}, scene: \${RayTracingTwins_scene_FOUND}\")
if(TARGET RayTracingTwins::scene)
    find_package(RayTracingTwins ${arguments}) # once more, as projects in projects do
endif()
")
    file(REMOVE_RECURSE ${SCRATCH}/finder-build)
    configure(${SCRATCH}/finder -B ${SCRATCH}/finder-build -DCMAKE_CXX_COMPILER_WORKS=ON ${ARGN})
    if(NOT said MATCHES "${pattern}" OR (result EQUAL 0) EQUAL ends)
        message(SEND_ERROR "find_package(RayTracingTwins ${arguments}) does not say '${pattern}': ${result}, ${said}")
    endif()
endfunction()

expect("1.0 REQUIRED COMPONENTS shared accel image scene cpu" "found: (1|TRUE), scene: (1|TRUE)" 0)
expect("REQUIRED COMPONENTS scenes" "has no component scenes: it must be among shared, core" 1)
expect("COMPONENTS scenes" "found: (0|FALSE)" 0)
expect("REQUIRED COMPONENTS scene OPTIONAL_COMPONENTS window" "found: (1|TRUE), scene: (1|TRUE)" 0)
expect("2.0 REQUIRED" "version.*2.0" 1)

# ---- all libraries link, with whatever they need of others -----------------------------------------------------------
file(WRITE ${SCRATCH}/links/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(links LANGUAGES CXX)
find_package(RayTracingTwins REQUIRED)
add_executable(links main.cpp)
target_link_libraries(links PRIVATE RayTracingTwins::cpu)
if(TARGET RayTracingTwins::gpu)
    target_link_libraries(links PRIVATE RayTracingTwins::gpu)
    target_compile_definitions(links PRIVATE HAS_GPU)
endif()
]])
file(WRITE ${SCRATCH}/links/main.cpp [[
#include <cstdio>
#include "Common/Core/Error.h"
#include "Common/Image/Denoise/Denoiser.h"
#include "Common/Image/ImageIo.h"
#include "Common/Scene/Gltf/GltfLoader.h"
#include "Common/Scene/Json/SceneJson.h"
#include "Common/Scene/Obj/ObjLoader.h"
#include "RayTracingCPU/CpuEngine.h"
#ifdef HAS_GPU
#include "RayTracingGPU/GpuEngine.h"
#endif
int main() {
    try {
        rt::image::readImage("none.tif");
        rt::scene::loadSceneFile("none.json"); // from here on linked, but not run
        rt::scene::loadObjScene("none.obj");
        rt::scene::loadGltfScene("none.glb");
        rt::image::denoise({}, 1);
        rt::cpu::makeCpuEngine({});
#ifdef HAS_GPU
        rt::gpu::makeGpuEngine(*static_cast<rt::vulkan::VulkanContext*>(nullptr));
#endif
    } catch (const rt::Error& error) {
        std::puts(error.what());
    }
}
]])
configure(${SCRATCH}/links -B ${SCRATCH}/links-build)
if(NOT result EQUAL 0)
    message(FATAL_ERROR "all components together cannot be configured: ${said}")
endif()
execute_process(COMMAND ${CMAKE_COMMAND} --build ${SCRATCH}/links-build OUTPUT_VARIABLE said ERROR_VARIABLE said)
execute_process(COMMAND ${SCRATCH}/links-build/links OUTPUT_VARIABLE printed)
if(NOT printed MATCHES "none.tif")
    message(SEND_ERROR "what links all libraries does not say that there is no file, but '${printed}': ${said}")
endif()

# ---- what find_package says of a package that lacks something --------------------------------------------------------
# As of a build without it.
file(GLOB_RECURSE config ${prefix}/*/RayTracingTwinsConfig.cmake)
file(READ ${config} text)
string(REGEX REPLACE "(set\\(rt_built [^)]*);vulkan;gpu" "\\1" text "${text}")
file(WRITE ${config} "${text}")
expect("REQUIRED COMPONENTS gpu" "was built without its component gpu" 1)
# As on a machine that lacks a library.
string(REGEX REPLACE "(set\\(rt_libraries_of_image [^)]*)" "\\1 embree" text "${text}")
file(WRITE ${config} "${text}")
expect("REQUIRED COMPONENTS image"
       "Its component image needs a library: embree was not found. Debian, Ubuntu: apt install libembree-dev" 1
       -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON)

# ---- headers --------------------------------------------------------------------------------------------------------
set(include ${prefix}/include/ray-tracing-twins)
file(GLOB_RECURSE headers RELATIVE ${include} ${include}/*)
list(LENGTH headers count)
if(count LESS 100)
    message(SEND_ERROR "only ${count} headers are installed")
endif()
foreach(header IN LISTS headers)
    if(NOT header MATCHES "\\.h$")
        message(SEND_ERROR "${header} is no header")
    endif()
    file(STRINGS ${include}/${header} lines REGEX "^ *# *include \"")
    foreach(line IN LISTS lines)
        string(REGEX REPLACE ".*\"(.*)\".*" "\\1" wanted "${line}")
        if(NOT wanted IN_LIST headers)
            message(SEND_ERROR "${header} includes ${wanted}, which is not public: cmake/Modules.cmake lists what is")
        endif()
    endforeach()
endforeach()
foreach(private IN ITEMS RayTracingCPU/PathKernel.h Common/Scene/Json/JsonNode.h Common/Core/RunMain.h Common/App)
    if(EXISTS ${include}/${private})
        message(SEND_ERROR "${private} is installed")
    endif()
endforeach()
file(REMOVE_RECURSE ${SCRATCH})
