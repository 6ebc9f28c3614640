// SPDX-License-Identifier: Apache-2.0
#include "board/box/stick.hpp"

#include "board/init/system.hpp"

#include <algorithm>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::box {

namespace {

/// Returns the first bytes of a disk; fewer when it has no more.
std::string read_head(const std::string& disk, std::uint64_t count) {
    std::string bytes(count, '\0');
    const int file = ::open(disk.c_str(), O_RDONLY | O_CLOEXEC);
    std::size_t have = 0;
    for (ssize_t n = 1; file >= 0 && n > 0 && have < bytes.size();
         have += static_cast<std::size_t>(std::max<ssize_t>(n, 0)))
        n = ::read(file, bytes.data() + have, bytes.size() - have);
    if (file >= 0) ::close(file);
    bytes.resize(have);
    return bytes;
}

} // namespace

std::optional<std::string> find_update() {
    for (const std::string& block : init::names_in("/sys/class/block"))
        if (::access(("/sys/class/block/" + block + "/partition").c_str(), F_OK) != 0 &&
            claimed_bytes(read_head("/dev/" + block, update_header_bytes)) != 0)
            return "/dev/" + block;
    return std::nullopt;
}

bool has_usb_storage() {
    const std::string folder = "/sys/bus/usb/devices/";
    return std::ranges::any_of(init::names_in(folder), [&](const std::string& device) {
        return init::read_line(folder + device + "/bInterfaceClass") == "08";
    });
}

std::expected<Update, std::string> read_update(const std::string& disk, const PublicKey& key) {
    const std::uint64_t claimed = claimed_bytes(read_head(disk, update_header_bytes));
    if (claimed > most_update_bytes) return std::unexpected("it is larger than a slot");
    return decode(read_head(disk, claimed), key);
}

} // namespace tappet::box
