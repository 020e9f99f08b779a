# Third-party libraries from the system's packages or from vcpkg, each as one target rt::<name>. A library is looked for by
# its CMake config, else by pkg-config, else by its header; nothing is downloaded.
find_package(PkgConfig QUIET)
find_package(Threads REQUIRED)

# rt_dependency(<name> [PACKAGE <config> [VERSION <version>] TARGETS <target>...] [PKGCONFIG <module>] [HEADER <header>])
# Creates rt::<name> from the first of TARGETS that the config package defines, or from the pkg-config module, or from the
# folder of the header. Without any of them rt::<name> does not exist.
function(rt_dependency name)
    cmake_parse_arguments(arg "" "PACKAGE;VERSION;PKGCONFIG;HEADER" "TARGETS" ${ARGN})
    add_library(rt-dependency-${name} INTERFACE)
    if(arg_PACKAGE)
        find_package(${arg_PACKAGE} ${arg_VERSION} CONFIG QUIET GLOBAL)
        foreach(target IN LISTS arg_TARGETS)
            if(TARGET ${target})
                target_link_libraries(rt-dependency-${name} INTERFACE ${target})
                add_library(rt::${name} ALIAS rt-dependency-${name})
                return()
            endif()
        endforeach()
    endif()
    if(arg_PKGCONFIG AND PkgConfig_FOUND)
        pkg_check_modules(RT_PC_${name} QUIET IMPORTED_TARGET GLOBAL ${arg_PKGCONFIG})
        if(RT_PC_${name}_FOUND)
            target_link_libraries(rt-dependency-${name} INTERFACE PkgConfig::RT_PC_${name})
            add_library(rt::${name} ALIAS rt-dependency-${name})
            return()
        endif()
    endif()
    if(arg_HEADER)
        find_path(RT_${name}_INCLUDE_DIR ${arg_HEADER} PATH_SUFFIXES ${name})
        mark_as_advanced(RT_${name}_INCLUDE_DIR)
        if(RT_${name}_INCLUDE_DIR)
            target_include_directories(rt-dependency-${name} SYSTEM INTERFACE ${RT_${name}_INCLUDE_DIR})
            add_library(rt::${name} ALIAS rt-dependency-${name})
        endif()
    endif()
endfunction()

# The same, and the configuration ends with the names of the packages that have it when there is none.
function(rt_require name debian vcpkg)
    rt_dependency(${name} ${ARGN})
    if(NOT TARGET rt::${name})
        message(FATAL_ERROR "${name} was not found. Debian, Ubuntu: apt install ${debian}. vcpkg: vcpkg install ${vcpkg}. "
                            "Or run ./build.sh, which installs everything.")
    endif()
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

rt_require(glm libglm-dev glm PACKAGE glm TARGETS glm::glm-header-only glm::glm PKGCONFIG glm HEADER glm/glm.hpp)
rt_require(spdlog libspdlog-dev spdlog PACKAGE spdlog TARGETS spdlog::spdlog PKGCONFIG spdlog)
rt_require(json nlohmann-json3-dev nlohmann-json PACKAGE nlohmann_json TARGETS nlohmann_json::nlohmann_json
           PKGCONFIG nlohmann_json HEADER nlohmann/json.hpp)
rt_require(cli11 libcli11-dev cli11 PACKAGE CLI11 TARGETS CLI11::CLI11 PKGCONFIG CLI11 HEADER CLI/CLI.hpp)
# Headers only: Common/Image compiles the parts that it uses, as Debian's library would bring all of them and vcpkg has none.
rt_require(stb libstb-dev stb HEADER stb_image.h)
# The header only, as with stb: Common/Scene/Gltf/TinyGltf.cpp compiles it.
rt_require(tinygltf libtinygltf-dev tinygltf HEADER tiny_gltf.h)
rt_require(png libpng-dev libpng PACKAGE PNG TARGETS PNG::PNG png_shared png_static PKGCONFIG libpng)
find_package(JPEG QUIET) # CMake's own module, as libjpeg-turbo has a CMake config in few packages
rt_require(jpeg libjpeg-dev libjpeg-turbo PACKAGE libjpeg-turbo TARGETS JPEG::JPEG PKGCONFIG libjpeg)
rt_require(openexr libopenexr-dev openexr PACKAGE OpenEXR TARGETS OpenEXR::OpenEXR PKGCONFIG OpenEXR)

# Of textures in these formats, which can be left out. CMake's own module first, as with JPEG.
find_package(TIFF 4.5 QUIET)
rt_dependency(tiff PACKAGE tiff VERSION 4.5 TARGETS TIFF::TIFF PKGCONFIG libtiff-4>=4.5)
rt_dependency(webp PACKAGE WebP TARGETS WebP::webp PKGCONFIG libwebp)

# Of compressed glTF, likewise.
rt_dependency(draco PACKAGE draco TARGETS draco::draco PKGCONFIG draco)
rt_dependency(meshoptimizer PACKAGE meshoptimizer TARGETS meshoptimizer::meshoptimizer)

# Of the window, which can be left out. ImGui with its backends for GLFW and Vulkan.
rt_dependency(glfw PACKAGE glfw3 TARGETS glfw PKGCONFIG glfw3)
rt_dependency(imgui PACKAGE imgui TARGETS imgui::imgui PKGCONFIG imgui)

# Of renders on several machines, which can be left out.
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI QUIET COMPONENTS CXX)

# libstdc++ runs std::execution::par serially unless oneTBB is there, and libc++ has no policies at all: only Microsoft's
# library needs nothing.
add_library(rt-parallel INTERFACE)
add_library(rt::parallel ALIAS rt-parallel)
target_link_libraries(rt-parallel INTERFACE Threads::Threads)
if(NOT MSVC)
    rt_require(tbb libtbb-dev tbb PACKAGE TBB TARGETS TBB::tbb PKGCONFIG tbb)
    target_link_libraries(rt-parallel INTERFACE rt::tbb)
endif()

if(RT_BUILD_TESTS)
    rt_require(gtest libgtest-dev gtest PACKAGE GTest TARGETS GTest::gtest PKGCONFIG gtest)
    rt_require(gtest_main libgtest-dev gtest PACKAGE GTest TARGETS GTest::gtest_main PKGCONFIG gtest_main)
endif()
if(RT_BUILD_BENCH)
    rt_require(benchmark libbenchmark-dev benchmark PACKAGE benchmark TARGETS benchmark::benchmark PKGCONFIG benchmark)
endif()
# Embree 3 is an oracle of tests and a yardstick of benchmarks; what compares with it is built only where it is installed
# (Debian 13 has Embree 4).
if(RT_BUILD_TESTS OR RT_BUILD_BENCH)
    rt_dependency(embree PACKAGE embree VERSION 3 TARGETS embree)
endif()
