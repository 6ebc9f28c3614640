// Every bound of the gateway in one table: what a client may take, and for how long.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace tappet::network {

using Clock = std::chrono::steady_clock;

struct Bounds {
    // connections
    std::size_t connections = 256;
    std::size_t connections_of_address = 32;
    std::size_t header_bytes = 8 * 1024;
    std::size_t body_bytes = 64 * 1024;
    std::size_t message_bytes = 64 * 1024;
    std::size_t message_depth = 4;
    std::size_t queue_bytes = 256 * 1024;
    int kernel_queue_bytes = 64 * 1024; ///< of a socket: more would only make frames older
    std::chrono::seconds handshake{10}; ///< TLS, header, body and answer, each
    std::chrono::seconds silence{20};   ///< of a WebSocket: a ping after half of it, dead after all of it
    std::chrono::seconds unknown{30};   ///< a WebSocket without a login
    // what a WebSocket may ask
    std::size_t watches = 16;
    std::size_t names = 256;            ///< of a watch
    std::chrono::milliseconds tick{50}; ///< the period of the fastest watch: 20 Hz
    std::size_t text_bytes = 1024;      ///< of a text value in a frame
    std::size_t requests_under_way = 32;
    std::chrono::seconds relay_idle{30};
    std::size_t relays_of_client = 2; ///< connections to machines, a descriptor each
    // runs of browser's commands
    std::size_t runs = 8;
    std::size_t runs_of_user = 2;
    std::size_t run_bytes = 64 * 1024; ///< of output that its client has not read
    unsigned screen_most = 500;        ///< lines or columns
    // pages
    std::size_t page_bytes = 1024 * 1024;
    std::size_t page_rows = 4000;
    // machines
    std::size_t machines = 32;
    std::chrono::milliseconds machine_patience{300};
    std::chrono::milliseconds machine_poll{250};
    // logging in
    std::size_t logins_at_once = 2;
    std::size_t logins_waiting = 16;
    std::size_t name_characters = 32;
    std::size_t password_least = 10;
    std::size_t password_most = 128;
    std::size_t sessions = 256;
    std::size_t sessions_of_user = 16;
    std::chrono::minutes session_idle{30};
    std::chrono::hours session_longest{12};
    unsigned failures = 5;
    std::size_t failures_kept = 1024;
    std::chrono::seconds lock_first{30};
    std::chrono::seconds lock_longest{15 * 60};
    // the log
    std::size_t log_line = 512;              ///< of a request; more is cut
    std::size_t log_bytes = 4 * 1024 * 1024; ///< of a file
    unsigned log_files = 8;                  ///< the present one and its predecessors
    // the process
    std::size_t descriptors = 1024;
    std::size_t memory_bytes = std::size_t{1} << 30; ///< of addresses, stacks and maps included
};

inline constexpr Bounds bounds{};

} // namespace tappet::network
