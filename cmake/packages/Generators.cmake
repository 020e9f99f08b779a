# Read by cpack for each kind of package. A package of Debian leaves libraries to other packages; an archive has the
# programs and brings libraries along.
if(CPACK_GENERATOR STREQUAL "DEB")
    set(CPACK_COMPONENTS_ALL ${CPACK_RT_PACKAGES})
    foreach(package IN LISTS CPACK_RT_PACKAGES)
        list(APPEND CPACK_COMPONENTS_ALL debian-${package})
    endforeach()
    set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package's description begins with its own
    set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
else()
    set(CPACK_COMPONENTS_ALL programs libraries)
    set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
    set(CPACK_PACKAGING_INSTALL_PREFIX /)
    set(CPACK_COMPONENT_INCLUDE_TOPLEVEL_DIRECTORY ON)
endif()
