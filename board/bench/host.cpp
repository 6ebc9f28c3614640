// SPDX-License-Identifier: Apache-2.0
// Reports to the host, and stops on errors.
#include "board/bench/host.hpp"

#include <cerrno>
#include <cstdio>

#include <fcntl.h>
#include <unistd.h>

namespace tappet::bench {

Results results;

void Results::write_all(std::string_view bytes) {
    while (descriptor_ >= 0 && !bytes.empty()) {
        const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
}

void give_up(const std::string& reason) {
    std::fprintf(stderr, "bench init: %s\n", reason.c_str());
    results.line("fault " + reason);
    init::power_off();
}

void must(const init::Done& done) {
    if (!done) give_up(done.error());
}

int open_port(const std::string& wanted) {
    const std::string folder = "/sys/class/virtio-ports";
    for (int attempt = 0; attempt < 500; ++attempt) {
        for (const std::string& port : init::names_in(folder)) {
            if (init::read_line(folder + "/" + port + "/name") == wanted) {
                const int descriptor = ::open(("/dev/" + port).c_str(), O_RDWR | O_CLOEXEC);
                if (descriptor >= 0) return descriptor;
            }
        }
        init::pause_for(std::chrono::milliseconds(10));
    }
    give_up("there is no port " + wanted + " to the host");
}

} // namespace tappet::bench
