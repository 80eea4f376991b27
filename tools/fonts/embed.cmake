# Bytes of a file to an array in C++: cmake -D IN=... -D OUT=... -D NAME=... -P embed.cmake
file(READ ${IN} hex HEX)
string(REGEX REPLACE "(................................)" "\\1\n" hex "${hex}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," hex "${hex}")
file(WRITE ${OUT} "constexpr unsigned char ${NAME}[] = {\n${hex}\n};\n")
