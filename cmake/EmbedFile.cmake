# Writes the bytes of RT_FILE as the header RT_HEADER with the array RT_SYMBOL; where RT_FILE is empty, an array of
# one zero.
set(bytes "0,")
if(RT_FILE)
    file(READ ${RT_FILE} digits HEX)
    string(REGEX REPLACE "(................................)" "\\1\n" digits "${digits}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${digits}")
endif()
file(WRITE ${RT_HEADER} "#pragma once\nalignas(4) inline constexpr unsigned char ${RT_SYMBOL}[] = {\n${bytes}\n};\n")
