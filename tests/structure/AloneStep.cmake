# One step of Alone.cmake, by COMPILER in the folder SCRATCH. Fails where a file does not compile alone without warnings,
# and prints what Clang says of it. KIND is
#   libraries  makes the module NAME of the headers of other projects that ours include
#   headers    makes the module NAME of ours
#   sources    compiles those of the target NAME
# CONFIG sets files, definitions and includes.
cmake_minimum_required(VERSION 3.25)
include(${CONFIG})
file(MAKE_DIRECTORY ${SCRATCH})

include(${CMAKE_CURRENT_LIST_DIR}/ClangOptions.cmake)

# All warnings, but that fields of Vulkan's records that are not named are zero, where GCC looks at all others. A file sees
# of its neighbours in a module only what it includes.
set(strict -Wall -Wextra -Wpedantic -Werror -Wno-missing-field-initializers
           -Xclang -fmodules-local-submodule-visibility)

# rt_compile(<option>...): by the modules that the steps before this one made. Prints what is wrong and sets `failed`.
function(rt_compile)
    set(modules -fmodules -fno-implicit-modules -fno-implicit-module-maps)
    foreach(module IN ITEMS Libraries Headers)
        if(module STREQUAL NAME)
            break()
        endif()
        list(APPEND modules -fmodule-map-file=${SCRATCH}/${module}.map -fmodule-file=${SCRATCH}/${module}.pcm)
    endforeach()
    execute_process(COMMAND ${COMPILER} ${options} ${modules} ${ARGN} RESULT_VARIABLE result ERROR_VARIABLE messages)
    if(NOT result EQUAL 0)
        message(NOTICE "${messages}")
        set(failed TRUE PARENT_SCOPE)
    endif()
endfunction()

# rt_make_module(<map> <option>...): the module NAME
function(rt_make_module map)
    file(WRITE ${SCRATCH}/${NAME}.map "${map}")
    rt_compile(${ARGN} -fmodule-map-file=${SCRATCH}/${NAME}.map -fmodule-name=${NAME} -Xclang -emit-module
               -x c++ -c ${SCRATCH}/${NAME}.map -o ${SCRATCH}/${NAME}.pcm)
    set(failed ${failed} PARENT_SCOPE)
endfunction()

if(KIND STREQUAL "libraries")
    # The standard library's, and those whose text does not depend on macros of who includes them.
    set(names "[a-z_]+|(CLI|embree3|glm|gtest|nlohmann|pybind11|spdlog|tbb)/.*|(vulkan/vulkan|imgui|Iex|Imf[A-Za-z]*)\\.h")
    cmake_host_system_information(RESULT processor QUERY OS_PLATFORM)
    if(processor MATCHES "^(x86_64|amd64)$")
        string(APPEND names "|[a-z]*mmintrin\\.h")
    endif()
    set(wanted "")
    foreach(file IN LISTS files)
        file(STRINGS ${file} lines REGEX "^#include <(${names})>")
        list(APPEND wanted ${lines})
    endforeach()
    list(TRANSFORM wanted REPLACE "^#include <(.*)>.*" "\\1")
    list(SORT wanted)
    list(REMOVE_DUPLICATES wanted)
    set(text "")
    foreach(header IN LISTS wanted)
        string(APPEND text "#if __has_include(<${header}>)\n#include <${header}>\n#endif\n")
    endforeach()
    file(WRITE ${SCRATCH}/Libraries.cpp "${text}")
    execute_process(COMMAND ${COMPILER} ${options} -M ${SCRATCH}/Libraries.cpp OUTPUT_VARIABLE found
                    COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "[ \\\n]+" ";" found "${found}")
    set(map "")
    foreach(header IN LISTS wanted)
        set(shortest "") # c++/12/vector, not c++/12/experimental/vector
        foreach(path IN LISTS found)
            string(LENGTH "${path}" length)
            if(path MATCHES "/${header}$" AND (NOT shortest OR length LESS least))
                set(shortest ${path})
                set(least ${length})
            endif()
        endforeach()
        if(shortest)
            file(REAL_PATH ${shortest} shortest)
            string(APPEND map "header \"${shortest}\"\n")
        endif()
    endforeach()
    rt_make_module("module ${NAME} [system] {\n${map}export *\n}\n")
elseif(KIND STREQUAL "headers")
    # Clang lets a namespace's unnamed one be seen where it was seen first in a module, so there it is seen by all.
    set(unnamed "namespace {}")
    foreach(file IN LISTS files)
        file(STRINGS ${file} lines REGEX "^namespace [A-Za-z0-9_:]+ {")
        foreach(line IN LISTS lines)
            list(APPEND unnamed "${line} namespace {} }")
        endforeach()
    endforeach()
    list(REMOVE_DUPLICATES unnamed)
    list(JOIN unnamed "\n" unnamed)
    file(WRITE ${SCRATCH}/${NAME}/Unnamed.h "${unnamed}\n")
    set(map "module Unnamed { header \"${NAME}/Unnamed.h\" }\n")
    set(number 0)
    foreach(file IN LISTS files)
        string(REPLACE "${ROOT}/" "" name ${file})
        math(EXPR number "${number} + 1")
        file(WRITE ${SCRATCH}/${NAME}/${number}.h "#include \"Unnamed.h\"\n")
        string(APPEND map "module \"${name}\" { header \"${NAME}/${number}.h\" header \"${file}\" export * }\n")
    endforeach()
    rt_make_module("module ${NAME} {\n${map}}\n" ${strict})
else()
    # As if more of the source followed, for which Clang leaves the making of templates to the end: builds do that.
    foreach(file IN LISTS files)
        rt_compile(${strict} -x c++-header ${file} -o ${SCRATCH}/${NAME}.pch)
    endforeach()
endif()

if(failed)
    execute_process(COMMAND ${COMPILER} --version OUTPUT_VARIABLE version)
    string(REGEX REPLACE "\n.*" "" version "${version}")
    message(FATAL_ERROR "${version}: see above")
endif()
