// SPDX-License-Identifier: Apache-2.0
// The box's network service: reports the running version on request, and keeps a signed update or order until
// somebody consents at the machine. It reads data from strangers, so it is an unprivileged, sandboxed process
// with a folder of its own and a lower priority than everything of the machine.
#pragma once

#include "board/box/update.hpp"
#include "board/init/system.hpp"

#include <cstdint>
#include <expected>
#include <string>

namespace tappet::box {

/// The process's folder, in memory, so that it does not survive a power-off. It belongs to init, which writes
/// there what only init may write; accepted files are in the folder below, which belongs to `nobody`.
inline constexpr const char* service_folder = "/run/service";
inline constexpr const char* status_file = "status"; ///< init's text for status requests
inline constexpr const char* offers_folder = "offers";
inline constexpr const char* offered_update = "offers/update";
inline constexpr const char* offered_order = "offers/order"; ///< the verb and the signature, one line each

/// Called before the process is started for the first time.
[[nodiscard]] init::Done make_service_folder();

/// Port of boards that do not state another.
inline constexpr std::uint16_t service_port = 4848;

struct ServiceFacts {
    std::uint16_t port = 0;
    std::expected<PublicKey, std::string> key{};
    Manifest own{};
    std::string nonce{};
};

/// Returns a new random number for each start; empty without the kernel's, and then no order is valid.
[[nodiscard]] std::string new_nonce();

/// Runs the process in its folder, which must exist. Ends when it cannot listen.
[[noreturn]] void serve_network(const ServiceFacts& facts);

// The protocol, line by line, the client first:
//     status                      -> ok, then the box's text
//     update, then the file       -> ok or refused, then a sentence
//     order VERB SIGNATURE        -> ok or refused, then a sentence
// Before that the box sends "tappet-box 1 MACHINE BOARD NONCE"; afterwards it closes the connection.
// reception.hpp states the guarantees to each client.
inline constexpr std::string_view service_greeting = "tappet-box 1 ";

} // namespace tappet::box
