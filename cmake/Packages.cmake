# What cpack makes of the install rules; ./build.sh package runs it. There is no package of headers and
# libraries: the libraries are linked into the programs and promise nobody an interface.
set(CPACK_PACKAGE_NAME ray-tracing-twins)
set(CPACK_PACKAGE_VENDOR "The Ray Tracing Twins authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "interactive path tracers on the CPU and on the GPU")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
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
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The window of either program shows pictures through a Vulkan driver.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS mesa-vulkan-drivers)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS xplanet-images)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Two programs render the same scenes in the same way: one on all cores of
the processor, one on the graphics card by Vulkan. A window shows the
picture while it gets cleaner; scripts render without a window.
.
The package also has a tool that compares, converts and denoises images,
and a benchmark of run time against error.")

if(UNIX AND NOT APPLE)
    set(documents ${CMAKE_INSTALL_DATADIR}/doc/ray-tracing-twins)
    install(FILES cmake/packages/copyright DESTINATION ${documents} COMPONENT debian EXCLUDE_FROM_ALL)
    if(RT_GZIP)
        set(changelog ${PROJECT_BINARY_DIR}/debian/changelog)
        configure_file(cmake/packages/changelog ${changelog} @ONLY)
        add_custom_command(OUTPUT ${changelog}.gz COMMAND ${RT_GZIP} -9nkf ${changelog} DEPENDS ${changelog} VERBATIM)
        add_custom_target(rt-debian-files ALL DEPENDS ${changelog}.gz)
        install(FILES ${changelog}.gz DESTINATION ${documents} COMPONENT debian EXCLUDE_FROM_ALL)
    endif()
endif()
include(CPack)
