# The modules: what cmake --install gives projects of others to build with, by
#     find_package(RayTracingTwins COMPONENTS scene cpu)
# These lists say which headers are public; no other is installed (docs/modules.md says what they are for,
# tests/modules that they compile).
include(CMakePackageConfigHelpers)
set(RT_MODULES "")
set(headers_folder ${CMAKE_INSTALL_INCLUDEDIR}/ray-tracing-twins)
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/RayTracingTwins)

# rt_module(<component> <target> <folder> <header without .h>...): nothing where the target is not built.
macro(rt_module component target folder)
    if(TARGET ${target})
        list(APPEND RT_MODULES ${component})
        set(RT_TARGET_${component} ${target})
        set_target_properties(${target} PROPERTIES EXPORT_NAME ${component})
        install(TARGETS ${target} EXPORT RayTracingTwins
                ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/ray-tracing-twins COMPONENT development)
        foreach(header ${ARGN})
            cmake_path(GET header PARENT_PATH below)
            install(FILES ${folder}/${header}.h DESTINATION ${headers_folder}/${folder}/${below}
                    COMPONENT development)
        endforeach()
    endif()
endmacro()

rt_module(shared rt-shared Common/Shared)
install(DIRECTORY Common/Shared DESTINATION ${headers_folder}/Common COMPONENT development FILES_MATCHING PATTERN *.h)
rt_module(core rt-core Common/Core CpuFeatures Error Hash Interruption Log Parallel Paths Printable)
rt_module(accel rt-accel Common/Accel AccelInput AccelView Box Build/BvhBuilder Bvh CpuAccel Traverse/RayQuery)
rt_module(image rt-image Common/Image Convergence Denoise/Denoiser Display ErrorEstimate Film FilmTiles Flip Image
          ImageIo ImageRows Metrics Statistics)
rt_module(scene rt-scene Common/Scene Affine Boxed Builtin/BuiltinScenes Builtin/SceneBuilder CameraRecord CompiledScene
          Compiler/Bounds Compiler/SceneCompiler FramingCamera Gltf/GltfLoader Json/SceneJson
          MaterialX/MaterialXLoader MaterialX/MaterialXWriter Moment Obj/ObjLoader
          Origins Pbrt/PbrtLoader SceneDesc Silhouettes Studio)
rt_module(render rt-render Common/Render Engine FilmEstimate FilmRun ForwardingEngine Names PictureDenoiser Progress
          RenderParams Settings ShutterEngine Stopwatch)
rt_module(cpu rt-cpu RayTracingCPU CpuEngine)
# Of these only what the GPU engine is made with.
rt_module(vulkan rt-vulkan Common/Vulkan Barrier DeviceMemory DeviceSelection FreeList Handle Instance Submission
          VulkanContext)
rt_module(gpu rt-gpu RayTracingGPU GpuEngine)

# What whoever includes the headers compiles with, as we do: GLM is always inlined, and products and sums are rounded
# one by one.
set(like_gcc $<CXX_COMPILER_ID:GNU,Clang,AppleClang>)
target_include_directories(rt-shared INTERFACE $<INSTALL_INTERFACE:${headers_folder}>)
target_compile_features(rt-shared INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)
target_compile_definitions(rt-shared INTERFACE $<INSTALL_INTERFACE:GLM_FORCE_INLINE>)
target_compile_options(rt-shared INTERFACE $<INSTALL_INTERFACE:$<${like_gcc}:-ffp-contract=off>>
                                           $<INSTALL_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>>)
if(MSVC)
    target_compile_definitions(rt-shared INTERFACE $<INSTALL_INTERFACE:NOMINMAX> $<INSTALL_INTERFACE:_USE_MATH_DEFINES>)
    target_compile_options(rt-shared INTERFACE $<INSTALL_INTERFACE:/permissive-> $<INSTALL_INTERFACE:/utf-8>)
endif()
set_target_properties(rt-parallel PROPERTIES EXPORT_NAME parallel) # of core
install(TARGETS rt-parallel EXPORT RayTracingTwins COMPONENT development)

# rt_needs(<target>): adds to `needs` and `packages` what whoever links the target has to find, by what it links itself.
function(rt_needs target)
    get_target_property(links ${target} INTERFACE_LINK_LIBRARIES)
    foreach(link IN LISTS links)
        string(REGEX REPLACE "^\\$<LINK_ONLY:(.*)>$" "\\1" link "${link}")
        if(link MATCHES "^(rt-.*|rt::parallel)$")
            string(REPLACE "rt::parallel" "rt-parallel" link ${link})
            rt_needs(${link})
        elseif(link MATCHES "^rt::(.*)$")
            list(APPEND needs ${CMAKE_MATCH_1})
        elseif(link MATCHES "^(Threads|Vulkan)::")
            list(APPEND packages ${CMAKE_MATCH_1})
        endif()
    endforeach()
    list(REMOVE_DUPLICATES needs)
    list(REMOVE_DUPLICATES packages)
    set(needs ${needs} PARENT_SCOPE)
    set(packages ${packages} PARENT_SCOPE)
endfunction()

set(RT_NEEDS "") # lines of the config
set(RT_DEVELOPMENT_LIBRARIES "") # all of them, for packages
foreach(component IN LISTS RT_MODULES)
    set(needs "")
    set(packages "")
    rt_needs(${RT_TARGET_${component}})
    list(APPEND RT_DEVELOPMENT_LIBRARIES ${needs})
    list(JOIN needs " " needs)
    list(JOIN packages " " packages)
    string(APPEND RT_NEEDS "set(rt_libraries_of_${component} ${needs})\nset(rt_packages_of_${component} ${packages})\n")
endforeach()
list(REMOVE_DUPLICATES RT_DEVELOPMENT_LIBRARIES)

set(config ${PROJECT_BINARY_DIR}/modules)
configure_package_config_file(cmake/modules/RayTracingTwinsConfig.cmake.in ${config}/RayTracingTwinsConfig.cmake
                              INSTALL_DESTINATION ${config_folder} NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Flags and files are promised by the first number; interfaces of C++ only by the first two.
write_basic_package_version_file(${config}/RayTracingTwinsConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${config}/RayTracingTwinsConfig.cmake ${config}/RayTracingTwinsConfigVersion.cmake cmake/Libraries.cmake
        DESTINATION ${config_folder} COMPONENT development)
install(EXPORT RayTracingTwins NAMESPACE RayTracingTwins:: FILE RayTracingTwinsTargets.cmake
        DESTINATION ${config_folder} COMPONENT development)
# The terms, also of what others wrote that is compiled into the libraries.
set(documents ${CMAKE_INSTALL_DATADIR}/doc/ray-tracing-twins-dev)
install(FILES cmake/packages/copyright DESTINATION ${documents} COMPONENT development)
install(DIRECTORY examples DESTINATION ${documents} COMPONENT development PATTERN build EXCLUDE)
