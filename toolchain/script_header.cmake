# SPDX-License-Identifier: Apache-2.0
# Writes the header TO with the script of the file FROM, which messages call PLACE; see script.cmake.
get_filename_component(name "${FROM}" NAME_WE)
file(READ "${FROM}" text)
if(NOT name MATCHES "^[A-Za-z_][A-Za-z0-9_]*$")
    message(FATAL_ERROR "script \"${PLACE}\": its name becomes one of C++; use characters, digits and _ only")
endif()
if(text MATCHES "[)]tappet_script\"")
    message(FATAL_ERROR "script \"${PLACE}\": it holds the characters that end its constant; write them apart")
endif()
# The text begins after the bracket, so that its lines are those of the file.
file(WRITE "${TO}"
"// The script ${PLACE} as a constant; made when it changed.
#pragma once

#include \"kernel/script/compiled.hpp\"

namespace tappet::scripts {

inline constexpr ScriptSource ${name}{\"${PLACE}\", R\"tappet_script(${text})tappet_script\"};

} // namespace tappet::scripts
")
