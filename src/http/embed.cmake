# cmake -DOUTPUT=assets.cpp "-DFILES=path=file;path=file" -P embed.cmake
# Writes a C++ source that holds the files' bytes, each under the path it is requested by.
set(arrays "")
set(table "")
set(n 0)
foreach(entry IN LISTS FILES)
    string(REGEX MATCH "^([^=]*)=(.*)$" _ "${entry}")
    set(path "${CMAKE_MATCH_1}")
    file(READ "${CMAKE_MATCH_2}" hex HEX)
    string(LENGTH "${hex}" length)
    math(EXPR length "${length} / 2")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(APPEND arrays "const unsigned char file${n}[] = {${bytes}0};\n")
    string(APPEND table "    {\"${path}\", {reinterpret_cast<const char*>(file${n}), ${length}}},\n")
    math(EXPR n "${n} + 1")
endforeach()
file(WRITE "${OUTPUT}" "#include \"http/assets.hpp\"\n\nnamespace vines::http {\n\nnamespace {\n${arrays}"
    "const Asset table[] = {\n${table}};\n}  // namespace\n\nstd::span<const Asset> assets() { return table; }\n\n}  // namespace vines::http\n")
