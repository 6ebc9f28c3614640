// The table: loops make its rows, because many are alike.
#include "tests/figures/dispatch/machine.hpp"

#include "kernel/machine/accept.hpp"
#include "tests/figures/measure/world.hpp"

namespace tappet::figures {

namespace {

/// Numbered names, with or without a facet's name after them.
struct Name {
    std::array<char, 16> characters{};
    std::size_t size = 0;
    constexpr Name() = default;
    constexpr Name(char kind, std::size_t number, std::string_view facet) {
        for (const char character :
             {kind, static_cast<char>('0' + number / 10), static_cast<char>('0' + number % 10)})
            characters[size++] = character;
        if (!facet.empty()) characters[size++] = '.';
        for (const char character : facet) characters[size++] = character;
    }
    [[nodiscard]] constexpr std::string_view view() const { return {characters.data(), size}; }
};
template <std::size_t n>
constexpr std::array<Name, n> numbered(char kind, std::string_view facet = {}) {
    std::array<Name, n> names;
    for (std::size_t i = 0; i < n; ++i) names[i] = Name{kind, i, facet};
    return names;
}
constexpr auto listener_names = numbered<listeners>('l');
constexpr auto listener_hears = numbered<listeners>('l', "hear");
constexpr auto listener_notes = numbered<listeners>('l', "note");
constexpr auto sender_names = numbered<senders>('s');
constexpr auto sender_notes = numbered<senders>('s', "note");
constexpr auto sender_clocked = numbered<senders>('s', "clocked");

struct Fan {
    std::string_view event;
    std::size_t rows;
    std::uint32_t quota; ///< 0: rows that call
};
constexpr std::array fans{Fan{"emitter.one", 1, 0},        Fan{"emitter.two", 2, 0},
                          Fan{"emitter.eight", 8, 0},      Fan{"emitter.many", listeners, 0},
                          Fan{"emitter.tell_one", 1, 32},  Fan{"emitter.tell_two", 2, 16},
                          Fan{"emitter.tell_eight", 8, 4}, Fan{"emitter.tell_many", listeners, 1}};
constexpr std::size_t fan_rows = [] {
    std::size_t sum = 0;
    for (const Fan& fan : fans) sum += fan.rows;
    return sum;
}();
constexpr std::size_t reaction_rows = fan_rows + 2 + 1 + 2 * senders;

constexpr auto rows = [] {
    Machine<1 + senders + listeners + 1, 3, 0, reaction_rows, 0> m;
    m.name = "dispatch";
    m.activities = {activity("near", every(1ms), budget(50us), runs("emitter")),
                    activity("far", on_work(), at_most(4, 1ms), deadline(500us), budget(50us), runs()),
                    activity("clocked", every(10ms), budget(50us), runs("clocked"))};
    std::size_t c = 0;
    m.components[c++] = component<Emitter>("emitter");
    m.components[c++] = component<Listener>("clocked");
    for (const Name& name : sender_names) {
        m.components[c++] = component<Sender>(name.view());
        static_cast<void>(m.activities[0].runs.push(name.view()));
    }
    for (const Name& name : listener_names) {
        m.components[c++] = component<Listener>(name.view());
        static_cast<void>(m.activities[1].runs.push(name.view()));
    }
    std::size_t r = 0;
    for (const Fan& fan : fans)
        for (std::size_t i = 0; i < fan.rows; ++i) {
            const std::string_view hear = listener_hears[i].view();
            m.reactions[r++] = when(fan.event, fan.quota == 0 ? call(hear) : tell(hear, queue(fan.quota)));
        }
    m.reactions[r++] = when("emitter.changing", call("l00.hear"), handled_by("emitter.calling"));
    m.reactions[r++] = when("emitter.changing", tell("l01.hear"), handled_by("emitter.telling"));
    m.reactions[r++] = uses("emitter.scaled", "l00.scaled");
    for (std::size_t i = 0; i < senders; ++i) {
        m.reactions[r++] = uses(sender_notes[i].view(), listener_notes[i].view());
        m.reactions[r++] = uses(sender_clocked[i].view(), "clocked.note");
    }
    return m;
}();
// A table has one memory, so that two machines need two tables.
constexpr auto table = rows, table_with_stamps = rows;

struct Machinery {
    World world;
    Measured all{};
    Machinery(os::Clock::Kind kind, const AcceptedMachine& machine) : world{kind, machine} {
        MachineInstance& instance = world.instance;
        all.emitter = instance.find<Emitter>("emitter");
        for (std::size_t i = 0; i < senders; ++i)
            all.sender[i] = instance.find<Sender>(sender_names[i].view());
        for (std::size_t i = 0; i < listeners; ++i)
            all.listener[i] = instance.find<Listener>(listener_names[i].view());
        all.far = &instance.engines()[1];
        all.clocked = &instance.engines()[2];
        // It is woken more often than its row promises, so that the claims are measured at first, each with
        // two system calls a cycle.
        while (kind == os::Clock::Kind::real &&
               all.far->statistics().measured_claims <= Engine::measured_at_first) {
            const RunsActivity here{0};
            static_cast<void>(all.sender[0]->note.send(1.0));
            all.far->run(true);
        }
    }
};

} // namespace

Measured& measured() {
    static Machinery machinery{os::Clock::Kind::virtual_time, AtRunTime<table, figures_board>::machine()};
    return machinery.all;
}
Measured& measured_with_stamps() {
    static Machinery machinery{os::Clock::Kind::real, AtRunTime<table_with_stamps, figures_board>::machine()};
    return machinery.all;
}

} // namespace tappet::figures
