// A valid DBC file made awkward, as the field's files are, without another meaning for the node "us".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace tappet::can {

/// `text` is a file of DbcGenerator. The seed selects among the faults.
inline std::string awkward(std::string text, std::uint64_t seed) {
    const auto put = [&](std::string_view before, const std::string& more) {
        if (const std::size_t at = text.find(before); at != text.npos) text.insert(at, more);
    };
    const auto replace = [&](std::string_view old, std::string_view with) {
        if (const std::size_t at = text.find(old); at != text.npos) text.replace(at, old.size(), with);
    };
    const auto has = [seed](unsigned bit) { return (seed >> bit & 1u) != 0; };
    if (has(0)) replace("BU_: us them others\n", "BU_: us\n");
    if (has(1)) put("BO_ ", "// us sends BO_ 9 x: 8 us\n");
    if (has(2)) replace("BO_ 3221225472 ", "BO_ 1073741824 ");
    if (has(3))
        put("CM_ \"generated",
            "BO_ 1999 Long: 1785 them\n SG_ Text : 0|8000@1+ (1,0) [0|1E+481] \"\" others\n"
            " SG_ Over : 0|8@1+ (1,0) [0|0] \"\" them\n SG_ Under : 4|8@1+ (1,0) [0|0] \"\" them\n\n");
    if (has(4)) text += "VAL_ 1997 Text 0 \"off\" ;\n";
    if (has(5)) text += "FILTER 3 \"of a maker\";\n";
    return text;
}

/// The same with faults that other readers do not read past.
inline std::string more_awkward(std::string text, std::uint64_t seed) {
    text = awkward(std::move(text), seed);
    const std::size_t first = text.find("\nBO_ ");
    if (first != text.npos)
        text.insert(first + 1, seed % 2 == 0 ? "CM_ \"without its end\"\n" : "BA_DEF_ \"Maker\" STRING\n");
    text += "VAL_ 1998 x 5 \"five\";\n";
    if (seed % 3 == 0) text.insert(0, "\xEF\xBB\xBF");
    if (seed % 5 == 0) text += "CM_ \"the last one\";";
    return text;
}

} // namespace tappet::can
