// The press with an interpreter under virtual time, and somebody who types lines.
#pragma once

#include "kernel/machine/accept.hpp"
#include "tests/kernel/services/browsing/press_rig.hpp"
#include "tests/kernel/services/interpreter/line_machine.hpp"

#include <gmock/gmock.h>

#include <memory>

namespace tappet::press {

class Lines : public testing::Test {
protected:
    std::string directory = testing::TempDir() + "tappet-lines-" + std::to_string(getpid());
    os::Clock clock{os::Clock::Kind::virtual_time};
    MachineInstance instance{AtRunTime<line_table, board>::machine(), clock};
    VirtualWorld world{instance};
    std::unique_ptr<Talker> talker;

    void SetUp() override {
        instance.browse_in(directory);
        const auto configured = instance.configure({});
        ASSERT_TRUE(configured) << configured.error().view();
        world.start();
        run(50ms);
        talker = std::make_unique<Talker>(path());
    }
    ~Lines() override {
        instance.find<BrowserService>("browser")->finalise();
        std::filesystem::remove_all(directory);
    }
    std::string path() const { return directory + "/press.socket"; }
    void run(Duration time) { static_cast<void>(world.run_until(clock.now() + time)); }
    std::string next(Talker& from, Duration time = 200ms) {
        std::string answer;
        for (const Time end = clock.now() + time; answer.empty() && clock.now() < end;) {
            run(10ms);
            answer = from.receive();
        }
        return answer;
    }
    std::string ask(Talker& who, std::string_view request) {
        EXPECT_TRUE(who.send(request));
        return next(who);
    }
    std::string ask(std::string_view request) { return ask(*talker, request); }
    /// How a line ended; the refusal of one that was not begun.
    std::string execute(std::string_view line) {
        std::string first = ask(request(line));
        return first.find(R"("state": "sent")") == std::string::npos ? first : next(*talker);
    }
    static std::string request(std::string_view line) {
        std::string words{"7 execute \""};
        for (const char character : line)
            words +=
                character == '"' || character == '\\' ? std::string{'\\', character} : std::string{character};
        return words + "\"";
    }
    Ram& ram() { return *instance.find<Ram>("ram"); }
    Gauge& gauge() { return *instance.find<Gauge>("gauge"); }
    Panel& panel(std::string_view name = "panel") { return *instance.find<Panel>(name); }
    CommandInterpreter& interpreter() { return *instance.find<CommandInterpreter>("interpreter"); }
};

} // namespace tappet::press
