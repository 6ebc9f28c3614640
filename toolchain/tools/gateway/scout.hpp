// Finds the machines of one directory, and notices when they appear, end and start again.
#pragma once

#include "toolchain/tools/gateway/bounds.hpp"
#include "toolchain/tools/gateway/place.hpp"

#include <functional>
#include <map>
#include <string>

namespace tappet::network {

/// A machine as the scout sees it now.
struct Sighting {
    std::string name{}; ///< of its socket
    std::string socket{};
    std::shared_ptr<const Place> place{}; ///< null: it does not answer
    std::string reason{};                 ///< then
    bool gone = false;                    ///< its socket is no longer there
};

/// Looks once a round. A machine that does not answer is asked less and less often, so that it does not hold
/// up the others. One thread.
class Scout {
public:
    explicit Scout(std::string directory) : directory_{std::move(directory)} {}
    /// Returns what changed since the last round.
    [[nodiscard]] std::vector<Sighting> look(Clock::time_point now);

private:
    struct Known {
        std::optional<browser::Link> link{};
        std::shared_ptr<const Place> place{};
        std::string reason{};
        Clock::time_point next{};
        std::chrono::milliseconds pause{};
    };
    void ask(const std::string& socket, Known& known, Clock::time_point now, std::vector<Sighting>& changed);

    std::string directory_;
    std::map<std::string, Known> known_{}; ///< by socket
};

} // namespace tappet::network
