// Writes the objects of an EDS or DCF file and the notes on its faults as rows of arrays.
#include "toolchain/tables/eds_tables.hpp"

#include "toolchain/tables/cpp_literal.hpp"

namespace tappet::tables {

using namespace canopen;

namespace {

/// A text with its length, which the compiler does not count then.
std::string view_of(std::string_view text) {
    return text.empty() ? "{}" : "{" + cpp_literal(text) + "," + std::to_string(text.size()) + "}";
}
template <class... Numbers> std::string list_of(const Numbers&... numbers) {
    std::string list;
    ((list += (list.empty() ? "{" : ",") + std::to_string(numbers)), ...);
    return list + "}";
}
std::string address_of(Address at) { return list_of(at.index, at.sub); }
std::string number_of(const Number& number) {
    return number.given ? "{" + std::to_string(number.bits) + "u," + std::to_string(number.given) + "," +
                              std::to_string(number.plus_node) + "}"
                        : "{}";
}
template <class Enum> std::string enum_of(std::string_view type, Enum value) {
    return "canopen::" + std::string{type} + list_of(static_cast<unsigned>(value));
}

std::string row_of(const Object& each) {
    return "{" + address_of(each.at) + "," + enum_of("DataType", each.type) + "," +
           enum_of("Access", each.access) + "," + std::to_string(each.mappable) + "," +
           std::to_string(each.is_parameter) + "," + std::to_string(each.flaws) + "," +
           number_of(each.value) + "," + number_of(each.low) + "," + number_of(each.high) + "," +
           view_of(each.name) + "," + view_of(each.text) + "," + std::to_string(each.line) + "}";
}
std::string row_of(const FileNote& each) {
    return "{" + enum_of("FileNote::Kind", each.kind) + "," + std::to_string(each.flaws) + "," +
           address_of(each.at) + "," + std::to_string(each.line) + "," + std::to_string(each.other) + "," +
           view_of(each.key) + "," + view_of(each.text) + "}";
}
template <class Row>
std::string array_of(std::string_view type, const std::string& name, const std::vector<Row>& rows) {
    std::string text = "inline constexpr std::array<canopen::" + std::string{type} + ", " +
                       std::to_string(rows.size()) + "> " + name + "{{\n";
    for (const Row& each : rows) text += "    " + row_of(each) + ",\n";
    return text + "}};\n";
}

} // namespace

std::string to_cpp(const canopen::detail::EdsReader& read, std::string_view name) {
    const std::string own{name};
    const Dictionary all = read.dictionary();
    const Identity& identity = all.identity;
    const bool is_refused = !read.fault.empty();
    return array_of("Object", own + "_objects", is_refused ? std::vector<Object>{} : read.objects) +
           array_of("FileNote", own + "_notes", is_refused ? std::vector<FileNote>{} : read.notes) +
           "inline constexpr canopen::EdsFile " + own + "{" + cpp_literal(read.fault.view()) + ",\n    {" +
           cpp_literal(all.file) + ", " + cpp_literal(all.product) + ", " + std::to_string(all.node) + ", " +
           list_of(identity.device_type, identity.vendor, identity.product, identity.revision) + ", " +
           std::to_string(all.doubted) + ", " + own + "_objects, " + own + "_notes}};\n";
}

} // namespace tappet::tables
