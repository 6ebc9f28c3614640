// Methods and commands that may block (thesis 4.5.2): the activities that run them and call them.
#include "tests/kernel/machine/virtual_rig.hpp"

#include <vector>

#include <unistd.h>

namespace tappet {
namespace {

/// Waits for a slow medium.
struct Archive {
    std::vector<int> stored{};
    bool store(int what, int& copies) noexcept {
        ::usleep(1);
        stored.push_back(what);
        copies = what * 2;
        return what >= 0;
    }
    int count(int times) noexcept {
        ::usleep(1);
        return times * static_cast<int>(stored.size());
    }
    static constexpr auto interface() {
        return facets(command<&Archive::store>("store", "is written", may_block),
                      method<&Archive::count>("count", "of what was written", may_block, any_thread));
    }
};

struct Clerk {
    MethodCall<int(int)> count;
    int counted = -1;
    void work(const Cycle&) { counted = count(10).value_or(0); }
    static constexpr auto interface() { return facets(calls<&Clerk::count>("count", "of the archive")); }
};
struct Foreman {
    CommandCall<int, int&> store;
    static constexpr auto interface() { return facets(sends<&Foreman::store>("store", "in the archive")); }
};

// clang-format off
constexpr auto table = machine("blocking",
    components(component<Foreman>("foreman"), component<Archive>("archive"), component<Clerk>("clerk")),
    activities(
        activity("motion",  every(1ms), budget(50us), runs("foreman")),
        activity("archive", on_work(), not_real_time, runs("archive")),
        activity("clerks",  every(50ms), not_real_time, runs("clerk"))),
    connections(),
    reactions(uses("foreman.store", "archive.store"), uses("clerk.count", "archive.count")),
    behaviours());
// clang-format on

struct BlockingOperation : testing::Test, RunningRig<table> {};

TEST_F(BlockingOperation, runs_in_an_activity_without_deadline_for_senders_with_one) {
    auto& store = the<Foreman>("foreman").store;
    EXPECT_TRUE(store.send(21));
    pass(20ms);
    EXPECT_EQ(store.state(), CommandState::done);
    EXPECT_EQ(store.result(), 42);
    EXPECT_EQ(the<Archive>("archive").stored, std::vector{21});
    store.reset();
    EXPECT_TRUE(store.send(-1));
    pass(20ms);
    EXPECT_EQ(store.state(), CommandState::rejected);
}

TEST_F(BlockingOperation, can_be_called_by_a_peer_in_an_activity_without_deadline) {
    EXPECT_TRUE(the<Foreman>("foreman").store.send(1));
    pass(200ms);
    EXPECT_EQ(the<Clerk>("clerk").counted, 10);
}

} // namespace
} // namespace tappet
