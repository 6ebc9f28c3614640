// A browser's session with one machine: the connection, the machine's memory and the map in it.
#pragma once

#include "kernel/machine/map/black_box.hpp"
#include "toolchain/tools/browser/link.hpp"
#include "toolchain/tools/browser/map_reader.hpp"
#include "toolchain/tools/browser/observer.hpp"

namespace tappet::browser {

/// A user for whom a program asks who is not its own: see "as" in browsing/protocol.hpp.
struct User {
    std::string name{};
    std::string role{};             ///< "observer", "operator" or "engineer"
    std::string origin = "network"; ///< or "panel"
};

class Session {
public:
    /// Connects, identifies the machine, and maps the memory. `place`: the prefix of its names. `user`: for
    /// whom it asks; null: for this program's own user.
    static Result<std::unique_ptr<Session>> open(const std::string& socket,
                                                 std::chrono::milliseconds patience, std::string place = {},
                                                 const User* user = nullptr);
    /// Opens a machine's remains, in a file that its guardian kept.
    static Result<std::unique_ptr<Session>> open_black_box(const std::string& file);
    /// Returns the black box; null: the machine lives.
    [[nodiscard]] const map::black_box::Record* black_box() const { return black_box_.get(); }
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    [[nodiscard]] Link& link() { return link_; }
    [[nodiscard]] const MapReader& map() const { return map_; }
    [[nodiscard]] const Observer& observer() const { return observer_; }
    /// Returns this browser's role at the machine: "observer", "operator" or "engineer".
    [[nodiscard]] const std::string& role() const { return role_; }

private:
    Session(Link link, SharedBlock block, MapReader map, std::string role,
            std::unique_ptr<map::black_box::Record> black_box = {})
        : link_{std::move(link)},
          block_{std::move(block)},
          map_{std::move(map)},
          black_box_{std::move(black_box)},
          observer_{map_, black_box_ != nullptr},
          role_{std::move(role)} {}

    Link link_;
    SharedBlock block_;
    MapReader map_;
    std::unique_ptr<map::black_box::Record> black_box_;
    Observer observer_;
    std::string role_;
};

} // namespace tappet::browser
