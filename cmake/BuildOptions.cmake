# How everything is compiled: language, warnings, floating point, sanitizers, and the instruction sets of kernels.
option(RT_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
set(RT_SANITIZE "" CACHE STRING "Sanitizers to build with: empty, address,undefined or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

get_property(RT_MULTI_CONFIG GLOBAL PROPERTY GENERATOR_IS_MULTI_CONFIG)
if(NOT RT_MULTI_CONFIG AND NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()

find_program(RT_CCACHE ccache)
mark_as_advanced(RT_CCACHE)
if(RT_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${RT_CCACHE})
endif()

# GLM's functions are inlined everywhere, so that no object file compiled for a newer instruction set can offer its copy of
# one to the others.
add_compile_definitions(GLM_FORCE_INLINE)

if(WIN32) # whose headers have macros of usual names, and lack that of pi
    add_compile_definitions(NOMINMAX WIN32_LEAN_AND_MEAN _USE_MATH_DEFINES)
endif()

# Products and sums are rounded one by one: scenes, films and metrics have the same bits on every machine.
if(MSVC)
    add_compile_options(/W4 /permissive- /utf-8 /bigobj /fp:precise $<$<BOOL:${RT_WARNINGS_AS_ERRORS}>:/WX>)
    add_compile_definitions(_CRT_SECURE_NO_WARNINGS)
else()
    add_compile_options(-Wall -Wextra -Wpedantic -ffp-contract=off $<$<BOOL:${RT_WARNINGS_AS_ERRORS}>:-Werror>)
    # GCC looks for memory that it can use again from 128 MB on, which costs a tenth of the time and finds little.
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288>)
    # GCC 12 takes the alternatives that a std::variant does not hold for uninitialised variables.
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
    # GCC 12's vectoriser of straight-line code drops the rounding to float in double(float(x)) of neighbouring components.
    add_compile_options($<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
        add_compile_options(-Wno-restrict) # false alarms for std::string's operator+, GCC bug 105329
    endif()
endif()

if(RT_SANITIZE)
    add_compile_options(-fsanitize=${RT_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${RT_SANITIZE})
    add_compile_definitions(RT_SANITIZED)
    # A chunk of a PNG may be empty, of which stb copies no byte from or to nowhere.
    set_source_files_properties(${PROJECT_SOURCE_DIR}/Common/Image/StbCodecs.cpp PROPERTIES COMPILE_OPTIONS
                                -fno-sanitize=nonnull-attribute)
endif()
if(RT_BUILD_FUZZ)
    add_compile_options(-fsanitize=fuzzer-no-link) # the coverage that guides mutations
endif()

# Of what waits for users and files, or is a test: to compile soon is worth more than to run fast.
function(rt_compile_sooner target)
    if(NOT MSVC)
        target_compile_options(${target} PRIVATE $<$<NOT:$<CONFIG:Debug>>:-O1>)
    endif()
endfunction()

# The instruction sets that kernels are compiled for on this architecture; the program chooses among them at run time.
string(TOLOWER "${CMAKE_SYSTEM_PROCESSOR}" RT_PROCESSOR)
set(RT_ALL_ISAS generic)
if(RT_PROCESSOR MATCHES "^(x86_64|amd64)$")
    set(RT_ALL_ISAS x86_64_v2 x86_64_v3 x86_64_v4)
endif()
set(RT_KERNELS all CACHE STRING "Instruction sets of kernels: all, host (the best of this processor), or a list")

# The best instruction set of this processor, as the program itself finds it.
function(rt_find_host_isa)
    if(DEFINED RT_HOST_ISA)
        return()
    endif()
    try_run(ran compiled SOURCES ${PROJECT_SOURCE_DIR}/cmake/HostInstructionSet.cpp
            ${PROJECT_SOURCE_DIR}/Common/Core/CpuFeatures.cpp CMAKE_FLAGS -DINCLUDE_DIRECTORIES=${PROJECT_SOURCE_DIR}
            RUN_OUTPUT_STDOUT_VARIABLE found CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON)
    if(NOT compiled OR NOT ran EQUAL 0)
        message(FATAL_ERROR "RT_KERNELS=host: what this processor runs cannot be told; name instruction sets")
    endif()
    string(REPLACE - _ found "${found}")
    set(RT_HOST_ISA ${found} CACHE INTERNAL "")
endfunction()

if(RT_KERNELS STREQUAL "host" AND NOT CMAKE_CROSSCOMPILING)
    rt_find_host_isa()
    set(RT_KERNEL_ISAS ${RT_HOST_ISA})
elseif(RT_KERNELS MATCHES "^(all|host)$")
    set(RT_KERNEL_ISAS ${RT_ALL_ISAS})
else()
    set(RT_KERNEL_ISAS ${RT_KERNELS})
endif()
foreach(isa IN LISTS RT_KERNEL_ISAS)
    if(NOT isa IN_LIST RT_ALL_ISAS)
        message(FATAL_ERROR "RT_KERNELS: ${isa} must be all, host or among ${RT_ALL_ISAS}")
    endif()
endforeach()
if(NOT RT_KERNEL_ISAS)
    message(FATAL_ERROR "RT_KERNELS: must be all, host or at least one of ${RT_ALL_ISAS}")
endif()

# Gives `source`, a kernel compiled for one of RT_KERNEL_ISAS, the options of that instruction set. Functions of <cmath>
# neither set errno nor raise flags that anyone reads. Products and sums are not contracted: a compiler would fuse them
# differently in every specialisation of a kernel, and their images would differ (it was measured to gain 3 %).
function(rt_set_kernel_options source isa)
    if(MSVC)
        set(options /O2)
        set(options.x86_64_v3 /arch:AVX2)
        set(options.x86_64_v4 /arch:AVX512)
    else()
        set(options -fno-math-errno -fno-trapping-math)
        # Kernels are few and huge functions, in which GCC searches for equal loads a fifth of the time, in vain.
        list(APPEND options $<$<CXX_COMPILER_ID:GNU>:--param=sccvn-max-alias-queries-per-access=64>)
        # The denoiser's read finite values alone, which makes minima and maxima of vectors single instructions.
        if(source MATCHES "/Denoise/")
            list(APPEND options -ffinite-math-only -fno-signed-zeros)
        endif()
        if(NOT RT_SANITIZE) # whose checks take compilers many minutes at this level
            list(PREPEND options $<$<NOT:$<CONFIG:Debug>>:-O3>)
        endif()
        set(options.x86_64_v2 -march=x86-64-v2)
        set(options.x86_64_v3 -march=x86-64-v3)
        # What v4 brings is its 32 registers; vectors of 16 floats were measured to bring nothing.
        set(options.x86_64_v4 -march=x86-64-v4 -mprefer-vector-width=256)
    endif()
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${options};${options.${isa}}")
    if(NOT RT_SANITIZE) # in one piece a kernel with the sanitizers' checks takes compilers a quarter of an hour
        set_source_files_properties(${source} PROPERTIES COMPILE_DEFINITIONS RT_KERNEL)
    endif()
endfunction()
