// tappet-tables FILE HEADER PLACE NAME: reads a DBC, EDS or DCF file, and writes the header with its tables,
// of which tappet::files::NAME is the constant. Sentences call the file PLACE. A fault of the file is a part
// of the tables: the compiler tells it to whoever takes the faulty part.
#include "toolchain/tables/dbc_tables.hpp"
#include "toolchain/tables/eds_tables.hpp"

#include <fstream>
#include <iostream>
#include <iterator>

namespace {

using namespace tappet::tables;
namespace can = tappet::can;
namespace canopen = tappet::canopen;

int fail(const std::string& sentence) {
    std::cerr << "tappet-tables: " << sentence << "\n";
    return 1;
}

std::string header_of(const std::string& place, const std::string& text, const std::string& name) {
    const bool is_dbc = place.ends_with(".dbc") || place.ends_with(".DBC");
    const std::string tables = is_dbc ? to_cpp(OwnTable{can::dbc::read(place, text)}.table, name)
                                      : to_cpp(canopen::detail::EdsReader{{place, text}}, name);
    return "// The tables of " + place +
           "; made when it changed.\n#pragma once\n#pragma GCC system_header // a literal may be of any "
           "length here\n\n"
           "#include \"" +
           std::string{is_dbc ? "drivers/can/dbc/table.hpp" : "drivers/canopen/eds.hpp"} +
           "\"\n\nnamespace tappet::files {\n\n" + tables + "\n} // namespace tappet::files\n";
}

std::string contents_of(const std::string& path) {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

} // namespace

int main(int count, char** words) {
    if (count != 5) return fail("usage: tappet-tables FILE HEADER PLACE NAME");
    const std::string path = words[1], to = words[2], place = words[3];
    std::ifstream file{path, std::ios::binary};
    const std::string text{std::istreambuf_iterator<char>{file}, {}};
    if (!file) return fail("\"" + path + "\" cannot be read");
    if (text.contains('\0')) return fail("\"" + place + "\" is no text: a byte of it is zero; take that out");
    const std::string header = header_of(place, text, words[4]);
    if (contents_of(to) == header) return 0; // whoever includes it is not compiled again
    std::ofstream out{to, std::ios::binary};
    out << header;
    out.close();
    return out ? 0 : fail("\"" + to + "\" cannot be written");
}
