// The only piece of a firmware that holds the script compiler.
#include "kernel/script/load.hpp"

#include "kernel/script/compile.hpp"

namespace tappet {

ScriptOutcome compile_loaded(std::string_view text, std::string_view name, const Reach& reach,
                             const ScriptRoom& room) {
    return compile_into(text, name, reach, room);
}

ScriptOutcome compile_line(std::string_view text, std::string_view name, const Reach& reach,
                           const ScriptRoom& room) {
    return compile_line_into(text, name, reach, room);
}

} // namespace tappet
