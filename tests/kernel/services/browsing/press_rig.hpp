// The press under virtual time, and a client that talks to it.
#pragma once

#include "kernel/machine/accept.hpp"
#include "kernel/services/configuration/property_files.hpp"
#include "tests/kernel/services/browsing/press_machine.hpp"

#include <gtest/gtest.h>

#include <filesystem>
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
    /// As somebody else, which only root can.
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

class Press : public testing::Test {
protected:
    std::string directory = testing::TempDir() + "tappet-browsing-" + std::to_string(getpid());
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<table, board>::machine(), clock};
    VirtualWorld world{instance};
    PropertyFiles files{directory};

    void SetUp() override {
        instance.browse_in(directory);
        instance.read_properties_from(files.store());
        const auto configured = instance.configure({});
        ASSERT_TRUE(configured) << configured.error().view();
        world.start();
        run(50ms);
    }
    ~Press() override {
        instance.find<BrowserService>("browser")->finalise();
        std::filesystem::remove_all(directory);
    }
    std::string path() const { return directory + "/press.socket"; }
    void run(Duration time) { static_cast<void>(world.run_until(clock.now() + time)); }
    /// What comes first after a request, within the time of a few cycles.
    std::string ask(Talker& talker, std::string_view request, Duration time = 100ms) {
        EXPECT_TRUE(talker.send(request));
        std::string answer;
        const Time end = clock.now() + time;
        while (answer.empty() && clock.now() < end) {
            run(10ms);
            answer = talker.receive();
        }
        return answer;
    }
    Ram& ram() { return *instance.find<Ram>("ram"); }
    static bool has(const std::string& text, std::string_view part) {
        return text.find(part) != std::string::npos;
    }
};

} // namespace tappet::press
