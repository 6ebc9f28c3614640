// An address on a network, as bindings and boards write it: "192.168.7.2:502".
#pragma once

#include <string_view>

namespace tappet {

/// Returns the port of "192.168.7.2:502": numeric IPv4, in its only accepted spelling; 0: it is spelled
/// otherwise.
constexpr int port_of(std::string_view address) noexcept {
    int parts = 0, number = -1;
    for (const char character : address) {
        if (character >= '0' && character <= '9') {
            if (number == 0) return 0; // one address with two spellings would be two devices
            number = (number < 0 ? 0 : number) * 10 + (character - '0');
            if (number > (parts < 4 ? 255 : 65535)) return 0;
        } else if (number >= 0 && character == (parts < 3 ? '.' : ':')) {
            ++parts;
            number = -1;
        } else {
            return 0;
        }
    }
    return parts == 4 && number > 0 ? number : 0;
}

/// Returns "192.168.7.2" of "192.168.7.2:502".
constexpr std::string_view host_of(std::string_view address) noexcept {
    return address.substr(0, address.find(':'));
}

} // namespace tappet
