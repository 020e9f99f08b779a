# The Python module: build/python/raytracing is the package as it can be imported, the extension module and the sources
# of Python/raytracing beside each other.
set(RT_CAN_BUILD_PYTHON OFF)

# Whether this interpreter, one of several perhaps, has numpy.
function(rt_has_numpy result interpreter)
    execute_process(COMMAND ${interpreter} -c "import numpy" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
    if(NOT status EQUAL 0)
        set(${result} FALSE PARENT_SCOPE)
    endif()
endfunction()

if(NOT CMAKE_CROSSCOMPILING)
    find_program(RT_PYTHON NAMES python3 python VALIDATOR rt_has_numpy DOC "Interpreter that the module is for")
endif()
if(RT_PYTHON)
    set(Python_EXECUTABLE ${RT_PYTHON})
    find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module)
    if(Python_Development.Module_FOUND)
        set(PYBIND11_FINDPYTHON ON)
        find_package(pybind11 2.10 CONFIG QUIET)
        if(pybind11_FOUND)
            set(RT_CAN_BUILD_PYTHON ON)
        endif()
    endif()
endif()
option(RT_BUILD_PYTHON "Build the Python module" ${RT_CAN_BUILD_PYTHON})
if(RT_BUILD_PYTHON AND NOT RT_CAN_BUILD_PYTHON)
    message(FATAL_ERROR "RT_BUILD_PYTHON needs Python 3.9 with its headers, pybind11 2.10 and numpy. Debian, Ubuntu: "
                        "apt install python3-dev pybind11-dev python3-numpy. vcpkg: vcpkg install python3 pybind11.")
endif()

# To be called when all libraries exist.
function(rt_add_python_module)
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/Python/*.cpp)
    pybind11_add_module(rt-python MODULE NO_EXTRAS ${sources})
    rt_compile_sooner(rt-python)
    if(NOT MSVC) # of their loops compilers make vectors
        set_source_files_properties(${PROJECT_SOURCE_DIR}/Python/Arrays.cpp ${PROJECT_SOURCE_DIR}/Python/Shapes.cpp
            PROPERTIES COMPILE_OPTIONS "$<$<NOT:$<CONFIG:Debug>>:-O3>;-fno-math-errno;-fno-trapping-math")
    endif()
    target_link_libraries(rt-python PRIVATE rt-probe rt-cpu)
    if(RT_BUILD_GPU)
        target_link_libraries(rt-python PRIVATE rt-gpu)
        target_compile_definitions(rt-python PRIVATE RT_HAS_GPU)
    endif()
    set(package ${PROJECT_BINARY_DIR}/python/raytracing)
    set_target_properties(rt-python PROPERTIES OUTPUT_NAME _core LIBRARY_OUTPUT_DIRECTORY ${package})

    file(GLOB files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/Python/raytracing/*.py
         ${PROJECT_SOURCE_DIR}/Python/raytracing/*.pyi ${PROJECT_SOURCE_DIR}/Python/raytracing/py.typed)
    set(copies "")
    foreach(file IN LISTS files)
        get_filename_component(name ${file} NAME)
        add_custom_command(OUTPUT ${package}/${name} COMMAND ${CMAKE_COMMAND} -E copy ${file} ${package}/${name}
                           DEPENDS ${file} VERBATIM)
        list(APPEND copies ${package}/${name})
    endforeach()
    add_custom_target(rt-python-files ALL DEPENDS ${copies})
    add_dependencies(rt-python rt-python-files)

    # Into site-packages of a prefix, such as /usr, a virtual environment or the user's own.
    set(RT_PYTHON_DIR "" CACHE STRING "Where cmake --install puts the Python module; empty: beside the prefix's others")
    set(destination ${RT_PYTHON_DIR})
    if(NOT destination)
        set(destination ${CMAKE_INSTALL_LIBDIR}/python${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}/site-packages)
        if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
            set(destination lib/python${Python_VERSION_MAJOR}/dist-packages)
        endif()
    endif()
    install(TARGETS rt-python LIBRARY DESTINATION ${destination}/raytracing COMPONENT python EXCLUDE_FROM_ALL)
    install(FILES ${files} DESTINATION ${destination}/raytracing COMPONENT python EXCLUDE_FROM_ALL)
    # Where no package of the programs brings them.
    install(DIRECTORY Assets/ DESTINATION ${destination}/raytracing/Assets COMPONENT python-assets EXCLUDE_FROM_ALL
            PATTERN desktop EXCLUDE)
endfunction()
