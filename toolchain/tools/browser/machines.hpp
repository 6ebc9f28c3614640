// The machines that a line may address: one, or several by name, such as the nodes of a system. A path is
// then "node.component.facet", as the system's table spells it.
#pragma once

#include "toolchain/tools/browser/options.hpp"
#include "toolchain/tools/browser/session.hpp"

namespace tappet::browser {

struct Machine {
    std::string name{}; ///< of its socket, or as given
    std::string socket{};
    std::unique_ptr<Session> session{}; ///< null: not asked yet, or it does not answer
};

class Machines {
public:
    /// Finds the machines at the sockets that the line names; otherwise all with a socket in its directory.
    /// Opens the session of a single machine at once. Several machines are asked only when a line addresses
    /// them, so that one without an answer does not block the others.
    /// `user`: for whom their sessions ask, if not for this program's own user.
    static Result<Machines> find(const Line& line, std::optional<User> user = {});
    static Machines of(std::unique_ptr<Session> session);

    [[nodiscard]] bool are_several() const { return all_.size() > 1; }
    [[nodiscard]] std::vector<Machine>& all() { return all_; }
    /// Returns the machine that a name such as "saw" or "saw.station.number" begins with; null: none.
    [[nodiscard]] Machine* named(std::string_view word);
    /// Returns its session; reconnects when the machine has ended meanwhile. The failure names the machine.
    Result<Session*> reach(Machine& machine);
    /// Returns the machines that answer now.
    std::vector<Session*> reachable();
    /// "conveyor, drill, saw".
    [[nodiscard]] std::string names() const;
    /// Returns where they were searched: "in '/run/tappet'", or "among those given".
    [[nodiscard]] const std::string& place() const { return place_; }

private:
    [[nodiscard]] const User* user() const { return user_ ? &*user_ : nullptr; }

    std::vector<Machine> all_{};
    std::string place_{};
    std::chrono::milliseconds patience_{};
    std::optional<User> user_{};
};

} // namespace tappet::browser
