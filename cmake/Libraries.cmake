# How the libraries of others are found, from the system's packages or from vcpkg, each as one target rt::<name>: by its
# CMake config, else by pkg-config, else by its header; nothing is downloaded. Projects that use the modules find what
# these need by this file, too: it is installed (cmake/Modules.cmake).
find_package(PkgConfig QUIET)

# rt_library(<name> <package of Debian> <port of vcpkg> [MODULE <CMake's own module>] [PACKAGE <config>]
#            [VERSION <least>] [TARGETS <target>...] [PKGCONFIG <module>] [HEADER <header>])
# Says how rt_find(<name>) finds it.
function(rt_library name debian vcpkg)
    set_property(GLOBAL PROPERTY RT_LIBRARY_${name} "${ARGN}")
    set_property(GLOBAL PROPERTY RT_LIBRARY_${name}_DEBIAN ${debian})
    set_property(GLOBAL PROPERTY RT_LIBRARY_${name}_VCPKG ${vcpkg})
endfunction()

# Creates rt::<name> from the first of TARGETS that there is, or from the pkg-config module, or from the folder of the
# header. Without any of them rt::<name> does not exist.
function(rt_find name)
    if(TARGET rt::${name})
        return()
    endif()
    get_property(how GLOBAL PROPERTY RT_LIBRARY_${name})
    cmake_parse_arguments(arg "" "MODULE;PACKAGE;VERSION;PKGCONFIG;HEADER" "TARGETS" ${how})
    if(arg_MODULE)
        find_package(${arg_MODULE} ${arg_VERSION} QUIET GLOBAL)
    endif()
    if(arg_PACKAGE)
        find_package(${arg_PACKAGE} ${arg_VERSION} CONFIG QUIET GLOBAL)
    endif()
    foreach(target IN LISTS arg_TARGETS)
        if(TARGET ${target})
            add_library(rt::${name} INTERFACE IMPORTED GLOBAL)
            target_link_libraries(rt::${name} INTERFACE ${target})
            return()
        endif()
    endforeach()
    if(arg_PKGCONFIG AND PkgConfig_FOUND)
        pkg_check_modules(RT_PC_${name} QUIET IMPORTED_TARGET GLOBAL ${arg_PKGCONFIG})
        if(RT_PC_${name}_FOUND)
            add_library(rt::${name} INTERFACE IMPORTED GLOBAL)
            target_link_libraries(rt::${name} INTERFACE PkgConfig::RT_PC_${name})
            return()
        endif()
    endif()
    if(arg_HEADER)
        find_path(RT_${name}_INCLUDE_DIR ${arg_HEADER} PATH_SUFFIXES ${name})
        mark_as_advanced(RT_${name}_INCLUDE_DIR)
        if(RT_${name}_INCLUDE_DIR)
            add_library(rt::${name} INTERFACE IMPORTED GLOBAL)
            target_include_directories(rt::${name} INTERFACE ${RT_${name}_INCLUDE_DIR})
        endif()
    endif()
endfunction()

# Which package brings a library that was not found.
function(rt_advice result name)
    get_property(debian GLOBAL PROPERTY RT_LIBRARY_${name}_DEBIAN)
    get_property(vcpkg GLOBAL PROPERTY RT_LIBRARY_${name}_VCPKG)
    set(${result} "${name} was not found. Debian, Ubuntu: apt install ${debian}. vcpkg: vcpkg install ${vcpkg}."
        PARENT_SCOPE)
endfunction()

rt_library(glm libglm-dev glm PACKAGE glm TARGETS glm::glm-header-only glm::glm PKGCONFIG glm HEADER glm/glm.hpp)
rt_library(spdlog libspdlog-dev spdlog PACKAGE spdlog TARGETS spdlog::spdlog PKGCONFIG spdlog)
rt_library(tbb libtbb-dev tbb PACKAGE TBB TARGETS TBB::tbb PKGCONFIG tbb)
rt_library(json nlohmann-json3-dev nlohmann-json PACKAGE nlohmann_json TARGETS nlohmann_json::nlohmann_json
           PKGCONFIG nlohmann_json HEADER nlohmann/json.hpp)
rt_library(cli11 libcli11-dev cli11 PACKAGE CLI11 TARGETS CLI11::CLI11 PKGCONFIG CLI11 HEADER CLI/CLI.hpp)
# Headers only: Common/Image compiles the parts that it uses, as Debian's library would bring all of them and vcpkg has
# none.
rt_library(stb libstb-dev stb HEADER stb_image.h)
# The header only, as with stb: Common/Scene/Gltf/TinyGltf.cpp compiles it.
rt_library(tinygltf libtinygltf-dev tinygltf HEADER tiny_gltf.h)
rt_library(png libpng-dev libpng PACKAGE PNG TARGETS PNG::PNG png_shared png_static PKGCONFIG libpng)
# CMake's own module first, as libjpeg-turbo has a CMake config in few packages; likewise libtiff.
rt_library(jpeg libjpeg-dev libjpeg-turbo MODULE JPEG PACKAGE libjpeg-turbo TARGETS JPEG::JPEG PKGCONFIG libjpeg)
rt_library(openexr libopenexr-dev openexr PACKAGE OpenEXR TARGETS OpenEXR::OpenEXR PKGCONFIG OpenEXR)
rt_library(tiff libtiff-dev tiff MODULE TIFF PACKAGE tiff VERSION 4.5 TARGETS TIFF::TIFF PKGCONFIG libtiff-4>=4.5)
rt_library(webp libwebp-dev libwebp PACKAGE WebP TARGETS WebP::webp PKGCONFIG libwebp)
rt_library(draco libdraco-dev draco PACKAGE draco TARGETS draco::draco PKGCONFIG draco)
rt_library(meshoptimizer libmeshoptimizer-dev meshoptimizer PACKAGE meshoptimizer TARGETS meshoptimizer::meshoptimizer)
rt_library(pugixml libpugixml-dev pugixml PACKAGE pugixml TARGETS pugixml::pugixml pugixml PKGCONFIG pugixml)
rt_library(zlib zlib1g-dev zlib MODULE ZLIB PACKAGE ZLIB TARGETS ZLIB::ZLIB PKGCONFIG zlib)
rt_library(glfw libglfw3-dev glfw3 PACKAGE glfw3 TARGETS glfw PKGCONFIG glfw3)
rt_library(imgui libimgui-dev imgui PACKAGE imgui TARGETS imgui::imgui PKGCONFIG imgui)
rt_library(gtest libgtest-dev gtest PACKAGE GTest TARGETS GTest::gtest PKGCONFIG gtest)
rt_library(gtest_main libgtest-dev gtest PACKAGE GTest TARGETS GTest::gtest_main PKGCONFIG gtest_main)
rt_library(benchmark libbenchmark-dev benchmark PACKAGE benchmark TARGETS benchmark::benchmark PKGCONFIG benchmark)
rt_library(embree libembree-dev embree3 PACKAGE embree VERSION 3 TARGETS embree)
