// A machine's memory as the gateway maps it, and what the machine said of itself.
#pragma once

#include "toolchain/tools/browser/link.hpp"
#include "toolchain/tools/browser/map_reader.hpp"

#include <memory>
#include <string>

namespace tappet::network {

/// One life of a machine: from when it was found until it ends. Reading it needs no thread of its own.
struct Place {
    Place(browser::SharedBlock mapped, browser::MapReader reader)
        : block{std::move(mapped)}, map{std::move(reader)} {}
    browser::SharedBlock block;
    browser::MapReader map;
    std::string board{}, world{}, build_id{}, framework{};
};

/// Opens a machine: `as`, hello, map. `place`: the prefix of its names, "saw.". The connection stays open, so
/// that its end tells the machine's.
[[nodiscard]] browser::Result<std::pair<browser::Link, std::shared_ptr<const Place>>>
open_place(const std::string& socket, std::string place);

} // namespace tappet::network
