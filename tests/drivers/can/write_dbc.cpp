// Writes a header with DBC files of some seeds, their tables, and the rows of their node "us", for a test
// that compiles them.
#include "tests/drivers/can/dbc_generator.hpp"
#include "toolchain/tables/cpp_literal.hpp"
#include "toolchain/tables/dbc_tables.hpp"

#include <fstream>

int main(int count, char** words) {
    using namespace tappet;
    if (count != 2) return 2;
    std::ofstream out{words[1]};
    out << "#pragma once\n\n#include \"drivers/can/from_dbc.hpp\"\n\nnamespace tappet::generated {\n\n";
    for (const int seed : {1, 2, 3, 4, 5, 6}) {
        can::DbcGenerator generator{static_cast<std::uint64_t>(seed)};
        const std::string text = generator.file(), number = std::to_string(seed);
        const tables::OwnTable own{can::dbc::read("t.dbc", text)};
        out << "inline constexpr std::string_view text_" << number << " = " << tables::cpp_literal(text)
            << ";\n"
            << tables::to_cpp(own.table, "file_" + number) << "inline constexpr auto node_" << number
            << " = can::node(\"us\"";
        for (const std::string& each : generator.own)
            out << ",\n    can::transmit(\"" << each << "\").safe_by_silence()";
        out << ");\ninline constexpr auto map_" << number << " = can::from_dbc<file_" << number << ", node_"
            << number << ">;\n\n";
    }
    out << "} // namespace tappet::generated\n";
    return out.good() ? 0 : 1;
}
