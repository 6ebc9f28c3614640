// An event has more reactions than bits.
// refused: loom: event "source.beat" has more than 64 reactions and triggers; let one operation emit an event of its own for some of them
#include "tests/diagnostics/small_machine.hpp"

using namespace small;

struct Source {
    Event<> beat;
    static constexpr auto interface() { return facets(event<&Source::beat>("beat", "of the reed")); }
};
/// 65 operations, named by two characters.
struct Crowd {
    void hear() noexcept TAPPET_REALTIME {}
    static constexpr std::size_t size = 65;
    static constexpr auto characters = [] {
        std::array<std::array<char, 8>, size> list{};
        for (std::size_t i = 0; i < size; ++i) {
            list[i] = {'c', 'r', 'o', 'w', 'd', '.'};
            list[i][6] = static_cast<char>('a' + i / 10);
            list[i][7] = static_cast<char>('a' + i % 10);
        }
        return list;
    }();
    template <std::size_t... i>
    static constexpr auto all(std::index_sequence<i...>) {
        return facets(operation<&Crowd::hear>(std::string_view{&characters[i][6], 2}, "it")...);
    }
    static constexpr auto interface() { return all(std::make_index_sequence<size>{}); }
};
template <std::size_t... i>
constexpr auto crowded(std::index_sequence<i...>) {
    return machine("loom", components(component<Source>("source"), component<Crowd>("crowd")),
                   activities(activity("all", every(1ms), budget(1us), runs("source", "crowd"))),
                   connections(),
                   reactions(when("source.beat", call(std::string_view{Crowd::characters[i].data(), 8}))...),
                   behaviours());
}
constexpr auto table = crowded(std::make_index_sequence<Crowd::size>{});
constexpr Board board{.name = "small", .world = "host", .memory_budget_bytes = 1'000'000};
template struct tappet::Firmware<table, board>;
