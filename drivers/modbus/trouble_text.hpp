// Messages about a server whose values do not arrive: the row of the map, what happened, and the cure.
#pragma once

#include "drivers/modbus/session.hpp"

namespace tappet::modbus {

/// Exception codes of the Modbus application protocol 1.1b3, section 7.
constexpr std::string_view exception_text(std::uint8_t code) noexcept {
    switch (code) {
    case 1: return "illegal function";
    case 2: return "illegal data address";
    case 3: return "illegal data value";
    case 4: return "device failure";
    case 5: return "acknowledged, but not done yet";
    case 6: return "device busy";
    case 8: return "memory parity error";
    case 10: return "gateway path unavailable";
    case 11: return "gateway target does not answer";
    default: return "a code of the device's own";
    }
}

/// Returns the text of a trouble whose outcome is not ok.
inline Sentence to_text(std::string_view row, const Trouble& trouble) noexcept {
    Sentence text{"row \"", row, "\": "};
    switch (trouble.outcome) {
    case Outcome::ok: break;
    case Outcome::exception:
        return text.add("the server refuses it, exception ")
            .add(unsigned{trouble.exception})
            .add(" (")
            .add(exception_text(trouble.exception))
            .add("); correct the map, or the server");
    case Outcome::timeout:
        return text.add("no answer in time; look at the server's supply, its unit and the line's setting");
    case Outcome::garbled:
        return text.add(
            "the reply does not match the request; look at the line's setting, its cable and its ends");
    case Outcome::refused: return text.add("no connection; look at the server's address, supply and cable");
    case Outcome::disconnected: return text.add("the connection broke; look at the server and its cable");
    }
    return text;
}

} // namespace tappet::modbus
