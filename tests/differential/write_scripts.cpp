// Writes generated scripts into a header, where the C++ compiler compiles them: write_scripts FILE
#include "tests/differential/generator.hpp"

#include <array>
#include <fstream>
#include <iostream>

int main(int count, char** arguments) {
    using tappet::GeneratorOptions;
    if (count != 2) {
        std::cerr << "write_scripts: found " << count - 1
                  << " arguments, expected the header to be written\n";
        return 2;
    }
    constexpr std::array<GeneratorOptions, 4> kinds{{{.machine = false},
                                                     {.states = 3, .nested = false, .children = false},
                                                     {.states = 6, .children = false},
                                                     {.states = 3}}};
    constexpr std::size_t scripts = 8; // they compile for long
    std::ofstream header{arguments[1]};
    header << "// Generated scripts as constants.\n#pragma once\n\nnamespace tappet {\n\n";
    for (std::size_t i = 0; i < scripts; ++i)
        header << "inline constexpr ScriptSource source_" << i << "{\"m.osd\", R\"osd("
               << tappet::Generator{900 + i, kinds[i % kinds.size()]}.script() << ")osd\"};\n"
               << "inline constexpr const ScriptUnit& script_" << i << " = compiled_script<source_" << i
               << ", bench_reach>;\n";
    header << "\ninline constexpr Compiled all_scripts[] = {\n";
    for (std::size_t i = 0; i < scripts; ++i)
        header << "    {source_" << i << ".text, &compiled<script_" << i << ">},\n";
    header << "};\n\n} // namespace tappet\n";
    return header.good() ? 0 : 1;
}
