# SPDX-License-Identifier: GPL-3.0-or-later
# Writes a file's text and checksum as a C++ constant, an EmbeddedFile. Run as
#   cmake -DINPUT=FILE -DOUTPUT=FILE.cpp -DHEADER=FILE.hpp -DNAME=constant -P embed.cmake
file(SHA256 ${INPUT} checksum)
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REGEX REPLACE "(0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,0x..,)" "\\1\n" bytes "${bytes}")
file(WRITE ${OUTPUT} "#include \"${HEADER}\"\n\nnamespace clerestory {\nnamespace {\nconst char text[] = {\n${bytes}0};\n}  // namespace\nconst EmbeddedFile ${NAME}{{text, sizeof(text) - 1}, \"${checksum}\"};\n}  // namespace clerestory\n")
