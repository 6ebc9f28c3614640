// The machine's side of browsing (thesis 4.8): a component that answers browsers over a local socket, from a
// background activity. Every change is made by the engine that owns the data.
#pragma once

#include "kernel/component/component.hpp"
#include "kernel/machine/map/view.hpp"
#include "kernel/services/browsing/connections.hpp"
#include "kernel/services/browsing/pending.hpp"
#include "kernel/services/browsing/reply.hpp"

namespace tappet {

/// Runs in an activity of its own that is not_real_time: it makes system calls, and may wait for the terminal
/// that shows its log. Nothing of the machine waits for it. A client that floods it gets its share of each
/// cycle and fills only its own socket.
///     component<BrowserService>("browser") ... activity("browser", every(20ms), not_real_time,
///     runs("browser"))
class BrowserService {
public:
    static constexpr bool sees_machine = true;
    /// The longest time that a client waits for its answer; a command reports its states as long as it runs.
    static constexpr Duration patience = 2s;
    static constexpr std::size_t max_pending = 16;
    static constexpr std::size_t max_commands = max_pending / 2; ///< of max_pending
    static constexpr std::size_t max_subscriptions = 32;
    static constexpr std::size_t max_events = 64; ///< of all subscriptions, between two cycles of the service

    Output<std::int64_t> clients, requests, refused;
    Property<bool> log{true};

    Sentence configure(Setup& setup);
    Sentence initialise();
    void work(const Cycle& cycle);
    void finalise();

    static constexpr auto interface() {
        return facets(output<&BrowserService::clients>("clients", "", "browsers that are connected"),
                      output<&BrowserService::requests>("requests", "", "accepted so far"),
                      output<&BrowserService::refused>("refused", "", "requests refused so far"),
                      property<&BrowserService::log>("log", "", "each request is printed, with who asked"));
    }

private:
    using Client = browsing::Client;
    using Request = browsing::Request;
    using Reply = browsing::Reply;
    using Refusal = browsing::Refusal;
    using Pending = browsing::Pending;

    /// The reason why a request is not done; an empty sentence: it is done, or will be.
    struct Verdict {
        Refusal code = Refusal::bad_request;
        Sentence why{};
        Verdict() = default;
        Verdict(Refusal c, const Sentence& w) noexcept : code{c}, why{w} {}
        [[nodiscard]] bool good() const noexcept { return why.empty(); }
    };
    struct Subscribed {
        browsing::Asker asker{};
        bool taken = false;
        End event{};
        std::size_t index = nowhere; ///< in the plan's subscriptions
        EventHandle handle{};
        std::int64_t lost = 0; ///< in this service, minus earlier losses of others
    };
    /// An emission, received between two cycles.
    struct Seen {
        std::size_t index = nowhere;
        Time at{};
        std::size_t arguments = 0; ///< their place in seen_bytes_
    };

    using Serve = Verdict(Client&, const Request&);
    /// Checks a pending request. True: it is over, and its client was answered.
    using Look = bool(Pending&);
#define TAPPET_X(name, ...) Serve serve_##name;
    TAPPET_REQUESTS(TAPPET_X)
#undef TAPPET_X
    Look look_at_facet, look_at_change, look_at_command, look_at_life, look_at_behave, look_at_why,
        look_at_line, look_at_saving;

    Serve answer;
    void accept();
    void hear(Client& client);
    void handle(Client& client, std::string_view packet, bool cut);
    void note(const Client& client, std::string_view what, std::string_view packet, const Verdict& verdict);
    /// Sends the reply as the answer: nothing is refused.
    Verdict finish(Client& client, Reply& reply) noexcept;
    /// Implements BrowsingAnswerer.
    static std::size_t answer_for_nobody(void* self, std::string_view request, std::span<char> into);
    [[nodiscard]] browsing::Asker asker(const Client& client, const Request& request) const noexcept {
        return {client.serial, request.number, now_, client.rights.role, client.user};
    }

    // Pending requests; requests_pending.cpp
    [[nodiscard]] Pending* free_place(Role role) noexcept;
    static Verdict no_place() noexcept;
    Verdict await(Pending& place, const browsing::Asker& asker, Look BrowserService::* look);
    Verdict await_engine(Pending& place, const browsing::Asker& asker, std::size_t component,
                         const Message& call, Look BrowserService::* look);
    void follow_pending();
    [[nodiscard]] Client* who_waits(const Pending& place) noexcept;
    bool answer_good(const Pending& place) noexcept;
    bool answer_bad(const Pending& place, Refusal code, const Sentence& why) noexcept;
    void note_end(const Pending& place, std::string_view how, std::string_view why) const noexcept;

    // Reading; requests_read.cpp
    void put_value(Reply& reply, End end, std::string_view name);

    // Changing; requests_change.cpp
    [[nodiscard]] static Verdict check_role(const Client& client, std::string_view what, Role least);
    /// The gate for each operation, method and command that a client names: its role and its origin.
    [[nodiscard]] static Verdict check_facet(const Client& client, std::string_view name, const Facet& facet);
    [[nodiscard]] Verdict read_arguments(const Facet& facet, const Request& request,
                                         std::span<std::byte> into);
    browsing::FacetCall& prepare(Pending& place, End end) const noexcept;
    Verdict reach(Pending& place, const browsing::Asker& asker, End end, Message::Run act);
    [[nodiscard]] Verdict check_alive(std::size_t component) noexcept;

    // Commands and lives; requests_follow.cpp
    Verdict change_life(Client& client, const Request& request, LifeChange change);

    // Events; requests_stream.cpp
    static void observe(void* self, std::size_t index, const std::byte* arguments, Time now) noexcept
        TAPPET_REALTIME;
    void tell_events();
    void drop(Subscribed& subscribed) noexcept;
    [[nodiscard]] std::int64_t lost_of(const Subscribed& subscribed) const noexcept;

    // Behaviours; requests_behaviour.cpp
    struct FoundBehaviour {
        std::size_t row = 0;
        BehaviourUnit* unit = nullptr;
        std::size_t part = 0;
    };
    /// A script that is being sent to a slot.
    struct Upload {
        BehaviourSlot* slot = nullptr;
        std::uint64_t client = 0;
        std::size_t characters = 0;
        Time since{};
    };
    Verdict empty_slot(Client& client, const Request& request, BehaviourSlot::Change change);
    Verdict change_slot(Client& client, const Request& request, BehaviourSlot& slot,
                        BehaviourSlot::Change change, const SlotMoment& moment);
    [[nodiscard]] BehaviourUnit* unit_of(std::size_t row) noexcept;
    Sentence find_behaviour(std::string_view name, FoundBehaviour& found) noexcept;
    Sentence find_slot(std::string_view name, BehaviourSlot*& slot) noexcept;
    template <class Copy>
    [[nodiscard]] bool read_between_steps(std::size_t activity, const Copy& copy) {
        // This activity is in the middle of a cycle and steps no behaviour meanwhile; nothing steps when no
        // client waits for the answer.
        if (activity == own_activity_ || for_nobody_.data() != nullptr) {
            copy();
            return true;
        }
        const auto view = map::View::open(machine_->observation().shared_memory());
        return view && view->consistent(static_cast<std::uint32_t>(activity), reading_attempts, copy);
    }
    void put_behaviour(Reply& reply, std::size_t row, const BehaviourUnit& unit, const UnitPart& part,
                       bool all);
    void put_slot(Reply& reply, const BehaviourSlot& slot);

    // Why a state machine is not in a state; requests_why.cpp
    Sentence find_state(std::string_view name, browsing::WhyOrder& order);

    // Lines of the script language; requests_line.cpp
    [[nodiscard]] browsing::FollowedLine find_interpreter_of_lines() noexcept;
    static Verdict no_interpreter() noexcept;

    static constexpr int reading_attempts = 1000;
    static constexpr std::size_t value_alignment = 16;
    MachineInstance* machine_ = nullptr;
    std::size_t own_activity_ = nowhere;
    Time now_{};
    browsing::Connections connections_{};
    std::uint64_t accepted_ = 0;
    std::uint64_t refused_ = 0;
    std::uint64_t turned_away_ = 0;
    std::array<Pending, max_pending> pending_{};
    std::array<Subscribed, max_subscriptions> subscribed_{};
    std::array<Seen, max_events> seen_{};
    alignas(value_alignment) std::array<std::byte, max_events * sizeof(Message::arguments)> seen_bytes_{};
    std::size_t seen_count_ = 0;
    std::size_t seen_bytes_used_ = 0;
    Upload upload_{};
    std::array<char, browsing::max_packet_bytes + 1> packet_{};
    std::span<char> for_nobody_{}; ///< the rest of the answer's buffer; empty: answer the client
};

} // namespace tappet
