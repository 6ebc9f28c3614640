// Writes a header with DBC files of some seeds and the rows of their node "us", for a test that compiles
// them.
#include "tests/drivers/can/dbc_generator.hpp"

#include <cstdio>
#include <fstream>

int main(int count, char** words) {
    if (count != 2) return 2;
    std::ofstream out{words[1]};
    out << "#pragma once\n\n#include \"drivers/can/from_dbc.hpp\"\n\nnamespace tappet::generated {\n\n";
    for (const int seed : {1, 2, 3, 4, 5, 6}) {
        tappet::can::DbcGenerator generator{static_cast<std::uint64_t>(seed)};
        out << "inline constexpr char text_" << seed << "[] =";
        bool is_open = false;
        for (const char character : generator.file()) {
            if (!is_open) out << "\n    \"";
            is_open = character != '\n';
            char escaped[8] = {};
            std::snprintf(escaped, sizeof escaped, "\\%03o",
                          static_cast<unsigned>(static_cast<unsigned char>(character)));
            const bool is_plain =
                character >= ' ' && character < 127 && character != '"' && character != '\\';
            out << (is_plain ? std::string(1, character) : escaped) << (is_open ? "" : "\"");
        }
        out << ";\ninline constexpr tappet::SourceText file_" << seed << "{\"t.dbc\", {text_" << seed
            << ", sizeof text_" << seed << " - 1}};\ninline constexpr auto node_" << seed
            << " = tappet::can::node(\"us\"";
        for (const std::string& own : generator.own)
            out << ",\n    tappet::can::transmit(\"" << own << "\").safe_by_silence()";
        out << ");\ninline constexpr auto map_" << seed << " = tappet::can::from_dbc<file_" << seed
            << ", node_" << seed << ">;\n\n";
    }
    out << "} // namespace tappet::generated\n";
    return out.good() ? 0 : 1;
}
