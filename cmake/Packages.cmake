# What cpack makes of the install rules; ./build.sh package runs it. For Debian there are three packages, so that nobody
# needs compilers or Python who wants the programs: these, the modules (Modules.cmake), and the Python module.
set(CPACK_PACKAGE_NAME ray-tracing-twins)
set(CPACK_PACKAGE_VENDOR "The Ray Tracing Twins authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "interactive path tracers on the CPU and on the GPU")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_PROJECT_CONFIG_FILE ${PROJECT_SOURCE_DIR}/cmake/packages/Generators.cmake)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/packages/SameTimes.cmake)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
if(WIN32)
    set(CPACK_GENERATOR ZIP)
elseif(APPLE)
    set(CPACK_GENERATOR TGZ)
else()
    set(CPACK_GENERATOR DEB TGZ)
endif()

# Debian asks for an address. example.org is reserved (RFC 2606), so that nobody gets mail in the authors' place: whoever
# hands packages on gives their own.
set(RT_MAINTAINER "Ray Tracing Twins authors <authors@ray-tracing-twins.example.org>"
    CACHE STRING "Who stands as the maintainer in packages")
set(CPACK_PACKAGE_CONTACT ${RT_MAINTAINER})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(RT_PACKAGES "") # groups of components of Debian's packages

# rt_debian_package(<group> <name> <section> <component>... [SHLIBDEPS] [DEPENDS <text>] [RECOMMENDS <text>]
#                   [SUGGESTS <text>] DESCRIPTION <text without a semicolon>)
# Of these components, and of what every package has to have.
macro(rt_debian_package group name section)
    cmake_parse_arguments(arg "SHLIBDEPS" "DEPENDS;RECOMMENDS;SUGGESTS;DESCRIPTION" "" ${ARGN})
    list(APPEND RT_PACKAGES ${group})
    string(TOUPPER ${group} upper)
    set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
    set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
    set(CPACK_DEBIAN_${upper}_DESCRIPTION ${arg_DESCRIPTION})
    set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ${arg_SHLIBDEPS})
    foreach(relation IN ITEMS DEPENDS RECOMMENDS SUGGESTS)
        set(CPACK_DEBIAN_${upper}_PACKAGE_${relation} ${arg_${relation}})
    endforeach()
    foreach(component IN ITEMS ${arg_UNPARSED_ARGUMENTS} debian-${group})
        string(TOUPPER ${component} component)
        set(CPACK_COMPONENT_${component}_GROUP ${group})
    endforeach()
    if(UNIX AND NOT APPLE)
        set(documents ${CMAKE_INSTALL_DATADIR}/doc/${name})
        install(FILES cmake/packages/copyright DESTINATION ${documents} COMPONENT debian-${group} EXCLUDE_FROM_ALL)
        if(RT_GZIP)
            install(FILES ${RT_CHANGELOG}.gz DESTINATION ${documents} COMPONENT debian-${group} EXCLUDE_FROM_ALL)
        endif()
    endif()
endmacro()

if(RT_GZIP AND UNIX AND NOT APPLE)
    set(RT_CHANGELOG ${PROJECT_BINARY_DIR}/debian/changelog)
    configure_file(cmake/packages/changelog ${RT_CHANGELOG} @ONLY)
    add_custom_command(OUTPUT ${RT_CHANGELOG}.gz COMMAND ${RT_GZIP} -9nkf ${RT_CHANGELOG} DEPENDS ${RT_CHANGELOG}
                       VERBATIM)
    add_custom_target(rt-debian-files ALL DEPENDS ${RT_CHANGELOG}.gz)
endif()

# The window of either program shows pictures through a Vulkan driver.
rt_debian_package(programs ray-tracing-twins graphics programs SHLIBDEPS RECOMMENDS mesa-vulkan-drivers
    SUGGESTS "xplanet-images, ray-tracing-twins-dev, python3-raytracing" DESCRIPTION
"interactive path tracers on the CPU and on the GPU
Two programs render the same scenes in the same way: one on all cores of
the processor, one on the graphics card by Vulkan. A window shows the
picture while it gets cleaner, and scripts render without a window.
.
The package also has a tool that compares, converts and denoises images,
and a benchmark of run time against error.")

set(needed "") # by whoever links the modules
foreach(library IN LISTS RT_DEVELOPMENT_LIBRARIES)
    get_property(package GLOBAL PROPERTY RT_LIBRARY_${library}_DEBIAN)
    list(APPEND needed ${package})
endforeach()
if(TARGET rt-vulkan)
    list(APPEND needed libvulkan-dev)
endif()
list(SORT needed)
list(JOIN needed ", " needed)
rt_debian_package(development ray-tracing-twins-dev libdevel development DEPENDS "${needed}, pkg-config"
    SUGGESTS "cmake (>= 3.25), ray-tracing-twins" DESCRIPTION
"modules of path tracers for one's own programs in C++
Static libraries, headers and a package that find_package of CMake finds:
formulas of light sampling and scattering, bounding volume hierarchies,
films, image files and errors, scenes and their files, and the engines of
ray-tracing-twins for the processor and for Vulkan.
.
Five programs that use them are among the documentation.")

if(RT_BUILD_PYTHON)
    math(EXPR after "${Python_VERSION_MINOR} + 1")
    set(python "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${after})")
    # The programs bring the assets.
    rt_debian_package(python python3-raytracing python python SHLIBDEPS
        DEPENDS "${python}, python3-numpy, ray-tracing-twins (= ${PROJECT_VERSION})" RECOMMENDS mesa-vulkan-drivers
        DESCRIPTION
"path tracers on the CPU and on the GPU, from Python
The module raytracing renders scenes of ray-tracing-twins to arrays of
numpy, with the flags and the bits of its programs, and hands over the
formulas behind them: light sampling, scattering, random numbers, rays,
errors of images and image files.")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/packages/python/postinst
        ${PROJECT_SOURCE_DIR}/cmake/packages/python/prerm)
endif()

# Read by Generators.cmake.
set(CPACK_RT_PACKAGES ${RT_PACKAGES})
include(CPack)
