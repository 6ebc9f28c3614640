// The machines that a line may be about: one, or several by their names, as the nodes of a system are. A path
// is then "node.component.facet", as the system's table spells it.
#pragma once

#include "toolchain/tools/browser/options.hpp"
#include "toolchain/tools/browser/session.hpp"

namespace tappet::browser {

struct Machine {
    std::string name{}; ///< of its socket, or as it was given
    std::string socket{};
    std::unique_ptr<Session> session{}; ///< null: nobody has asked it yet, or it does not answer
};

class Machines {
public:
    /// At the sockets that the line names; otherwise all that have one in its directory. Of the only one the
    /// session is open. Several are asked when a line is about them, so that one which does not answer
    /// hinders no other.
    static Result<Machines> find(const Line& line);
    static Machines of(std::unique_ptr<Session> session);

    [[nodiscard]] bool are_several() const { return all_.size() > 1; }
    [[nodiscard]] std::vector<Machine>& all() { return all_; }
    /// The one that a name of the form "saw" or "saw.station.number" begins with; null: none does.
    [[nodiscard]] Machine* named(std::string_view word);
    /// Its session; one that has ended meanwhile is asked anew. The failure says which machine it is.
    Result<Session*> reach(Machine& machine);
    /// Those that answer now.
    std::vector<Session*> reachable();
    /// "conveyor, drill, saw".
    [[nodiscard]] std::string names() const;
    /// Where they were looked for: "in '/run/tappet'", or "among those given".
    [[nodiscard]] const std::string& place() const { return place_; }

private:
    std::vector<Machine> all_{};
    std::string place_{};
    std::chrono::milliseconds patience_{};
};

} // namespace tappet::browser
