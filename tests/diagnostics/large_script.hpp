// Writes the source of a large script: 100 states and 1000 statements, as native code.
#pragma once

#include <ostream>
#include <string>

namespace tappet::diagnostics {

constexpr int script_states = 100;

inline void write_state(std::ostream& file, int number) {
    const std::string me = std::to_string(number);
    file << "    "
         << (number == 0                   ? "initial "
             : number == script_states - 1 ? "final "
                                           : "")
         << "state S" << me << " {\n        entry { set n = " << me << "; set sum = sum + n; }\n"
         << "        run {\n            set x = x * 0.5 + " << me << ".25;\n"
         << "            if (x > 100.0) then { set x = 0.0; set odd = !odd; }\n"
         << "            set sum = sum % 1000 + n * 2;\n        }\n"
         << "        exit { set sum = sum - n; set odd = sum > 10 && n < 50; }\n";
    if (number != script_states - 1)
        file << "        transition beat if n == " << me << " then { set sum = sum + 1; } select S"
             << number + 1 << "\n        transitions { if x > 1000.0 then { set x = 1.0; } select S"
             << (number * 7 + 1) % script_states << " }\n";
    file << "    }\n";
}

inline void write_script(std::ostream& file) {
    file << "#include \"kernel/machine/table/compiled.hpp\"\n"
            "#include \"kernel/script/compiled.hpp\"\n\nnamespace tappet {\n\n"
            "struct Large {\n    Event<> beat;\n    static constexpr auto interface() {\n"
            "        return facets(event<&Large::beat>(\"beat\", \"on\"));\n    }\n};\n"
            "inline constexpr ScriptSource large_source{\"large.osd\", R\"osd(StateMachine Large {\n"
            "    var int n = 0;\n    var int sum = 0;\n    var double x = 0.0;\n    var bool odd = false;\n";
    for (int number = 0; number < script_states; ++number) write_state(file, number);
    file << "}\nRootStateMachine Large large\n)osd\"};\n"
            "inline constexpr auto large_reach = script_reach(reachable<Large>(\"large\"));\n"
            "inline constexpr ScriptUnit large_script = compiled_script<large_source, large_reach>;\n"
            "static_assert(large_script.types[0].machine.states.size() == "
         << script_states
         << ");\nstatic_assert(large_script.types[0].tables.nodes.size() >= 1000);\n"
            "extern const BehaviourRow row;\n"
            "constexpr BehaviourRow row = behaviour(\"large\", compiled<large_script>);\n\n} // namespace "
            "tappet\n";
}

} // namespace tappet::diagnostics
