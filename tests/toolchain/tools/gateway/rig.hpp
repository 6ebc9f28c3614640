// A hub with a machine that the test controls, without a network.
#pragma once

#include "tests/toolchain/tools/browser/sample_machine.hpp"
#include "toolchain/tools/gateway/hub.hpp"
#include "toolchain/tools/gateway/peer.hpp"

#include <nlohmann/json.hpp>

namespace tappet::network {

/// A client whose queue the test bounds.
struct Client : Outlet {
    bool offer(std::string frame) override {
        if (!reads) return false;
        frames.push_back(std::move(frame));
        return true;
    }
    bool has_room() const override { return reads; }
    void send(std::string text) override { texts.push_back(nlohmann::json::parse(text)); }
    void end(std::string_view reason) override { ended = reason; }

    bool reads = true;
    std::vector<std::string> frames{};
    std::vector<nlohmann::json> texts{};
    std::string ended{};
};

/// The machine's end of a relay.
struct Line {
    OnPacket receive{};
    std::vector<std::string> sent{};
    bool full = false;
    bool open = false;
};

class Rig {
public:
    explicit Rig(Access access = Access{LoggedIn{"mary", Role::engineer}}, std::string log = {})
        : hub{std::move(access), std::move(log), outside()} {
        look();
    }
    /// Lets the scout look once.
    void look() { hub.see(scout.look(now)); }
    void tick(int ticks = 1) {
        for (int i = 0; i < ticks; ++i) hub.tick(now += bounds.tick);
    }
    std::shared_ptr<Peer> join(Outlet& client,
                               std::optional<LoggedIn> who = LoggedIn{"mary", Role::engineer}) {
        return std::make_shared<Peer>(hub, client, "10.0.0.1", std::move(who), std::string{}, now);
    }

    browser::SampleMachine machine{};
    Clock::time_point now = Clock::now();
    Scout scout{machine.directory()};
    Line line{};
    std::vector<std::function<void()>> checks{}; ///< passwords that wait to be checked
    Hub hub;

private:
    struct Wired : Relay {
        explicit Wired(Line& to) : line{to} { line.open = true; }
        ~Wired() override { line.open = false; }
        bool send(std::string_view packet) override {
            if (line.full) return false;
            line.sent.emplace_back(packet);
            return true;
        }
        Line& line;
    };
    Outside outside() {
        Outside made;
        made.connect = [this](const std::string&, OnPacket receive, std::string&) {
            line.receive = std::move(receive);
            return std::make_unique<Wired>(line);
        };
        made.in_background = [this](std::function<bool()> work, std::function<void(bool)> done) {
            checks.push_back([work = std::move(work), done = std::move(done)] { done(work()); });
            return true;
        };
        // On this thread: the test's runs print little.
        made.start = [](const std::function<void()>& work) { work(); };
        made.on_network = [](const std::function<void()>& what) { what(); };
        made.directory = machine.directory();
        return made;
    }
};

} // namespace tappet::network
