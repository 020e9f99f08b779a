# The font of the interface is a file of a system package that becomes an array of a C++ header: the program looks for
# none when it runs. Without the file the window takes what the machine that it runs on has.
find_file(RT_UI_FONT DejaVuSans.ttf
          PATHS /usr/share/fonts/truetype/dejavu /usr/share/fonts/TTF /usr/share/fonts/dejavu-sans-fonts
                /usr/local/share/fonts /opt/homebrew/share/fonts
          NO_DEFAULT_PATH DOC "TrueType font of the interface")
mark_as_advanced(RT_UI_FONT)
if(NOT RT_UI_FONT)
    message(STATUS "DejaVuSans.ttf was not found (Debian, Ubuntu: apt install fonts-dejavu-core): "
                   "the window takes a font of the machine that it runs on")
endif()

# RT_UI_FONT becomes the header "UiFont.h" in an include folder of `target`, with the array kUiFont.
function(rt_embed_font target)
    set(header ${PROJECT_BINARY_DIR}/fonts/UiFont.h)
    set(file ${RT_UI_FONT})
    if(NOT file)
        set(file "")
    endif()
    add_custom_command(
        OUTPUT ${header}
        COMMAND ${CMAKE_COMMAND} -DRT_FILE=${file} -DRT_HEADER=${header} -DRT_SYMBOL=kUiFont
                -P ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake
        DEPENDS ${file} ${PROJECT_SOURCE_DIR}/cmake/EmbedFile.cmake
        COMMENT "Font ${file}"
        VERBATIM)
    target_sources(${target} PRIVATE ${header})
    target_include_directories(${target} PRIVATE ${PROJECT_BINARY_DIR}/fonts)
endfunction()
