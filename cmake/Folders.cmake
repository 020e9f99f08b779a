# One folder, one target: sources are found by where they are, so adding a file changes no list.

# Library `name` of every source in `folder` except Main.cpp, on top of the libraries after DEPENDS; of those after
# INCLUDES it compiles headers alone, which whoever links it need not have. COLD: rt_compile_sooner(). Sources named
# X.<isa>.cpp are kernels: those of this architecture get the options of their instruction set, the others are left out.
# A folder of headers makes an interface library.
function(rt_add_library name folder)
    cmake_parse_arguments(arg "COLD" "" "DEPENDS;INCLUDES" ${ARGN})
    list(TRANSFORM arg_INCLUDES REPLACE "(.+)" "$<BUILD_INTERFACE:\\1>")
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/Main\\.cpp$")
    set(kernels ${sources})
    list(FILTER kernels INCLUDE REGEX "\\.(generic|x86_64_v[0-9])\\.cpp$")
    list(FILTER sources EXCLUDE REGEX "\\.(generic|x86_64_v[0-9])\\.cpp$")
    set(tables "") # what tells the library's sources which kernels there are
    foreach(kernel IN LISTS kernels)
        string(REGEX REPLACE ".*\\.(.*)\\.cpp$" "\\1" isa ${kernel})
        if(isa IN_LIST RT_KERNEL_ISAS)
            rt_set_kernel_options(${kernel} ${isa})
            list(APPEND sources ${kernel})
            list(APPEND tables RT_KERNELS_${isa})
        endif()
    endforeach()

    # Compiled alone, not merged with others: implementations of libraries of one header, which they configure by macros,
    # and what asks Windows, whose header has macros of common words.
    set(alone ${sources})
    list(FILTER alone INCLUDE REGEX "/(TinyGltf|StbCodecs|NewFile|ExecutablePath|Platform)\\.cpp$")
    set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

    if(sources)
        add_library(${name} STATIC ${sources})
        target_link_libraries(${name} PUBLIC ${arg_DEPENDS} ${arg_INCLUDES})
        target_compile_definitions(${name} PRIVATE ${tables})
        if(arg_COLD)
            rt_compile_sooner(${name})
        endif()
        # So that the Python module is linked from the very objects that the programs are.
        set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden
                                                 VISIBILITY_INLINES_HIDDEN ON)
    else()
        add_library(${name} INTERFACE)
        target_link_libraries(${name} INTERFACE ${arg_DEPENDS} ${arg_INCLUDES})
    endif()
endfunction()

# Program `name` whose main() is in `source`; none while there is no such file.
function(rt_add_program name source)
    cmake_parse_arguments(arg "" "" "DEPENDS" ${ARGN})
    file(GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${source})
    if(found)
        add_executable(${name} ${found})
        set_target_properties(${name} PROPERTIES UNITY_BUILD OFF) # few sources
        target_link_libraries(${name} PRIVATE ${arg_DEPENDS})
    endif()
endfunction()

# X.json of `folder` for each name X becomes a row {"X", "its text"} of the header "<header>.inc" in an include folder of
# `target`.
function(rt_embed_texts target header folder)
    set(rows "")
    foreach(name IN LISTS ARGN)
        set(file ${PROJECT_SOURCE_DIR}/${folder}/${name}.json)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
        file(READ ${file} text)
        string(APPEND rows "{\"${name}\", R\"rt-text(${text})rt-text\"},\n")
    endforeach()
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/texts/${header}.inc CONTENT "@rows@" @ONLY)
    target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/texts)
endfunction()
