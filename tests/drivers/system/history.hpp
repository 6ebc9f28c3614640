// Everything emitted, sent, served and executed in one run of a system whose senders share one receiver, with
// its true time; and the rules that hold whatever goes wrong in between.
#pragma once

#include "kernel/component/command.hpp"
#include "kernel/system/channel.hpp"
#include "tests/drivers/system/linearizable.hpp"

#include <array>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tappet::history {

using Number = std::int32_t; ///< identifies an event or a command, uniquely in a history

/// One start of a node.
struct Life {
    Time begins{};
    Time ends = never;
};
struct Emission {
    std::size_t sender = 0;
    Number number = 0;
    Time at{};
};
/// The sender learned that one of its events was lost.
struct Loss {
    std::size_t sender = 0;
    Time at{};
};
struct Served {
    Number number = 0;
    Time at{};
};
/// A command, as its sender saw it. Its number is what it adds to the receiver's sum.
struct Asked {
    std::size_t sender = 0;
    Number number = 0;
    Time invoked{};
    Time responded = never;
    CommandState how = CommandState::sent;
    Number result = 0;
};
/// The receiver accepted a command, or refused it.
struct Begun {
    Number number = 0;
    Time at{};
    bool is_refused = false;
};
struct Executed {
    Number number = 0;
    Number result = 0;
    Time at{};
};
/// Both ends of a row, one way, of all starts.
struct Channel {
    std::string_view name{};
    std::size_t sender = 0, receiver = 0;
    bool has_services = false; ///< each arrival is a `Served` of this sender
    SendCounts sent{};
    ReceiveCounts received{};
    std::uint64_t waiting = 0; ///< at the end of the history: neither answered, nor lost, nor unknown
};
/// The bounds from the rows.
struct Times {
    Duration event{}, command{}; ///< from emission or sending until served or given up
    Duration reader{};           ///< until a sender learns what its node knows
    Duration drift{};            ///< total drift of the clocks against the true time
};

struct History {
    Times times{};
    std::size_t receiver = 0;
    std::vector<std::vector<Life>> lives{}; ///< by node
    std::vector<Emission> emitted{};
    std::vector<Loss> told{};
    std::vector<Served> served{};
    std::vector<Asked> asked{};
    std::vector<Begun> begun{};
    std::vector<Executed> executed{};
    std::vector<Channel> channels{};

    [[nodiscard]] bool has_end_in(std::size_t node, Time from, Time to) const {
        return std::ranges::any_of(lives[node],
                                   [&](const Life& life) { return life.ends >= from && life.ends <= to; });
    }
    [[nodiscard]] std::size_t ends_of(std::size_t node) const {
        return static_cast<std::size_t>(
            std::ranges::count_if(lives[node], [](const Life& life) { return life.ends != never; }));
    }
};

/// Returns empty when the rule holds.
using Fault = std::string;

template <class List>
auto find_number(const List& list, Number number) {
    return std::ranges::find(list, number, [](const auto& each) { return each.number; });
}

inline Fault never_twice(const History& history) {
    const auto check = [](const auto& list, const char* what) -> Fault {
        std::set<Number> met;
        for (const auto& each : list)
            if (!met.insert(each.number).second) return std::to_string(each.number) + what;
        return {};
    };
    if (const Fault fault = check(history.served, " was served twice"); !fault.empty()) return fault;
    if (const Fault fault = check(history.begun, " was taken up twice"); !fault.empty()) return fault;
    return check(history.executed, " was executed twice");
}

/// Everything served was emitted before, and everything executed was sent and accepted before.
inline Fault nothing_from_nowhere(const History& history) {
    for (const Served& each : history.served) {
        const auto from = find_number(history.emitted, each.number);
        if (from == history.emitted.end() || from->at > each.at)
            return "event " + std::to_string(each.number) + " was served, but not emitted before";
    }
    for (const Begun& each : history.begun) {
        const auto from = find_number(history.asked, each.number);
        if (from == history.asked.end() || from->invoked > each.at)
            return "command " + std::to_string(each.number) + " was taken up, but not sent before";
    }
    for (const Executed& each : history.executed) {
        const auto from = find_number(history.begun, each.number);
        if (from == history.begun.end() || from->at > each.at)
            return "command " + std::to_string(each.number) + " was executed, but not taken up before";
    }
    return {};
}

/// For each sender, over all starts: the receiver gets its messages in the order of emission or sending.
inline Fault in_order(const History& history) {
    const auto check = [](const auto& sources, const auto& arrivals, const char* what) -> Fault {
        std::map<Number, std::pair<std::size_t, std::size_t>> place; // sender, and position in its order
        for (std::size_t i = 0; i < sources.size(); ++i) place[sources[i].number] = {sources[i].sender, i};
        std::map<std::size_t, std::size_t> last;
        for (const auto& each : arrivals) {
            const auto from = place.find(each.number);
            if (from == place.end()) continue;
            std::size_t& before = last[from->second.first];
            if (from->second.second < before)
                return std::string{what} + " " + std::to_string(each.number) + " came after a later one";
            before = from->second.second;
        }
        return {};
    };
    const Fault fault = check(history.emitted, history.served, "event");
    return fault.empty() ? check(history.asked, history.begun, "command") : fault;
}

/// For an event that was not served, its sender's component learned so in time, or one of the two ended.
inline Fault losses_are_told(const History& history) {
    for (const Emission& each : history.emitted) {
        if (find_number(history.served, each.number) != history.served.end()) continue;
        const Time limit = each.at + history.times.event + history.times.reader + history.times.drift;
        const bool is_told = std::ranges::any_of(history.told, [&](const Loss& loss) {
            return loss.sender == each.sender && loss.at >= each.at && loss.at <= limit;
        });
        if (!is_told && !history.has_end_in(each.sender, each.at, limit) &&
            !history.has_end_in(history.receiver, each.at, limit))
            return "event " + std::to_string(each.number) + " is lost, and nobody was told";
    }
    return {};
}

/// Each message is delivered or lost, and both ends agree; only messages lost with the end of a start are
/// unknown.
inline Fault counts_agree(const History& history) {
    for (const Channel& each : history.channels) {
        const SendCounts& sent = each.sent;
        const ReceiveCounts& received = each.received;
        const auto fault = [&](const char* what) { return std::string{each.name} + ": " + what; };
        const std::size_t ends = history.ends_of(each.sender) + history.ends_of(each.receiver);
        if (each.waiting != 0) return fault("still waits for an answer");
        if (sent.offered != sent.delivered + sent.lost + sent.unknown) return fault("the sum is wrong");
        if (ends == 0 && sent.unknown != 0) return fault("unknown, but no start ended");
        if (received.served < sent.delivered || received.served > sent.delivered + sent.unknown)
            return fault("what is delivered was not served");
        if (received.lost < sent.lost || received.lost > sent.lost + sent.unknown)
            return fault("the two ends do not know the same losses");
        if (!each.has_services) continue;
        // A receiver that ends loses the waiting content of its component's mailbox: one message, of one row.
        std::uint64_t services = 0;
        for (const Emission& one : history.emitted)
            services +=
                one.sender == each.sender && find_number(history.served, one.number) != history.served.end()
                    ? 1u
                    : 0u;
        if (services > received.served || services + history.ends_of(each.receiver) < received.served)
            return fault("its services are not those that its end counted");
    }
    return {};
}

/// Served within the time of its row, and answered within twice that, since a reply waits for the previous
/// one; a command completes unless its sender ends.
inline Fault in_time(const History& history) {
    const Times& times = history.times;
    const Duration late = times.drift;
    for (const Served& each : history.served) {
        const auto from = find_number(history.emitted, each.number);
        if (from != history.emitted.end() && each.at - from->at > times.event + late)
            return "event " + std::to_string(each.number) + " was served too late";
    }
    for (const Begun& each : history.begun) {
        const auto from = find_number(history.asked, each.number);
        if (from != history.asked.end() && each.at - from->invoked > times.command + late)
            return "command " + std::to_string(each.number) + " was taken up too late";
    }
    for (const Asked& each : history.asked) {
        const auto done = find_number(history.executed, each.number);
        if (each.how == CommandState::done && done != history.executed.end() &&
            each.responded - done->at > 2 * times.command + late)
            return "command " + std::to_string(each.number) + " was answered too late";
        if (each.responded == never && !history.has_end_in(each.sender, each.invoked, never - 1ns))
            return "command " + std::to_string(each.number) + " has no end, though its sender lives";
    }
    return {};
}

/// A command that is done was executed between its two times with that result. One rejected at its own node
/// was never accepted; one refused at the other node was not executed.
inline Fault ends_are_true(const History& history) {
    for (const Asked& each : history.asked) {
        const auto begun = find_number(history.begun, each.number);
        const auto executed = find_number(history.executed, each.number);
        const std::string name = "command " + std::to_string(each.number);
        if (each.how == CommandState::done &&
            (executed == history.executed.end() || executed->at < each.invoked ||
             executed->at > each.responded || executed->result != each.result))
            return name + " is done, but was not executed so";
        if (each.how == CommandState::rejected && begun != history.begun.end())
            return name + " was rejected, and taken up all the same";
        if (begun != history.begun.end() && begun->is_refused && executed != history.executed.end())
            return name + " was refused, and executed all the same";
    }
    return {};
}

inline std::int32_t add_to(std::int32_t& sum, std::int32_t number) { return sum += number; }

/// Each start of the receiver is an object of its own, and executes nothing from before. Only refusals in the
/// receiver's record count, since refused commands did not happen: the answers alone must fit.
inline Fault linearizable(const History& history) {
    std::size_t done = 0, of_lives = 0;
    for (const Asked& each : history.asked) done += each.how == CommandState::done ? 1u : 0u;
    for (const Life& life : history.lives[history.receiver]) {
        std::vector<Operation> operations;
        for (const Asked& each : history.asked) {
            if (each.invoked < life.begins || each.invoked > life.ends) continue;
            const auto begun = find_number(history.begun, each.number);
            if (each.how == CommandState::rejected || (begun != history.begun.end() && begun->is_refused))
                continue;
            Operation one{.invoked = each.invoked, .argument = each.number};
            if (each.how == CommandState::done) one.responded = each.responded, one.result = each.result;
            of_lives += one.result ? 1u : 0u;
            operations.push_back(one);
        }
        if (!Linearization{operations, add_to}.exists())
            return "no order of the " + std::to_string(operations.size()) + " commands from " +
                   std::to_string(to_ns(life.begins)) + " ns on explains their answers";
    }
    return done == of_lives ? Fault{} : "a command is done that was sent while no receiver lived";
}

struct Checker {
    std::string_view name{};
    Fault (*check)(const History&) = nullptr;
};
inline constexpr std::array checkers{
    Checker{"never_twice", never_twice},     Checker{"nothing_from_nowhere", nothing_from_nowhere},
    Checker{"in_order", in_order},           Checker{"losses_are_told", losses_are_told},
    Checker{"counts_agree", counts_agree},   Checker{"in_time", in_time},
    Checker{"ends_are_true", ends_are_true}, Checker{"linearizable", linearizable}};

/// One entry "name: fault" for each checker that finds a fault.
inline std::vector<std::string> faults_of(const History& history) {
    std::vector<std::string> faults;
    for (const Checker& each : checkers)
        if (const Fault fault = each.check(history); !fault.empty())
            faults.push_back(std::string{each.name} + ": " + fault);
    return faults;
}

} // namespace tappet::history
