# SPDX-License-Identifier: Apache-2.0
# Writes the header TO with the text of the file FROM, which messages call PLACE, as tappet::CONSTANT; see script.cmake.
cmake_minimum_required(VERSION 3.25)
string(REGEX MATCH "^([a-z]+)::(.+)$" ignored "${CONSTANT}")
set(room "${CMAKE_MATCH_1}")
set(name "${CMAKE_MATCH_2}")
file(READ "${FROM}" text)
file(READ "${FROM}" bytes HEX)
string(REGEX REPLACE "(..)" " \\1" bytes "${bytes}")
if(bytes MATCHES " 00")
    message(FATAL_ERROR "\"${PLACE}\" is no text: a byte of it is zero; take that out")
endif()
if(text MATCHES "[)]tappet_text\"")
    message(FATAL_ERROR "\"${PLACE}\" holds the characters that end its constant; write them apart")
endif()
# A byte that may be no UTF-8 stands in a literal of its own, so that compilers read none.
if(bytes MATCHES " [89a-f]")
    foreach(byte RANGE 128 255)
        string(ASCII ${byte} character)
        math(EXPR high "${byte} / 64")
        math(EXPR middle "${byte} / 8 % 8")
        math(EXPR low "${byte} % 8")
        string(REPLACE "${character}" ")tappet_text\" \"\\${high}${middle}${low}\" R\"tappet_text(" text "${text}")
    endforeach()
endif()
# The text begins after the bracket, so that its lines are those of the file. It is an array: with g++ a view of a literal
# costs its whole length wherever it is handed over in a constant expression.
file(WRITE "${TO}"
"// The file ${PLACE} as a constant; made when it changed.
#pragma once
#pragma GCC system_header // a literal may be of any length here

#include \"kernel/base/source_text.hpp\"

namespace tappet::${room} {

inline constexpr char ${name}_text[] = R\"tappet_text(${text})tappet_text\";
inline constexpr SourceText ${name}{\"${PLACE}\", {${name}_text, sizeof ${name}_text - 1}};

} // namespace tappet::${room}
")
