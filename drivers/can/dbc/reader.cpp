// Reads a DBC file.
#include "drivers/can/dbc/reader.hpp"

namespace tappet::can::dbc {

Network read(std::string_view file, std::string_view text) {
    Network network{.file = file, .text = text};
    Reader{network}.read();
    return network;
}

} // namespace tappet::can::dbc
