// All that clients share: machines, access, the log and the counters. It knows no socket of the network.
#pragma once

#include "toolchain/tools/gateway/access.hpp"
#include "toolchain/tools/gateway/audit.hpp"
#include "toolchain/tools/gateway/metrics.hpp"
#include "toolchain/tools/gateway/relay.hpp"
#include "toolchain/tools/gateway/run.hpp"

#include <set>

namespace tappet::network {

class Peer;

/// The doors to the outside, which tests replace.
struct Outside {
    Connect connect{};
    /// Runs `work` on another thread, then `done` on the caller's; false: too many wait already.
    std::function<bool(std::function<bool()> work, std::function<void(bool)> done)> in_background{};
    /// Starts a run on a thread of its own.
    std::function<void(std::function<void()> work)> start{};
    /// Calls a function on the network's thread, from any.
    std::function<void(std::function<void()> what)> on_network{};
    std::string directory{};   ///< of machines' sockets, for runs
    std::string black_boxes{}; ///< folder of machines' black boxes, for runs; empty: none is shown
};

class Hub {
public:
    Hub(Access access, std::string log, Outside outside)
        : access_{std::move(access)}, audit_{std::move(log)}, outside_{std::move(outside)} {}

    [[nodiscard]] Access& access() { return access_; }
    [[nodiscard]] Audit& audit() { return audit_; }
    [[nodiscard]] Counters& counters() { return counters_; }
    [[nodiscard]] const Outside& outside() const { return outside_; }

    void see(const std::vector<Sighting>& sightings);
    /// Looks at the machines and lets each client send what is due: every bounds.tick.
    void tick(Clock::time_point now);
    /// Returns what to print: once a second.
    [[nodiscard]] std::string each_second(Clock::time_point now);

    [[nodiscard]] Station* find(std::string_view machine);
    /// Returns the machine that "saw.station.number" begins with; null: none.
    [[nodiscard]] Station* owner_of(std::string_view name);
    [[nodiscard]] std::vector<const Station*> stations() const;
    /// Returns the present values of the names that a line may change, as a JSON object; empty: there are
    /// none.
    /// No machine: names begin with theirs.
    [[nodiscard]] std::string values_of(std::string_view machine, std::string_view line);

    /// Starts a browser's command; `woken` is called on the network's thread when it has something to send.
    /// The error says why not.
    [[nodiscard]] std::expected<std::shared_ptr<Run>, std::string>
    run(const Message& message, const LoggedIn& who, std::function<void()> woken);

    using OnLogin = std::function<void(std::expected<Access::Admitted, std::string> outcome)>;
    /// Checks a password in the background.
    void login(const std::string& user, const std::string& password, const std::string& address,
               OnLogin done);

    void join(Peer& peer) { peers_.insert(&peer); }
    void leave(Peer& peer) { peers_.erase(&peer); }
    /// Ends what clients have under way, before threads are joined.
    void close();

private:
    Access access_;
    Audit audit_;
    Outside outside_;
    Counters counters_{};
    std::map<std::string, Station, std::less<>> stations_{};
    std::set<Peer*> peers_{};
    std::map<std::string, std::size_t> runs_{}; ///< under way, by user
};

} // namespace tappet::network
