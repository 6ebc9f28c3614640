// Emission to several subscribers, and rows that are connected and disconnected.
#include "tests/figures/dispatch/groups.hpp"
#include "tests/figures/dispatch/machine.hpp"

#include <boost/lockfree/spsc_queue.hpp>
#include <boost/signals2.hpp>

#include <atomic>
#include <cstring>
#include <functional>
#include <vector>

namespace tappet::figures {

namespace {

// ---- floors and peers: the same reaction by other means

// Aligned like ours: where a short function crosses a block of 32 bytes, a call takes a fifth longer.
[[gnu::noinline, gnu::aligned(32)]] void hear(void* context, double value) noexcept {
    static_cast<Listener*>(context)->sum += value;
}
struct Entry {
    void (*function)(void*, double) noexcept;
    void* context;
};
struct List {
    std::size_t count = 0;
    std::array<Entry, listeners> entries{};
};
template <std::size_t n>
List& list() {
    static List filled = [] {
        List made{n, {}};
        for (std::size_t i = 0; i < n; ++i) made.entries[i] = {&hear, measured().listener[i]};
        return made;
    }();
    return filled;
}
template <std::size_t n>
void call_pointers(std::size_t times) {
    List& called = list<n>();
    for (std::size_t i = 0; i < times; ++i) {
        keep(called);
        const std::size_t count = called.count;
        for (std::size_t k = 0; k < count; ++k) called.entries[k].function(called.entries[k].context, 1.0);
    }
}

template <std::size_t n>
void call_functions(std::size_t times) {
    static std::vector<std::function<void(double)>> functions = [] {
        std::vector<std::function<void(double)>> filled;
        for (std::size_t i = 0; i < n; ++i)
            filled.emplace_back([at = measured().listener[i]](double value) { hear(at, value); });
        return filled;
    }();
    for (std::size_t i = 0; i < times; ++i) {
        keep(functions);
        for (const auto& function : functions) function(1.0);
    }
}

using Signal = boost::signals2::signal<void(double)>;
template <std::size_t n>
void call_signal(std::size_t times) {
    static Signal emitted;
    [[maybe_unused]] static const std::size_t connected = [] {
        for (std::size_t i = 0; i < n; ++i)
            emitted.connect([at = measured().listener[i]](double value) { hear(at, value); });
        return n;
    }();
    for (std::size_t i = 0; i < times; ++i) emitted(1.0);
}

// ---- ours

template <Event<double> Emitter::* event>
void emit(std::size_t times) {
    const RunsActivity here{0};
    Emitter* const emitter = measured().emitter;
    for (std::size_t i = 0; i < times; ++i) (emitter->*event).emit(1.0);
}
void serve(std::size_t) { measured().far->run(true); }

void single_call(std::size_t times) {
    static void (*volatile pointer)(void*, double) noexcept = &hear;
    Listener* const listener = measured().listener[0];
    for (std::size_t i = 0; i < times; ++i) pointer(listener, 1.0);
}

template <Event<double> Emitter::* event, std::size_t n>
Group synchronous(std::string name) {
    return {"dispatch.emit.call." + name,
            "emission to " + name + " synchronous subscriber" + (n == 1 ? "" : "s"),
            "thesis 4.6.2",
            n == 64 ? std::size_t{8} : std::size_t{64},
            {{"emit", Standing::ours, &emit<event>},
             {"loop over function pointers", Standing::floor, &call_pointers<n>},
             {"loop over std::function", Standing::peer, &call_functions<n>},
             {"boost signals2", Standing::peer, &call_signal<n>}},
            {{"emit to n = " + name + " synchronous subscribers <= 1.1 x a loop over n function pointers",
              "emit",
              1.1,
              {"loop over function pointers"}}}};
}

// ---- asynchronous: each subscriber's message goes to its engine's mailbox

/// As large as one of our messages.
struct Parcel {
    void (*run)(void*, const std::byte*);
    void* object;
    std::array<std::byte, sizeof(Message) - 2 * sizeof(void*)> arguments;
};
boost::lockfree::spsc_queue<Parcel, boost::lockfree::capacity<256>> parcels;
std::atomic<std::uint64_t> bits{0};
template <std::size_t n>
void push_parcels(std::size_t times) {
    double value = 1.0;
    keep(value);
    for (std::size_t i = 0; i < times; ++i)
        for (std::size_t k = 0; k < n; ++k) {
            Parcel parcel{nullptr, &parcels, {}};
            std::memcpy(parcel.arguments.data(), &value, sizeof value);
            bool pushed = parcels.push(parcel);
            keep(pushed);
            bits.fetch_or(1, std::memory_order_release);
        }
}
void take_parcels(std::size_t) {
    parcels.consume_all([](const Parcel&) {});
    bits.store(0);
}

template <Event<double> Emitter::* event, std::size_t n>
Group asynchronous(std::string name, std::size_t batch) {
    return {"dispatch.emit.tell." + name,
            "emission to " + name + " asynchronous subscriber" + (n == 1 ? "" : "s") + " of another activity",
            "thesis 4.6.2",
            batch,
            {{"emit", Standing::ours, &emit<event>, &serve},
             {"boost spsc_queue push of 72 bytes and atomic OR, for each", Standing::floor, &push_parcels<n>,
              &take_parcels}}};
}

// ---- rows that are connected and disconnected

template <EventHandle Emitter::* handle>
void change(std::size_t times) {
    const EventHandle& row = measured().emitter->*handle;
    for (std::size_t i = 0; i < times; ++i) {
        row.disconnect();
        row.connect();
    }
}
void two_operations(std::size_t times) {
    for (std::size_t i = 0; i < times; ++i) {
        bits.fetch_and(~std::uint64_t{1}, std::memory_order_release);
        bits.fetch_or(1, std::memory_order_release);
    }
}
void change_signal(std::size_t times) {
    static Signal changing;
    for (std::size_t i = 0; i < times; ++i) {
        const boost::signals2::connection made = changing.connect([](double) {});
        made.disconnect();
    }
}

} // namespace

void add_events(std::vector<Group>& groups) {
    groups.push_back({"dispatch.emit.none",
                      "emission while nobody is connected",
                      "thesis 4.6.2",
                      64,
                      {{"emit", Standing::ours, &emit<&Emitter::none>},
                       {"call through a function pointer", Standing::floor, &single_call},
                       {"loop over no function pointer", Standing::floor, &call_pointers<0>},
                       {"boost signals2", Standing::peer, &call_signal<0>}}});
    groups.back().goals.push_back(
        {"emit with no subscriber connected <= 1 ns where a function-pointer call costs 2",
         "emit",
         0.5,
         {"call through a function pointer"}});
    groups.push_back(synchronous<&Emitter::one, 1>("1"));
    groups.push_back(synchronous<&Emitter::two, 2>("2"));
    groups.push_back(synchronous<&Emitter::eight, 8>("8"));
    groups.push_back(synchronous<&Emitter::many, 64>("64"));
    groups.push_back(asynchronous<&Emitter::tell_one, 1>("1", 32));
    groups.push_back(asynchronous<&Emitter::tell_two, 2>("2", 16));
    groups.push_back(asynchronous<&Emitter::tell_eight, 8>("8", 4));
    groups.push_back(asynchronous<&Emitter::tell_many, 64>("64", 1));
    groups.push_back({"dispatch.connect",
                      "disconnect and connect",
                      "thesis 4.6.2",
                      64,
                      {{"a synchronous row", Standing::ours, &change<&Emitter::calling>},
                       {"an asynchronous row", Standing::ours, &change<&Emitter::telling>},
                       {"two atomic operations", Standing::floor, &two_operations},
                       {"boost signals2", Standing::peer, &change_signal}}});
}

} // namespace tappet::figures
