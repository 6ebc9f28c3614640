// Machines in virtual time that are browsed, above all the press, and a client that talks to them.
#pragma once

#include "kernel/services/configuration/property_files.hpp"
#include "tests/kernel/machine/virtual_rig.hpp"
#include "tests/kernel/services/browsing/press_machine.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace tappet::press {

/// One client.
class Talker {
public:
    explicit Talker(const std::string& path) : connection_{os::LocalConnection::connect(path.c_str())} {
        EXPECT_TRUE(connection_) << "cannot connect";
    }
    /// As another user, which only root can do.
    Talker(const std::string& path, uid_t user) : connection_{connect_as(user, path)} {
        EXPECT_TRUE(connection_) << "cannot connect";
    }
    bool send(std::string_view request) {
        return connection_->send(request) == os::LocalConnection::Sent::sent;
    }
    /// The next packet; empty when none waits.
    std::string receive(int* descriptor = nullptr) {
        std::string room(browsing::max_packet_bytes + 1, '\0');
        const auto received =
            connection_->receive(room, descriptor != nullptr ? os::Passed::one : os::Passed::none);
        if (received.what != os::LocalConnection::Received::What::packet) return {};
        if (descriptor != nullptr) *descriptor = received.passed;
        room.resize(received.bytes);
        return room;
    }
    /// All waiting packets.
    std::string receive_all() {
        std::string all;
        for (std::string each = receive(); !each.empty(); each = receive()) all += each;
        return all;
    }
    void close() { connection_->close(); }
    [[nodiscard]] bool gone() {
        char byte = 0;
        return connection_->receive({&byte, 1}).what == os::LocalConnection::Received::What::closed;
    }

private:
    using Connected = std::expected<os::LocalConnection, Sentence>;
    static Connected connect_as(uid_t user, const std::string& path) {
        EXPECT_EQ(::seteuid(user), 0);
        Connected made = os::LocalConnection::connect(path.c_str());
        EXPECT_EQ(::seteuid(0), 0);
        return made;
    }

    Connected connection_;
};

/// A machine with a browser.
template <const auto& of_table> class Browsed : public testing::Test, protected PlacedRig<of_table, board> {
protected:
    std::string directory = testing::TempDir() + "tappet-browsed-" + std::to_string(getpid());
    PropertyFiles files{directory};

    void SetUp() override {
        std::filesystem::create_directories(directory);
        this->instance.browse_in(directory);
        this->instance.read_properties_from(files.store());
        const auto configured = this->instance.configure({});
        ASSERT_TRUE(configured) << configured.error().view();
        this->world.start();
        this->run(50ms);
    }
    ~Browsed() override {
        this->template the<BrowserService>("browser").finalise();
        std::filesystem::remove_all(directory);
    }
    std::string path() const { return directory + "/" + std::string{of_table.view().name} + ".socket"; }
    /// The client of requests for which a test names none; connected on first use.
    Talker& talker() {
        if (!talker_) talker_.emplace(path());
        return *talker_;
    }
    /// The first packet within the time.
    std::string next(Talker& to, Duration time = 200ms) {
        std::string answer;
        for (const Time end = this->clock.now() + time; answer.empty() && this->clock.now() < end;) {
            this->run(10ms);
            answer = to.receive();
        }
        return answer;
    }
    std::string ask(Talker& who, std::string_view request, Duration time = 100ms) {
        EXPECT_TRUE(who.send(request));
        return next(who, time);
    }
    std::string ask(std::string_view request, Duration time = 100ms) { return ask(talker(), request, time); }
    /// Simulates a thread that never returns; start() starts it again.
    Engine& hang(std::size_t activity) {
        Engine& engine = this->instance.engines()[activity];
        engine.stop(this->clock.now());
        engine.plan().parts[0].state.store(ComponentState::running);
        return engine;
    }
    static testing::AssertionResult has(const std::string& text, std::string_view part) {
        if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
        return testing::AssertionFailure() << part << " is not in: " << text;
    }

private:
    std::optional<Talker> talker_;
};

class Press : public Browsed<table> {
protected:
    Ram& ram() { return the<Ram>("ram"); }
};

} // namespace tappet::press
