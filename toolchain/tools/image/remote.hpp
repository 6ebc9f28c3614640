// SPDX-License-Identifier: Apache-2.0
// A box over the network: reads its status, sends it an update or an order. board/box/service.hpp is the
// other end.
#pragma once

#include "board/box/update.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace tappet::image {

struct Answer {
    bool is_accepted = false;
    std::string text{};
};

/// `box`: "192.168.8.1", or "192.168.8.1:4848". Throws a Fault on failure.
[[nodiscard]] Answer ask_status(const std::string& box);
/// Calls `done` with the progress.
[[nodiscard]] Answer send_update(const std::string& box, const std::filesystem::path& file,
                                 const std::function<void(std::uint64_t bytes, std::uint64_t of)>& done);
/// `verb`: one of box::order_verbs.
[[nodiscard]] Answer send_order(const std::string& box, const std::string& verb, const box::SecretKey& key);

} // namespace tappet::image
