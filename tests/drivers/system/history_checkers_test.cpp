// A right history passes every checker; a planted fault is found by its own checker, and by no other.
#include "tests/drivers/system/history.hpp"

#include <gtest/gtest.h>

namespace tappet::history {
namespace {

constexpr std::size_t one = 0, two = 1, taker = 2;

Time at(std::int64_t ms) { return Time{} + ms * 1ms; }

/// Two senders, for a fifth of a second: an event of the second one is lost; its 1000 failed there but was
/// executed; 15 was refused, and 3 did not leave its node.
History right_one() {
    History history;
    history.times = {.event = 30ms, .command = 30ms, .reader = 5ms, .drift = 0ms};
    history.receiver = taker;
    history.lives = {{{at(0)}}, {{at(0)}}, {{at(0)}}};
    history.emitted = {{one, 1, at(10)}, {two, 2, at(12)}, {one, 3, at(60)}, {two, 4, at(65)}};
    history.served = {{1, at(15)}, {2, at(15)}, {3, at(65)}};
    history.told = {{two, at(96)}};
    history.asked = {{one, 100, at(10), at(25), CommandState::done, 100},
                     {two, 20, at(12), at(40), CommandState::done, 120},
                     {one, 3, at(60), at(65), CommandState::rejected},
                     {one, 15, at(80), at(90), CommandState::failed},
                     {two, 1000, at(100), at(130), CommandState::failed},
                     {one, 7, at(140), at(150), CommandState::done, 1127}};
    history.begun = {{100, at(15)}, {20, at(15)}, {15, at(85), true}, {1000, at(110)}, {7, at(145)}};
    history.executed = {{100, 100, at(20)}, {20, 120, at(30)}, {1000, 1120, at(115)}, {7, 1127, at(145)}};
    history.channels = {{.name = "events of one",
                         .sender = one,
                         .receiver = taker,
                         .has_services = true,
                         .sent = {.offered = 2, .delivered = 2},
                         .received = {.served = 2}},
                        {.name = "events of two",
                         .sender = two,
                         .receiver = taker,
                         .has_services = true,
                         .sent = {.offered = 2, .delivered = 1, .lost = 1},
                         .received = {.served = 1, .lost = 1}}};
    return history;
}
Asked& asked(History& history, Number number) {
    return *std::ranges::find(history.asked, number, &Asked::number);
}
Executed& executed(History& history, Number number) {
    return *std::ranges::find(history.executed, number, &Executed::number);
}
/// The receiver's note and the sender's result agree, and both are wrong.
void answer(History& history, Number number, Number result) {
    asked(history, number).result = executed(history, number).result = result;
}

/// The names of the checkers that find a fault, one after the other.
std::string found_by(const History& history) {
    std::string names;
    for (const Checker& each : checkers)
        if (!each.check(history).empty()) names += (names.empty() ? "" : " ") + std::string{each.name};
    return names;
}
/// Plants a change in the right history; returns the checkers that find it.
template <class Plant>
std::string found_in(Plant plant) {
    History history = right_one();
    plant(history);
    return found_by(history);
}

TEST(HistoryCheckers, accept_a_right_history) {
    EXPECT_EQ(faults_of(right_one()), std::vector<std::string>{});
}

TEST(HistoryCheckers, find_duplicates) {
    EXPECT_EQ(found_in([](History& h) { h.served.push_back({3, at(66)}); }), "never_twice");
    EXPECT_EQ(found_in([](History& h) { h.begun.push_back({7, at(146)}); }), "never_twice");
    EXPECT_EQ(found_in([](History& h) { h.executed.push_back({7, 1134, at(149)}); }), "never_twice");
}

TEST(HistoryCheckers, find_deliveries_from_nowhere) {
    EXPECT_EQ(found_in([](History& h) { h.served.push_back({9, at(66)}); }), "nothing_from_nowhere");
    EXPECT_EQ(found_in([](History& h) { h.served[0].at = at(9); }), "nothing_from_nowhere");
    EXPECT_EQ(found_in([](History& h) { h.begun.push_back({9, at(146)}); }), "nothing_from_nowhere");
    EXPECT_EQ(found_in([](History& h) { h.begun[0].at = at(21); }), "nothing_from_nowhere") << "too late";
}

TEST(HistoryCheckers, find_reordered_deliveries) {
    EXPECT_EQ(found_in([](History& h) { std::swap(h.served[0], h.served[2]); }), "in_order");
    EXPECT_EQ(found_in([](History& h) { std::swap(h.begun[0], h.begun[4]); }), "in_order");
    EXPECT_EQ(found_in([](History& h) { std::swap(h.served[0], h.served[1]); }), "")
        << "of two senders there is none";
}

TEST(HistoryCheckers, find_losses_not_reported_in_time) {
    EXPECT_EQ(found_in([](History& h) { h.told.clear(); }), "losses_are_told");
    EXPECT_EQ(found_in([](History& h) { h.told[0].at = at(101); }), "losses_are_told");
    EXPECT_EQ(found_in([](History& h) { h.told[0].at = at(64); }), "losses_are_told");
    EXPECT_EQ(found_in([](History& h) { h.told[0].sender = one; }), "losses_are_told");
}

TEST(HistoryCheckers, find_counts_that_differ) {
    EXPECT_EQ(found_in([](History& h) { h.channels[1].received.lost = 0; }), "counts_agree");
    EXPECT_EQ(found_in([](History& h) { ++h.channels[0].received.served; }), "counts_agree");
    EXPECT_EQ(found_in([](History& h) { ++h.channels[0].sent.offered; }), "counts_agree");
    EXPECT_EQ(found_in([](History& h) { ++h.channels[0].sent.offered, ++h.channels[0].sent.unknown; }),
              "counts_agree")
        << "no start ended";
    EXPECT_EQ(found_in([](History& h) { ++h.channels[0].waiting; }), "counts_agree");
    EXPECT_EQ(found_in([](History& h) {
                  h.channels[0].sent = {.offered = 3, .delivered = 3};
                  h.channels[0].received.served = 3;
              }),
              "counts_agree")
        << "both ends say three, and the component served two";
}

TEST(HistoryCheckers, find_late_deliveries) {
    EXPECT_EQ(found_in([](History& h) { h.served[2].at = at(91); }), "in_time");
    EXPECT_EQ(found_in([](History& h) { h.begun[3].at = executed(h, 1000).at = at(131); }), "in_time");
    EXPECT_EQ(found_in([](History& h) { asked(h, 7).responded = at(206); }), "in_time");
    EXPECT_EQ(found_in([](History& h) { asked(h, 15).responded = never; }), "in_time");
}

TEST(HistoryCheckers, find_false_outcomes) {
    EXPECT_EQ(found_in([](History& h) { executed(h, 7).result = 127; }), "ends_are_true");
    EXPECT_EQ(found_in([](History& h) { h.executed.pop_back(); }), "ends_are_true") << "done, not executed";
    EXPECT_EQ(found_in([](History& h) { executed(h, 20).at = at(41); }), "ends_are_true") << "after its end";
    EXPECT_EQ(found_in([](History& h) { h.begun.insert(h.begun.begin() + 2, {3, at(62)}); }), "ends_are_true")
        << "rejected, and taken up";
    EXPECT_EQ(found_in([](History& h) { h.executed.push_back({15, 135, at(86)}); }), "ends_are_true")
        << "refused, and executed";
}

TEST(HistoryCheckers, find_answers_that_no_order_explains) {
    EXPECT_EQ(found_in([](History& h) { answer(h, 20, 20); }), "linearizable") << "a lost update";
    EXPECT_EQ(found_in([](History& h) { answer(h, 7, 1120); }), "linearizable") << "a stale answer";
    EXPECT_EQ(found_in([](History& h) { answer(h, 7, 2127); }), "linearizable") << "1000 twice";
    EXPECT_EQ(found_in([](History& h) { answer(h, 7, 1142); }), "linearizable") << "a refused one is in it";
    EXPECT_EQ(found_in([](History& h) { answer(h, 7, 1130); }), "linearizable") << "a rejected one is in it";
    EXPECT_EQ(found_in([](History& h) { answer(h, 7, 127); }), "")
        << "of a command that failed nobody knows whether it happened";
}

TEST(HistoryCheckers, find_state_kept_across_a_restart) {
    const auto begin_anew = [](History& h) { h.lives[taker] = {{at(0), at(133)}, {at(135), never}}; };
    EXPECT_EQ(found_in([&](History& h) { begin_anew(h); }), "linearizable") << "the old sum";
    EXPECT_EQ(found_in([&](History& h) { begin_anew(h), answer(h, 7, 1007); }), "linearizable")
        << "a command of before";
    EXPECT_EQ(found_in([&](History& h) { begin_anew(h), answer(h, 7, 7); }), "");
    EXPECT_EQ(found_in([&](History& h) {
                  h.lives[taker] = {{at(0), at(133)}, {at(141), never}};
                  answer(h, 7, 7);
              }),
              "linearizable")
        << "nobody lived when it was sent";
}

} // namespace
} // namespace tappet::history
